// Compressed size of the page's files, as transferred.

/**
 * {path: compressed bytes} of the page, whose path is "", and of the files that it loads at first.
 * They lie in a folder named by 12 hexadecimal digits (web/bundle.mjs). url: without a trailing
 * slash.
 */
export async function weigh(url) {
  const text = async (path) => (await fetch(`${url}/${path}`)).text();
  const paths = new Set(["", ...(await text("")).match(/(?<=(?:src|href)=")[0-9a-f]{12}\/[^"]+/g)]);
  // A set also visits what is added meanwhile: modules imported by modules.
  for (const path of paths) {
    if (!path.endsWith(".js")) continue;
    const folder = path.slice(0, path.lastIndexOf("/") + 1);
    for (const [, name] of (await text(path)).matchAll(/(?:from|import)\s*"\.\/([^"]+)"/g))
      paths.add(folder + name);
  }
  const bytes = async (path) => {
    const options = {headers: {"Accept-Encoding": "gzip"}, method: "HEAD"};
    const {headers} = await fetch(`${url}/${path}`, options);
    return Number(headers.get("content-length"));
  };
  return Object.fromEntries(
    await Promise.all([...paths].map(async (path) => [path, await bytes(path)])),
  );
}

export const sum = (bytes) => Object.values(bytes).reduce((a, b) => a + b);

// Compressed size of the page's files, as transferred.

/**
 * {path: compressed bytes} of the page, whose path is "", and of the files that it references. They
 * lie in a folder named by 12 hexadecimal digits (web/bundle.mjs). url: without a trailing slash.
 */
export async function weigh(url) {
  const index = await (await fetch(url)).text();
  const paths = ["", ...index.match(/(?<=(?:src|href)=")[0-9a-f]{12}\/[^"]+/g)];
  const bytes = async (path) => {
    const options = {headers: {"Accept-Encoding": "gzip"}, method: "HEAD"};
    const {headers} = await fetch(`${url}/${path}`, options);
    return Number(headers.get("content-length"));
  };
  return Object.fromEntries(
    await Promise.all(paths.map(async (path) => [path, await bytes(path)])),
  );
}

export const sum = (bytes) => Object.values(bytes).reduce((a, b) => a + b);

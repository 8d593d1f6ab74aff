// Size of the page's files as transferred.

/** Compressed bytes by path. */
export async function weigh(url) {
  const index = await (await fetch(url)).text();
  const paths = ["", ...index.match(/(?<=(?:src|href)=")[0-9a-f]{12}\/[^"]+/g)];
  const bytes = async (path) => {
    const asked = {headers: {"Accept-Encoding": "gzip"}, method: "HEAD"};
    const {headers} = await fetch(`${url}/${path}`, asked);
    return Number(headers.get("content-length"));
  };
  return Object.fromEntries(
    await Promise.all(paths.map(async (path) => [path, await bytes(path)])),
  );
}

export const sum = (bytes) => Object.values(bytes).reduce((a, b) => a + b);

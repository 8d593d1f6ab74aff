// Compressed size of the page's files, as transferred.

/**
 * {name: compressed bytes} of the page, whose name is "", and of the files that it has loaded. They
 * lie in a folder named by 12 hexadecimal digits (web/bundle.mjs).
 */
export const weigh = (page) =>
  page.evaluate(() => {
    const [index] = performance.getEntriesByType("navigation");
    const files = performance
      .getEntriesByType("resource")
      .map(({name, encodedBodySize}) => [/\/[0-9a-f]{12}\/(.*)/.exec(name)?.[1], encodedBodySize])
      .filter(([name]) => name);
    return {"": index.encodedBodySize, ...Object.fromEntries(files)};
  });

export const sum = (bytes) => Object.values(bytes).reduce((a, b) => a + b);

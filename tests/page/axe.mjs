// What axe-core finds on a page.
import {readFile} from "node:fs/promises";
import {createRequire} from "node:module";

const require = createRequire(new URL("../../web/package.json", import.meta.url));

/** In words, a text for each. */
export async function findings(page) {
  const axe = await readFile(require.resolve("axe-core/axe.min.js"), "utf8");
  return page.evaluate(async (source) => {
    new Function(source)();
    const {violations} = await window.axe.run(document, {resultTypes: ["violations"]});
    return violations.flatMap(({id, nodes}) =>
      nodes.map(({target, failureSummary}) => `${id}: ${target.join(" ")}: ${failureSummary}`),
    );
  }, axe);
}

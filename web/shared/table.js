// Tables of texts.
import {element} from "./dom.js";

const row = (tag, cells) =>
  element("tr", {}, ...cells.map((textContent) => element(tag, {textContent})));

/** The head and the body of a table. */
export const tableOf = (names, rows) => [
  element("thead", {}, row("th", names)),
  element("tbody", {}, ...rows.map((cells) => row("td", cells))),
];

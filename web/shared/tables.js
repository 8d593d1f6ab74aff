// Lists of labelled values, remarks and warnings; tables of texts.
import {$, element} from "./dom.js";
import {count} from "./numbers.js";

/** Shows entries [term, value, remark] as cards in a <dl>. */
export function cards(list, entries) {
  const card = ([term, value, remark]) => {
    const small = element("small", {}, remark ? ` ${remark}` : "");
    return element("div", {}, element("dt", {}, term), element("dd", {}, value, small));
  };
  list.replaceChildren(...entries.map(card));
}

/** Lists remarks in the <details id>, with their number as summary; hides it without any. */
export function showRemarks(id, remarks) {
  const details = $(id);
  details.hidden = !remarks.length;
  details.querySelector("summary").textContent = count(remarks.length, "remark");
  listWarnings(details.querySelector("ul"), remarks);
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {}, w)));

const row = (tag, cells) =>
  element("tr", {}, ...cells.map((textContent) => element(tag, {textContent})));

/** Head and body of a table. */
export const tableOf = (names, rows) => [
  element("thead", {}, row("th", names)),
  element("tbody", {}, ...rows.map((cells) => row("td", cells))),
];

// Terms with their values, as cards, and warnings as a list.
import {$, element} from "./dom.js";
import {count} from "./numbers.js";

/** entries: [term, value, a remark]. */
export function cards(list, entries) {
  const card = ([term, value, remark]) => {
    const small = element("small", {}, remark ? ` ${remark}` : "");
    return element("div", {}, element("dt", {}, term), element("dd", {}, value, small));
  };
  list.replaceChildren(...entries.map(card));
}

/** What there is to know beside a result, behind its number: in a <details id> with a list. */
export function showRemarks(id, remarks) {
  const details = $(id);
  details.hidden = !remarks.length;
  details.querySelector("summary").textContent = count(remarks.length, "remark");
  listWarnings(details.querySelector("ul"), remarks);
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {}, w)));

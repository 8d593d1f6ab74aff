// Terms with their values, as cards, and warnings as a list.
import {element} from "./dom.js";

/** entries: [term, value, a remark]. */
export function cards(list, entries) {
  const card = ([term, value, remark]) => {
    const small = element("small", {textContent: remark ? ` ${remark}` : ""});
    const name = element("dt", {textContent: term});
    return element("div", {}, name, element("dd", {}, value, small));
  };
  list.replaceChildren(...entries.map(card));
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {textContent: w})));

// Terms with their values, as cards, and warnings as a list.
import {element} from "./dom.js";

/** entries: [term, value, a remark]. */
export function cards(list, entries) {
  const card = ([term, value, remark]) => {
    const small = element("small", {}, remark ? ` ${remark}` : "");
    return element("div", {}, element("dt", {}, term), element("dd", {}, value, small));
  };
  list.replaceChildren(...entries.map(card));
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {}, w)));

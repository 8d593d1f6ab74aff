// <details> elements filled when first opened, because schemas can be recursive.
import {$, element} from "../shared/dom.js";

const openers = new Map(); // functions that open an element, by its id

/**
 * Returns a <details> element. summary: nodes; make() returns the content; place: id, if any, by
 * which unfold() opens the element.
 */
export function fold(summary, make, place) {
  const node = element("details", {}, element("summary", {}, ...summary));
  let filled = false;
  const open = () => {
    if (!filled) node.append(...make());
    filled = true;
    node.open = true;
  };
  node.addEventListener("toggle", () => node.open && open());
  if (place) openers.set(place, open);
  return node;
}

/**
 * Opens all elements around an id, from the outside in. Ids are paths such as "a.b/c": each part
 * before a "." or "/" is the id of an enclosing element.
 */
export const unfold = (place) => {
  for (const {index} of place.matchAll(/[./]|$/g)) openers.get(place.slice(0, index))?.();
};

/** Opens and focuses the element whose id is the fragment `hash` ("#id"), and scrolls to it. */
export function reveal(hash) {
  const place = hash.slice(1);
  unfold(place);
  const found = $(place);
  if (!found) return;
  const focused = found.tagName === "DETAILS" ? found.firstChild : found;
  if (focused === found) found.tabIndex = -1;
  focused.focus({preventScroll: true});
  found.scrollIntoView({block: focused === found ? "center" : "start"});
}

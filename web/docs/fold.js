// <details> elements filled when first opened, because schemas can be recursive.
import {$, element} from "../shared/dom.js";

const folds = new Map(); // by the id of their content

/** A <details> element. summary: nodes; make() returns the content; place: its id, if any. */
export function fold(summary, make, place) {
  const node = element("details", {}, element("summary", {}, ...summary));
  let filled = false;
  const open = () => {
    if (!filled) node.append(...make());
    filled = true;
    node.open = true;
  };
  node.addEventListener("toggle", () => node.open && open());
  if (place) folds.set(place, open);
  return node;
}

/** Opens all elements around an id, from the outside in. */
export const unfold = (place) => {
  for (const {index} of place.matchAll(/[./]|$/g)) folds.get(place.slice(0, index))?.();
};

/** Scrolls to the id in the address and focuses it. */
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

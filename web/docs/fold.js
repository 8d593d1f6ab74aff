// What is folded is made when it is first opened: a schema may hold itself.
import {$, element} from "../shared/dom.js";

const folds = new Map(); // by the place of what they hold

/** A <details>. summary: nodes; make(): the nodes in it; place: of them, if they have one. */
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

/** Opens what is around a place, from outside in. */
export const unfold = (place) => {
  for (const {index} of place.matchAll(/[./]|$/g)) folds.get(place.slice(0, index))?.();
};

/** Goes to the place that the address names. */
export function reveal(hash) {
  const place = hash.slice(1);
  unfold(place);
  const found = $(place);
  if (!found) return;
  const heard = found.tagName === "DETAILS" ? found.firstChild : found;
  if (heard === found) found.tabIndex = -1;
  heard.focus({preventScroll: true});
  found.scrollIntoView({block: heard === found ? "center" : "start"});
}

// Terms that explain themselves: the element `term-NAME` of the page, on hover, focus and touch.
import {$, attributes, on} from "./dom.js";

const box = $("term");

function show({target}) {
  if (box.contains(target)) return; // on the way to its link
  const node = target.closest?.("[data-term]");
  box.hidden = !node;
  if (!node) return;
  attributes(node, {"aria-describedby": box.id});
  box.replaceChildren($(`term-${node.dataset.term}`).content.cloneNode(true));
  const {left, top, bottom} = node.getBoundingClientRect();
  const {offsetWidth: width, offsetHeight: height} = box;
  const fits = bottom + height < innerHeight;
  box.style.left = `${Math.max(Math.min(left, innerWidth - width), 0)}px`;
  box.style.top = `${fits ? bottom : top - height}px`;
}

on(document, {
  pointerover: show,
  focusin: show,
  keydown({key}) {
    if (key === "Escape") box.hidden = true;
  },
});

// What all plots have in common: a canvas that is drawn anew whenever it gets another size, and over
// it a ring about one point, which needs no new drawing. One that has no width, as in a closed part
// of the page, is drawn when it gets one.
import {element} from "./dom.js";
import {blank, Size} from "./frame.js";

export class Plot {
  frame = null;
  head = 0;
  lit = [];

  /**
   * container: the node whose size counts; layer: what the ring lies in. What is drawn is of who extends
   * this: prepare(width, height, alone), {frame, ...}; and paint(c, what was prepared), c: a canvas'
   * context, or what draws in its place. head: px above the canvas; offset: of the canvas in
   * the ring's layer, px.
   */
  constructor(canvas, container, layer) {
    Object.assign(this, {canvas, container});
    this.ring = element("div", {className: "lit", hidden: true});
    layer.append(this.ring);
    this.size = new Size(container, () => this.resized());
  }

  resized() {
    this.refresh();
  }

  /** Draws what is in view. */
  refresh() {
    const {width} = this.size;
    if (!width) return;
    const height = Math.max(this.size.height - this.head, 50);
    const prepared = this.prepare(width, height);
    if (!prepared) return;
    this.frame = prepared.frame;
    this.place(height);
    this.paint(blank(this.canvas, {width, height}), prepared);
    this.light(...this.lit);
  }

  /** A canvas of so many px, and what lies over it, get their place. */
  place() {}

  /** All of it, for a picture of its own. */
  paintAll(c, width, height) {
    const prepared = this.prepare(width, height, true);
    if (prepared) this.paint(c, prepared);
  }

  /** Rings a point; none without one, or out of view. */
  light(x, y) {
    this.lit = [x, y];
    const {frame, ring} = this;
    const [left, top] = frame ? [frame.px(x ?? NaN), frame.py(y ?? NaN)] : [];
    ring.hidden = !frame?.holds(left, top);
    if (ring.hidden) return;
    const [right, down] = this.offset;
    ring.style.transform = `translate(${left + right}px, ${top + down}px)`;
  }
}

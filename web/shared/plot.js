// Base of all plots: a canvas that is redrawn when its size changes, and a ring around one point,
// which moves without redrawing. A plot of width zero (in a closed <details>) is drawn when it gets
// a width.
import {element} from "./dom.js";
import {blank, Size} from "./frame.js";

export class Plot {
  frame = null;
  head = 0;
  lit = [];

  /**
   * container: the node whose size counts; layer: parent of the ring. Subclasses implement
   * prepare(width, height, alone), which returns {frame, ...}, and paint(c, prepared) with a canvas
   * context or an SvgPen. head: px above the canvas; offset: position of the canvas in `layer`, px.
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

  /** Positions the canvas; overridden by subclasses. */
  place() {}

  /** Draws the plot for export. */
  paintAll(c, width, height) {
    const prepared = this.prepare(width, height, true);
    if (prepared) this.paint(c, prepared);
  }

  /** Rings a point; hides the ring without one or when the point is out of view. */
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

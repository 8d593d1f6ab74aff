// Bases of all plots. A plot is a canvas that is redrawn when its size changes, and a ring around one
// point, which moves without redrawing. A plot of width zero (in a closed <details>) is drawn when
// it gets a width.
import {element} from "./dom.js";
import {blank, font, Size} from "./frame.js";
import {listen} from "./gestures.js";
import {drawText, ink} from "./ink.js";
import {nearest} from "./search.js";
import {Viewport} from "./viewport.js";

export class Plot {
  frame = null;
  head = 0;
  lit = [];

  /**
   * container: the node whose size counts; layer: parent of the ring; viewport: whose cursor the
   * ring follows, if any. Subclasses implement prepare(width, height, alone), which returns {frame,
   * marks}, or {empty} for a text in place of both, or null. head: px above the canvas; offset:
   * position of the canvas in `layer`, px.
   */
  constructor(canvas, container, layer, viewport) {
    Object.assign(this, {canvas, container, viewport});
    this.ring = element("div", {className: "lit", hidden: true});
    layer.append(this.ring);
    this.size = new Size(container, () => this.resized());
    viewport?.onCursor(() => this.point());
  }

  /**
   * points: {x, y, t}, of which the one nearest to the cursor is ringed; t: their places on the
   * viewport, by default x. Further options are those of the subclass.
   */
  draw(options) {
    this.last = options;
    this.refresh();
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
    paint(blank(this.canvas, {width, height}), {width, height, ...prepared});
    this.point();
    this.light(...this.lit);
  }

  /** Positions the canvas; overridden by subclasses. */
  place() {}

  /** Draws the plot for export. */
  paintAll(c, width, height) {
    const prepared = this.prepare(width, height, true);
    if (prepared) paint(c, {width, height, ...prepared});
  }

  /** Follows the cursor. */
  point() {
    const {x, y, t = x} = this.last?.points ?? {};
    const {cursor} = this.viewport ?? {};
    if (!x || cursor == null) return;
    const i = nearest(t, cursor);
    this.light(x[i], y[i]);
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

/** A plot over a viewport. Plots that share a viewport zoom together and show one cursor. */
export class ZoomablePlot extends Plot {
  /**
   * viewport: of x; across: of y, where the plot zooms in both directions. In addition to the
   * methods of Plot, subclasses implement cursorText(cursor) and click(at, reach, {top, y, touch}).
   */
  constructor(container, viewport = new Viewport(), across = null) {
    const canvas = element("canvas");
    const over = element("div", {className: "over"});
    super(canvas, container, over, viewport);
    Object.assign(this, {across, over});
    this.cursor = element("div", {className: "cursor", hidden: true});
    over.prepend(this.cursor);
    container.append(canvas, over);
    for (const each of [viewport, across]) each?.onZoom(() => this.soon());
    listen(over, viewport, (...where) => this.click(...where), across);
  }

  /** Redraws once before the next frame. */
  soon() {
    this.waiting ||= requestAnimationFrame(() => {
      this.waiting = 0;
      this.refresh();
    });
  }

  /** Positions the canvas and the element over it. */
  place(height) {
    const {box, width, height: high} = this.frame;
    this.offset = [-box.left, -box.top];
    const place = {left: box.left, top: box.top + this.head, width, height: high};
    for (const [name, px] of Object.entries(place)) this.over.style[name] = `${px}px`;
    this.canvas.style.height = `${height}px`;
  }

  point() {
    super.point();
    const {cursor, range, width} = this.viewport;
    const share = cursor === null ? -1 : (cursor - range[0]) / width;
    const inView = this.frame && share >= 0 && share <= 1;
    this.cursor.hidden = !inView;
    if (!inView) return;
    this.cursor.style.transform = `translateX(${Math.round(share * this.frame.width)}px)`;
    this.cursor.dataset.at = this.cursorText(cursor);
  }
}

function paint(c, {frame, marks, empty, width, height}) {
  if (!frame) {
    c.font = font;
    ink(c, "soft");
    return drawText(c, empty, width / 2, height / 2);
  }
  frame.draw(c);
  frame.clip(c);
  for (const mark of marks) if (!mark.above) mark.draw(c, frame);
  c.restore();
  for (const mark of marks) if (mark.above) mark.draw(c, frame);
}

// What plots over an Axis have in common: a canvas with a frame, and over it the cursor, a ring and
// what takes the pointer. Plots that share an axis zoom together and show one cursor. One that has no
// width, as in a closed part of the page, is drawn when it gets one.
import {Axis} from "./axis.js";
import {element} from "./dom.js";
import {blank, Size} from "./frame.js";
import {listen} from "./gestures.js";

export class Panel {
  /**
   * axis: that of x; across: that of y, where one zooms into it, too. What is drawn is of who
   * extends this: prepare(width, height, alone), {frame, ...}; paint(c, what was prepared); and
   * cursorText(cursor) and click(at, reach, {left, top, touch}). head: px above the canvas.
   */
  constructor(container, axis = new Axis(), across = null) {
    Object.assign(this, {container, axis, across, frame: null, head: 0});
    this.canvas = element("canvas");
    this.over = element("div", {className: "over"});
    this.cursor = element("div", {className: "cursor", hidden: true});
    this.ring = element("div", {className: "lit", hidden: true});
    this.over.append(this.cursor, this.ring);
    container.append(this.canvas, this.over);
    axis.onView(() => this.soon());
    across?.onView(() => this.soon());
    axis.onCursor(() => this.point());
    listen(this.over, axis, (...where) => this.click(...where), across);
    this.size = new Size(container, () => this.resized());
  }

  resized() {
    this.refresh();
  }

  /** Before the next frame, however often one asks. */
  soon() {
    this.waiting ||= requestAnimationFrame(() => {
      this.waiting = 0;
      this.refresh();
    });
  }

  /** Draws what is in view. */
  refresh() {
    const {width} = this.size;
    if (!width) return;
    const height = Math.max(this.size.height - this.head, 50);
    const prepared = this.prepare(width, height);
    if (!prepared) return;
    this.frame = prepared.frame;
    this.place(width, height);
    this.paint(blank(this.canvas, {width, height}), prepared);
    this.point();
    this.light(...(this.lit ?? []));
  }

  /** The canvas, and what lies over it and takes the pointer. */
  place(width, height) {
    const {box} = this.frame;
    const placed = [width, height, box.right, box.bottom, this.head].join();
    if (this.placed === placed) return;
    this.placed = placed;
    this.canvas.style.height = `${height}px`;
    Object.assign(this.over.style, {
      left: `${box.left}px`,
      top: `${box.top + this.head}px`,
      width: `${this.frame.width}px`,
      height: `${this.frame.height}px`,
    });
  }

  /** All of it, for a picture of its own. */
  paintAll(c, width, height) {
    const prepared = this.prepare(width, height, true);
    if (prepared) this.paint(c, prepared);
    return prepared;
  }

  /** The cursor. */
  point() {
    const {cursor, view} = this.axis;
    const inView = this.frame && cursor !== null && cursor >= view[0] && cursor <= view[1];
    this.cursor.hidden = !inView;
    if (!inView) return;
    const share = (cursor - view[0]) / (view[1] - view[0]);
    this.cursor.style.transform = `translateX(${Math.round(share * this.frame.width)}px)`;
    this.cursor.dataset.at = this.cursorText(cursor);
  }

  /** Rings a point; none without one, or out of view. */
  light(x, y) {
    this.lit = [x, y];
    const {frame} = this;
    const {box} = frame ?? {};
    const [left, top] = frame && x != null && y != null ? [frame.px(x), frame.py(y)] : [];
    const inside = left >= box?.left && left <= box.right && top >= box.top && top <= box.bottom;
    this.ring.hidden = !inside;
    if (inside) this.ring.style.transform = `translate(${left - box.left}px, ${top - box.top}px)`;
  }
}

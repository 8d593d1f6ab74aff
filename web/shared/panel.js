// What plots over an Axis have in common: over their canvas the cursor and what takes the pointer.
// Plots that share an axis zoom together and show one cursor.
import {Axis} from "./axis.js";
import {element} from "./dom.js";
import {listen} from "./gestures.js";
import {Plot} from "./plot.js";

export class Panel extends Plot {
  /**
   * axis: that of x; across: that of y, where one zooms into it, too. Of who extends this are, beside
   * what a Plot needs, cursorText(cursor) and click(at, reach, {top, y, touch}).
   */
  constructor(container, axis = new Axis(), across = null) {
    const canvas = element("canvas");
    const over = element("div", {className: "over"});
    super(canvas, container, over);
    Object.assign(this, {axis, across, over});
    this.cursor = element("div", {className: "cursor", hidden: true});
    over.prepend(this.cursor);
    container.append(canvas, over);
    for (const each of [axis, across]) each?.onView(() => this.soon());
    axis.onCursor(() => this.point());
    listen(over, axis, (...where) => this.click(...where), across);
  }

  /** Before the next frame, however often one asks. */
  soon() {
    this.waiting ||= requestAnimationFrame(() => {
      this.waiting = 0;
      this.refresh();
    });
  }

  refresh() {
    super.refresh();
    this.point();
  }

  /** The canvas, and what lies over it and takes the pointer. */
  place(height) {
    const {box, width, height: high} = this.frame;
    this.offset = [-box.left, -box.top];
    const places = {left: box.left, top: box.top + this.head, width, height: high};
    for (const [name, px] of Object.entries(places)) this.over.style[name] = `${px}px`;
    this.canvas.style.height = `${height}px`;
  }

  /** The cursor. */
  point() {
    const {cursor, view, width} = this.axis;
    const share = cursor === null ? -1 : (cursor - view[0]) / width;
    const inView = this.frame && share >= 0 && share <= 1;
    this.cursor.hidden = !inView;
    if (!inView) return;
    this.cursor.style.transform = `translateX(${Math.round(share * this.frame.width)}px)`;
    this.cursor.dataset.at = this.cursorText(cursor);
  }
}

// A plot over a viewport, with a cursor and an element that receives pointer events. Plots that
// share a viewport zoom together and show one cursor.

import {element} from "./dom.js";
import {listen} from "./gestures.js";
import {Plot} from "./plot.js";
import {Viewport} from "./viewport.js";

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
    const places = {left: box.left, top: box.top + this.head, width, height: high};
    for (const [name, px] of Object.entries(places)) this.over.style[name] = `${px}px`;
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

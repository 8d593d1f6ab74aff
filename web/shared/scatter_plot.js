// Plots of points and curves in a plane. Points can be picked with the pointer.
import {on} from "./dom.js";
import {Frame, rangeOf} from "./frame.js";
import {Plot} from "./plot.js";

const reach = 14; // px within which a point is picked

export class ScatterPlot extends Plot {
  /** viewport: whose cursor the ring follows. */
  constructor(canvas, viewport) {
    super(canvas, canvas, canvas.parentNode, viewport);
    const hover = (event) => this.hover(event);
    on(canvas, {pointermove: hover, click: hover});
    this.resized();
  }

  resized() {
    this.offset = [this.canvas.offsetLeft, this.canvas.offsetTop];
    this.refresh();
  }

  /** The marks with points. */
  get groups() {
    return this.last.marks.filter(({x, y}) => x && y);
  }

  /**
   * Options of draw(): marks; x, y: {label, range}, the range by default that of the points; equal:
   * same scale on both axes; empty: text shown without points; points: as in Plot; they can be
   * picked where they have use(i, clicked).
   */
  prepare(width, height) {
    if (!this.last) return null;
    const {marks, equal, empty = "no impacts"} = this.last;
    const axes = ["x", "y"].map((key) => {
      const range = rangeOf(this.groups.map((group) => group[key]));
      return {range, ...this.last[key]};
    });
    if (!axes.every(({range}) => range)) return {frame: null, empty};
    const frame = new Frame(width, height, ...axes);
    return {marks, frame: equal ? new Frame(width, height, ...sameScale(axes, frame)) : frame};
  }

  /** {names, columns}: points and curves with their group. */
  numbers() {
    const {x, y} = this.last;
    const all = (key) => this.groups.flatMap((group) => group[key]);
    const labels = this.groups.flatMap((group) => group.x.map(() => group.label ?? group.colour));
    return {names: [x.label, y.label, "group"], columns: [all("x"), all("y"), labels]};
  }

  /** Picks the point nearest to the pointer. */
  hover({offsetX, offsetY, type}) {
    const {x, y, use} = this.last?.points ?? {};
    if (!use || !this.frame) return;
    const {px, py} = this.frame;
    let best = reach;
    let found = -1;
    x.forEach((v, i) => {
      const distance = Math.hypot(px(v) - offsetX, py(y[i]) - offsetY);
      if (distance < best) [best, found] = [distance, i];
    });
    if (found < 0) return;
    this.light(x[found], y[found]);
    use(found, type === "click");
  }
}

/** Axes extended so that a unit has the same length on both. */
function sameScale(axes, {width, height}) {
  const pixels = [width, height];
  const size = ({range: [min, max]}) => max - min;
  const unit = Math.min(...axes.map((axis, i) => pixels[i] / size(axis)));
  return axes.map((axis, i) => {
    const more = (pixels[i] / unit - size(axis)) / 2;
    return {...axis, range: [axis.range[0] - more, axis.range[1] + more]};
  });
}

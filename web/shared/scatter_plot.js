// Points in a plane, and curves, on a canvas. What lies under the pointer is told, and one point
// can be ringed without a new drawing.
import {countPoints, density} from "./density.js";
import {on} from "./dom.js";
import {Frame, font, rangeOf} from "./frame.js";
import {ink, stroke, write} from "./ink.js";
import {Plot} from "./plot.js";
import {symbol} from "./shapes.js";

const many = 5000; // points from which on their density is drawn
const reach = 14; // px within which a point is meant

export class ScatterPlot extends Plot {
  constructor(canvas) {
    super(canvas, canvas, canvas.parentNode);
    const hover = (event) => this.hover(event);
    on(canvas, {pointermove: hover, click: hover});
    this.resized();
  }

  resized() {
    this.offset = [this.canvas.offsetLeft, this.canvas.offsetTop];
    this.refresh();
  }

  /**
   * groups: [{x, y, colour, size, alpha, shape, label}], shape: ring, cross or else a dot; label: in
   * its table; curves: [{x, y, colour, dash, label}]; levels: [{y, colour, label}]; extent: {x, y}, else that of the groups; equal:
   * the same scale on both axes; xLabel, yLabel; empty: what to say if there are no points; pick:
   * {x, y, use(i, clicked)}, the points that can be pointed at, and what is called then.
   */
  draw(options) {
    this.last = options;
    this.refresh();
  }

  /** Without a frame where there are no points. */
  prepare(width, height) {
    if (!this.last) return null;
    const {groups, extent, equal, xLabel, yLabel} = this.last;
    const ranges = ["x", "y"].map((key) => extent?.[key] ?? rangeOf(groups.map((g) => g[key])));
    const make = ([x, y]) =>
      new Frame(width, height, {range: x, label: xLabel}, {range: y, label: yLabel});
    if (!ranges.every(Boolean)) return {width, height};
    const frame = make(ranges);
    return {frame: equal ? make(sameScale(ranges, frame)) : frame};
  }

  paint(c, {frame, width, height}) {
    const {groups, curves = [], levels = [], empty = "no impacts"} = this.last;
    if (!frame) {
      c.font = font;
      ink(c, "soft");
      write(c, empty, width / 2, height / 2);
      return;
    }
    frame.draw(c);
    frame.clip(c);
    for (const group of groups) this.dots(c, group, frame);
    for (const {x, y, colour, dash} of curves) {
      ink(c, colour, 1.6, dash);
      stroke(
        c,
        x.map((v, i) => [frame.px(v), frame.py(y[i])]),
      );
    }
    for (const {y, colour, label = ""} of levels) {
      ink(c, colour);
      frame.across(c, y);
      write(c, label, frame.box.right - 4, frame.py(y) - 2, "right", "bottom");
    }
    c.restore();
  }

  /** {names, columns}: the numbers of its points and curves, by group. */
  numbers() {
    const {groups, curves = [], xLabel, yLabel} = this.last;
    const parts = [...groups, ...curves];
    const all = (key) => parts.flatMap((part) => part[key]);
    const names = parts.flatMap(({x, label, colour}) => x.map(() => label ?? colour));
    return {names: [xLabel, yLabel, "group"], columns: [all("x"), all("y"), names]};
  }

  /** The point nearest to the pointer, if it is near. */
  hover({offsetX, offsetY, type}) {
    const {pick} = this.last ?? {};
    if (!pick || !this.frame) return;
    const {px, py} = this.frame;
    let best = reach;
    let found = -1;
    pick.x.forEach((x, i) => {
      const distance = Math.hypot(px(x) - offsetX, py(pick.y[i]) - offsetY);
      if (distance < best) [best, found] = [distance, i];
    });
    if (found < 0) return;
    this.light(pick.x[found], pick.y[found]);
    pick.use(found, type === "click");
  }

  dots(c, {x, y, colour, size = 2.4, alpha = 0.75, shape}, frame) {
    const {px, py, box} = frame;
    c.globalAlpha = alpha;
    if (x.length > many) {
      const image = density(countPoints(x, y, frame), colour);
      c.drawImage(image, box.left, box.top, frame.width, frame.height);
    } else {
      ink(c, colour, 1.2);
      c.beginPath();
      for (let i = 0; i < x.length; ++i)
        symbol(c, shape ?? "square", px(x[i]), py(y[i]), shape ? size : size / 2);
      c.stroke();
    }
    c.globalAlpha = 1;
  }
}

/** The ranges widened so that a unit is as long on both axes. */
function sameScale(ranges, {width, height}) {
  const pixels = [width, height];
  const unit = Math.min(...ranges.map(([min, max], i) => pixels[i] / (max - min)));
  return ranges.map(([min, max], i) => {
    const more = (pixels[i] / unit - (max - min)) / 2;
    return [min - more, max + more];
  });
}

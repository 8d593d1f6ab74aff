// Scatter plots of points and curves on a canvas. Points can be picked with the pointer, and one
// can be ringed without redrawing.
import {countPoints, density} from "./density.js";
import {on} from "./dom.js";
import {Frame, font, rangeOf} from "./frame.js";
import {drawText, ink, stroke} from "./ink.js";
import {Plot} from "./plot.js";
import {symbol} from "./shapes.js";

const many = 5000; // points above which the density is drawn
const reach = 14; // px within which a point is picked

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
   * groups: [{x, y, colour, size, alpha, shape, label}]; shape: "ring", "cross" or a square dot;
   * label: name in the table; curves: [{x, y, colour, dash, label}]; levels: [{y, colour, label}];
   * extent: {x, y}, default: range of the groups; equal: same scale on both axes; xLabel, yLabel;
   * empty: text shown without points; pick: {x, y, use(i, clicked)}: points that can be picked, and
   * the callback.
   */
  draw(options) {
    this.last = options;
    this.refresh();
  }

  /** Returns no frame when there are no points. */
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
      drawText(c, empty, width / 2, height / 2);
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
      drawText(c, label, frame.box.right - 4, frame.py(y) - 2, "right", "bottom");
    }
    c.restore();
  }

  /** {names, columns}: points and curves with their group. */
  numbers() {
    const {groups, curves = [], xLabel, yLabel} = this.last;
    const parts = [...groups, ...curves];
    const all = (key) => parts.flatMap((part) => part[key]);
    const names = parts.flatMap(({x, label, colour}) => x.map(() => label ?? colour));
    return {names: [xLabel, yLabel, "group"], columns: [all("x"), all("y"), names]};
  }

  /** Picks the point nearest to the pointer. */
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

/** Ranges extended so that a unit has the same length on both axes. */
function sameScale(ranges, {width, height}) {
  const pixels = [width, height];
  const unit = Math.min(...ranges.map(([min, max], i) => pixels[i] / (max - min)));
  return ranges.map(([min, max], i) => {
    const more = (pixels[i] / unit - (max - min)) / 2;
    return [min - more, max + more];
  });
}

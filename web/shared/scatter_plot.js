// Points in a plane, and curves, on a canvas. What lies under the pointer is told, and one point
// can be ringed without a new drawing.
import {colour} from "./colours.js";
import {countPoints, density} from "./density.js";
import {element} from "./dom.js";
import {blank, Frame, font, rangeOf, Size} from "./frame.js";
import {symbol} from "./shapes.js";

const many = 5000; // points from which on their density is drawn
const reach = 14; // px within which a point is meant

export class ScatterPlot {
  constructor(canvas) {
    this.canvas = canvas;
    this.ring = element("div", {className: "lit", hidden: true});
    canvas.parentNode.append(this.ring);
    this.size = new Size(canvas, () => {
      this.offset = [canvas.offsetLeft, canvas.offsetTop];
      this.refresh();
    });
    this.offset = [canvas.offsetLeft, canvas.offsetTop];
    canvas.addEventListener("pointermove", (event) => this.hover(event));
    canvas.addEventListener("click", (event) => this.hover(event));
  }

  /**
   * groups: [{x, y, colour, size, alpha, shape}], shape: ring, cross or else a dot; curves: [{x, y,
   * colour, dash}]; levels: [{y, colour, label}]; extent: {x, y}, else that of the groups; equal:
   * the same scale on both axes; xLabel, yLabel; empty: what to say if there are no points; pick:
   * {x, y, use(i)}, the points that can be pointed at, and what is called then.
   */
  draw(options) {
    this.last = options;
    const {width, height} = this.size;
    this.frame = null;
    if (width) this.paint(blank(this.canvas, this.size), width, height);
    this.light(...(this.lit ?? []));
  }

  /** c: a canvas' context, or what draws in its place. */
  paint(c, width, height) {
    const {groups, curves = [], levels = [], equal, empty = "no impacts", ...rest} = this.last;
    const of = (key) => rest.extent?.[key] ?? rangeOf(groups.map((group) => group[key]));
    const [x, y] = [of("x"), of("y")];
    c.font = font;
    if (!x || !y) {
      c.fillStyle = colour("soft");
      c.textAlign = "center";
      c.fillText(empty, width / 2, height / 2);
      return;
    }
    const make = (ex, ey) =>
      new Frame(width, height, {range: ex, label: rest.xLabel}, {range: ey, label: rest.yLabel});
    const frame = equal ? make(...sameScale(x, y, make(x, y))) : make(x, y);
    this.frame = frame;
    frame.draw(c);
    frame.clip(c);
    for (const group of groups) this.dots(c, group, frame);
    for (const curve of curves) this.curve(c, curve, frame);
    for (const level of levels) this.level(c, level, frame);
    c.restore();
  }

  /** All of it, for a picture of its own. */
  paintAll(c, width, height) {
    const {frame} = this;
    this.paint(c, width, height);
    this.frame = frame;
  }

  /** {names, columns}: the numbers of its points, by group. */
  numbers() {
    const {groups, xLabel, yLabel} = this.last;
    const all = (key) => groups.flatMap((group) => group[key]);
    const names = groups.flatMap(({x, label, colour: name}) => x.map(() => label ?? name));
    return {names: [xLabel, yLabel, "group"], columns: [all("x"), all("y"), names]};
  }

  /** Rings a point; none without one. */
  light(x, y) {
    this.lit = [x, y];
    const {frame} = this;
    const shown = Boolean(frame) && x != null && y != null;
    const [left, top] = shown ? [frame.px(x), frame.py(y)] : [0, 0];
    const {box} = frame ?? {};
    const inside =
      shown && left >= box.left && left <= box.right && top >= box.top && top <= box.bottom;
    this.ring.hidden = !inside;
    if (!inside) return;
    const [x0, y0] = this.offset;
    this.ring.style.transform = `translate(${left + x0}px, ${top + y0}px)`;
  }

  /** The point nearest to the pointer, if it is near. */
  hover(event) {
    const {pick} = this.last ?? {};
    if (!pick || !this.frame) return;
    const box = this.canvas.getBoundingClientRect();
    const [left, top] = [event.clientX - box.left, event.clientY - box.top];
    const {px, py} = this.frame;
    let best = reach ** 2;
    let found = -1;
    for (let i = 0; i < pick.x.length; ++i) {
      const distance = (px(pick.x[i]) - left) ** 2 + (py(pick.y[i]) - top) ** 2;
      if (distance < best) [best, found] = [distance, i];
    }
    if (found >= 0) pick.use(found);
  }

  dots(c, {x, y, colour: name, size = 2.4, alpha = 0.75, shape}, frame) {
    const {px, py, box} = frame;
    c.globalAlpha = alpha;
    if (x.length > many) {
      const image = density(countPoints(x, y, frame), name);
      c.drawImage(image, box.left, box.top, frame.width, frame.height);
      c.globalAlpha = 1;
      return;
    }
    c.fillStyle = c.strokeStyle = colour(name);
    if (shape) {
      c.lineWidth = 1.2;
      c.beginPath();
      for (let i = 0; i < x.length; ++i) symbol(c, shape, px(x[i]), py(y[i]), size);
      c.stroke();
    } else {
      for (let i = 0; i < x.length; ++i)
        c.fillRect(px(x[i]) - size / 2, py(y[i]) - size / 2, size, size);
    }
    c.globalAlpha = 1;
  }

  curve(c, {x, y, colour: name, dash = []}, {px, py}) {
    c.strokeStyle = colour(name);
    c.lineWidth = 1.6;
    c.setLineDash(dash);
    c.beginPath();
    for (let i = 0; i < x.length; ++i) c.lineTo(px(x[i]), py(y[i]));
    c.stroke();
  }

  level(c, {y, colour: name, label = ""}, frame) {
    c.strokeStyle = c.fillStyle = colour(name);
    c.lineWidth = 1;
    c.setLineDash([]);
    frame.across(c, y);
    c.textAlign = "right";
    c.textBaseline = "bottom";
    c.fillText(label, frame.box.right - 4, frame.py(y) - 2);
  }

  refresh() {
    if (this.last) this.draw(this.last);
  }
}

/** The ranges widened so that a unit is as long on both axes. */
function sameScale(ex, ey, {width, height}) {
  const unit = Math.min(width / (ex[1] - ex[0]), height / (ey[1] - ey[0]));
  const around = ([min, max], pixels) => [
    (min + max) / 2 - pixels / unit / 2,
    (min + max) / 2 + pixels / unit / 2,
  ];
  return [around(ex, width), around(ey, height)];
}

// The axes of a plot: where its values lie in pixels, and what is written along them. It draws with
// whatever has the methods of a canvas' context.
import {colour} from "./colours.js";
import {minus, short} from "./numbers.js";
import {logTicks, ticks} from "./ticks.js";

export const font = "11px system-ui, sans-serif";

/** Pixels of a value between two places. */
function scaleOf({range: [min, max], log}, from, to) {
  if (!log) return (v) => from + ((v - min) / (max - min)) * (to - from);
  const [low, high] = [Math.log(min), Math.log(max)];
  return (v) => from + ((Math.log(v) - low) / (high - low)) * (to - from);
}

/** The value of a place. */
function inverseOf({range: [min, max], log}, from, to) {
  const share = (place) => (place - from) / (to - from);
  if (!log) return (place) => min + share(place) * (max - min);
  return (place) => min * (max / min) ** share(place);
}

/** A label, in as many digits as tell it from the next. */
function numberAt(v, step) {
  const near = step > 0 && Math.abs(v) > 2e4 * step;
  const places = Math.min(Math.max(-Math.floor(Math.log10(step)), 0), 15);
  return near ? minus(v.toFixed(places)) : short(Number(v.toPrecision(12)));
}

/** {at, text} of the labels, at most so many. */
function labelsOf({range, log, factor = 1, labels}, most) {
  const [min, max] = range.map((v) => v * factor);
  const powers = log ? logTicks(min, max) : []; // few within a power of ten
  const list = labels?.(min, max) ?? (powers.length > 2 ? powers : ticks(min, max, most));
  const round = !labels && powers.length <= 2 && list.length > 1;
  const step = round ? list[1] - list[0] : 0;
  return list.map((v) => ({at: (v.at ?? v) / factor, text: v.text ?? numberAt(v, step)}));
}

export class Frame {
  /**
   * A plot of so many pixels. x, y: {range, log, label, factor, bare, labels}: what is in view,
   * whether it is logarithmic, the axis' name, what its numbers are multiplied by, whether they are
   * left out, and labels(min, max) in place of round ones, as numbers or {at, text}; beside:
   * px at its right.
   */
  constructor(width, height, x, y, beside = 10) {
    this.x = x;
    this.y = y;
    const bottom = height - (x.bare ? 5 : 18) - (x.label && !x.bare ? 14 : 0);
    this.box = {left: 50, top: 5, right: width - beside, bottom: Math.max(bottom, 15)};
    const {left, top, right, bottom: low} = this.box;
    this.px = scaleOf(x, left, right);
    this.py = scaleOf(y, low, top);
    this.vx = inverseOf(x, left, right);
    this.vy = inverseOf(y, low, top);
  }

  get width() {
    return this.box.right - this.box.left;
  }

  get height() {
    return this.box.bottom - this.box.top;
  }

  clip(c) {
    c.save();
    c.beginPath();
    c.rect(this.box.left, this.box.top, this.width, this.height);
    c.clip();
  }

  /** A straight line, sharp. */
  line(c, x0, y0, x1, y1) {
    c.beginPath();
    c.moveTo(Math.round(x0) + 0.5, Math.round(y0) + 0.5);
    c.lineTo(Math.round(x1) + 0.5, Math.round(y1) + 0.5);
    c.stroke();
  }

  across(c, y) {
    this.line(c, this.box.left, this.py(y), this.box.right, this.py(y));
  }

  upright(c, x) {
    this.line(c, this.px(x), this.box.top, this.px(x), this.box.bottom);
  }

  draw(c) {
    c.font = font;
    c.lineWidth = 1;
    c.setLineDash([]);
    c.strokeStyle = colour("grid");
    c.fillStyle = colour("soft");
    this.drawX(c);
    this.drawY(c);
  }

  drawX(c) {
    const {left, right, bottom} = this.box;
    c.textAlign = "center";
    c.textBaseline = "top";
    const most = Math.max(2, Math.min(10, Math.floor(this.width / 70)));
    for (const {at, text} of labelsOf(this.x, most)) {
      this.upright(c, at);
      if (!this.x.bare) c.fillText(text, this.px(at), bottom + 4);
    }
    if (!this.x.bare) c.fillText(this.x.label ?? "", (left + right) / 2, bottom + 17);
  }

  drawY(c) {
    const {left, top, bottom} = this.box;
    c.textAlign = "right";
    c.textBaseline = "middle";
    const most = Math.max(2, Math.min(8, Math.floor(this.height / 22)));
    for (const {at, text} of labelsOf(this.y, most)) {
      this.across(c, at);
      c.fillText(text, left - 5, this.py(at));
    }
    c.save();
    c.translate(8, (top + bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.textAlign = "center";
    c.fillText(this.y.label ?? "", 0, 0);
    c.restore();
  }
}

/** The range of values with a margin on both sides; null where there are none. */
export function rangeOf(columns, {log = false, margin = 0.06} = {}) {
  let min = Infinity;
  let max = -Infinity;
  for (const column of columns)
    for (const v of column) {
      if (v === null) continue;
      if (v < min) min = v;
      if (v > max) max = v;
    }
  if (!(min <= max)) return null;
  if (log) return [min / 1.3, max * 1.3];
  const more = (max - min) * margin || Math.abs(max) * margin || 1;
  return [min - more, max + more];
}

/**
 * Calls draw(width, height) whenever a node gets another size. It is kept: asking the browser costs
 * a layout each time.
 */
export class Size {
  constructor(node, draw) {
    Object.assign(this, {width: node.clientWidth, height: node.clientHeight});
    const changed = () => {
      const {clientWidth: width, clientHeight: height} = node;
      if (this.width === width && this.height === height) return;
      Object.assign(this, {width, height});
      draw();
    };
    new ResizeObserver(changed).observe(node);
  }
}

/** A canvas of so many CSS pixels, emptied. */
export function blank(canvas, {width, height}) {
  const ratio = devicePixelRatio;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  const c = canvas.getContext("2d");
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, {width: w, height: h});
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  return c;
}

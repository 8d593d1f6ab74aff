// Frame of a plot: the mapping from values to pixels, grid lines and labels.
import {extent, ticks as roundValues} from "d3-array";
import {colour, drawText, drawTextUpwards, ink, stroke} from "./ink.js";
import {clamp, minus, shortTo} from "./numbers.js";

export const font = "11px system-ui, sans-serif";
const letter = 3.4; // px, half the width of a digit
const small = 130; // px of height below which a plot has few labels

/** The position of a value; NaN for a missing one or one that the axis cannot show. */
function scaleOf({range, log}, from, to) {
  const at = (v) => (log ? Math.log(v || NaN) : (v ?? NaN));
  const [low, high] = range.map(at);
  return (v) => from + ((at(v) - low) / (high - low)) * (to - from);
}

/** Multiples of 1, 2 or 5 times a power of ten: about `count`, but at least two. */
export function ticks(min, max, count) {
  const list = roundValues(min, max, count);
  return list.length > 1 ? list : roundValues(min, max, 2 * count);
}

/** Powers of ten, every n-th where they are many; with 2 and 5 between where they are few. */
function logTicks(min, max) {
  const from = Math.floor(Math.log10(min));
  const to = Math.ceil(Math.log10(max));
  const step = Math.ceil((to - from) / 8);
  const factors = to - from < 4 ? [1, 2, 5] : [1];
  const list = [];
  for (let k = from; k <= to; k += step) for (const m of factors) list.push(m * 10 ** k);
  return list.filter((v) => v >= min && v <= max);
}

/** Labels {at, text}, about `count`, with enough digits to distinguish neighbours. */
function labelsOf({range, log, factor = 1, labels}, count) {
  if (labels) return labels.filter(({at}) => at >= range[0] - 1e-9 && at <= range[1] + 1e-9);
  const [min, max] = range.map((v) => v * factor);
  const powers = log ? logTicks(min, max) : [];
  const round = powers.length < 2; // fewer than two powers of ten in range
  const list = round ? ticks(min, max, count) : powers;
  const step = list[1] - list[0];
  const text = (v) =>
    round && Math.abs(v) > 2e4 * step
      ? minus(v.toFixed(clamp(-Math.floor(Math.log10(step)), 0, 15)))
      : shortTo(12, v);
  return list.map((v) => ({at: v / factor, text: text(v)}));
}

/** The pixel position at which a thin line is sharp. */
const sharp = (px) => Math.round(px) + 0.5;

/** An axis whose range around 0 is extended. */
const extended = (axis, factor) => ({...axis, range: axis.range.map((v) => v * factor)});

export class Frame {
  /**
   * x, y: {range, log, label, factor, aligned, labels}: visible range, logarithmic scale, name of the
   * axis, factor of its numbers, numbers at the side even in small plots, and labels [{at, text}] in
   * place of round numbers. beside, above: px at the right and at the top;
   * equal: both axes have the same range around 0, extended so that a unit has the same length.
   */
  constructor({width: all, height: whole}, {x, y, beside = 10, above: top = 5, equal}) {
    const bare = whole < small && !x.aligned; // without numbers of x
    const [left, right] = [bare ? 36 : 58, all - beside];
    const below = bare ? 5 : 18 + (x.label ? 14 : 0);
    const bottom = Math.max(whole - below, 15);
    const [width, height] = [right - left, bottom - top];
    const square = Math.min(width, height);
    this.x = equal ? extended(x, width / square) : x;
    this.y = equal ? extended(y, height / square) : y;
    Object.assign(this, {box: {left, top, right, bottom}, beside, bare, width, height});
    this.px = scaleOf(this.x, left, right);
    this.py = scaleOf(this.y, bottom, top);
  }

  /** True when a position in px lies in the plot. */
  holds(x, y) {
    const {left, top, right, bottom} = this.box;
    return x >= left && x <= right && y >= top && y <= bottom;
  }

  /** Clips drawing to the plot until the context is restored. */
  clip(c) {
    c.save();
    c.beginPath();
    c.rect(this.box.left, this.box.top, this.width, this.height);
    c.clip();
  }

  across(c, y) {
    const {left, right} = this.box;
    const at = sharp(this.py(y));
    stroke(c, [left, at], [right, at]);
  }

  upright(c, x) {
    const {top, bottom} = this.box;
    const at = sharp(this.px(x));
    stroke(c, [at, top], [at, bottom]);
  }

  draw(c) {
    const {x, y, box, bare, px, py} = this;
    const {left, top, right, bottom} = box;
    c.font = font;
    ink(c, "grid");
    c.fillStyle = colour("soft");
    const end = right + this.beside; // keeps the last label inside the canvas
    const below = (text, at, down) => {
      const half = letter * text.length;
      if (!bare) drawText(c, text, Math.min(at, end - half), bottom + down, "center", "top");
    };
    for (const {at, text} of labelsOf(x, clamp(this.width / 100, 2, 7))) {
      this.upright(c, at);
      below(text, px(at), 4);
    }
    below(x.label ?? "", (left + right) / 2, 17);
    for (const {at, text} of labelsOf(y, clamp(this.height / 31, 2, 6))) {
      this.across(c, at);
      drawText(c, text, left - 5, py(at), "right");
    }
    if (!bare) drawTextUpwards(c, y.label ?? "", 8, (top + bottom) / 2);
  }
}

/** The range of all values with a margin on both sides; null without values. */
export function rangeOf(columns, log = false) {
  const shown = log ? (v) => (v > 0 ? v : null) : undefined;
  const [min, max] = extent(columns.flatMap((column) => extent(column, shown)));
  if (min === undefined) return null;
  if (log) return [min / 1.3, max * 1.3];
  const more = (max - min || Math.abs(max)) * 0.06 || 1;
  return [min - more, max + more];
}

/** The size of a node, cached since reading it forces a layout; draw() is called when it changes. */
export function sizeOf(node, draw) {
  const size = {width: 0, height: 0};
  new ResizeObserver(() => {
    Object.assign(size, {width: node.clientWidth, height: node.clientHeight});
    draw();
  }).observe(node);
  return size;
}

/** Clears a canvas, after resizing it to the given CSS pixels if necessary; returns its context. */
export function blank(canvas, {width, height}) {
  const ratio = devicePixelRatio;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  const c = canvas.getContext("2d");
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, {width: w, height: h});
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  return c;
}

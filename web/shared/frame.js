// The axes of a plot: where its values lie in pixels, and what is written along them. It draws with
// whatever has the methods of a canvas' context.
import {colour} from "./colours.js";
import {ink, stroke, write, writeUpwards} from "./ink.js";
import {clamp, minus, shortTo} from "./numbers.js";
import {logTicks, ticks} from "./ticks.js";

export const font = "11px system-ui, sans-serif";
const letter = 3.4; // px of half a digit of it

/** Pixels of a value between two places. */
function scaleOf({range, log}, from, to) {
  const at = log ? Math.log : (v) => v;
  const [low, high] = range.map(at);
  return (v) => from + ((at(v) - low) / (high - low)) * (to - from);
}

/** {at, text} of the labels, at most so many; in as many digits as tell one from the next. */
function labelsOf({range, log, factor = 1, labels}, most) {
  if (labels) return labels(...range);
  const [min, max] = range.map((v) => v * factor);
  const powers = log ? logTicks(min, max) : [];
  const round = powers.length < 2; // all within a step of those
  const list = round ? ticks(min, max, most) : powers;
  const step = list[1] - list[0];
  const text = (v) =>
    round && Math.abs(v) > 2e4 * step
      ? minus(v.toFixed(clamp(-Math.floor(Math.log10(step)), 0, 15)))
      : shortTo(12, v);
  return list.map((v) => ({at: v / factor, text: text(v)}));
}

/** Where a thin line fills a pixel. */
const sharp = (px) => Math.round(px) + 0.5;

export class Frame {
  /**
   * A plot of so many pixels. x, y: {range, log, label, factor, bare, labels}: what is in view,
   * whether it is logarithmic, the axis' name, what its numbers are multiplied by, whether they are
   * left out, and labels(min, max), [{at, text}], in place of round ones; beside: px at its right.
   */
  constructor(width, height, x, y, beside = 10) {
    const [left, top, right] = [50, 5, width - beside];
    const below = x.bare ? 5 : 18 + (x.label ? 14 : 0);
    const bottom = Math.max(height - below, 15);
    const box = {left, top, right, bottom};
    Object.assign(this, {x, y, box, beside, width: right - left, height: bottom - top});
    Object.assign(this, {px: scaleOf(x, left, right), py: scaleOf(y, bottom, top)});
  }

  /** Whether a place in pixels lies in the plot. */
  holds(x, y) {
    const {left, top, right, bottom} = this.box;
    return x >= left && x <= right && y >= top && y <= bottom;
  }

  /** Only what lies in the plot, or so many px around it, is drawn until the context is restored. */
  clip(c, around = 0) {
    const {left, top} = this.box;
    c.save();
    c.beginPath();
    c.rect(left - around, top - around, this.width + 2 * around, this.height + 2 * around);
    c.clip();
  }

  across(c, y) {
    const {left, right} = this.box;
    stroke(
      c,
      [left, right].map((end) => [end, sharp(this.py(y))]),
    );
  }

  upright(c, x) {
    const {top, bottom} = this.box;
    stroke(
      c,
      [top, bottom].map((end) => [sharp(this.px(x)), end]),
    );
  }

  draw(c) {
    const {x, y, box, px, py} = this;
    const {left, top, right, bottom} = box;
    c.font = font;
    ink(c, "grid");
    c.fillStyle = colour("soft");
    const end = right + this.beside; // what is written about the last place stays within it
    const below = (text, at, down) => {
      const half = letter * text.length;
      if (!x.bare) write(c, text, Math.min(at, end - half), bottom + down, "center", "top");
    };
    for (const {at, text} of labelsOf(x, clamp(Math.floor(this.width / 70), 2, 10))) {
      this.upright(c, at);
      below(text, px(at), 4);
    }
    below(x.label ?? "", (left + right) / 2, 17);
    for (const {at, text} of labelsOf(y, clamp(Math.floor(this.height / 22), 2, 8))) {
      this.across(c, at);
      write(c, text, left - 5, py(at), "right");
    }
    writeUpwards(c, y.label ?? "", 8, (top + bottom) / 2);
  }
}

/** The range of values with a margin on both sides; null where there are none. */
export function rangeOf(columns, log = false) {
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
  const more = (max - min || Math.abs(max)) * 0.06 || 1;
  return [min - more, max + more];
}

/**
 * The size of a node, and draw() whenever it gets another one. It is kept: asking the browser costs
 * a layout each time.
 */
export class Size {
  constructor(node, draw) {
    const changes = () => {
      const {width, height} = this;
      Object.assign(this, {width: node.clientWidth, height: node.clientHeight});
      return this.width !== width || this.height !== height;
    };
    changes();
    new ResizeObserver(() => changes() && draw()).observe(node);
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

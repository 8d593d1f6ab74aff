// What plots draw: lines of many points, symbols of many places.
import {colour} from "./colours.js";
import {firstFrom} from "./search.js";

/** The part of ascending values that is in view, and one more on either side. */
function inView(x, [min, max]) {
  return [Math.max(firstFrom(x, min) - 1, 0), Math.min(firstFrom(x, max) + 1, x.length)];
}

/** A line through points with ascending x; null and NaN break it. dense: there are many in a pixel. */
export function line(c, frame, x, y, {colour: name, width = 1, dash = []}, dense = false) {
  const [from, to] = inView(x, frame.x.range);
  c.strokeStyle = c.fillStyle = colour(name);
  c.lineWidth = width;
  c.setLineDash(dash);
  if (dense || to - from > 4 * frame.width) return envelope(c, frame, x, y, from, to, width);
  c.beginPath();
  let broken = true;
  for (let i = from; i < to; ++i) {
    if (y[i] == null || Number.isNaN(y[i])) broken = true;
    else {
      const [px, py] = [frame.px(x[i]), frame.py(y[i])];
      if (broken) c.moveTo(px, py);
      else c.lineTo(px, py);
      broken = false;
    }
  }
  c.stroke();
  c.setLineDash([]);
}

/**
 * The lowest and the highest of each pixel, down to the one before and up to it, so that no spike
 * is lost and nothing gapes.
 */
function envelope(c, frame, x, y, from, to, width) {
  let column = null;
  let low = null; // as pixels, downwards
  let high = null;
  let before = null;
  const add = () => {
    if (column === null) return;
    const top = Math.min(high, before?.low ?? high);
    const bottom = Math.max(low, before?.high ?? low);
    c.fillRect(column, top - width / 2, 1, bottom - top + width);
    before = {low, high};
  };
  for (let i = from; i < to; ++i) {
    if (y[i] == null || Number.isNaN(y[i])) continue;
    const at = Math.floor(frame.px(x[i]));
    const py = frame.py(y[i]);
    if (at !== column) {
      add();
      column = at;
      low = high = py;
    } else if (py > low) low = py;
    else if (py < high) high = py;
  }
  add();
}

/** Of places that have been drawn on, in pixels: what falls on one again is not seen. */
class Drawn {
  constructor({left, top, right, bottom}) {
    this.left = left;
    this.top = top;
    this.columns = Math.ceil(2 * (right - left)) + 4;
    this.seen = new Uint8Array(this.columns * (Math.ceil(2 * (bottom - top)) + 4));
  }

  /** Whether a place is new. */
  add(x, y) {
    const at = Math.round(2 * (y - this.top)) * this.columns + Math.round(2 * (x - this.left));
    if (this.seen[at]) return false;
    this.seen[at] = 1;
    return true;
  }
}

/** Adds a symbol to a path: a cross or else a ring; a square is filled at once. */
export function symbol(c, shape, x, y, r) {
  if (shape === "square") c.fillRect(x - r, y - r, 2 * r, 2 * r);
  else if (shape === "cross") {
    c.moveTo(x - r, y - r);
    c.lineTo(x + r, y + r);
    c.moveTo(x - r, y + r);
    c.lineTo(x + r, y - r);
  } else {
    c.moveTo(x + r, y);
    c.arc(x, y, r, 0, 2 * Math.PI);
  }
}

/**
 * Symbols over ascending x, smaller where there are many. One beyond the range of y lies on its
 * edge, or, where it is clipped, is not seen.
 */
export function symbols(c, frame, group, clipped = false) {
  const {x, y, colour: name, shape, size = 4, width = 1.3} = group;
  const {left, top, right, bottom} = frame.box;
  const [from, to] = [firstFrom(x, frame.x.range[0]), inView(x, frame.x.range)[1]];
  const room = Math.sqrt(frame.width / (3 * Math.max(to - from, 1)));
  const r = Math.max(size * Math.min(room, 1), 0.75);
  const many = to - from > (shape === "dot" ? 100 : 2000); // a path of many discs takes long to fill
  const kind = many ? "square" : shape;
  const half = many ? 0.85 * r : r;
  const drawn = new Drawn(frame.box);
  const around = clipped ? 0 : r;
  c.save();
  c.beginPath();
  c.rect(left - around, top - around, right - left + 2 * around, bottom - top + 2 * around);
  c.clip();
  c.strokeStyle = c.fillStyle = colour(name);
  c.lineWidth = width;
  c.setLineDash([]);
  c.beginPath();
  for (let i = from; i < to; ++i) {
    if (y[i] == null || x[i] > frame.x.range[1]) continue;
    const px = frame.px(x[i]);
    const py = Math.min(Math.max(frame.py(y[i]), top - 2 * around), bottom + 2 * around);
    const edge = Math.min(Math.max(py, top), bottom);
    const place = clipped ? py : edge;
    if ((!clipped || py === edge) && drawn.add(px, edge)) symbol(c, kind, px, place, half);
  }
  if (kind === "dot") c.fill();
  else if (!many) c.stroke();
  c.restore();
}

/** Intervals of x as one path, filled once: those that share a pixel do not darken it. */
export function shade(c, frame, intervals, name) {
  if (!intervals.length) return;
  const {left, right, top} = frame.box;
  c.fillStyle = colour(name);
  c.beginPath();
  for (const [from, to] of intervals) {
    const a = Math.max(frame.px(from), left);
    const b = Math.min(frame.px(to), right);
    if (b > left && a < right) c.rect(a, top, Math.max(b - a, 1), frame.height);
  }
  c.fill();
}

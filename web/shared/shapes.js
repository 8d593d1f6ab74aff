// Lines of many points, symbols and shaded intervals.
import {ink} from "./ink.js";
import {clamp} from "./numbers.js";
import {firstFrom, lastUpTo} from "./search.js";

/**
 * A line through points with ascending x; null and NaN interrupt it. dense: several points per
 * pixel.
 */
export function line(c, frame, x, y, {colour, width = 1, dash}, dense) {
  const [min, max] = frame.x.range;
  // Visible points and one more on either side.
  const [from, to] = [
    Math.max(firstFrom(x, min) - 1, 0),
    Math.min(firstFrom(x, max) + 1, x.length),
  ];
  const isThere = (v) => v != null && !Number.isNaN(v);
  ink(c, colour, width, dash);
  c.beginPath();
  const {add, end} = dense || to - from > 4 * frame.width ? envelope(c, width) : path(c);
  for (let i = from; i < to; ++i) add(frame.px(x[i]), isThere(y[i]) ? frame.py(y[i]) : null);
  end();
}

/** Connects points directly. */
function path(c) {
  let broken = true;
  const add = (px, py) => {
    if (py !== null) c[broken ? "moveTo" : "lineTo"](px, py);
    broken = py === null;
  };
  return {add, end: () => c.stroke()};
}

/**
 * Draws minimum and maximum of each pixel, joined to the previous pixel, so that spikes stay
 * visible and no gaps appear.
 */
function envelope(c, width) {
  let column = null;
  let low; // px, downwards
  let high;
  let before = null;
  const end = () => {
    if (column === null) return;
    before ??= {low, high};
    const top = Math.min(high, before.low);
    const bottom = Math.max(low, before.high);
    c.fillRect(column, top - width / 2, 1, bottom - top + width);
    before = {low, high};
  };
  const add = (px, py) => {
    if (py === null) return;
    const at = Math.floor(px);
    if (at !== column) {
      end();
      column = at;
      low = high = py;
    } else if (py > low) low = py;
    else if (py < high) high = py;
  };
  return {add, end};
}

/** Adds a symbol to a path: a cross or a circle; a square is filled immediately. */
export function symbol(c, shape, x, y, r) {
  if (shape === "square") c.fillRect(x - r, y - r, 2 * r, 2 * r);
  else if (shape === "cross")
    for (const up of [r, -r]) {
      c.moveTo(x - r, y - up);
      c.lineTo(x + r, y + up);
    }
  else {
    c.moveTo(x + r, y);
    c.arc(x, y, r, 0, 2 * Math.PI);
  }
}

/**
 * Symbols at ascending x, smaller where there are many. Values out of range lie on the edge of the
 * plot; `clipped` symbols are cut there.
 */
export function symbols(c, frame, group, clipped = false) {
  const {x, y, colour, shape, size = 4, width = 1.3} = group;
  const {top, bottom} = frame.box;
  const [min, max] = frame.x.range;
  const [from, to] = [firstFrom(x, min), lastUpTo(x, max) + 1];
  const room = Math.sqrt(frame.width / (3 * Math.max(to - from, 1)));
  const r = Math.max(size * Math.min(room, 1), 0.75);
  const many = to - from > (shape === "dot" ? 100 : 2000); // filling a path of many discs is slow
  const drawn = new Set(); // half pixels: a symbol on top of another is invisible
  frame.clip(c, clipped ? 0 : r);
  ink(c, colour, width);
  c.beginPath();
  for (let i = from; i < to; ++i) {
    if (y[i] == null) continue;
    const px = frame.px(x[i]);
    const py = clamp(frame.py(y[i]), top, bottom);
    const place = Math.round(2 * py) * 1e5 + Math.round(2 * px);
    if (drawn.has(place)) continue;
    drawn.add(place);
    symbol(c, many ? "square" : shape, px, py, many ? 0.85 * r : r);
  }
  if (shape === "dot") c.fill();
  else c.stroke();
  c.restore();
}

/** Fills intervals of x as one path, so that intervals in the same pixel do not darken it. */
export function shade(c, frame, intervals, name) {
  const {left, right, top} = frame.box;
  ink(c, name);
  c.beginPath();
  for (const [from, to] of intervals) {
    const a = Math.max(frame.px(from), left);
    const b = Math.min(frame.px(to), right);
    if (b > left && a < right) c.rect(a, top, Math.max(b - a, 1), frame.height);
  }
  c.fill();
}

// Colour scales of maps, and the bar that shows them.

import {font, ticks} from "../shared/frame.js";
import {colour, drawText, drawTextUpwards, hex, ink} from "../shared/ink.js";
import {kind} from "../shared/marks.js";
import {clamp, short} from "../shared/numbers.js";

/** The colour at fraction t in [0, 1] of a list of colour stops. */
function between(list, t) {
  const at = clamp(t, 0, 1) * (list.length - 1);
  const i = Math.min(Math.floor(at), list.length - 2);
  const part = at - i;
  return list[i].map((v, k) => Math.round(v + (list[i + 1][k] - v) * part));
}

/** The next round number away from 0. */
function rounded(v) {
  if (v === 0) return 0;
  const power = 10 ** Math.floor(Math.log10(Math.abs(v)));
  const steps = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10];
  const step = steps.find((s) => s * power >= Math.abs(v) * (1 - 1e-9));
  return Number((Math.sign(v) * step * power).toPrecision(3));
}

const spare = 0.02; // fraction of the values at either end that can lie beyond the scale

/**
 * Round ends of the colour scale of some values. A few outliers can lie beyond the ends, so that
 * they do not flatten the colours of the others.
 */
export function endsOf({diverging, from0}, values) {
  const sorted = Float64Array.from(values).sort();
  const n = sorted.length;
  if (!n) return [0, 1];
  const [low, high] = [spare, 1 - spare].map((q) => sorted[Math.round(q * (n - 1))]);
  if (diverging) {
    const ends = [rounded(Math.min(low, 0)), rounded(Math.max(high, 0))];
    return ends[0] < ends[1] ? ends : [-1, 1];
  }
  if (from0) return [0, rounded(high) || 1];
  const step = rounded((high - low) / 10 || Math.abs(low) / 10 || 0.1);
  const ends = [Math.floor(low / step + 1e-9) * step, Math.ceil(high / step - 1e-9) * step];
  return ends[0] < ends[1] ? ends : [ends[0], ends[0] + step];
}

/**
 * {at(value): colour as bytes, ends, beyond: [whether at() got values below the scale, above it]}.
 * The colours of a diverging scale are symmetric about 0, whatever its ends.
 */
export function scaleOf({diverging}, ends) {
  const [low, high] = ends;
  const stops = colour(diverging ? "diverging" : "sequential")
    .split(/\s+/)
    .map(hex);
  const most = Math.max(-low, high);
  const [first, last] = diverging ? [-most, most] : ends;
  const beyond = [false, false];
  const at = (v) => {
    beyond[0] ||= v < low;
    beyond[1] ||= v > high;
    return between(stops, (v - first) / (last - first));
  };
  return {ends, beyond, at};
}

export const barWidth = 86; // px next to the map
const thickness = 12; // px of the bar

/** The bar of a scale at the right of a plot, with its title. */
export const bar = kind(
  (c, {box, height}, {scale, title}) => {
    const {at, ends, beyond} = scale;
    const [low, high] = ends;
    const left = box.right + 12;
    const rows = Math.min(Math.round(height), 256);
    const row = height / rows;
    for (let y = 0; y < rows; ++y) {
      c.fillStyle = `rgb(${at(high - ((y + 0.5) / rows) * (high - low))})`;
      c.fillRect(left, box.top + y * row, thickness, row + 0.5);
    }
    c.font = font;
    ink(c, "soft");
    let last = Infinity;
    for (const value of marksOf(ends, height)) {
      const y = box.bottom - ((value - low) / (high - low)) * height;
      if (last - y < 12) continue;
      last = y;
      const sign =
        (value === low && beyond[0] && "≤ ") || (value === high && beyond[1] && "≥ ") || "";
      const text = `${sign}${short(Number(value.toPrecision(6)))}`;
      drawText(c, text, left + thickness + 5, clamp(y, box.top + 5, box.bottom - 5), "left");
    }
    drawTextUpwards(c, title, left + barWidth - 20, (box.top + box.bottom) / 2);
  },
  {above: true},
);

/** Values written next to a bar, ascending. */
function marksOf([low, high], height) {
  const inside = low < 0 && high > 0 ? [low, 0, high] : ticks(low, high, Math.max(2, height / 45));
  return [...new Set([low, ...inside, high])].sort((a, b) => a - b);
}

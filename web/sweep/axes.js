// What the plots of a sweep have in common: their axes, and how one points at a place and opens it.
import {colour} from "../shared/colours.js";
import {short} from "../shared/numbers.js";
import {symbolOf} from "../shared/quantities.js";
import {logTicks, ticks} from "../shared/ticks.js";

/**
 * Labels of an axis that is logarithmic; linear ones where there is less than a power of two or so
 * between its ends.
 */
const logSplits = (min, max) => {
  const list = logTicks(min, max);
  return list.length > 2 ? list : ticks(min, max, 5);
};
const quarters = (min, max) =>
  [0, 0.5, 1, 1.5, 2].map((v) => v * Math.PI).filter((v) => v >= min - 1e-9 && v <= max + 1e-9);
const turnsOfPi = {0: "0", 0.5: "π/2", 1: "π", 1.5: "3π/2", 2: "2π"};
const turn = (v) => turnsOfPi[Number((v / Math.PI).toFixed(6))] ?? short(v);

const axisStyle = () => ({
  stroke: colour("soft"),
  grid: {stroke: colour("grid"), width: 1},
  ticks: {stroke: colour("line"), width: 1, size: 4},
  font: "11px system-ui",
  labelFont: "11px system-ui",
  labelGap: 0,
});

export const nameOf = (axis, units) => `${symbolOf(axis.parameter)}${units(axis.parameter)}`;

/** A value of a parameter with its unit. */
const withUnit = (parameter, value, units) =>
  `${Number(value.toPrecision(6))}${units(parameter).replace(/[()]/g, "")}`;

/** A position on an axis in words: [term, value]. */
export const coordinate = ({parameter, values}, i, units) => [
  symbolOf(parameter),
  withUnit(parameter, values[i], units),
];

/** What names a value of the axis that is folded; null where none is. */
export const whereOf = ({reduced}, units) =>
  reduced && ((value) => `${symbolOf(reduced)} = ${withUnit(reduced, value, units)}`);

/** How a point that is simulated alone differs from that of the sweep. */
export const afresh = ({request}) =>
  (request.carry_state ?? "none") === "none" ? "" : ", afresh: not from its neighbour's last state";

/** Round labels, as many as there is room for: 80 px each in a row, 38 px in a column. */
function roundSplits(u, side, min, max) {
  const room = side === "x" ? u.width / 80 : u.height / 38;
  return ticks(min, max, Math.max(2, Math.min(10, Math.floor(room))));
}

/** An axis of uPlot. log(): whether it is logarithmic now; turns(): whether it is a phase. */
export function plotAxis(options, {log = () => false, turns = () => false} = {}) {
  const scale = options.side === 3 ? "y" : "x";
  const splits = (u, _, min, max) => {
    if (turns()) return quarters(min, max);
    return log() ? logSplits(min, max) : roundSplits(u, scale, min, max);
  };
  const filter = (_, list) => list;
  const values = (_, list) => list.map(turns() ? turn : short);
  return {...axisStyle(), ...options, scale, splits, filter, values};
}

/** A zoom is what it is; no zoom is the whole axis with half a step at its ends. */
export const wholeOrZoomed = (axis) => (_, min, max) => {
  const {values, borders} = axis;
  const n = values.length;
  const whole = n === 1 || min == null || (min === values[0] && max === values[n - 1]);
  return whole ? [borders[0], borders[n]] : [min, max];
};

export function clipped(u, paint) {
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  u.ctx.clip();
  paint(u.ctx);
  u.ctx.restore();
}

/** Lines across the plot. */
export function rule(u, levels, name) {
  u.ctx.strokeStyle = colour(name);
  u.ctx.lineWidth = devicePixelRatio;
  for (const level of levels) {
    const y = Math.round(u.valToPos(level, "y", true));
    u.ctx.beginPath();
    u.ctx.moveTo(u.bbox.left, y);
    u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
    u.ctx.stroke();
  }
}

const patience = 260; // ms in which a second click makes it a double click, which zooms out

/**
 * Pointing at a plot. move(left, top, event): the pointer is there, in the plot's own pixels;
 * leave(); open(left, top): a click of a mouse, not the end of a drag; touch(left, top): a finger,
 * which cannot hover first.
 */
export function point(over, {move, leave, open, touch}) {
  let down = null;
  let waiting = 0;
  let type = "mouse";
  const place = (event) => {
    const box = over.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  over.addEventListener("pointerdown", (event) => {
    down = [event.clientX, event.clientY];
    type = event.pointerType;
  });
  over.addEventListener("mousemove", (event) => {
    if (type === "mouse") move(...place(event));
  });
  over.addEventListener("mouseleave", () => {
    if (type === "mouse") leave();
  });
  over.addEventListener("click", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    if (type !== "mouse") return touch(...place(event));
    clearTimeout(waiting);
    if (event.detail === 1) waiting = setTimeout(open, patience, ...place(event));
  });
}

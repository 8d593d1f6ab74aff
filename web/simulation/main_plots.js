// Plots of the first screen. They share a cursor, and ring the impact nearest to it.
import {bisectCenter, bisectLeft} from "d3-array";
import {$, attributes, setTexts} from "../shared/dom.js";
import {exponentRange} from "../shared/exponents.js";
import {rangeOf} from "../shared/frame.js";
import {beads, curve, dots, levels, line, symbols} from "../shared/marks.js";
import {inMm, lastUpTo, mm, short} from "../shared/numbers.js";
import {unitsOf} from "../shared/units.js";
import {commonOptions, exponentLines, halves, picked} from "./plot_options.js";
import {inUnits, largestMagnitude, run, viewport} from "./run.js";
import {plotsIn} from "./words.js";

const mostSamples = 100000; // samples in an exported table
// Side of the impacts of each colour, and their name in tables.
const walls = {plus: [1, "x − y = b"], minus: [-1, "x − y = −b"]};

let plots;
let pinned = null; // {answer, motion} of the run to compare with
let traced = null; // the motion in the visible range, cached

export function start() {
  plots = plotsIn($("instrument"));
  viewport.onCursor(tell);
}

export const redraw = () => plots.refresh();

const optionsOf = {load, x: displacement, relative, lambda: exponents, section, largest, manifold};
const deferredPlots = ["largest", "manifold"];

/** Draws some plots; those that need the deferred answer are marked until then. */
function drawPlots(...names) {
  for (const name of deferredPlots) $(`figure-${name}`).classList.toggle("pending", !run.deferred);
  for (const name of names) plots.draw(name, optionsOf[name]());
  tell();
}

/** Draws the run. */
export function draw() {
  traced = null;
  plots.common = commonOptions(run.answer);
  const deferred = run.deferred ? deferredPlots : [];
  drawPlots("load", "x", "relative", "lambda", "section", ...deferred);
}

/** Draws the deferred answer: eigenvalues, raw product, manifold. */
export const showDeferred = () => drawPlots("lambda", ...deferredPlots);

/** Sets or clears the run to compare with. */
export function pin(other) {
  pinned = other;
  if (run) draw();
}

/** Ratio of the pinned run's tau to the shown run's; on a common axis in seconds the two differ. */
const rate = () =>
  run.answer.parameters.si
    ? (pinned.answer.parameters.derived.omega0 ?? 1) * run.units.x.factor
    : 1;

/** Motions over from..to in mm, that of the pinned run first. */
function traces(from, to, columns) {
  const trace = (motion, by) => {
    const {tau, x, gap, dense} = motion.trace(from * by, to * by, columns);
    return {tau, dense, x: mm(x), gap: gap.map((v) => -1000 * v)};
  };
  const own = trace(run.motion, 1);
  return pinned ? [{...trace(pinned.motion, rate()), tau: own.tau}, own] : [own];
}

/** Columns for a table of a range. */
const finest = (from, to) =>
  Math.min(Math.ceil((8 * (to - from)) / run.motion.shortest) + 200, mostSamples);

/** The motions over a range; two plots use those of the visible one. */
function tracesOf(from, to, columns = finest(from, to)) {
  const key = [from, to, columns].join();
  if (traced?.key !== key) traced = {key, lines: traces(from, to, columns)};
  return traced.lines;
}

/** A component of the motion, x or gap, for the plots over time; heights: of the impacts. */
function partOf(name, label, heights) {
  const styles = [{label, colour: "motion"}];
  if (pinned) styles.unshift({label: `${label}, pinned`, colour: "pinned", width: 1.6});
  const {tau: x, side} = run.motion.impacts;
  const impacts = Object.entries(walls).map(([colour, [wall]]) => {
    const y = heights.map((v, i) => (side[i] === wall ? v : null));
    return symbols({x, y, colour, shape: "dot", size: 2.2});
  });
  const linesOf = (motions) => {
    const {tau, dense} = motions.at(-1);
    return styles.map((style, k) => line({...style, dense, x: tau, y: motions[k][name]}));
  };
  return {
    unit: "mm",
    trace: (...part) => [...linesOf(tracesOf(...part)), ...impacts],
    points: {x, y: heights},
  };
}

// Columns of a load: name of the axis, factor of its numbers.
const loads = {
  acceleration_m_s2: ["base x″ (m/s²)", 1],
  displacement_m: ["base (mm)", 1000],
  force_N: ["force (N)", 1],
};

/** The samples of a load that has no period; null without one. */
function load() {
  if (!run.load) return null;
  const {time_s: time, ...columns} = run.load;
  const {omega0} = run.answer.parameters.derived;
  const [name] = Object.keys(loads).filter((each) => Array.isArray(columns[each]));
  const [label, factor] = loads[name];
  const x = time.map((t) => (t - time[0]) * omega0);
  const y = columns[name].map((v) => v * factor);
  const marks = [levels({y: 0}), line({label, colour: "trace", x, y})];
  return {marks, y: {label}, x: {...run.units.x, aligned: true}};
}

/** The range does not change with the zoom. */
function displacement() {
  const reach = 1080 * Math.max(run.motion.reach, pinned?.motion.reach ?? 0) || 1;
  return {
    ...partOf("x", "x", mm(run.motion.impacts.x)),
    y: {label: run.load ? "x − base (mm)" : "x (mm)", range: [-reach, reach]},
  };
}

function relative() {
  const b = run.motion.b * 1000;
  const heights = run.answer.impacts.side.map((side) => side * b);
  const other = (pinned?.motion.b ?? 0) * 1000;
  const reach = 1.14 * Math.max(b, other);
  const walls = [levels({y: [-b, b]}), levels({y: [-other, other], colour: "pinned"})];
  return {
    ...partOf("gap", "x − y", heights),
    under: [...plots.common.under, ...walls.slice(0, pinned ? 2 : 1)],
    y: {label: "x − y (mm)", range: [-reach, reach]},
  };
}

function largest() {
  const {tau, T} = run.deferred.eigenvalues;
  const points = {x: tau, y: T.map(([first]) => first)};
  return {
    marks: [
      levels({y: 1}),
      line({label: "|μ₁|", colour: "c3", width: 0.8, ...points}),
      beads({colour: "c3", size: 2, ...points}),
    ],
    y: {label: "|μ| of T", log: true, range: rangeOf([[1], points.y], true)},
    points,
  };
}

/** Exponents by qr, the largest of the raw product, and the largest of the pinned run. */
function exponents() {
  const {qr} = run.answer.exponents;
  const other = pinned?.answer.exponents.qr?.history;
  const options = exponentLines(qr, exponentRange([qr?.history, other]));
  const x = qr?.history?.tau ?? [];
  const beside = (history, style) => {
    if (!history?.tau.length) return;
    const {tau, lambda1, by = 1} = history;
    const at = (t) => (t * by <= tau.at(-1) ? lambda1[lastUpTo(tau, t * by)] : null) ?? null;
    options.marks.push(line({...style, x, y: x.map(at)}));
  };
  const raw = run.deferred?.exponents.raw_product?.history;
  beside(raw, {label: "λ₁ raw", colour: "soft", width: 1.2, dash: [5, 4]});
  beside(other && {...other, by: rate()}, {label: "λ₁ pinned", colour: "pinned", width: 1.6});
  return options;
}

function section() {
  const {impacts} = run.motion;
  const {velocity} = run.units;
  const place = (of, units = run.units) => ({
    x: mm(of.x),
    y: inUnits(of.x_dot_after, units.velocity),
  });
  const kindOf = ([colour, [wall, label]]) => [colour, (i) => impacts.side[i] === wall, label];
  const points = place(impacts);
  const marks = halves(points, Object.entries(walls).map(kindOf));
  if (pinned) {
    const there = place(pinned.answer.impacts, unitsOf(pinned.answer.parameters));
    marks.unshift(dots({...there, colour: "pinned", label: "pinned", size: 1.5}));
  }
  return {
    marks,
    x: {label: "x (mm)"},
    y: {label: `x′ after (${velocity.unit})`},
    points: picked(points, impacts.tau),
  };
}

/** Shows the values at the cursor next to the titles; by: the cause of the cursor's move. */
function tell(by) {
  const {cursor} = viewport;
  if (!run || cursor === null) return;
  const {motion} = run;
  const {tau: moments} = motion.impacts;
  const impact = moments[bisectCenter(moments, cursor)];
  const {tau: known, T} = run.deferred?.eigenvalues ?? {tau: []};
  const k = bisectLeft(known, impact);
  const modulus = known[k] === impact ? T?.[k]?.[0] : null;
  const {x, y} = motion.at(cursor);
  const at = run.units.at(cursor);
  const texts = {
    x: inMm(x),
    relative: inMm(x - y),
    largest: modulus == null ? "" : short(modulus),
    lambda: `at ${at}`, // the legend shows the values
  };
  for (const [name, text] of Object.entries(texts)) {
    setTexts({[`value-${name}`]: text});
    if (by === "play") continue; // not announced 60 times a second
    attributes($(`plot-${name}`), {"aria-valuetext": name === "lambda" ? at : `${at} ${text}`});
  }
}

/** The branches extend far beyond the run's points, the fold and the free amplitude shown. */
export function manifold() {
  const {points, fold, free_amplitude: free} = run.deferred.manifold;
  const dash = [5, 4];
  const {velocity} = run.units;
  const place = ({V, C}) => ({x: inUnits(V, velocity), y: mm(C)});
  const marks = [
    dots({...place(points), colour: "after", label: "half cycle", size: 1.1, alpha: 0.6}),
  ];
  if (fold) {
    const at = place({V: [fold.V], C: [fold.C]});
    marks.push(dots({...at, colour: "wall", label: "fold", size: 4}));
  }
  const styles = {
    stable: {colour: "c2"},
    unstable: {colour: "c3", dash},
    asymmetric: {colour: "c4", dash},
  };
  for (const [label, style] of Object.entries(styles)) {
    const branch = run.deferred.manifold[label];
    document.querySelector(`#figure-manifold .key.${label}`).hidden = !branch;
    if (branch) marks.push(curve({...place(branch), ...style, label}));
  }
  if (free)
    marks.push(levels({y: free * 1000, colour: "wall", text: "amplitude without absorber"}));
  const reach = (values) => [0, 1.15 * largestMagnitude(values) || 0.001];
  const extent = place({
    V: reach([...points.V, 1.4 * fold?.V]),
    C: reach([...points.C, 1.6 * fold?.C, free]),
  });
  return {
    marks,
    x: {label: `speed of the ball, V (${velocity.unit})`, range: extent.x},
    y: {label: "amplitude of x, C (mm)", range: extent.y},
    points: picked(place(points), points.tau),
  };
}

// Plots of the first screen: motion over time (reconstructed from the impacts), largest modulus of
// T, exponents, section and manifold. They share a cursor, and the impact nearest to it is ringed
// in each.
import {$, attributes, setTexts} from "../shared/dom.js";
import {exponentRange} from "../shared/exponents.js";
import {inMm, short} from "../shared/numbers.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {unitsOf} from "../shared/units.js";
import {alongRun, inUnits, largestMagnitude, logRange, mm, positive} from "./columns.js";
import {exponentLines, halves, marksOf, PlotGroup} from "./plot_group.js";
import {pick, run, viewport} from "./run.js";

const mostSamples = 100000; // samples in an exported table
const alone = matchMedia("(max-width: 700px)"); // one plot at a time is shown
const walls = {plus: 1, minus: -1}; // by colour
const wallNames = {plus: "y − x = −b", minus: "y − x = b"};
const overTime = ["x", "relative", "largest", "lambda"];

let plots;
let pinned = null; // {answer, motion} of the run to compare with
let traced = null; // the motion in the visible range, cached
let byWall = null; // the impacts at each wall, cached

export function start() {
  plots = new PlotGroup(overTime, ["section", "manifold"]);
  viewport.onCursor(light);
  viewport.onZoom(light);
}

export const redraw = () => plots.refresh();

const optionsOf = {x: displacement, relative, lambda: exponents, section, largest, manifold};
const deferredPlots = ["largest", "manifold"];

/**
 * Returns functions that draw the plots. Plots that need the deferred answer are marked until it
 * arrives.
 */
function stepsOf(...names) {
  for (const name of deferredPlots) $(`figure-${name}`).classList.toggle("pending", !run.deferred);
  return [...names.map((name) => () => plots.draw(name, optionsOf[name]())), light];
}

export function drawing() {
  traced = null;
  byWall = null;
  plots.marks = marksOf(run.answer);
  return stepsOf("x", "relative", "lambda", "section", ...(run.deferred ? deferredPlots : []));
}

/** Draws the deferred answer: eigenvalues, raw product, manifold. */
export function showDeferred() {
  for (const step of stepsOf("lambda", ...deferredPlots)) step();
}

/** Sets or clears the run to compare with. */
export function pin(other) {
  pinned = other;
  if (run) for (const step of drawing()) step();
}

/** Ratio of the pinned run's tau to the shown run's; on a common axis in seconds the two differ. */
const rate = () =>
  run.units.si ? (pinned.answer.parameters.derived.omega0 ?? 1) * run.units.x.factor : 1;

/** Motions over from..to in mm, that of the pinned run first. */
function traces(from, to, columns) {
  const trace = (motion, by) => {
    const {tau, x, gap, dense} = motion.trace(from * by, to * by, columns);
    return {tau, dense, x: mm(x), gap: mm(gap)};
  };
  const own = trace(run.motion, 1);
  return pinned ? [{...trace(pinned.motion, rate()), tau: own.tau}, own] : [own];
}

/** The motions of the visible range; two plots use them. */
function inView(...part) {
  const key = part.join();
  if (traced?.key !== key) traced = {key, lines: traces(...part)};
  return traced.lines;
}

/** Impacts of each wall: {mine: indices, x: times, ...style}. */
const impactsByWall = ({tau, side}) =>
  Object.entries(walls).map(([colour, wall]) => {
    const mine = [...tau.keys()].filter((i) => side[i] === wall);
    return {mine, x: mine.map((i) => tau[i]), colour, shape: "dot", size: 2.2};
  });

/**
 * A component of the motion, x or gap, for the plots over time; at(i) is the height of the i-th
 * impact.
 */
function partOf(name, label, at) {
  const data = (lines) => [lines[0].tau, ...lines.map((line) => line[name])];
  const trace = (...part) => {
    const lines = inView(...part);
    return {data: data(lines), dense: lines.at(-1).dense};
  };
  const samples = (from, to) => {
    const columns = Math.ceil((8 * (to - from)) / run.motion.shortest) + 200;
    return data(traces(from, to, Math.min(columns, mostSamples)));
  };
  const series = [{label, colour: "motion"}];
  if (pinned) series.unshift({label: `${label}, pinned`, colour: "pinned"});
  byWall ??= impactsByWall(run.answer.impacts);
  const marks = byWall.map(({mine, ...wall}) => ({...wall, y: mine.map(at)}));
  const bare = !alone.matches;
  return {bare, unit: "mm", label: `${label} (mm)`, trace, samples, series, marks};
}

/** The range does not change with the zoom. */
function displacement() {
  const {x} = run.answer.impacts;
  inView(0, run.motion.end, plots.all.x.columns); // also sets motion.reach
  const reach = 1080 * Math.max(run.motion.reach, pinned?.motion.reach ?? 0) || 1;
  return {...partOf("x", "x", (i) => x[i] * 1000), range: [-reach, reach]};
}

function relative() {
  const b = run.motion.b * 1000;
  const {side} = run.answer.impacts;
  return {
    ...partOf("gap", "y − x", (i) => -side[i] * b),
    range: [-1.14 * b, 1.14 * b],
    levels: [-b, b],
  };
}

function largest() {
  const {tau, T} = run.deferred.eigenvalues;
  const moduli = T.map(([first]) => positive(first));
  return {
    bare: !alone.matches,
    series: [{label: "|μ₁|", colour: "c3", width: 0.8, dots: 4}],
    data: alongRun(tau, [moduli]),
    label: "|μ| of T",
    log: true,
    range: logRange([moduli]),
    levels: [1],
  };
}

/** Exponents by qr, the largest of the raw product, and the largest of the pinned run. */
function exponents() {
  const {qr} = run.answer.exponents;
  const lines = exponentLines(qr);
  const beside = (history, style) => {
    if (!history?.tau.length) return;
    const {tau, lambda1, by = 1} = history;
    const at = (t) => (t * by <= tau.at(-1) ? lambda1[lastUpTo(tau, t * by)] : null) ?? null;
    lines.series.push(style);
    lines.data.push(lines.data[0].map(at));
  };
  beside(run.deferred?.exponents.raw_product?.history, {
    label: "λ₁ raw",
    colour: "soft",
    width: 1.2,
    dash: [5, 4],
  });
  const other = pinned?.answer.exponents.qr?.history;
  beside(other && {...other, by: rate()}, {label: "λ₁ pinned", colour: "pinned", width: 1.6});
  return {...lines, range: exponentRange([qr?.history, other])};
}

/** States after each impact, by wall. */
function section() {
  const {impacts} = run.answer;
  const {velocity} = run.units;
  const place = (of, units = run.units) => ({
    x: mm(of.x),
    y: inUnits(of.x_dot_after, units.velocity),
  });
  const kinds = Object.entries(walls).map(([name, wall]) => [
    name,
    (i) => impacts.side[i] === wall,
    wallNames[name],
  ]);
  const points = place(impacts);
  const groups = halves(points, kinds);
  const style = {colour: "pinned", label: "pinned", size: 3, alpha: 1};
  if (pinned)
    groups.unshift({...place(pinned.answer.impacts, unitsOf(pinned.answer.parameters)), ...style});
  return {
    groups,
    xLabel: "x (mm)",
    yLabel: `x′ after (${velocity.unit})`,
    pick: {...points, use: (i, clicked) => pick(impacts.tau[i], clicked)},
  };
}

/** Rings the impact nearest to the cursor in all plots; by: the cause of the cursor's move. */
function light(by) {
  const {cursor} = viewport;
  if (!plots.all.section.last || cursor === null) return;
  const {motion, deferred} = run;
  const {tau, x, side} = motion.impacts;
  const i = motion.impactNear(cursor);
  const modulus = modulusAt(tau[i]);
  plots.all.x.light(tau[i], x[i] * 1000);
  plots.all.relative.light(tau[i], -side[i] * motion.b * 1000);
  plots.ring("section", i);
  tell(modulus, by === "play");
  if (!deferred) return;
  plots.all.largest.light(tau[i], modulus);
  plots.ring("manifold", firstFrom(deferred.manifold.points.tau, cursor));
}

/** The largest modulus of T at an impact; null if unknown. */
function modulusAt(tau) {
  const {tau: moments, T} = run.deferred?.eigenvalues ?? {tau: []};
  const k = firstFrom(moments, tau);
  return moments[k] === tau ? (T?.[k]?.[0] ?? null) : null;
}

/** Shows the values at the cursor next to the titles. */
function tell(modulus, playing) {
  const {cursor} = viewport;
  const {x, y} = run.motion.at(cursor);
  const values = {
    x: inMm(x),
    relative: inMm(y - x),
    largest: modulus == null ? "" : short(modulus),
  };
  for (const [name, text] of Object.entries(values)) setTexts({[`value-${name}`]: text});
  setTexts({"value-lambda": `at ${run.units.at(cursor)}`}); // the legend shows the values
  if (playing) return; // not announced 60 times a second
  for (const name of overTime)
    attributes($(`plot-${name}`), {
      "aria-valuetext": `${run.units.at(cursor)} ${values[name] ?? ""}`,
    });
}

/**
 * The branches extend far beyond most runs, so the plot shows the range of the run's points, the
 * fold and the free amplitude.
 */
export function manifold() {
  const {points, fold, free_amplitude: free, stable, unstable, asymmetric} = run.deferred.manifold;
  const {velocity} = run.units;
  const place = ({V, C}) => ({x: inUnits(V, velocity), y: mm(C)});
  const groups = [{...place(points), colour: "after", label: "half cycle", size: 2.2, alpha: 0.6}];
  if (fold)
    groups.push({
      ...place({V: [fold.V], C: [fold.C]}),
      colour: "wall",
      label: "fold",
      size: 8,
      alpha: 1,
    });
  const dash = [5, 4];
  const curves = [
    stable && {...place(stable), colour: "c2", label: "stable"},
    unstable && {...place(unstable), colour: "c3", dash, label: "unstable"},
    asymmetric && {...place(asymmetric), colour: "c4", dash, label: "asymmetric"},
  ];
  for (const [name, curve] of Object.entries({stable, unstable, asymmetric}))
    document.querySelector(`#figure-manifold .key.${name}`).hidden = !curve;
  const reach = (values, ...others) => [
    0,
    Math.max(largestMagnitude(values), ...others) * 1.15 || 0.001,
  ];
  return {
    groups,
    curves: curves.filter(Boolean),
    levels: free ? [{y: free * 1000, colour: "wall", label: "amplitude without absorber"}] : [],
    extent: place({
      V: reach(points.V, 1.4 * (fold?.V ?? 0)),
      C: reach(points.C, 1.6 * (fold?.C ?? 0), free ?? 0),
    }),
    pick: {...place(points), use: (i, clicked) => pick(points.tau[i], clicked)},
    xLabel: `speed of the ball, V (${velocity.unit})`,
    yLabel: "amplitude of x, C (mm)",
  };
}

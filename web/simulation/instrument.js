// The plots of the first screen: the motion over time, made anew from the impacts for whatever is in
// view, the largest modulus of T, the exponents, the section and the manifold. One cursor goes
// through all of them, and the impact nearest to it is ringed in each.
import {$, attributes, write} from "../shared/dom.js";
import {exponentRange} from "../shared/exponents.js";
import {inMm, short} from "../shared/numbers.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {unitsOf} from "../shared/units.js";
import {logRange, mm, over, overRun, positive} from "./columns.js";
import {manifold} from "./manifold.js";
import {marksOf} from "./marks.js";
import {exponentLines, halves, Plots} from "./plots.js";
import {axis, pick, run} from "./run.js";

const mostSamples = 100000; // of the motion, as numbers
const alone = matchMedia("(max-width: 700px)"); // one plot at a time is on the screen
const walls = {plus: 1, minus: -1}; // by their colours
const wallNames = {plus: "y − x = −b", minus: "y − x = b"};
const overTime = ["x", "relative", "largest", "lambda"];

let plots;
let pinned = null; // {answer, motion} of a run to compare with
let traced = null; // what of the motion is in view
let byWall = null; // the impacts at each wall, once they are drawn

export function start() {
  plots = new Plots(overTime, ["section", "manifold"]);
  axis.onCursor(light);
  axis.onView(light);
}

export const redraw = () => plots.refresh();

// What each plot draws.
const optionsOf = {x: displacement, relative, lambda: exponents, section, largest, manifold};
const ofMore = ["largest", "manifold"];

/** The steps that draw plots; those of a second answer are marked until it is there. */
function stepsOf(...names) {
  for (const name of ofMore) $(`figure-${name}`).classList.toggle("behind", !run.more);
  return [...names.map((name) => () => plots.draw(name, optionsOf[name]())), light];
}

/** What shows the run, step by step. */
export function drawing() {
  traced = null;
  byWall = null;
  plots.marks = marksOf(run.answer);
  return stepsOf("x", "relative", "lambda", "section", ...(run.more ? ofMore : []));
}

/** What a second answer of the same run brings: eigenvalues, the raw product, the manifold. */
export function showMore() {
  for (const step of stepsOf("lambda", ...ofMore)) step();
}

/** A run to compare with, or none. */
export function pin(other) {
  pinned = other;
  if (run) for (const step of drawing()) step();
}

/** How the pinned run's tau goes on while the shown one's goes by 1: in seconds each has its own. */
const rate = () =>
  run.units.si ? (pinned.answer.parameters.derived.omega0 ?? 1) * run.units.x.factor : 1;

/** The motions from..to in mm, that of the pinned run first. */
function traces(from, to, columns) {
  const trace = (motion, by) => {
    const {tau, x, gap, dense} = motion.trace(from * by, to * by, columns);
    return {tau, dense, x: mm(x), gap: mm(gap)};
  };
  const own = trace(run.motion, 1);
  return pinned ? [{...trace(pinned.motion, rate()), tau: own.tau}, own] : [own];
}

/** The same of what is in view, of which two plots draw a part each. */
function inView(...part) {
  const key = part.join();
  if (traced?.key !== key) traced = {key, lines: traces(...part)};
  return traced.lines;
}

/** {mine: their indices, x: their moments, and how they look} for each wall. */
const impactsByWall = ({tau, side}) =>
  Object.entries(walls).map(([colour, wall]) => {
    const mine = [...tau.keys()].filter((i) => side[i] === wall);
    return {mine, x: mine.map((i) => tau[i]), colour, shape: "dot", size: 2.2};
  });

/**
 * A part of the motion, x or gap, as both plots over time draw it; at(i): where the i-th impact
 * lies.
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

/** Over a range that a zoom does not change. */
function displacement() {
  const {x} = run.answer.impacts;
  inView(0, run.motion.end, plots.all.x.columns); // which is drawn, where all is in view
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
  const {tau, T} = run.more.eigenvalues;
  const moduli = T.map(([first]) => positive(first));
  return {
    bare: !alone.matches,
    series: [{label: "|μ₁|", colour: "c3", width: 0.8, dots: 4}],
    data: overRun(tau, [moduli]),
    label: "|μ| of T",
    log: true,
    range: logRange([moduli]),
    levels: [1],
  };
}

/** And beside them the largest as rounding makes it, and that of the pinned run. */
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
  beside(run.more?.exponents.raw_product?.history, {
    label: "λ₁ raw",
    colour: "soft",
    width: 1.2,
    dash: [5, 4],
  });
  const other = pinned?.answer.exponents.qr?.history;
  beside(other && {...other, by: rate()}, {label: "λ₁ pinned", colour: "pinned", width: 1.6});
  return {...lines, range: exponentRange([qr?.history, other])};
}

/** After each impact, by wall. */
function section() {
  const {impacts} = run.answer;
  const {velocity} = run.units;
  const place = (of, units = run.units) => ({
    x: mm(of.x),
    y: over(of.x_dot_after, units.velocity),
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

/** Rings the impact nearest to the cursor, and the half cycle that it lies in; by: who moved it. */
function light(by) {
  const {cursor} = axis;
  if (!plots.all.section.last || cursor === null) return;
  const {motion, more} = run;
  const {tau, x, side} = motion.impacts;
  const i = motion.impactNear(cursor);
  const modulus = modulusAt(tau[i]);
  plots.all.x.light(tau[i], x[i] * 1000);
  plots.all.relative.light(tau[i], -side[i] * motion.b * 1000);
  plots.ring("section", i);
  tell(modulus, by === "play");
  if (!more) return;
  plots.all.largest.light(tau[i], modulus);
  plots.ring("manifold", firstFrom(more.manifold.points.tau, cursor));
}

/** The largest modulus of T at an impact, where it is known. */
function modulusAt(tau) {
  const {tau: moments, T} = run.more?.eigenvalues ?? {tau: []};
  const k = firstFrom(moments, tau);
  return moments[k] === tau ? (T?.[k]?.[0] ?? null) : null;
}

/** The values at the cursor, beside the title of each plot. */
function tell(modulus, playing) {
  const {cursor} = axis;
  const {x, y} = run.motion.at(cursor);
  const values = {
    x: inMm(x),
    relative: inMm(y - x),
    largest: modulus == null ? "" : short(modulus),
  };
  for (const [name, text] of Object.entries(values)) write({[`value-${name}`]: text});
  write({"value-lambda": `at ${run.units.at(cursor)}`}); // which its legend tells
  if (playing) return; // a reader of the page is not told sixty times a second
  for (const name of overTime)
    attributes($(`plot-${name}`), {
      "aria-valuetext": `${run.units.at(cursor)} ${values[name] ?? ""}`,
    });
}

// The plots of a measurement: the record with its impacts, and what was identified from them.
import {Axis} from "../shared/axis.js";
import {$, element} from "../shared/dom.js";
import {exponentRange, exponentSeries} from "../shared/exponents.js";
import {addMenu, captionOf} from "../shared/figure_menu.js";
import {rangeOf} from "../shared/frame.js";
import {LinePlot} from "../shared/line_plot.js";
import {operable} from "../shared/operable.js";
import {verdicts} from "../shared/quantities.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {isLeftOut, kindOf} from "./impact_list.js";
import {spikeNear} from "./record.js";

const axis = new Axis();
const line = (name) => [name, new LinePlot($(`plot-measured-${name}`), axis)];
const plane = (name) => [name, new ScatterPlot($(`plot-measured-${name}`))];
const planes = ["portrait", "section"];
const plots = Object.fromEntries([
  ...["a", "x", "qr", "raw", "R", "steps"].map(line),
  ...planes.map(plane),
]);
const mm = (metres) => metres.map((v) => v * 1000);

/** Draws lines over the record. */
const drawLines = (name, options) => plots[name].draw({...options, x: "t (s)"});

/** The figures of the paper that show the same of its own records, by preset. */
const figures = {
  fig15: {a: 15, x: 16, portrait: 17, section: 18, qr: 19, raw: 19},
  fig20: {a: 20, x: 21, portrait: 22, section: 23, qr: 24, raw: 24},
};
const figureOf = (name) => $(`plot-measured-${name}`).closest("figure");

/** told(): {name, answer} of the record that is shown. */
export function start(told) {
  axis.onCursor(() => light(told().answer));
  for (const [name, plot] of Object.entries(plots)) {
    const {title} = captionOf(figureOf(name));
    operable(plot, title, () => told().answer?.impacts.time_s ?? []);
    addMenu(figureOf(name), plot, () => ({
      title,
      summary: summaryOf(told()),
      caption: told().name,
      name: `measured-${name}`,
    }));
  }
}

function summaryOf({answer}) {
  if (!answer) return "A record of which nothing is identified yet.";
  const {impacts, verdict, slope} = answer;
  const lambda = slope.lambda1 == null ? "" : `, slope of λ₁τ ${slope.lambda1.toFixed(4)}`;
  return `${impacts.tau.length} impacts, ${verdicts[verdict] ?? "no verdict"}${lambda}`;
}

/** Tags the plots of an experiment of the paper with its figures. */
export function nameFigures(preset) {
  for (const tag of document.querySelectorAll("#measure-results .tag")) tag.remove();
  for (const [name, number] of Object.entries(figures[preset] ?? {})) {
    const title = "what this figure of the paper shows of its own record";
    const tag = element("span", {className: "tag", textContent: `as Fig. ${number}`, title});
    figureOf(name).querySelector("figcaption").append(tag);
  }
}

/** Rings the impact nearest to the cursor. */
function light(answer) {
  const {cursor} = axis;
  if (!answer || cursor === null) return;
  const {time_s: t, x, x_dot_after: xDot, R} = answer.impacts;
  const before = Math.max(lastUpTo(t, cursor), 0);
  const i = t[before + 1] - cursor < cursor - t[before] ? before + 1 : before;
  const {omega0} = answer.parameters.derived;
  for (const name of planes) plots[name].light(x[i] * 1000, xDot[i] * 1000 * omega0);
  plots.x.light(t[i], x[i] * 1000);
  plots.R.light(t[i], R[i]);
}

export function redraw() {
  for (const plot of Object.values(plots)) plot.refresh();
}

/** The colours of the marks of impacts, by kind. */
const kinds = {plus: "plus", minus: "minus", "left-out": "wall", removed: "soft", edited: "c4"};

/** The rows of the list as marks at heights: y(row). */
const marks = (rows, y, shape, size) =>
  Object.entries(kinds)
    .map(([kind, colour]) => {
      const mine = rows.filter((row) => kindOf(row) === kind);
      const stroke = colour === kind ? {size, width: 1.3} : {size: size * 1.6, width: 2};
      return {x: mine.map((row) => row.t), y: mine.map(y), colour, shape, ...stroke};
    })
    .filter(({x}) => x.length);

/** The value of a column between its samples. */
function valueAt({t}, column, moment) {
  const i = Math.min(Math.max(firstFrom(t, moment), 1), t.length - 1);
  const share = (moment - t[i - 1]) / (t[i] - t[i - 1]);
  return column[i - 1] + (column[i] - column[i - 1]) * share;
}

/**
 * The impacts of the list on the plots of the record, with its edits, and the intervals in which the
 * mass sticks to a wall; answer: null before there is one.
 */
export function mark(record, rows, answer) {
  const {t, a, x} = record;
  const seconds = secondsOf(answer);
  const {tau_start: from, tau_end: to} = answer?.sticking ?? {tau_start: []};
  const stuck = from.map((tau, i) => seconds([tau, to[i]]));
  const step = (t.at(-1) - t[0]) / (t.length - 1);
  const reach = (answer ? answer.signal.pulse_s / 2 : step) + step;
  if (a)
    plots.a.mark(
      marks(rows, (row) => a[spikeNear(record, row.t, reach)], "cross", 4),
      stuck,
    );
  if (!x) return;
  const rings = marks(rows, (row) => valueAt(record, x, row.t), "ring", 3.5);
  plots.x.mark([...forwardMarks(answer, seconds), ...rings], stuck);
}

/** What makes moments in s of those of an answer. */
const secondsOf = (answer) => (taus) => taus.map((tau) => tau / answer.parameters.derived.omega0);

/** Where the identified system, run from the first known state, meets its walls. */
function forwardMarks(answer, seconds) {
  if (!answer?.forward) return [];
  const {tau, x} = answer.forward.impacts;
  return [{x: seconds(tau), y: mm(x), colour: "soft", shape: "dot", size: 1.4}];
}

/** The record, before anything is known of it; click: where one clicks on the acceleration. */
export function drawRecord({t, a, x}, click) {
  const draw = (name, column, series, label, more) => {
    $(`figure-measured-${name}`).hidden = !column;
    const span = [t[0], t.at(-1)];
    const trace = {label: series, colour: "trace"};
    if (column) drawLines(name, {series: [trace], data: [t, column], span, label, ...more});
  };
  draw("a", a, "x″", "acceleration (m/s²)", {click});
  draw("x", x, "x", "x (mm)");
}

function drawExponents(answer) {
  const {exponents, slope} = answer;
  const {lambda1: y, low: from, high: to} = slope;
  const told = [y, from, to].filter((v) => v != null);
  const range = exponentRange([exponents.qr?.history, exponents.raw_product?.history]);
  const common = {
    label: "λ",
    range: [Math.min(range[0], ...told), Math.max(range[1], ...told)],
    levels: [0],
  };
  $("figure-measured-raw").hidden = !exponents.raw_product;
  const known = y != null && {
    levels: [0, {y, colour: "before"}],
    layers: [{from, to, colour: "interval"}],
  };
  const seconds = secondsOf(answer);
  drawLines("qr", {...common, ...historyOf(exponents.qr, seconds), ...known});
  drawLines("raw", {...common, ...historyOf(exponents.raw_product, seconds)});
}

/** An estimator's exponents over the impacts, and as rings where they end. */
function historyOf(estimator, seconds) {
  if (!estimator?.history?.tau.length) return {series: [], data: [[]]};
  const {history, final: y} = estimator;
  const {series, columns} = exponentSeries(history);
  const t = seconds(history.tau);
  const x = y.map(() => t.at(-1));
  const marks = [{x, y, colour: "text", shape: "ring", size: 3.5}];
  return {series, data: [t, ...columns], marks};
}

/** R of each impact; one that is not consistent lies where it fits, or at the edge. */
function drawRestitution({impacts, restitution}) {
  const {time_s: t, R, side, status} = impacts;
  const of = (sign) => R.map((v, i) => (side[i] === sign && status[i] === "ok" ? v : null));
  const columns = [of(1), of(-1)];
  const around = columns.flat().flatMap((v) => (v === null ? [] : [v - 0.004, v + 0.004]));
  const left = [...R.keys()].filter((i) => isLeftOut(status[i]) && R[i] != null);
  const crosses = {x: left.map((i) => t[i]), y: left.map((i) => R[i]), colour: "wall"};
  const walls = ["plus", "minus"];
  drawLines("R", {
    series: walls.map((colour, k) => ({label: `R at ${"+−"[k]}b`, colour, dots: 4.5})),
    data: [t, ...columns],
    range: rangeOf([around]) ?? [0, 1],
    label: "R",
    levels: walls.map((colour) => ({y: restitution[colour].R, colour})).filter(({y}) => y != null),
    marks: [{...crosses, shape: "cross", size: 5, width: 2}],
  });
}

function drawSteps({impacts: {tau, time_s: t}, parameters}) {
  const half = Math.PI / parameters.Omega;
  const steps = tau.map((v, i) => (v - tau[i - 1]) / half || null); // the first has none before it
  drawLines("steps", {
    series: [{label: "time since the last impact", colour: "c1", dots: 4}],
    data: [t, steps],
    log: true,
    range: rangeOf([steps, [0.5, 2]], {log: true}),
    label: "half periods",
    levels: [1],
  });
}

function drawSections({impacts, parameters}) {
  const x = mm(impacts.x);
  const inSeconds = 1000 * parameters.derived.omega0; // mm/s of m per unit of tau
  const points = (velocity) => ({x, y: velocity.map((v) => v * inSeconds)});
  const after = points(impacts.x_dot_after);
  const draw = (name, yLabel, groups) =>
    plots[name].draw({
      pick: {...after, use: (i) => axis.point(impacts.time_s[i], "pick")},
      groups,
      xLabel: "x (mm)",
      yLabel,
    });
  draw("portrait", "x′ (mm/s)", [
    {...points(impacts.x_dot_before), colour: "before", shape: "ring", size: 3.4},
    {...after, colour: "after", shape: "cross", size: 2.8},
  ]);
  const atWall = (sign, colour) => {
    const of = (column) => column.filter((_, i) => impacts.side[i] === sign);
    return {x: of(x), y: of(after.y), colour, size: 3.6, alpha: 1};
  };
  draw("section", "x′ after (mm/s)", [atWall(1, "plus"), atWall(-1, "minus")]);
}

export function draw(answer) {
  drawExponents(answer);
  drawRestitution(answer);
  drawSteps(answer);
  drawSections(answer);
}

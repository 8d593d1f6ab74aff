// The plots of a measurement: the record with its impacts, and what was identified from them.
import {Axis} from "../shared/axis.js";
import {$, element} from "../shared/dom.js";
import {exponentSeries} from "../shared/exponents.js";
import {addMenu} from "../shared/figure_menu.js";
import {LinePlot} from "../shared/line_plot.js";
import {operable} from "../shared/operable.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {isLeftOut} from "./impact_list.js";
import {spikeNear} from "./record.js";

const axis = new Axis();
const line = (name) => [name, new LinePlot($(`plot-measured-${name}`), axis)];
const scatter = (name) => [name, new ScatterPlot($(`plot-measured-${name}`))];
const plots = Object.fromEntries([
  ...["a", "x", "qr", "raw", "R", "steps"].map(line),
  ...["portrait", "section"].map(scatter),
]);
const mm = (metres) => metres.map((v) => v * 1000);
const seconds = "t (s)";

/** What a plot shows, and the figures of the paper that show it of their record, by preset. */
const figures = {
  a: {title: "Acceleration of the oscillator, with its impacts", fig15: 15, fig20: 20},
  x: {title: "Displacement of the oscillator, with its impacts", fig15: 16, fig20: 21},
  portrait: {title: "Phase portrait at impacts", fig15: 17, fig20: 22},
  section: {title: "Section after impact, by wall", fig15: 18, fig20: 23},
  qr: {title: "Transient Lyapunov exponents, qr", fig15: 19, fig20: 24},
  raw: {title: "Transient Lyapunov exponents, raw_product", fig15: 19, fig20: 24},
  R: {title: "Restitution coefficient of each impact"},
  steps: {title: "Time from impact to impact, in half forcing periods"},
};
const figureOf = (name) => $(`plot-measured-${name}`).closest("figure");

/** told(): {name, answer} of the record that is shown. */
export function start(told) {
  axis.onCursor(() => light(told().answer));
  for (const [name, plot] of Object.entries(plots)) {
    const {title} = figures[name];
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
  return `${impacts.tau.length} impacts, ${verdict.replace("_", " ")}${lambda}`;
}

/** Tags the plots of an experiment of the paper with its figures. */
export function nameFigures(preset) {
  for (const [name, numbers] of Object.entries(figures)) {
    const caption = figureOf(name).querySelector("figcaption");
    caption.querySelector(".tag")?.remove();
    if (!numbers[preset]) continue;
    const title = "what this figure of the paper shows of its own record";
    caption.append(
      element("span", {className: "tag", textContent: `as Fig. ${numbers[preset]}`, title}),
    );
  }
}

/** Rings the impact nearest to the cursor. */
function light(answer) {
  if (!answer || axis.cursor === null) return;
  const {time_s: t, x, x_dot_after: xDot} = answer.impacts;
  const before = lastUpTo(t, axis.cursor);
  const i =
    t[before + 1] - axis.cursor < axis.cursor - t[before] ? before + 1 : Math.max(before, 0);
  for (const name of ["portrait", "section"]) plots[name].light(x[i] * 1000, xDot[i] * 1000);
  plots.x.light(t[i], x[i] * 1000);
  plots.R.light(t[i], answer.impacts.R[i]);
}

export function redraw() {
  for (const plot of Object.values(plots)) plot.refresh();
}

// How an impact is marked: by its wall, or because it is left out or edited.
const kinds = {plus: "plus", minus: "minus", left: "wall", removed: "soft", edited: "c4"};
function kindOf(row) {
  if (row.removed) return "removed";
  if (row.t !== row.found) return "edited";
  if (isLeftOut(row.status)) return "left";
  return row.side > 0 ? "plus" : "minus";
}

/** The rows of the list as marks at heights: y(row). */
function marks(rows, y, shape, size) {
  return Object.entries(kinds)
    .map(([kind, colour]) => {
      const mine = rows.filter((row) => kindOf(row) === kind);
      const usual = kind === "plus" || kind === "minus";
      const stroke = usual ? {size, width: 1.3} : {size: size * 1.6, width: 2};
      return {x: mine.map((row) => row.t), y: mine.map(y), colour, shape, ...stroke};
    })
    .filter((group) => group.x.length);
}

/** The value of a column between its samples. */
function valueAt({t}, column, moment) {
  const i = Math.min(Math.max(firstFrom(t, moment), 1), t.length - 1);
  const share = (moment - t[i - 1]) / (t[i] - t[i - 1]);
  return column[i - 1] + (column[i] - column[i - 1]) * Math.min(Math.max(share, 0), 1);
}

/**
 * The impacts of the list on the plots of the record, with its edits; answer: null before there is
 * one.
 */
export function mark(record, rows, answer) {
  if (record.a) {
    const step = (record.t.at(-1) - record.t[0]) / (record.t.length - 1);
    const reach = (answer ? answer.signal.pulse_s / 2 : step) + step;
    plots.a.mark(
      marks(rows, (row) => record.a[spikeNear(record, row.t, reach)], "cross", 4),
      stuck(answer),
    );
  }
  if (record.x)
    plots.x.mark(
      [
        ...(answer ? forwardMarks(answer) : []),
        ...marks(rows, (row) => valueAt(record, record.x, row.t), "ring", 3.5),
      ],
      stuck(answer),
    );
}

/** The intervals in s in which the mass sticks to a wall. */
function stuck(answer) {
  if (!answer) return [];
  const {tau_start: from, tau_end: to} = answer.sticking;
  const {omega0} = answer.parameters.derived;
  return from.map((tau, i) => [tau / omega0, to[i] / omega0]);
}

/** Where the identified system, run from the first known state, meets its walls. */
function forwardMarks({forward, parameters}) {
  if (!forward) return [];
  const {tau, x} = forward.impacts;
  const omega0 = parameters.derived.omega0;
  return [{x: tau.map((v) => v / omega0), y: mm(x), colour: "soft", shape: "dot", size: 1.4}];
}

/** The record, before anything is known of it; click: where one clicks on the acceleration. */
export function drawRecord(record, click) {
  $("figure-measured-a").hidden = !record.a;
  $("figure-measured-x").hidden = !record.x;
  if (record.a)
    plots.a.draw({
      series: [{label: "x″", colour: "trace"}],
      data: [record.t, record.a],
      span: [record.t[0], record.t.at(-1)],
      label: "acceleration (m/s²)",
      x: seconds,
      click,
    });
  if (record.x)
    plots.x.draw({
      series: [{label: "x", colour: "trace"}],
      data: [record.t, record.x],
      span: [record.t[0], record.t.at(-1)],
      label: "x (mm)",
      x: seconds,
    });
}

/**
 * Columns over the impacts' time, from the record's start to its end, so that all plots lie under
 * each other.
 */
function overRecord(t, columns, [start, end]) {
  const before = !(t[0] <= start);
  const after = !(t[t.length - 1] >= end);
  const around = (column, first, last) => [
    ...(before ? [first] : []),
    ...column,
    ...(after ? [last] : []),
  ];
  return [around(t, start, end), ...columns.map((column) => around(column, null, null))];
}

/** What shows the end of the histories: their starts leave it. */
function rangeOf(histories, others) {
  const values = [0, ...others];
  for (const history of histories)
    for (const k of [1, 2, 3, 4])
      for (const v of history[`lambda${k}`].slice(Math.floor(history.tau.length / 5)))
        if (v != null) values.push(v);
  const low = values.reduce((a, v) => Math.min(a, v), Infinity);
  const high = values.reduce((a, v) => Math.max(a, v), -Infinity);
  const margin = (high - low || 0.1) * 0.12;
  return [low - margin, high + margin];
}

function drawExponents({exponents: {qr, raw_product: raw}, slope, parameters}, span) {
  const omega0 = parameters.derived.omega0;
  const histories = [qr, raw].map((estimator) => estimator?.history).filter((h) => h?.tau.length);
  const told = [slope.lambda1, slope.low, slope.high].filter((v) => v != null);
  const common = {span, omega0, range: rangeOf(histories, told)};
  const known = slope.lambda1 != null;
  const level = known ? [{y: slope.lambda1, colour: "before"}] : [];
  const layers = known ? [{from: slope.low, to: slope.high, colour: "interval"}] : [];
  $("figure-measured-raw").hidden = !raw;
  drawHistory(plots.qr, qr, common, level, layers);
  drawHistory(plots.raw, raw, common);
}

/** An estimator's exponents over the impacts, and as rings where they end. */
function drawHistory(plot, estimator, {span, omega0, range}, level = [], layers = []) {
  const history = estimator?.history;
  const shared = {label: "λ", x: seconds};
  if (!history?.tau.length) {
    plot.draw({...shared, series: [{label: "λ", colour: "c1"}], data: [span, [null, null]]});
    return;
  }
  const {series, columns} = exponentSeries(history);
  const t = history.tau.map((tau) => tau / omega0);
  const {final} = estimator;
  const end = {x: final.map(() => t.at(-1)), y: final, colour: "text", shape: "ring", size: 3.5};
  plot.draw({
    ...shared,
    series,
    data: overRecord(t, columns, span),
    range,
    levels: [{y: 0, colour: "soft"}, ...level],
    layers,
    marks: [end],
  });
}

/** R of each impact; one that is not consistent lies where it fits, or at the edge. */
function drawRestitution({impacts, restitution: {plus, minus}}, span) {
  const good = impacts.R.filter((R, i) => R != null && impacts.status[i] === "ok");
  const low = good.reduce((a, v) => Math.min(a, v), Infinity);
  const high = good.reduce((a, v) => Math.max(a, v), -Infinity);
  const margin = Math.max((high - low) * 0.15, 0.004);
  const of = (side) =>
    impacts.R.map((R, i) => (impacts.side[i] === side && impacts.status[i] === "ok" ? R : null));
  const left = impacts.time_s
    .map((t, i) => ({t, R: impacts.R[i], status: impacts.status[i]}))
    .filter(({R, status}) => isLeftOut(status) && R != null);
  const crosses = {x: left.map(({t}) => t), y: left.map(({R}) => R), colour: "wall"};
  const levels = [
    {y: plus.R, colour: "plus"},
    {y: minus.R, colour: "minus"},
  ];
  plots.R.draw({
    series: [
      {label: "R at +b", colour: "plus", dots: 4.5},
      {label: "R at −b", colour: "minus", dots: 4.5},
    ],
    data: overRecord(impacts.time_s, [of(1), of(-1)], span),
    range: good.length ? [low - margin, high + margin] : [0, 1],
    label: "R",
    x: seconds,
    levels: levels.filter(({y}) => y != null),
    marks: [{...crosses, shape: "cross", size: 5, width: 2}],
  });
}

function drawSteps({impacts, parameters}, span) {
  const half = Math.PI / parameters.Omega;
  const steps = impacts.tau.map((tau, i) => (i ? (tau - impacts.tau[i - 1]) / half : null));
  const most = steps.reduce((a, d) => Math.max(a, d ?? 0), 2);
  const least = steps.reduce((a, d) => (d ? Math.min(a, d) : a), 0.5);
  plots.steps.draw({
    series: [{label: "time since the last impact", colour: "c1", dots: 4}],
    data: overRecord(impacts.time_s, [steps], span),
    log: true,
    range: [least / 1.3, most * 1.3],
    label: "half periods",
    x: seconds,
    levels: [1],
  });
}

function drawSections({impacts}) {
  const xLabel = "x (mm)";
  const points = (velocity, keep) => {
    const x = [];
    const y = [];
    impacts.x.forEach((v, i) => {
      if (keep(i)) {
        x.push(v * 1000);
        y.push(velocity[i] * 1000);
      }
    });
    return {x, y};
  };
  const all = () => true;
  const side = (sign) => (i) => impacts.side[i] === sign;
  const pick = (i) => axis.point(impacts.time_s[i], "pick");
  const after = points(impacts.x_dot_after, all);
  plots.portrait.draw({
    pick: {...after, use: pick},
    groups: [
      {...points(impacts.x_dot_before, all), colour: "before", shape: "ring", size: 3.4},
      {...after, colour: "after", shape: "cross", size: 2.8},
    ],
    xLabel,
    yLabel: "x′ (mm)",
  });
  plots.section.draw({
    pick: {...after, use: pick},
    groups: [
      {...points(impacts.x_dot_after, side(1)), colour: "plus", size: 3.6, alpha: 1},
      {...points(impacts.x_dot_after, side(-1)), colour: "minus", size: 3.6, alpha: 1},
    ],
    xLabel,
    yLabel: "x′ after (mm)",
  });
}

export function draw(record, answer) {
  const span = [record.t[0], record.t.at(-1)];
  drawExponents(answer, span);
  drawRestitution(answer, span);
  drawSteps(answer, span);
  drawSections(answer);
}

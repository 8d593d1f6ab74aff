// Plots of a measurement: the record with its impacts, and the results identified from it.
import {bisectLeft} from "d3-array";
import {$, element} from "../shared/dom.js";
import {exponentMarks, exponentRange} from "../shared/exponents.js";
import {rangeOf} from "../shared/frame.js";
import {bands, beads, dots, layer, levels, line, symbols} from "../shared/marks.js";
import {mm} from "../shared/numbers.js";
import {PlotGroup} from "../shared/plot.js";
import {verdicts} from "../shared/quantities.js";
import {Viewport} from "../shared/viewport.js";
import {isLeftOut, kindOf} from "./impact_list.js";
import {spikeNear} from "./record.js";

const viewport = new Viewport();
let plots;

const firstFigures = {fig15: 15, fig20: 20}; // of the paper, of each preset

/** shown() returns {name, answer} of the record shown. */
export function start(shown) {
  plots = new PlotGroup($("measure-results"), viewport, {
    prefix: "figure-measured-",
    about: (name) => ({
      summary: summaryOf(shown()),
      caption: shown().name,
      name: `measured-${name}`,
    }),
    moments: () => shown().answer?.impacts.time_s ?? [],
  });
  plots.common = {x: {label: "t (s)", factor: 1}};
}

function summaryOf({answer}) {
  if (!answer) return "A record that is not identified yet.";
  const {impacts, verdict, slope} = answer;
  const lambda = slope.lambda1 == null ? "" : `, slope of λ₁τ ${slope.lambda1.toFixed(4)}`;
  return `${impacts.tau.length} impacts, ${verdicts[verdict] ?? "no verdict"}${lambda}`;
}

/** Tags the plots of an experiment with the figures of the paper: `data-after` the first. */
export function nameFigures(preset) {
  const title = "the corresponding figure of the paper, for its own record";
  for (const tag of document.querySelectorAll("#measure-results .tag")) tag.remove();
  if (!firstFigures[preset]) return;
  for (const figure of document.querySelectorAll("#measure-results [data-after]")) {
    const textContent = `as Fig. ${firstFigures[preset] + Number(figure.dataset.after)}`;
    const tag = element("span", {className: "tag", textContent, title});
    figure.querySelector("figcaption").append(tag);
  }
}

export const redraw = () => plots.refresh();

/** Colours of the impact marks, by kind. */
const kinds = {plus: "plus", minus: "minus", "left-out": "wall", removed: "soft", edited: "c4"};

/** Marks for the rows of the list at the heights y(row). */
const marksOf = (rows, y, shape, size) =>
  Object.entries(kinds).map(([kind, colour]) => {
    const mine = rows.filter((row) => kindOf(row) === kind);
    const stroke = colour === kind ? {size, width: 1.3} : {size: size * 1.6, width: 2};
    return symbols({x: mine.map((row) => row.t), y: mine.map(y), colour, shape, ...stroke});
  });

/** A column, interpolated linearly. */
function valueAt({t}, column, moment) {
  const i = Math.min(Math.max(bisectLeft(t, moment), 1), t.length - 1);
  const share = (moment - t[i - 1]) / (t[i] - t[i - 1]);
  return column[i - 1] + (column[i] - column[i - 1]) * share;
}

/** Impacts of the identified system, run forward from the first known state. */
function forwardMarks(answer) {
  if (!answer?.forward) return [];
  const {time_s: t, x} = answer.forward.impacts;
  return [symbols({x: t, y: mm(x), colour: "soft", shape: "dot", size: 1.4})];
}

/**
 * Draws a record with its impacts, the rows of the list, and sticking phases. answer: null before
 * identification; click: handler of clicks on the acceleration.
 */
export function drawRecord(record, rows, answer, click) {
  const {t, a, x} = record;
  const {time_start_s: from, time_end_s: to} = answer?.sticking ?? {time_start_s: []};
  const stuck = bands({intervals: from.map((start, i) => [start, to[i]]), colour: "shade"});
  const step = (t.at(-1) - t[0]) / (t.length - 1);
  const reach = (answer ? answer.signal.pulse_s / 2 : step) + step;
  const spikeOf = (row) => a[spikeNear(record, row.t, reach)];
  const heightOf = (row) => valueAt(record, x, row.t);
  const draw = (name, y, series, label, marksOver, more) => {
    const marks = [line({label: series, colour: "trace", x: t, y})];
    plots.draw(name, y && {marks, under: [stuck, ...marksOver()], y: {label}, ...more});
  };
  viewport.span(t[0], t.at(-1));
  draw("a", a, "x″", "acceleration (m/s²)", () => marksOf(rows, spikeOf, "cross", 4), {click});
  const rings = () => [...forwardMarks(answer), ...marksOf(rows, heightOf, "ring", 3.5)];
  draw("x", x, "x", "x (mm)", rings, {
    points: answer && {x: answer.impacts.time_s, y: mm(answer.impacts.x)},
  });
}

/** Exponents by qr with the slope, and by the raw product; rings mark the final values. */
function exponents({exponents: {qr, raw_product: raw}, slope: {lambda1, low: from, high: to}}) {
  const shown = [lambda1, from, to].filter((v) => v != null);
  const [least, most] = exponentRange([qr?.history, raw?.history]);
  const y = {label: "λ", range: [Math.min(least, ...shown), Math.max(most, ...shown)]};
  const slope = [layer({from, to, colour: "interval"}), levels({y: lambda1, colour: "before"})];
  const zero = levels({y: 0, colour: "soft"});
  return {
    qr: {y, marks: historyOf(qr), under: [...(lambda1 == null ? [] : slope), zero]},
    raw: raw && {y, marks: historyOf(raw), under: [zero]},
  };
}

function historyOf({history, final: y} = {}) {
  if (!history?.tau.length) return [];
  const {time_s: t} = history;
  const ends = symbols({x: y.map(() => t.at(-1)), y, colour: "text", shape: "ring", size: 3.5});
  return [...exponentMarks({history}, t), ends];
}

const signs = {plus: 1, minus: -1}; // of the impacts at each wall

/** R of each impact. Inconsistent values lie at their place or at the edge of the plot. */
function coefficients({impacts, restitution}) {
  const {time_s: x, R, side, status} = impacts;
  const only = (isWanted) => R.map((v, i) => (isWanted(i) ? v : null));
  const used = only((i) => status[i] === "ok").filter((v) => v !== null);
  const atWall = ([colour, sign]) => {
    const y = only((i) => side[i] === sign && status[i] === "ok");
    return beads({label: `R at ${sign > 0 ? "+" : "−"}b`, colour, size: 2.25, x, y});
  };
  const fitted = Object.keys(signs).filter((wall) => restitution[wall].R != null);
  const leftOut = {x, y: only((i) => isLeftOut(status[i])), colour: "wall"};
  return {
    marks: [
      ...fitted.map((colour) => levels({y: restitution[colour].R, colour})),
      ...Object.entries(signs).map(atWall),
      symbols({...leftOut, shape: "cross", size: 5, width: 2}),
    ],
    y: {range: rangeOf([used.flatMap((v) => [v - 0.004, v + 0.004])]) ?? [0, 1], label: "R"},
    points: {x, y: R},
  };
}

function steps({impacts: {tau, time_s: x}, parameters}) {
  const half = Math.PI / parameters.Omega;
  const y = tau.map((v, i) => (v - tau[i - 1]) / half || null); // none before the first
  const label = "time since the previous impact";
  return {
    marks: [levels({y: 1, colour: "soft"}), beads({label, colour: "c1", size: 2, x, y})],
    y: {log: true, range: rangeOf([y, [0.5, 2]], true), label: "half periods"},
  };
}

function sections({impacts}) {
  const {time_s: t, side} = impacts;
  const points = (velocity) => ({x: mm(impacts.x), y: mm(velocity)});
  const [before, after] = ["before", "after"].map((when) => points(impacts[`x_velocity_${when}`]));
  const plane = (label, ...marks) => ({
    marks,
    x: {label: "x (mm)"},
    y: {label},
    points: {...after, t, use: (i) => viewport.point(t[i])},
  });
  const atWall = ([colour, sign]) => {
    const of = (column) => column.filter((_, i) => side[i] === sign);
    return dots({x: of(after.x), y: of(after.y), colour, size: 1.8});
  };
  return {
    portrait: plane(
      "x′ (mm/s)",
      dots({...before, colour: "before", shape: "ring", size: 3.4, alpha: 0.75}),
      dots({...after, colour: "after", shape: "cross", size: 2.8, alpha: 0.75}),
    ),
    section: plane("x′ after (mm/s)", ...Object.entries(signs).map(atWall)),
  };
}

export function draw(answer) {
  const all = {...exponents(answer), R: coefficients(answer), steps: steps(answer)};
  for (const [name, options] of Object.entries({...all, ...sections(answer)}))
    plots.draw(name, options);
}

// Plots of the details: lines over the time axis of the first screen, and sections.
import {mean, min} from "d3-array";
import {exponentRange} from "../shared/exponents.js";
import {rangeOf} from "../shared/frame.js";
import {beads, curve, dots, levels, line} from "../shared/marks.js";
import {digits, mm} from "../shared/numbers.js";
import {exponentLines, halves, picked} from "./plot_options.js";
import {inUnits, largestMagnitude, run} from "./run.js";

const estimators = ["qr", "eigenvalues", "raw_product"];
const matrices = ["J", "M", "T"];

/** An object with of(name) for each name. */
const each = (names, of) => Object.fromEntries(names.map((name) => [name, of(name)]));

const one = levels({y: 1, colour: "soft"});

function acceleration({tau, x_ddot: values}) {
  const {of, unit} = run.units.acceleration;
  const marks = [line({label: "x″", colour: "c4", x: tau, y: values.map(of)})];
  return {marks, y: {label: `x″ (${unit})`}};
}

function impactsPerCycle({tau: x, z: y}) {
  return {
    marks: [levels({y: [1, 2, 3]}), line({label: "z", colour: "c4", width: 1.5, x, y})],
    y: {range: [0, Math.max(3.4, largestMagnitude(y) * 1.08)], label: "impacts per cycle"},
  };
}

function exponentPlots(exponents) {
  const range = exponentRange(estimators.map((name) => exponents[name]?.history));
  return each(estimators, (name) => exponentLines(exponents[name], range));
}

/** Four moduli per impact; those of a pair coincide, so later ones are drawn smaller. */
function matrixPlot(name, eigenvalues) {
  const {tau: x} = eigenvalues;
  const log = name === "T";
  const columns = [0, 1, 2, 3].map((k) => eigenvalues[name].map((moduli) => moduli[k]));
  const least = min([1, ...columns[3]]);
  const modulus = (y, k) =>
    beads({label: `|μ${"₁₂₃₄"[k]}|`, colour: `c${k + 1}`, size: (5.4 - k) / 2, x, y});
  const range = log ? rangeOf([[1], ...columns], true) : [least - 0.08, 1.06];
  return {marks: [one, ...columns.map(modulus)], y: {log, range, label: `|μ| of ${name}`}};
}

function impactPlanes(impacts) {
  const {velocity} = run.units;
  const speeds = (name, when) => inUnits(impacts[`${name}_dot_${when}`], velocity);
  const axis = (symbol) => ({label: `${symbol} (${velocity.unit})`});
  const plane = (of) => ({
    marks: ["before", "after"].map((when) => dots({...of(when), colour: when, alpha: 0.75})),
    points: picked(of("after"), impacts.tau),
  });
  return {
    portrait: {
      ...plane((when) => ({x: mm(impacts.x), y: speeds("x", when)})),
      x: {label: "x (mm)"},
      y: axis("x′"),
    },
    velocities: {
      ...plane((when) => ({x: speeds("x", when), y: speeds("y", when)})),
      x: axis("x′"),
      y: axis("y′"),
    },
  };
}

function stroboscopic({tau, x, x_dot: xDot}) {
  const {velocity} = run.units;
  const points = {x: mm(x), y: inUnits(xDot, velocity)};
  return {
    marks: halves(points, [["c1", () => true]]),
    x: {label: "x (mm)"},
    y: {label: `x′ (${velocity.unit})`},
    empty: "no whole cycle in the window",
    points: picked(points, tau),
  };
}

/** Times between impacts. Chatter lies below the axis. */
function differences({tau: x, time_difference: times}, Omega) {
  const y = times.map((d) => (d === null ? null : (d * Omega) / Math.PI));
  const range = [0.1, Math.max(largestMagnitude(y), 2) * 1.3];
  return {
    marks: [one, beads({label: "time since the previous impact", colour: "c1", size: 1.75, x, y})],
    y: {log: true, range, label: "half periods"},
  };
}

const circle = Array.from({length: 181}, (_, i) => (i * Math.PI) / 90);

function multiplierPlane({modulus, re, im}) {
  const reach = Math.max(1, ...modulus) * 1.12;
  const range = [-reach, reach];
  return {
    marks: [
      dots({x: re, y: im, colour: "before", size: 3.5}),
      curve({x: circle.map(Math.cos), y: circle.map(Math.sin), colour: "soft"}),
    ],
    equal: true,
    x: {label: "Re μ", range},
    y: {label: "Im μ", range},
  };
}

/** A line with the fitted slope through the centre of the fitted logarithms. */
function fitted({tau, distance, slope: {lambda1, tau_start: from, tau_end: to}}) {
  const within = (t) => t >= from && t <= to;
  const part = tau.map((t, i) => [t, Math.log(distance[i])]);
  const kept = part.filter(([t, log]) => within(t) && Number.isFinite(log));
  const [middle, height] = [0, 1].map((k) => mean(kept, (pair) => pair[k]));
  return tau.map((t) => (within(t) ? Math.exp(height + lambda1 * (t - middle)) : null));
}

/** Distance of a slightly perturbed run, compared with the linear theory. */
function divergence(perturbation) {
  const {tau, distance, predicted, slope} = perturbation;
  const beyond = 10 * largestMagnitude(distance); // the prediction grows without bound
  const linear = predicted.distance.map((v) => (v < beyond ? v : null));
  const of = (label, y, style) => line({label, x: tau, y, ...style});
  const marks = [
    of("distance", distance, {colour: "c1", width: 1.4}),
    of("linear theory", linear, {colour: "soft", dash: [5, 4]}),
  ];
  const style = {colour: "before", width: 2.5};
  if (slope?.lambda1) marks.push(of(`slope ${digits(slope.lambda1)}`, fitted(perturbation), style));
  return {marks, y: {log: true, label: "distance (m)"}};
}

/** Options of each plot by name, in the units of the run; none for one that is hidden. */
export function detailsOptions(answer) {
  const {series, exponents, regime, eigenvalues, section, parameters} = answer;
  const orbit = regime.periodic && regime.contacts > 0; // not for periodic free flight
  return {
    acceleration: acceleration(series),
    z: impactsPerCycle(regime.z_moving),
    ...exponentPlots(exponents),
    ...each(matrices, (name) => matrixPlot(name, eigenvalues)),
    ...impactPlanes(answer.impacts),
    stroboscopic: stroboscopic(section.stroboscopic),
    differences: differences(section.impact, parameters.Omega),
    multipliers: orbit && multiplierPlane(regime.multipliers),
    divergence: answer.perturbation && divergence(answer.perturbation),
  };
}

// Plots of the details: lines over the time axis of the first screen, and sections.
import {reveal} from "../shared/dom.js";
import {exponentRange} from "../shared/exponents.js";
import {digits} from "../shared/numbers.js";
import {alongRun, inUnits, largestMagnitude, logRange, mm, positive} from "./columns.js";
import {exponentLines, halves} from "./plot_group.js";
import {pick, run} from "./run.js";

const estimators = ["qr", "eigenvalues", "raw_product"];
const matrices = ["J", "M", "T"];
export const overTime = [
  "acceleration",
  "z",
  "differences",
  "divergence",
  ...matrices,
  ...estimators,
];
export const planes = ["portrait", "velocities", "stroboscopic", "multipliers"];

/** An object with of(name) for each name. */
const each = (names, of) => Object.fromEntries(names.map((name) => [name, of(name)]));

const soft = {y: 1, colour: "soft"};

function acceleration({tau, x_ddot: values}) {
  const {of, unit} = run.units.acceleration;
  return {
    series: [{label: "x″", colour: "c4"}],
    data: [tau, values.map(of)],
    label: `x″ (${unit})`,
  };
}

function impactsPerCycle({tau, z}) {
  return {
    series: [{label: "z", colour: "c4", width: 1.5}],
    data: alongRun(tau, [z]),
    range: [0, Math.max(3.4, largestMagnitude(z) * 1.08)],
    label: "impacts per cycle",
    levels: [1, 2, 3],
  };
}

/** All estimators with the same range. */
function exponentPlots(exponents) {
  const range = exponentRange(estimators.map((name) => exponents[name]?.history));
  return each(estimators, (name) => ({...exponentLines(exponents[name]), range}));
}

/**
 * Four eigenvalue moduli per impact. The moduli of a pair coincide, so later ones are drawn smaller
 * and the earlier ones remain visible.
 */
function matrixPlot(name, eigenvalues) {
  const log = name === "T";
  const ks = [0, 1, 2, 3];
  const columns = ks.map((k) => eigenvalues[name].map((moduli) => moduli[k]));
  const least = columns[3].reduce((a, v) => Math.min(a, v), 1);
  return {
    series: ks.map((k) => ({label: `|μ${"₁₂₃₄"[k]}|`, colour: `c${k + 1}`, dots: 5.4 - k})),
    data: alongRun(eigenvalues.tau, log ? columns.map((one) => one.map(positive)) : columns),
    log,
    range: log ? logRange(columns) : [least - 0.08, 1.06],
    label: `|μ| of ${name}`,
    levels: [soft],
  };
}

/** States at the impacts, before and after. */
function impactPlanes(impacts) {
  const {velocity} = run.units;
  const speeds = (name, when) => inUnits(impacts[`${name}_dot_${when}`], velocity);
  const label = (symbol) => `${symbol} (${velocity.unit})`;
  const plane = (of) => ({
    groups: ["before", "after"].map((when) => ({...of(when), colour: when})),
    pick: {...of("after"), use: (i, clicked) => pick(impacts.tau[i], clicked)},
  });
  return {
    portrait: {
      ...plane((when) => ({x: mm(impacts.x), y: speeds("x", when)})),
      xLabel: "x (mm)",
      yLabel: label("x′"),
    },
    velocities: {
      ...plane((when) => ({x: speeds("x", when), y: speeds("y", when)})),
      xLabel: label("x′"),
      yLabel: label("y′"),
    },
  };
}

function stroboscopic({tau, x, x_dot: xDot}) {
  const {velocity} = run.units;
  const points = {x: mm(x), y: inUnits(xDot, velocity)};
  return {
    groups: halves(points, [["c1", () => true]]),
    xLabel: "x (mm)",
    yLabel: `x′ (${velocity.unit})`,
    empty: "no whole cycle in the window",
    pick: {...points, use: (i, clicked) => pick(tau[i], clicked)},
  };
}

/** Times between impacts. Chatter lies below the axis. */
function differences({tau, time_difference: times}, Omega) {
  const inHalfPeriods = times.map((d) => (d === null ? null : (d * Omega) / Math.PI));
  return {
    series: [{label: "time since the previous impact", colour: "c1", dots: 3.5}],
    data: alongRun(tau, [inHalfPeriods]),
    log: true,
    range: [0.1, Math.max(largestMagnitude(inHalfPeriods), 2) * 1.3],
    label: "half periods",
    levels: [soft],
  };
}

const circle = Array.from({length: 181}, (_, i) => (i * Math.PI) / 90);

function multiplierPlane({modulus, re, im}) {
  const reach = Math.max(1, ...modulus) * 1.12;
  const extent = [-reach, reach];
  return {
    groups: [{x: re, y: im, colour: "before", size: 7, alpha: 1}],
    curves: [{x: circle.map(Math.cos), y: circle.map(Math.sin), colour: "soft"}],
    extent: {x: extent, y: extent},
    equal: true,
    xLabel: "Re μ",
    yLabel: "Im μ",
  };
}

const mean = (values) => values.reduce((a, v) => a + v, 0) / values.length;

/** A line with the fitted slope through the centre of the fitted logarithms. */
function fitted({tau, distance, slope: {lambda1, tau_start: from, tau_end: to}}) {
  const within = (t) => t >= from && t <= to;
  const part = tau.map((t, i) => [t, Math.log(distance[i])]);
  const kept = part.filter(([t, log]) => within(t) && Number.isFinite(log));
  const [middle, height] = [0, 1].map((k) => mean(kept.map((pair) => pair[k])));
  return tau.map((t) => (within(t) ? Math.exp(height + lambda1 * (t - middle)) : null));
}

/** Distance of a slightly perturbed run, compared with the linear theory. */
function divergence(perturbation) {
  const {tau, distance, predicted, slope} = perturbation;
  const beyond = 10 * largestMagnitude(distance); // the prediction grows without bound
  const plot = {
    series: [
      {label: "distance", colour: "c1", width: 1.4},
      {label: "linear theory", colour: "soft", dash: [5, 4]},
    ],
    data: [
      tau,
      distance.map(positive),
      predicted.distance.map((v) => (v < beyond ? positive(v) : null)),
    ],
    log: true,
    label: "distance (m)",
  };
  if (slope) {
    plot.series.push({label: `slope ${digits(slope.lambda1)}`, colour: "before", width: 2.5});
    plot.data.push(fitted(perturbation));
  }
  return plot;
}

/** Options of each plot by name, in the units of the run. */
export function detailsOptions(answer) {
  const {series, exponents, regime, eigenvalues, section, parameters} = answer;
  const orbit = regime.periodic && regime.contacts > 0; // not for periodic free flight
  reveal({"figure-multipliers": orbit});
  return {
    acceleration: acceleration(series),
    z: impactsPerCycle(regime.z_moving),
    ...exponentPlots(exponents),
    ...each(matrices, (name) => matrixPlot(name, eigenvalues)),
    ...impactPlanes(answer.impacts),
    stroboscopic: stroboscopic(section.stroboscopic),
    differences: differences(section.impact, parameters.Omega),
    ...(orbit && {multipliers: multiplierPlane(regime.multipliers)}),
    divergence: divergence(answer.perturbation),
  };
}

// The plots of the details: the rest of what is known of a run, over the same time as the first
// screen's or as sections.
import {$} from "../shared/dom.js";
import {exponentRange, exponentSeries} from "../shared/exponents.js";
import {LinePlot} from "../shared/line_plot.js";
import {digits} from "../shared/numbers.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {logRange, mm, over, overRun, positive} from "./columns.js";

const estimators = ["qr", "eigenvalues", "raw_product"];
const matrices = ["J", "M", "T"];
const overTime = ["acceleration", "z", "differences", "divergence", ...matrices, ...estimators];
const planes = ["portrait", "velocities", "stroboscopic", "multipliers"];

function drawMotion(plots, {series, regime, status}, marks, units) {
  plots.acceleration.draw({
    ...marks,
    series: [{label: "x″", colour: "c4"}],
    data: [series.tau, over(series.x_ddot, units.acceleration)],
    label: `x″ (${units.acceleration.unit})`,
  });
  const {tau, z} = regime.z_moving;
  plots.z.draw({
    ...marks,
    series: [{label: "z", colour: "c4", width: 1.5}],
    data: overRun(tau, [z], status.tau),
    range: [0, Math.max(3.4, z.reduce((a, v) => Math.max(a, v), 0) * 1.08)],
    label: "impacts per cycle",
    levels: [1, 2, 3],
    levelColour: "line",
  });
}

function drawExponents(plots, exponents, end, marks) {
  const range = exponentRange(estimators.map((name) => exponents[name]?.history));
  for (const name of estimators) {
    const {history, status} = exponents[name] ?? {};
    const {series, columns} = exponentSeries(history, status);
    const data = overRun(history?.tau ?? [], history ? columns : columns.map(() => []), end);
    plots[name].draw({...marks, series, data, range, label: "λ", levels: [0], levelColour: "line"});
  }
}

/**
 * Four moduli an impact. Those of a pair coincide: the later ones are smaller, so that the earlier
 * ones show around them.
 */
function drawMatrices(plots, eigenvalues, end, marks) {
  const series = [0, 1, 2, 3].map((k) => ({
    label: `|μ${"₁₂₃₄"[k]}|`,
    colour: `c${k + 1}`,
    dots: 5.4 - k,
  }));
  for (const name of matrices) {
    const log = name === "T";
    const value = log ? positive : (v) => v;
    const columns = [0, 1, 2, 3].map((k) => eigenvalues[name].map((moduli) => value(moduli[k])));
    const least = columns[3].reduce((a, v) => Math.min(a, v), 1);
    plots[name].draw({
      ...marks,
      series,
      data: overRun(eigenvalues.tau, columns, end),
      log,
      range: log ? logRange(columns) : [least - 0.08, 1.06],
      label: `|μ| of ${name}`,
      levels: [1],
    });
  }
}

/** The points of a section, the first half of the run paler: what lasts stands out. */
function halves(x, y, velocity, colour) {
  const middle = x.length / 2;
  const part = (alpha, size, wanted) => {
    const of = (column) => column.filter((_, i) => wanted(i));
    return {colour, alpha, size, x: mm(of(x)), y: over(of(y), velocity)};
  };
  return [part(0.35, 2.4, (i) => i < middle), part(1, 3, (i) => i >= middle)];
}

/** The states at the impacts, before and after them. */
/** The places of impacts in the planes of the details, by plot. */
export const placesOf = (impacts, {velocity}) => ({
  portrait: {x: mm(impacts.x), y: over(impacts.x_dot_after, velocity)},
  velocities: {x: over(impacts.x_dot_after, velocity), y: over(impacts.y_dot_after, velocity)},
});

/** point(tau): the cursor goes there. */
function drawImpacts(plots, impacts, units, point) {
  const {velocity} = units;
  const places = placesOf(impacts, units);
  const pick = (name) => ({...places[name], use: (i) => point(impacts.tau[i])});
  const before = {colour: "before"};
  const after = {colour: "after"};
  const name = (symbol) => `${symbol} (${velocity.unit})`;
  const speeds = (column) => over(column, velocity);
  plots.portrait.draw({
    groups: [
      {...before, x: mm(impacts.x), y: speeds(impacts.x_dot_before)},
      {...after, x: mm(impacts.x), y: speeds(impacts.x_dot_after)},
    ],
    xLabel: "x (mm)",
    yLabel: name("x′"),
    pick: pick("portrait"),
  });
  plots.velocities.draw({
    groups: [
      {...before, x: speeds(impacts.x_dot_before), y: speeds(impacts.y_dot_before)},
      {...after, x: speeds(impacts.x_dot_after), y: speeds(impacts.y_dot_after)},
    ],
    xLabel: name("x′"),
    yLabel: name("y′"),
    pick: pick("velocities"),
  });
}

function drawStroboscopic(plots, {tau, x, x_dot: xDot}, {velocity}, point) {
  plots.stroboscopic.draw({
    groups: halves(x, xDot, velocity, "c1"),
    xLabel: "x (mm)",
    yLabel: `x′ (${velocity.unit})`,
    empty: "no whole cycle in the window",
    pick: {x: mm(x), y: over(xDot, velocity), use: (i) => point(tau[i])},
  });
}

/** The time between impacts. Chatter falls below the axis. */
function drawDifferences(plots, {tau, time_difference: differences}, Omega, end, marks) {
  const inHalfPeriods = differences.map((d) => (d === null ? null : (d * Omega) / Math.PI));
  const most = inHalfPeriods.reduce((a, d) => Math.max(a, d ?? 0), 2);
  plots.differences.draw({
    ...marks,
    series: [{label: "time since the last impact", colour: "c1", dots: 3.5}],
    data: overRun(tau, [inHalfPeriods], end),
    log: true,
    range: [0.1, most * 1.3],
    label: "half periods",
    levels: [1],
  });
}

const circle = Array.from({length: 181}, (_, i) => (i * Math.PI) / 90);

function drawMultipliers(plots, {periodic, contacts, multipliers}) {
  const shown = periodic && contacts > 0; // a free flight is one, too
  $("figure-multipliers").hidden = !shown;
  if (!shown) return;
  const most = Math.max(1, ...multipliers.modulus) * 1.12;
  plots.multipliers.draw({
    groups: [{x: multipliers.re, y: multipliers.im, colour: "before", size: 7, alpha: 1}],
    curves: [{x: circle.map(Math.cos), y: circle.map(Math.sin), colour: "soft"}],
    extent: {x: [-most, most], y: [-most, most]},
    equal: true,
    xLabel: "Re μ",
    yLabel: "Im μ",
  });
}

/** How a run that starts a little off departs, beside what the linear theory says. */
function drawDivergence(plots, {tau, distance, predicted, slope}, marks) {
  const log = distance.map(Math.log);
  const mean = (values) => values.reduce((a, v) => a + v, 0) / values.length;
  const within = tau.map((t) => slope && t >= slope.tau_start && t <= slope.tau_end);
  const part = (values) => values.filter((_, i) => within[i] && Number.isFinite(log[i]));
  const [middle, height] = [mean(part(tau)), mean(part(log))];
  const beyond = 10 * distance.reduce((a, v) => Math.max(a, v), 0); // of no use any more
  const fitted = tau.map((t, i) =>
    within[i] ? Math.exp(height + slope.lambda1 * (t - middle)) : null,
  );
  plots.divergence.draw({
    ...marks,
    series: [
      {label: "distance", colour: "c1", width: 1.4},
      {label: "linear theory", colour: "soft", dash: [5, 4]},
      ...(slope ? [{label: `slope ${digits(slope.lambda1)}`, colour: "before", width: 2.5}] : []),
    ],
    data: [
      tau,
      distance.map(positive),
      predicted.distance.map((v) => (v < beyond ? positive(v) : null)),
      ...(slope ? [fitted] : []),
    ],
    log: true,
    label: "distance (m)",
  });
}

/** The plots, over the time of an axis. */
export function makePlots(axis) {
  const line = (name) => [name, new LinePlot($(`plot-${name}`), axis)];
  const scatter = (name) => [name, new ScatterPlot($(`plot-${name}`))];
  return Object.fromEntries([...overTime.map(line), ...planes.map(scatter)]);
}

/** marks: what lies over all plots over time; units: as of unitsOf; point(tau): moves the cursor. */
export function drawDetails(plots, answer, marks, units, point) {
  const {exponents, regime, status, eigenvalues, section, parameters} = answer;
  const end = status.tau;
  drawMotion(plots, answer, marks, units);
  drawExponents(plots, exponents, end, marks);
  drawMatrices(plots, eigenvalues, end, marks);
  drawImpacts(plots, answer.impacts, units, point);
  drawStroboscopic(plots, section.stroboscopic, units, point);
  drawDifferences(plots, section.impact, parameters.Omega, end, marks);
  drawMultipliers(plots, regime);
  drawDivergence(plots, answer.perturbation, marks);
}

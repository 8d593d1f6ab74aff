// The plots: what each of them shows of an answer, in the units that are chosen.
import {$} from "./dom.js";
import {exponentSeries} from "./exponents.js";
import {LinePlot, ScatterPlot} from "./plots.js";

const mm = (metres) => metres.map((v) => v * 1000);
const estimators = ["qr", "eigenvalues", "raw_product"];
const matrices = ["J", "M", "T"];

const line = (name, options) => [name, new LinePlot($(`plot-${name}`), options)];
const scatter = (name) => [name, new ScatterPlot($(`plot-${name}`))];
const plots = Object.fromEntries([
  ...["x", "acceleration", "largest", "relative", "z", ...matrices, "differences"].map((name) =>
    line(name, {synced: "tau"}),
  ),
  ...estimators.map((name) => line(name)),
  ...["portrait", "velocities", "section", "stroboscopic", "multipliers", "manifold"].map(scatter),
]);

/** A column in other units. */
const over = (column, quantity) => column.map(quantity.of);

export function redraw() {
  for (const plot of Object.values(plots)) plot.redraw();
}

/** Columns over tau without repeats of tau, which uPlot does not take. */
function ascending(tau, columns) {
  const keep = tau.map((t, i) => i === 0 || t > tau[i - 1]);
  return [tau, ...columns].map((column) => column.filter((_, i) => keep[i]));
}

/** The same, from the start of the run to its end: plots over tau lie under each other. */
function overRun(tau, columns, end) {
  const [t, ...rest] = ascending(tau, columns);
  const before = !t.length || t[0] > 0;
  const after = !t.length || t[t.length - 1] < end;
  const around = (column, first, last) => [
    ...(before ? [first] : []),
    ...column,
    ...(after ? [last] : []),
  ];
  return [around(t, 0, end), ...rest.map((column) => around(column, null, null))];
}

/** y - x over tau, with the contacts put between the samples: there it reaches the walls. */
function relativeDisplacement({series, impacts, parameters}) {
  const tau = [];
  const gap = [];
  const push = (t, g) => {
    if (!tau.length || t > tau[tau.length - 1]) {
      tau.push(t);
      gap.push(g);
    }
  };
  let i = 0;
  for (let k = 0; k < series.tau.length; ++k) {
    for (; i < impacts.tau.length && impacts.tau[i] <= series.tau[k]; ++i)
      push(impacts.tau[i], -impacts.side[i] * parameters.b * 1000);
    push(series.tau[k], (series.y[k] - series.x[k]) * 1000);
  }
  return [tau, gap];
}

/**
 * A range for a logarithmic axis that holds all values and 1; a value that is not positive has no
 * place on it.
 */
function logRange(columns) {
  let min = 1;
  let max = 1;
  for (const column of columns)
    for (const v of column)
      if (v > 0) {
        min = Math.min(min, v);
        max = Math.max(max, v);
      }
  return [min / 1.6, max * 1.6];
}

const positive = (v) => (v > 0 ? v : null);

function drawMotion(answer, marks, units) {
  const {series, eigenvalues, regime, parameters, status} = answer;
  const time = (tau) => over(tau, units.time);
  const t = time(series.tau);
  const end = units.time.of(status.tau);
  plots.x.draw({
    ...marks,
    series: [{label: "x", colour: "c1"}],
    data: [t, mm(series.x)],
    label: "x (mm)",
  });
  plots.acceleration.draw({
    ...marks,
    series: [{label: "x″", colour: "c4"}],
    data: [t, over(series.x_ddot, units.acceleration)],
    label: `x″ (${units.acceleration.unit})`,
  });
  const largest = eigenvalues.T.map((moduli) => positive(moduli[0]));
  plots.largest.draw({
    ...marks,
    series: [{label: "|μ₁|", colour: "c3", width: 0.7, dots: 4}],
    data: overRun(time(eigenvalues.tau), [largest], end),
    label: "largest |μ| of T",
    log: true,
    range: logRange([largest]),
    levels: [1],
  });
  const b = parameters.b * 1000;
  const [tau, gap] = relativeDisplacement(answer);
  plots.relative.draw({
    ...marks,
    series: [{label: "y − x", colour: "c2"}],
    data: [time(tau), gap],
    range: [-1.12 * b, 1.12 * b],
    label: "y − x (mm)",
    levels: [-b, b],
    levelColour: "wall",
  });
  const {tau: moments, z} = regime.z_moving;
  plots.z.draw({
    ...marks,
    series: [{label: "z", colour: "c4", width: 1.5}],
    data: overRun(time(moments), [z], end),
    range: [0, Math.max(3.4, z.reduce((a, v) => Math.max(a, v), 0) * 1.08)],
    label: "impacts per cycle",
    levels: [1, 2, 3],
    levelColour: "line",
  });
}

/**
 * The exponents differ by little once they have settled: the range that shows that, and what led
 * there leaves it.
 */
function exponentRange(exponents) {
  const values = [0];
  for (const name of estimators) {
    const history = exponents[name]?.history;
    if (!history) continue;
    const from = Math.floor(history.tau.length / 4);
    for (const key of ["lambda1", "lambda2", "lambda3", "lambda4"])
      for (const v of history[key].slice(from)) if (v !== null) values.push(v);
  }
  values.sort((a, b) => a - b);
  const low = values[Math.floor(values.length * 0.01)];
  const high = values[Math.ceil(values.length * 0.99) - 1];
  const margin = (high - low || 0.1) * 0.15;
  return [low - margin, high + margin];
}

function drawExponents(exponents, end, units) {
  const range = exponentRange(exponents);
  for (const name of estimators) {
    const history = exponents[name]?.history;
    const {series, columns} = exponentSeries(history);
    const data = history?.tau.length
      ? ascending(over(history.tau, units.time), columns)
      : [[0, end], ...columns.map(() => [null, null])];
    plots[name].draw({series, data, range, x: units.x, label: units.lambda, levels: [0]});
  }
}

/**
 * Four moduli an impact. Those of a pair coincide: the later ones are smaller, so that the earlier
 * ones show around them.
 */
function drawMatrices(eigenvalues, end, marks, units) {
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
      data: overRun(over(eigenvalues.tau, units.time), columns, end),
      log,
      range: log ? logRange(columns) : [least - 0.08, 1.06],
      label: `|μ| of ${name}`,
      levels: [1],
    });
  }
}

/**
 * The points of a section, the first half of the run paler: what is left of the start recedes
 * behind what lasts.
 */
function halves(x, y, velocity, colour, keep = () => true) {
  const middle = x.length / 2;
  const part = (alpha, size, wanted) => {
    const of = (column) => column.filter((_, i) => keep(i) && wanted(i));
    return {colour, alpha, size, x: mm(of(x)), y: over(of(y), velocity)};
  };
  return [part(0.35, 2.4, (i) => i < middle), part(1, 3, (i) => i >= middle)];
}

/** The states at the impacts, before and after them. */
function drawImpacts(impacts, {velocity}) {
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
  });
  plots.velocities.draw({
    groups: [
      {...before, x: speeds(impacts.x_dot_before), y: speeds(impacts.y_dot_before)},
      {...after, x: speeds(impacts.x_dot_after), y: speeds(impacts.y_dot_after)},
    ],
    xLabel: name("x′"),
    yLabel: name("y′"),
  });
}

function drawSections({impact, stroboscopic}, {velocity}) {
  const side = (sign, colour) =>
    halves(impact.x, impact.x_dot_after, velocity, colour, (i) => impact.side[i] === sign);
  plots.section.draw({
    groups: [...side(1, "plus"), ...side(-1, "minus")],
    xLabel: "x (mm)",
    yLabel: `x′ after (${velocity.unit})`,
  });
  plots.stroboscopic.draw({
    groups: halves(stroboscopic.x, stroboscopic.x_dot, velocity, "c1"),
    xLabel: "x (mm)",
    yLabel: `x′ (${velocity.unit})`,
    empty: "no whole cycle in the window",
  });
}

/** The time between impacts. Chatter falls below the axis. */
function drawDifferences({tau, time_difference: differences}, Omega, end, marks, {time}) {
  const inHalfPeriods = differences.map((d) => (d === null ? null : (d * Omega) / Math.PI));
  const most = inHalfPeriods.reduce((a, d) => Math.max(a, d ?? 0), 2);
  plots.differences.draw({
    ...marks,
    series: [{label: "time since the last impact", colour: "c1", dots: 3.5}],
    data: overRun(over(tau, time), [inHalfPeriods], end),
    log: true,
    range: [0.1, most * 1.3],
    label: "half periods",
    levels: [1],
  });
}

const circle = Array.from({length: 181}, (_, i) => (i * Math.PI) / 90);

function drawMultipliers({periodic, contacts, multipliers}) {
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

/**
 * The branches reach far beyond most runs: the plot shows what lies near the run's points, the fold
 * and the free amplitude.
 */
function drawManifold(manifold, {velocity}) {
  const {points, fold, free_amplitude: free} = manifold;
  const place = ({V, C}) => ({x: over(V, velocity), y: mm(C)});
  const groups = [{...place(points), colour: "after", size: 2.2, alpha: 0.6}];
  if (fold) groups.push({...place({V: [fold.V], C: [fold.C]}), colour: "wall", size: 8, alpha: 1});
  const branches = [
    {branch: manifold.stable, colour: "c2"},
    {branch: manifold.unstable, colour: "c3", dash: [5, 4]},
    {branch: manifold.asymmetric, colour: "c4", dash: [5, 4]},
  ];
  const curves = branches
    .filter(({branch}) => branch)
    .map(({branch, ...style}) => ({...place(branch), ...style}));
  const most = (values, quantity, ...others) =>
    quantity.of(values.reduce((a, v) => Math.max(a, v), Math.max(...others))) * 1.15 || 1;
  const length = {of: (v) => v * 1000};
  plots.manifold.draw({
    groups,
    curves,
    levels: free ? [{y: free * 1000, colour: "wall", label: "amplitude without absorber"}] : [],
    extent: {
      x: [0, most(points.V, velocity, 1.4 * (fold?.V ?? 0))],
      y: [0, most(points.C, length, 1.6 * (fold?.C ?? 0), free ?? 0)],
    },
    xLabel: `speed of the free mass, V (${velocity.unit})`,
    yLabel: "amplitude of x, C (mm)",
  });
}

/** units: as of unitsOf. */
export function draw(answer, units) {
  const {sticking, exponents, regime, windows = [], request, status} = answer;
  const {stretches} = regime;
  const end = units.time.of(status.tau);
  const pairs = ({tau_start: from, tau_end: to}) =>
    from.map((tau, i) => [units.time.of(tau), units.time.of(to[i])]);
  const window = exponents.window && request.window ? exponents.window : [];
  const borders = [...window, ...windows.flatMap((w) => w.asked)];
  const marks = {
    x: units.x,
    bands: pairs(sticking),
    calm: pairs(stretches).filter((_, i) => stretches.synchronised[i]),
    lines: over(borders, units.time),
  };
  drawMotion(answer, marks, units);
  drawExponents(exponents, end, units);
  drawMatrices(answer.eigenvalues, end, {x: marks.x, lines: marks.lines}, units);
  drawImpacts(answer.impacts, units);
  drawSections(answer.section, units);
  drawDifferences(answer.section.impact, answer.parameters.Omega, end, marks, units);
  drawMultipliers(regime);
  drawManifold(answer.manifold, units);
}

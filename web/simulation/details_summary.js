// Results of a run as text and numbers: cards of the window and the whole run, the table of
// windows, and the energy balance.
//
// units: {si, time, velocity, ..., at(tau)}. A quantity is {of(value), unit}: of() converts a
// dimensionless value, unit is the suffix. at(tau) formats a time.
import {$, cards, reveal, setTexts, tableOf} from "../shared/dom.js";
import {resolved} from "../shared/form.js";
import {count, digits, inMm, minus, percent, shortTo} from "../shared/numbers.js";
import {symbolOf, verdicts} from "../shared/quantities.js";
import {largestMagnitude} from "./run.js";

const exponent = ({final, status}, k) => (status[k] === "minus_infinity" ? "−∞" : digits(final[k]));

function regimeCard({type, description, capture}, units) {
  const name = type === "none" ? "none" : `Type ${type}`;
  if (!capture?.chaotic_before) return ["regime", name, description];
  const when = capture.tau === null ? "after the end of the run" : `at ${units.at(capture.tau)}`;
  return ["regime", name, `${description}; captured ${when} after a chaotic transient`];
}

function rhythm(r) {
  if (!r.contacts) return "";
  if (!r.periodic) return `${percent(r.synchronised.share)} of the contacts synchronised`;
  const chatter = r.chatter_impacts_per_period;
  const sticks = r.sticks_per_period;
  const parts = [
    `period ${count(r.period_cycles, "cycle")}: ${count(r.impacts_per_period, "impact")}`,
    chatter && `${count(chatter, "chatter impact")}`,
    sticks && count(sticks, "stick"),
    r.symmetric ? "symmetric" : "asymmetric",
    !r.stable && "unstable",
  ];
  return parts.filter(Boolean).join(", ");
}

function verdictCard({verdict, verdict_reason: given}, r) {
  // The service writes plain text: typographic characters are substituted.
  const text = given?.replace("lambda1", "λ₁").replace("= -", "= −");
  const reason = text ?? "requires the estimator qr";
  const name = verdicts[verdict] ?? "–";
  if (!r.periodic || !r.contacts || verdict !== "not_decided") return ["verdict", name, reason];
  const orbit = `a ${r.stable ? "stable" : "unstable"} periodic orbit`;
  return ["verdict", name, `${reason}; the motion ends on ${orbit}`];
}

function lambdaCard({qr}, {time}) {
  const error = qr?.standard_error[0];
  const remark = error == null ? "" : `± ${digits(error)}`;
  // Exponents are per unit of tau, even if times are in seconds.
  const unit = time.unit ? " per unit of τ" : "";
  return ["λ₁ (qr)", qr ? digits(qr.final[0]) : "–", remark + unit];
}

/**
 * Number of positive exponents per estimator; the one of qr is meaningful only if the verdict is
 * decided.
 */
function positivesCard({qr, raw_product: product, verdict}) {
  const positives = (estimator) =>
    estimator?.final[0] == null ? "–" : String(estimator.final.filter((v) => v > 0).length);
  const [byQr, raw] = [qr, product].map(positives);
  const decided = {regular: "none in the long run", chaotic: byQr, not_decided: "not decided"};
  const remark = raw === "–" || raw === byQr ? "" : `${raw} by the raw product`;
  return ["positive exponents (qr)", decided[verdict] ?? "–", remark];
}

function residualCard({qr, sum_rule_residual: residual, impacts}) {
  if (residual != null) return ["sum rule residual", minus(residual.toExponential(1))];
  return ["sum rule residual", "–", qr && impacts > 1 ? "undefined after sticking" : ""];
}

const inUnit = (value, {of, unit}) => `${shortTo(3, of(value))} ${unit}`;

/** Cards in SI; the median of an even count is the upper of the middle two. */
function engineeringCards({impacts, series, parameters}, units) {
  const {si, derived} = parameters;
  const {relative_speed: speed, impulse} = impacts;
  const ratio = shortTo(4, si.f / derived.f0);
  const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];
  const highest = shortTo(3, units.velocity.of(largestMagnitude(speed)));
  const blow = inUnit(median(impulse.map(Math.abs)), units.impulse);
  return [
    ["forcing", `${shortTo(3, si.f)} Hz`, `${ratio} of f₀; base ± ${inMm(si.F)}`],
    [
      "impact speed",
      inUnit(median(speed), units.velocity),
      speed.length ? `median; at most ${highest}; impulse ${blow}` : "",
    ],
    [
      "peak acceleration",
      inUnit(largestMagnitude(series.x_ddot), units.acceleration),
      "of m₁ between the impacts",
    ],
  ];
}

const freeAmplitudeCard = (free, {peak}) => [
  "amplitude without absorber",
  inMm(free),
  `with absorber: |x| up to ${inMm(peak)}`,
];

/** Title of the window's cards. */
function windowTitle({window, impacts}, {at}, requested) {
  if (!window) return requested ? "Window without impacts" : "Run without impacts";
  const whole = requested ? "Window" : "Whole run, first to last impact";
  return `${whole}: ${at(window[0])} to ${at(window[1]).replace(/^.*= /, "")}, ${count(impacts, "impact")}`;
}

export function summarise(answer, units) {
  const {exponents, regime, energy, impacts, sticking, parameters} = answer;
  const stickingPhases = sticking.side.length;
  const {amplitude: free} = energy.without_absorber;
  setTexts({"summary-title": windowTitle(exponents, units, parameters.window)});
  cards($("summary"), [
    regimeCard(regime, units),
    ["impacts per cycle, z", digits(regime.z, 3), rhythm(regime)],
    verdictCard(exponents, regime),
    lambdaCard(exponents, units),
    positivesCard(exponents),
    residualCard(exponents),
    ["dissipated by impacts", percent(energy.share_impacts), "of all dissipation"],
    ["rms of x", percent(energy.rms_ratio), "of that without absorber"],
    ...(free == null ? [] : [freeAmplitudeCard(free, energy)]),
  ]);
  cards($("summary-run"), [
    ["impacts", String(impacts.tau.length), "chatter included"],
    ["sticking phases", String(stickingPhases), stickingPhases ? "shaded in the plots" : ""],
    ["damping ζ", digits(parameters.derived.zeta, 5), parameters.damping.replaceAll("_", " ")],
    ...(units.si ? engineeringCards(answer, units) : []),
  ]);
}

export function tabulate(windows = [], {time}) {
  reveal({"figure-windows": windows.length});
  const span = time.unit ? ["from (s)", "to (s)"] : ["τ from", "to"];
  const names = [...span, "impacts", "λ₁", "λ₂", "λ₃", "λ₄", "verdict"];
  const rows = windows.map((w) => {
    const lambda = [0, 1, 2, 3].map((k) => (w.qr ? exponent(w.qr, k) : "–"));
    const error = w.qr?.standard_error[0];
    const requested = w.asked.map((t) => (time.unit ? time.of(t).toFixed(2) : String(t)));
    if (error != null) lambda[0] += ` ± ${digits(error)}`;
    return [...requested, String(w.impacts), ...lambda, verdicts[w.verdict] ?? "–"];
  });
  $("windows").replaceChildren(...tableOf(names, rows));
}

/** Energy supplied, and the decay times of a free decay. */
function energyNote({input, at_start: start, decay}, units) {
  const supply = [
    input && `${inUnit(input, units.energy)} from the base`,
    start && `${inUnit(start, units.energy)} at the start`,
  ];
  const parts = [supply.filter(Boolean).join(", "), ...(decay ? decayTimes(decay, units) : [])];
  return parts.filter(Boolean).join("; ");
}

/** Times at which half and a tenth of the energy are left, with and without the absorber. */
function decayTimes(decay, {at}) {
  const timeOf = (tau, before = "") => (tau == null ? "not in this run" : before + at(tau));
  return Object.entries({tau_half: "half of the energy", tau_tenth: "a tenth"})
    .map(([name, what]) => [what, decay[name], decay.without_absorber[name]])
    .filter(([, ...taus]) => taus.some((tau) => tau != null))
    .map(
      ([what, tau, without]) =>
        `${what} is left ${timeOf(tau, "at ")} (without absorber: ${timeOf(without)})`,
    );
}

/**
 * Shows the energy balance: the energy supplied by the base or present at the start is dissipated by
 * the damper and the impacts, or is left at the end. The fractions are of the sum of these three,
 * which equals the energy supplied. Compares rms and peak of x with those without the absorber.
 */
export function accountEnergy(energy, units) {
  const {damper, impacts, at_end: left, without_absorber: without} = energy;
  const total = damper + impacts + left || 1;
  const parts = Object.entries({damper, impacts, "left at the end": left});
  const row = ([name, value]) => [name, percent(value / total), inUnit(value, units.energy)];
  const compared = Object.entries({rms: "rms", peak: "largest"});
  const both = ([key, name]) => [name, inMm(energy[key]), inMm(without[key])];
  const tables = {
    "energy-parts": tableOf(["energy to", "fraction", "amount"], parts.map(row)),
    "energy-compared": tableOf(["|x|", "with absorber", "without"], compared.map(both)),
  };
  for (const [id, rows] of Object.entries(tables)) $(id).replaceChildren(...rows);
  setTexts({"energy-note": energyNote(energy, units)});
  reveal({"energy-scale": !units.si});
}

// Table of a run's parameters: symbol, value with unit, and origin.
// Derived parameters: unit and what they follow from.
const derived = {
  zeta: ["", "epsilon, lambda, damping"],
  omega0: ["rad/s", "k1, m1"],
  omega_d: ["", "zeta"],
  A: ["m", "G, epsilon, lambda, Omega"],
  phi: ["rad", "epsilon, lambda, Omega"],
  cycle: ["", "Omega"],
  cycle_s: ["s", "f"],
  time_end_s: ["s", "tau_end, omega0"],
  window_s: ["s", "window, omega0"],
};

function precise(value) {
  if (Array.isArray(value)) return value.map(precise).join(" to ");
  if (typeof value === "number") return minus(String(Number(value.toPrecision(6))));
  return String(value).replaceAll("_", " ");
}

export function listParameters(parameters, fieldOf) {
  const {values, origins} = resolved(parameters);
  const all = {...values, ...parameters.derived};
  const known = [...Object.keys(fieldOf), ...Object.keys(derived)].filter(
    (name) => name !== "R" && all[name] != null, // R: each wall has its own row
  );
  const rows = known.map((name) => {
    const [unit, from] = derived[name] ?? [fieldOf[name].unit ?? ""];
    const shown = unit === "dimensionless" ? "" : unit.replace("tau", "τ");
    const origin = origins[name] ?? (from && `follows from ${from}`) ?? "";
    return [name, symbolOf(name), `${precise(all[name])} ${shown}`.trim(), origin];
  });
  $("parameters").replaceChildren(...tableOf(["name", "symbol", "value", "origin"], rows));
}

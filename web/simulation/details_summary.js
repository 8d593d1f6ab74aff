// What a run came to, in words and numbers: cards of the window and of the whole run, the windows'
// table and where the energy went.
import {cards} from "../shared/cards.js";
import {$, element, reveal, write} from "../shared/dom.js";
import {clamp, count, digits, inMm, minus, percent, shortTo} from "../shared/numbers.js";
import {verdicts} from "../shared/quantities.js";
import {tableOf} from "../shared/table.js";
import {most} from "./columns.js";

/** How many exponents of an estimator are positive. */
const positives = (estimator) =>
  estimator?.final[0] == null ? null : estimator.final.filter((v) => v > 0).length;

/** An exponent in a word where it has no value. */
const exponent = ({final, status}, k) => (status[k] === "minus_infinity" ? "−∞" : digits(final[k]));

function regimeCard({type, description, capture}, units) {
  const name = type === "none" ? "none" : `Type ${type}`;
  if (!capture?.chaotic_before) return ["regime", name, description];
  const when = capture.tau === null ? "behind the run's end" : `at ${units.at(capture.tau)}`;
  return ["regime", name, `${description}; captured ${when} after a chaotic transient`];
}

/** How the impacts follow each other, in words. */
function rhythm(r) {
  if (!r.contacts) return "";
  if (!r.periodic) return `${percent(r.synchronised.share)} of the contacts synchronised`;
  const chatter = r.chatter_impacts_per_period;
  const sticks = r.sticks_per_period;
  const parts = [
    `period ${count(r.period_cycles, "cycle")}: ${count(r.impacts_per_period, "impact")}`,
    chatter && `${chatter} of chatter`,
    sticks && count(sticks, "stick"),
    r.symmetric ? "symmetric" : "asymmetric",
    !r.stable && "unstable",
  ];
  return parts.filter(Boolean).join(", ");
}

function verdictCard({verdict, verdict_reason: given}, r) {
  const told = given?.replace("lambda1", "λ₁").replace("= -", "= −");
  const reason = told ?? "needs the estimator qr";
  const name = verdicts[verdict] ?? "–";
  if (!r.periodic || !r.contacts || verdict !== "not_decided") return ["verdict", name, reason];
  const orbit = `a ${r.stable ? "stable" : "unstable"} periodic orbit`;
  return ["verdict", name, `${reason}; the motion ends on ${orbit}`];
}

function lambdaCard({qr}, {time}) {
  const error = qr?.standard_error[0];
  const remark = error == null ? "" : `± ${digits(error)}`;
  const unit = time.unit ? " per unit of τ" : "";
  return ["λ₁ (qr)", qr ? digits(qr.final[0]) : "–", remark + unit];
}

/** How many are positive by each estimator: by qr that says something only where it is decided. */
function positivesCard({qr, raw_product: product, verdict}) {
  const exact = positives(qr);
  const raw = positives(product);
  const differs = `${raw} by the raw product`;
  const remark = raw === null || raw === exact ? "" : differs;
  const open = verdict === "not_decided" ? "not decided" : "–";
  const decided = {regular: "none that lasts", chaotic: String(exact ?? "–")};
  const shown = decided[verdict] ?? open;
  return ["positive exponents (qr)", shown, remark];
}

function residualCard({qr, sum_rule_residual: residual, impacts}) {
  if (residual != null) return ["sum rule residual", minus(residual.toExponential(1))];
  return ["sum rule residual", "–", qr && impacts > 1 ? "not defined after a stick" : ""];
}

const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

/** A value in a unit of the answer. */
const inUnit = (value, {of, unit}) => `${shortTo(3, of(value))} ${unit}`;

function forcingCard({si, derived}) {
  const ratio = shortTo(4, si.f / derived.f0);
  return ["forcing", `${shortTo(3, si.f)} Hz`, `${ratio} of f₀; base ± ${inMm(si.F)}`];
}

function impactSpeedCard({relative_speed: speed, impulse}, {velocity, impulse: blow}) {
  const highest = shortTo(3, velocity.of(most(speed)));
  const remark = `median; at most ${highest}; impulse ${inUnit(median(impulse.map(Math.abs)), blow)}`;
  return ["impact speed", inUnit(median(speed), velocity), speed.length ? remark : ""];
}

/** Where there is one. */
function amplitudeCards({without_absorber: {amplitude: free}, peak}) {
  const remark = `with it |x| comes to ${inMm(peak)}`;
  return free == null ? [] : [["amplitude without absorber", inMm(free), remark]];
}

/** What a laboratory measures. */
const engineeringCards = ({impacts, series, parameters}, units) => [
  forcingCard(parameters),
  impactSpeedCard(impacts, units),
  [
    "peak acceleration",
    inUnit(most(series.x_ddot), units.acceleration),
    "of m₁ between the impacts",
  ],
];

/** What the cards of the window refer to. */
function windowTitle({window, impacts}, {at}, asked) {
  if (!window)
    return asked ? "Of the window, which has no impacts" : "Of the run, which has no impacts";
  const whole = asked ? "Of the window" : "Of the whole run, from its first impact to its last";
  return `${whole}: ${at(window[0])} to ${at(window[1]).replace(/^.*= /, "")}, ${count(impacts, "impact")}`;
}

export function summarise(answer, units) {
  const {exponents, regime, energy, impacts, sticking, parameters} = answer;
  const stuck = sticking.side.length;
  write({"summary-title": windowTitle(exponents, units, parameters.window)});
  cards($("summary"), [
    regimeCard(regime, units),
    ["impacts per cycle, z", digits(regime.z, 3), rhythm(regime)],
    verdictCard(exponents, regime),
    lambdaCard(exponents, units),
    positivesCard(exponents),
    residualCard(exponents),
    ["taken by the impacts", percent(energy.share_impacts), "of the energy that is dissipated"],
    ["rms of x", percent(energy.rms_ratio), "of that without absorber"],
    ...amplitudeCards(energy),
  ]);
  cards($("summary-run"), [
    ["impacts", String(impacts.tau.length), "chatter included"],
    ["stuck phases", String(stuck), stuck ? "shaded in the plots" : ""],
    ["damping ζ", digits(parameters.derived.zeta, 5), parameters.damping.replaceAll("_", " ")],
    ...(units.si ? engineeringCards(answer, units) : []),
  ]);
}

/** The exponents of each window asked for. */
export function tabulate(windows = [], {time}) {
  reveal({"figure-windows": windows.length});
  const span = time.unit ? ["from (s)", "to (s)"] : ["τ from", "to"];
  const names = [...span, "impacts", "λ₁", "λ₂", "λ₃", "λ₄", "verdict"];
  const rows = windows.map((w) => {
    const lambda = [0, 1, 2, 3].map((k) => (w.qr ? exponent(w.qr, k) : "–"));
    const error = w.qr?.standard_error[0];
    const asked = w.asked.map((t) => (time.unit ? time.of(t).toFixed(2) : String(t)));
    if (error != null) lambda[0] += ` ± ${digits(error)}`;
    return [...asked, String(w.impacts), ...lambda, verdicts[w.verdict] ?? "–"];
  });
  $("windows").replaceChildren(...tableOf(names, rows));
}

/** A bar as long as its share of the whole. */
function bar(share, className) {
  const node = element("span", {className});
  node.style.width = `${clamp(share, 0, 1) * 100}%`;
  return node;
}

/** One amount beside another, as bars of one scale. */
function compare(term, withAbsorber, without) {
  const whole = Math.max(withAbsorber, without) || 1;
  const line = (name, value, className) => [
    element("span", {className: "name", textContent: name}),
    element("span", {className: "track"}, bar(value / whole, className)),
    element("span", {className: "amount", textContent: inMm(value)}),
  ];
  return element(
    "div",
    {className: "compare"},
    element("b", {textContent: term}),
    ...line("with absorber", withAbsorber, "with"),
    ...line("without", without, "without"),
  );
}

/** Where the energy came from, and how a free decay went. */
function energyNote({input, at_start: start, decay}, units) {
  const supply = [
    input && `${inUnit(input, units.energy)} from the base`,
    start && `${inUnit(start, units.energy)} there at the start`,
  ];
  const parts = [supply.filter(Boolean).join(", "), ...(decay ? decayTimes(decay, units) : [])];
  return parts.filter(Boolean).join("; ");
}

/** When a half and a tenth of a free decay's energy are left, with the absorber and without it. */
function decayTimes(decay, {at}) {
  const moment = (tau, before = "") => (tau == null ? "not in this run" : before + at(tau));
  const line = ([what, name]) => {
    const withIt = decay[name];
    const without = decay.without_absorber[name];
    const known = withIt != null || without != null;
    return (
      known && `${what} is left ${moment(withIt, "at ")} (without absorber: ${moment(without)})`
    );
  };
  return Object.entries({half: "tau_half", "a tenth": "tau_tenth"}).map(line);
}

/**
 * What was supplied (by the base, or there at the start) went into the damper, the impacts, or is
 * still there.
 */
export function accountEnergy(energy, units) {
  const {damper, impacts, at_end: left, without_absorber: without} = energy;
  const supplied = damper + impacts + left || 1;
  const parts = [
    ["damper", "damper", damper],
    ["impacts", "impacts", impacts],
    ["left", "left at the end", left],
  ];
  const bars = parts.map(([className, , value]) => bar(value / supplied, className));
  const keys = parts.map(([className, name, value]) =>
    element(
      "li",
      {},
      element("span", {className: `key ${className}`, textContent: name}),
      element("b", {textContent: percent(value / supplied)}),
      element("small", {textContent: inUnit(value, units.energy)}),
    ),
  );
  reveal({"energy-scale": !units.si});
  $("energy").replaceChildren(
    element("div", {className: "stack"}, ...bars),
    element("ul", {className: "parts"}, ...keys),
    element("p", {className: "note", textContent: energyNote(energy, units)}),
    compare("rms of x", energy.rms, without.rms),
    compare("peak of |x|", energy.peak, without.peak),
  );
}

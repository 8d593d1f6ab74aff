// What a run came to, in words and numbers: cards of the window and of the whole run, the windows'
// table and where the energy went.
import {cards} from "../shared/cards.js";
import {$, element} from "../shared/dom.js";
import {count, digits, minus, percent} from "../shared/numbers.js";
import {verdicts} from "../shared/quantities.js";

const positives = (estimator) =>
  !estimator || estimator.final[0] == null ? null : estimator.final.filter((v) => v > 0).length;

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
  return [
    `period ${count(r.period_cycles, "cycle")}: ${count(r.impacts_per_period, "impact")}`,
    ...(chatter ? [`${chatter} of chatter`] : []),
    ...(sticks ? [count(sticks, "stick")] : []),
    r.symmetric ? "symmetric" : "asymmetric",
    ...(r.stable ? [] : ["unstable"]),
  ].join(", ");
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
  const differs = `rounding makes raw_product show ${raw}`;
  const remark = raw === null || raw === exact ? "" : differs;
  const shown = verdict === "regular" ? "none by more than its error" : String(exact ?? "–");
  return ["positive exponents (qr)", shown, remark];
}

function residualCard({qr, sum_rule_residual: residual, impacts}) {
  if (residual != null) return ["sum rule residual", minus(residual.toExponential(1)), ""];
  return ["sum rule residual", "–", qr && impacts > 1 ? "not defined after a stick" : ""];
}

const millimetres = (metres, n = 1) => `${digits(metres * 1000, n)} mm`;
const most = (values) => values.reduce((a, v) => Math.max(a, Math.abs(v)), 0);
const median = (values) =>
  values.length ? [...values].sort((a, b) => a - b)[values.length >> 1] : null;
const rounded = (value) => (value == null ? "–" : minus(Number(value.toPrecision(3)).toString()));

function forcingCard({si, derived}) {
  const ratio = Number((si.f / derived.f0).toPrecision(4));
  const amplitude = Number((si.F * 1000).toPrecision(3));
  return ["forcing", `${rounded(si.f)} Hz`, `${ratio} of f₀; base ± ${amplitude} mm`];
}

function impactSpeedCard({relative_speed: speed, impulse}, units) {
  const {unit} = units.velocity;
  if (!speed.length) return ["impact speed", `– ${unit}`, ""];
  const hit = (of) => rounded(units.velocity.of(of(speed)));
  const blow = rounded(units.impulse.of(median(impulse.map(Math.abs))));
  const remark = `median; at most ${hit(most)}; impulse ${blow} ${units.impulse.unit}`;
  return ["impact speed", `${hit(median)} ${unit}`, remark];
}

function amplitudeCard({without_absorber: {amplitude: free}, peak}) {
  const remark = `with it |x| comes to ${millimetres(peak)}`;
  return ["amplitude without absorber", free == null ? "–" : millimetres(free), remark];
}

/** What a laboratory measures. */
function engineeringCards({impacts, series, parameters}, units) {
  const {of, unit} = units.acceleration;
  const acceleration = `${rounded(of(most(series.x_ddot)))} ${unit}`;
  return [
    forcingCard(parameters),
    impactSpeedCard(impacts, units),
    ["peak acceleration", acceleration, "of m₁ between the impacts"],
  ];
}

function rmsCard({rms_ratio: ratio, without_absorber: {amplitude}}, units) {
  const told = units.si || amplitude == null; // on a card of its own, or not there
  const remark = told ? "" : `, whose amplitude is ${millimetres(amplitude)}`;
  return ["rms of x", percent(ratio), `of that without absorber${remark}`];
}

/** What the cards of the window refer to. */
function windowTitle({window, impacts}, {at}, asked) {
  if (!window) return "Of the run, which has no impacts";
  const whole = asked ? "Of the window" : "Of the whole run, from its first impact to its last";
  return `${whole}: ${at(window[0])} to ${at(window[1]).replace(/^.*= /, "")}, ${count(impacts, "impact")}`;
}

export function summarise(answer, units) {
  const {exponents, regime, energy, impacts, sticking, parameters} = answer;
  const stuck = sticking.side.length;
  $("summary-title").textContent = windowTitle(exponents, units, parameters.window);
  cards($("summary"), [
    regimeCard(regime, units),
    ["impacts per cycle, z", digits(regime.z, 3), rhythm(regime)],
    verdictCard(exponents, regime),
    lambdaCard(exponents, units),
    positivesCard(exponents),
    residualCard(exponents),
    ["taken by the impacts", percent(energy.share_impacts), "of the energy that is dissipated"],
    rmsCard(energy, units),
    ...(units.si ? [amplitudeCard(energy)] : []),
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
  $("figure-windows").hidden = !windows.length;
  const row = (tag, cells) =>
    element("tr", {}, ...cells.map((textContent) => element(tag, {textContent})));
  const head = row("th", [
    time.unit ? "from (s)" : "τ from",
    time.unit ? "to (s)" : "to",
    "impacts",
    "λ₁",
    "λ₂",
    "λ₃",
    "λ₄",
    "verdict",
  ]);
  const rows = windows.map((w) => {
    const lambda = [0, 1, 2, 3].map((k) => (w.qr ? exponent(w.qr, k) : "–"));
    const error = w.qr?.standard_error[0];
    const asked = w.asked.map((t) => (time.unit ? time.of(t).toFixed(2) : String(t)));
    return row("td", [
      ...asked,
      String(w.impacts),
      error == null ? lambda[0] : `${lambda[0]} ± ${digits(error)}`,
      ...lambda.slice(1),
      verdicts[w.verdict] ?? "–",
    ]);
  });
  $("windows").replaceChildren(element("thead", {}, head), element("tbody", {}, ...rows));
}

/** A bar as long as its share of the whole. */
function bar(share, className) {
  const node = element("span", {className});
  node.style.width = `${Math.min(Math.max(share, 0), 1) * 100}%`;
  return node;
}

/** One amount beside another, as bars of one scale. */
function compare(term, withAbsorber, without) {
  const whole = Math.max(withAbsorber, without) || 1;
  const line = (name, value, className) => [
    element("span", {className: "name", textContent: name}),
    element("span", {className: "track"}, bar(value / whole, className)),
    element("span", {className: "amount", textContent: `${digits(value * 1000, 2)} mm`}),
  ];
  return element(
    "div",
    {className: "compare"},
    element("b", {textContent: term}),
    ...line("with absorber", withAbsorber, "with"),
    ...line("without", without, "without"),
  );
}

function amount(value, {of, unit}) {
  const small = value !== 0 && Math.abs(of(value)) < 1e-3;
  return `${small ? digits(of(value)) : rounded(of(value))} ${unit}`;
}

/** Where the energy came from, and how a free decay went. */
function energyNote({input, at_start: start, decay}, units) {
  const supply = [
    ...(input ? [`${amount(input, units.energy)} from the base`] : []),
    ...(start ? [`${amount(start, units.energy)} there at the start`] : []),
  ].join(", ");
  return [...(supply ? [supply] : []), ...(decay ? decayTimes(decay, units) : [])].join("; ");
}

/** When a half and a tenth of a free decay's energy are left, with the absorber and without it. */
function decayTimes(decay, {at}) {
  const moment = (tau) => (tau == null ? "not in this run" : at(tau));
  const line = (what, name) => {
    const withIt = decay[name];
    const without = decay.without_absorber[name];
    if (withIt == null && without == null) return [];
    const left = `${withIt == null ? "" : "at "}${moment(withIt)}`;
    return [`${what} is left ${left} (without absorber: ${moment(without)})`];
  };
  return [...line("half", "tau_half"), ...line("a tenth", "tau_tenth")];
}

/**
 * What was supplied (by the base, or there at the start) went into the damper, the impacts, or is
 * still there.
 */
export function accountEnergy(energy, units) {
  const {damper, impacts, at_end: left, without_absorber: without} = energy;
  const supplied = damper + impacts + left || 1;
  const parts = [
    {className: "damper", name: "damper", value: damper},
    {className: "impacts", name: "impacts", value: impacts},
    {className: "left", name: "left at the end", value: left},
  ];
  const bars = parts.map(({className, value}) => bar(value / supplied, className));
  const keys = parts.map(({className, name, value}) =>
    element(
      "li",
      {},
      element("span", {className: `key ${className}`, textContent: name}),
      element("b", {textContent: percent(value / supplied)}),
      element("small", {textContent: amount(value, units.energy)}),
    ),
  );
  $("energy-scale").hidden = units.si;
  $("energy").replaceChildren(
    element("div", {className: "stack"}, ...bars),
    element("ul", {className: "parts"}, ...keys),
    element("p", {className: "note", textContent: energyNote(energy, units)}),
    compare("rms of x", energy.rms, without.rms),
    compare("peak of |x|", energy.peak, without.peak),
  );
}

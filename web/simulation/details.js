// The details of a run: cards, tables and plots, which need a larger answer while they are open.
import {median} from "d3-array";
import {$, cards, countUp, reveal, sayIn, setTexts, tableOf} from "../shared/dom.js";
import {resolved, rounded, textOf} from "../shared/form.js";
import {count, digits, inMm, joined, minus, percent, shortTo} from "../shared/numbers.js";
import {symbolOf, verdicts} from "../shared/quantities.js";
import {detailsOptions} from "./details_plots.js";
import {commonOptions} from "./plot_options.js";
import {largestMagnitude, run} from "./run.js";
import {plotsIn} from "./words.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime"];
const parts = {include: [...include, "manifold"]};
const perturbation = {x_dot: 1e-9}; // possible at a wall; needs a motion in closed form

const details = $("details");
const say = sayIn("details-message");
let plots;
let fieldOf;

/** The parts of a run that the details need while they are open; null otherwise. */
export const wanted = () =>
  details.open ? {...(!run.answer.series && {perturbation}), ...parts} : null;

export function busy(is) {
  say(is && details.open ? "computing …" : "");
  details.classList.toggle("stale", details.open && !run.deferred?.section);
}

/** Shows the deferred answer of the run if it has what the open details need. */
export function show() {
  const {deferred: answer, units} = run;
  if (!details.open || !answer?.section) return;
  plots ??= plotsIn(details);
  summarise(answer, units);
  listParameters(answer.parameters, fieldOf);
  tabulate(answer.windows, units);
  accountEnergy(answer.energy, units);
  plots.common = commonOptions(answer);
  for (const [name, options] of Object.entries(detailsOptions(answer))) plots.draw(name, options);
  countUp(details);
  if (!$("model-sketch").hasChildNodes()) showModel().catch(() => {}); // optional
}

export const redraw = () => plots?.refresh();

/** table: fields of /v1/parameters by name; request(): requests what is wanted. */
export function start(table, request) {
  fieldOf = table;
  details.ontoggle = () => {
    if (!details.open || !run) return;
    if (run.deferred?.section) show();
    else request();
  };
}

/** Shows the drawing of the system in the page's colours. */
async function showModel() {
  const sketch = $("model-sketch");
  sketch.innerHTML = await (await fetch(sketch.dataset.src)).text();
}

const withErrorOf = ({standard_error: [error]}) => (error == null ? "" : `± ${digits(error)}`);

const inUnit = (value, {of, unit}) => `${shortTo(3, of(value))} ${unit}`;

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
  return joined([
    `period ${count(r.period_cycles, "cycle")}: ${count(r.impacts_per_period, "impact")}`,
    chatter && count(chatter, "chatter impact"),
    r.sticks_per_period && count(r.sticks_per_period, "stick"),
    r.symmetric ? "symmetric" : "asymmetric",
    !r.stable && "unstable",
  ]);
}

function verdictCard({verdict, verdict_reason: given}, {periodic, contacts, stable}) {
  // The service writes plain text: typographic characters are substituted.
  const reason = given?.replace("lambda1", "λ₁").replace("= -", "= −");
  const orbit =
    periodic && contacts && verdict === "not_decided"
      ? `the motion ends on a ${stable ? "stable" : "unstable"} periodic orbit`
      : "";
  const why = joined([reason ?? "requires the estimator qr", orbit], "; ");
  return ["verdict", verdicts[verdict] ?? "–", why];
}

/** Positive exponents per estimator; those of qr are meaningful once the verdict is decided. */
function positivesCard({qr, raw_product: product, verdict}) {
  const [byQr, raw] = [qr, product].map((estimator) =>
    estimator?.final[0] == null ? "–" : String(estimator.final.filter((v) => v > 0).length),
  );
  const decided = {regular: "none in the long run", chaotic: byQr, not_decided: "not decided"};
  const remark = raw === "–" || raw === byQr ? "" : `${raw} by the raw product`;
  return ["positive exponents (qr)", decided[verdict] ?? "–", remark];
}

/** Cards in SI. */
function engineeringCards({impacts, series, parameters}, {velocity, impulse, acceleration}) {
  const {si, derived} = parameters;
  const {relative_speed: speed} = impacts;
  const highest = shortTo(3, velocity.of(largestMagnitude(speed)));
  const blow = inUnit(median(impacts.impulse, Math.abs), impulse);
  const remark = speed.length ? `median; at most ${highest}; impulse ${blow}` : "";
  const peak = inUnit(largestMagnitude(series.x_ddot), acceleration);
  const base = `${shortTo(4, si.f / derived.f0)} of f₀; base ± ${inMm(si.F)}`;
  const load = parameters.forcing ? ["load", ""] : [`${shortTo(3, si.f)} Hz`, base];
  return [
    ["forcing", ...load],
    ["impact speed", inUnit(median(speed), velocity), remark],
    ["peak acceleration", peak, "of m₁ between the impacts"],
  ];
}

function windowTitle({window, impacts}, {at}, requested) {
  if (!window) return requested ? "Window without impacts" : "Run without impacts";
  const whole = requested ? "Window" : "Whole run, first to last impact";
  return `${whole}: ${at(window[0])} to ${at(window[1]).replace(/^.*= /, "")}, ${count(impacts, "impact")}`;
}

function summarise(answer, units) {
  const {exponents, regime, energy, impacts, sticking, parameters} = answer;
  const {qr, sum_rule_residual: residual} = exponents;
  const noResidual = residual == null && qr && exponents.impacts > 1 && "unknown: rounding";
  const {amplitude: free} = energy.without_absorber;
  // Exponents are per unit of tau, even if times are in seconds.
  const perTime = units.time.unit ? " per unit of τ" : "";
  setTexts({"summary-title": windowTitle(exponents, units, parameters.window)});
  const peak = `with absorber: |x| up to ${inMm(energy.peak)}`;
  cards($("summary"), [
    regimeCard(regime, units),
    ["impacts per cycle, z", digits(regime.z, 3), rhythm(regime)],
    verdictCard(exponents, regime),
    ["λ₁ (qr)", digits(qr?.final[0]), (qr ? withErrorOf(qr) : "") + perTime],
    positivesCard(exponents),
    ["sum rule residual", residual == null ? "–" : minus(residual.toExponential(1)), noResidual],
    ["dissipated by impacts", percent(energy.share_impacts), "of all dissipation"],
    ["rms of x", percent(energy.rms_ratio), "of that without absorber"],
    ...(free == null ? [] : [["amplitude without absorber", inMm(free), peak]]),
  ]);
  const stuck = sticking.side.length;
  cards($("summary-run"), [
    ["impacts", String(impacts.tau.length), "chatter included"],
    ["sticking phases", String(stuck), stuck ? "shaded in the plots" : ""],
    ["damping ζ", digits(parameters.derived.zeta, 5), parameters.damping.replaceAll("_", " ")],
    ...(parameters.si ? engineeringCards(answer, units) : []),
  ]);
}

const exponent = ({final, status}, k) => (status[k] === "minus_infinity" ? "−∞" : digits(final[k]));

function tabulate(windows = [], {time}) {
  reveal({"figure-windows": windows.length});
  const span = time.unit ? ["from (s)", "to (s)"] : ["τ from", "to"];
  const names = [...span, "impacts", "λ₁", "λ₂", "λ₃", "λ₄", "verdict"];
  const rows = windows.map(({qr, asked, impacts, verdict}) => {
    const [first, ...others] = [0, 1, 2, 3].map((k) => (qr ? exponent(qr, k) : "–"));
    const lambda = [joined([first, qr && withErrorOf(qr)], " "), ...others];
    const requested = asked.map((t) => (time.unit ? time.of(t).toFixed(2) : String(t)));
    return [...requested, String(impacts), ...lambda, verdicts[verdict] ?? "–"];
  });
  $("windows").replaceChildren(...tableOf(names, rows));
}

/** When a fraction of the energy is left, with and without the absorber. */
function decayTime(what, tau, without, {at}) {
  if ((tau ?? without) == null) return "";
  const timeOf = (when, before = "") => (when == null ? "not in this run" : before + at(when));
  return `${what} is left ${timeOf(tau, "at ")} (without absorber: ${timeOf(without)})`;
}

/** Shows where the supplied energy went, and rms and peak of x with and without the absorber. */
function accountEnergy(energy, units) {
  const {input, damper, impacts, friction = 0, at_start: start, at_end: rest, decay} = energy;
  const total = damper + impacts + friction + rest || 1;
  const parts = {damper, impacts, ...(friction && {friction}), "left at the end": rest};
  const amount = ([name, v]) => [name, percent(v / total), inUnit(v, units.energy)];
  const rows = Object.entries(parts).map(amount);
  const compare = (name, key) => [name, inMm(energy[key]), inMm(energy.without_absorber[key])];
  const compared = [compare("rms", "rms"), compare("largest", "peak")];
  $("energy-parts").replaceChildren(...tableOf(["energy to", "fraction", "amount"], rows));
  $("energy-compared").replaceChildren(...tableOf(["|x|", "with absorber", "without"], compared));
  const supply = joined([
    input && `${inUnit(input, units.energy)} from the forcing`,
    start && `${inUnit(start, units.energy)} at the start`,
  ]);
  const left = (name, what) =>
    decay && decayTime(what, decay[name], decay.without_absorber[name], units);
  const times = [left("tau_half", "half of the energy"), left("tau_tenth", "a tenth")];
  setTexts({"energy-note": joined([supply, ...times], "; ")});
  reveal({"energy-scale": !run.answer.parameters.si});
}

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

function listParameters(parameters, fieldOf) {
  const {values, origins} = resolved(parameters);
  const all = {...values, ...parameters.derived};
  const known = [...Object.keys(fieldOf), ...Object.keys(derived)].filter(
    (name) => name !== "R" && all[name] != null, // R: each wall has its own row
  );
  const rows = known.map((name) => {
    const [unit, from] = derived[name] ?? [fieldOf[name].unit ?? ""];
    const shown = unit === "dimensionless" ? "" : unit.replace("tau", "τ");
    const origin = origins[name] ?? (from && `follows from ${from}`) ?? "";
    const value = minus(textOf(rounded(all[name])).replaceAll("_", " "));
    return [name, symbolOf(name), `${value} ${shown}`.trim(), origin];
  });
  $("parameters").replaceChildren(...tableOf(["name", "symbol", "value", "origin"], rows));
}

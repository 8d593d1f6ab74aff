// The results of a measurement as cards, and the table of fitted parameters.
import {$, cards, listWarnings} from "../shared/dom.js";
import {count, digits, joined, minus, shortTo, withError} from "../shared/numbers.js";
import {verdicts} from "../shared/quantities.js";
import {isLeftOut} from "./impact_list.js";

function exponentCards({parameters, exponents: {qr}, slope, forward, ...answer}) {
  const error = qr?.standard_error[0];
  const {lambda1, low, high} = slope;
  const zeta = `damping ζ = ${digits(parameters.derived.zeta)}`;
  const reason = answer.verdict_reason.replace("damping zeta", zeta);
  const atEnd = error == null ? "" : `± ${digits(error)}, at the last impact`;
  const interval = low == null ? "" : `90 %: ${digits(low)} to ${digits(high)}`;
  const source = forward ? "simulated from the first known state" : "no state is known";
  return [
    ["verdict", verdicts[answer.verdict] ?? "–", reason],
    ["λ₁ (qr)", digits(qr?.final[0]), atEnd],
    ["slope of λ₁ τ", digits(lambda1), interval],
    ["λ₁ of the identified system", digits(forward?.lambda[0]), source],
  ];
}

function impactsCard({impacts: {status, tau}, sticking}) {
  const of = (text) => status.filter((v) => v === text).length;
  const unknown = of("R is not known");
  const hidden = of("hidden");
  const stuck = sticking.side.length;
  const notes = [
    `${status.filter(isLeftOut).length} left out`,
    hidden && `${hidden} hidden`,
    stuck && `${count(stuck, "sticking phase")}, shaded`,
    unknown && `R of ${unknown} not known, at the ends`,
  ];
  return ["impacts", tau.length, joined(notes, "; ")];
}

const restitutionCard = (wall, {R, standard_error: error, impacts}) => [
  `R at ${wall}`,
  withError(R, error, 4),
  count(impacts, "impact"),
];

/** The fitted clearance, compared with the given one. */
function clearanceCard({b, standard_error: error}, parameters) {
  const off = (b / parameters.b - 1) * 100;
  const agreement = Math.abs(off) < 0.05 ? "agrees" : `off by ${digits(off, 1)} %`;
  const given = `given ${shortTo(5, parameters.b * 1000)} mm${b == null ? "" : `, ${agreement}`}`;
  const isUsed = parameters.origin.b === "fitted to the record";
  const fitted = b == null ? "–" : `${withError(b * 1000, error * 1000, 2)} mm`;
  return ["b fitted", fitted, isUsed ? "used in place of the given value" : given];
}

function signalCards(signal, milliseconds) {
  const {noise_displacement: x, noise_acceleration: a, pulse_s: pulse} = signal;
  const {samples, sampling_rate: rate} = signal;
  const noise = a == null ? "" : `${shortTo(3, a)} m/s²`;
  const width = pulse ? `${shortTo(2, pulse * rate)} samples long` : "too few are visible";
  const duration = `${count(samples, "sample")}, ${(samples / rate).toFixed(1)} s`;
  const answered = `answered in ${milliseconds.toFixed(0)} ms`;
  return [
    ["forcing G", `${shortTo(4, signal.G * 1000)} mm`, "fitted"],
    ["noise", x == null ? "–" : `${shortTo(3, x * 1e6)} µm`, noise],
    ["pulse of an impact", pulse ? `${shortTo(3, pulse * 1000)} ms` : "–", width],
    ["sampling", `${shortTo(5, rate)} Hz`, `${duration}; ${answered}`],
  ];
}

export function summariseMeasurement(answer, milliseconds) {
  const {parameters, restitution, b_fitted: fitted, signal, warnings} = answer;
  cards($("measure-summary"), [
    ...exponentCards(answer),
    impactsCard(answer),
    restitutionCard("+b", restitution.plus),
    restitutionCard("−b", restitution.minus),
    clearanceCard(fitted, parameters),
    ...signalCards(signal, milliseconds),
  ]);
  listWarnings($("measure-warnings"), warnings);
  showFit(answer);
}

/** Fills in the table of fitted values; each cell states its key in `fitted`, unit and factor. */
function showFit({fitted, signal: {forcing}}) {
  for (const cell of $("measure-fitted").querySelectorAll("[data-value]")) {
    const {value: key, unit = "", factor = 1} = cell.dataset;
    const {value, standard_error: error, fixed} = fitted[key];
    const given = fixed && value !== null; // null: withheld
    const shown = given
      ? minus(String(Number((value * factor).toPrecision(6))))
      : withError(value && value * factor, error * factor, 4);
    cell.textContent = `${shown} ${unit}`.trim() + (given ? ", as given" : "");
  }
  $("measure-channel").textContent = forcing
    ? `The forcing channel gives f = ${forcing.f.toPrecision(7)} Hz and ` +
      `F = ${(forcing.F * 1000).toPrecision(4)} mm; in the motion it appears ` +
      `${minus(forcing.phase.toFixed(3))} rad later.`
    : "";
}

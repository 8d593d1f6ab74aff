// What a measurement came to, in words and numbers.

import {cards, listWarnings} from "../shared/cards.js";
import {$} from "../shared/dom.js";
import {count, digits, withError} from "../shared/numbers.js";
import {verdicts} from "../shared/quantities.js";
import {isLeftOut} from "./impact_list.js";

export const about = (value, n) => (value == null ? "–" : String(Number(value.toPrecision(n))));

const wall = (name, {R, standard_error: error, impacts}) => [
  `R at ${name}`,
  withError(R, error, 4),
  count(impacts, "impact"),
];

function exponentCards({
  parameters,
  exponents: {qr},
  slope,
  verdict,
  verdict_reason: reason,
  forward,
}) {
  const error = qr?.standard_error[0];
  const damping = `damping ζ = ${digits(parameters.derived.zeta)}`;
  return [
    ["verdict", verdicts[verdict] ?? "–", reason.replace("damping zeta", damping)],
    [
      "λ₁ (qr)",
      digits(qr?.final[0]),
      error == null ? "" : `± ${digits(error)}, at the last impact`,
    ],
    [
      "slope of λ₁ τ",
      digits(slope.lambda1),
      slope.low == null ? "" : `90 %: ${digits(slope.low)} to ${digits(slope.high)}`,
    ],
    [
      "λ₁ of the identified system",
      digits(forward?.lambda[0]),
      forward ? "run forward from the first known state" : "no state is known",
    ],
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
    stuck && `${count(stuck, "stuck phase")}, shaded`,
    unknown && `R of ${unknown} not known, at the ends`,
  ];
  return ["impacts", tau.length, notes.filter(Boolean).join("; ")];
}

/** The half clearance that the impacts fit, beside the given one, in mm. */
function clearanceCard({b, standard_error: error}, parameters) {
  const card = (remark) => [
    "b fitted",
    b == null ? "–" : `${withError(b * 1000, error * 1000, 2)} mm`,
    remark,
  ];
  if (parameters.origin.b === "fitted to the record") return card("taken, not the given one");
  const given = `given ${about(parameters.b * 1000, 5)} mm`;
  if (b == null) return card(given);
  const off = (b / parameters.b - 1) * 100;
  return card(`${given}, ${Math.abs(off) < 0.05 ? "agrees" : `off by ${digits(off, 1)} %`}`);
}

function signalCards(signal, milliseconds) {
  const {noise_displacement: x, noise_acceleration: a, pulse_s: pulse} = signal;
  const {samples, sampling_rate: rate} = signal;
  const seconds = (samples / rate).toFixed(1);
  const answered = `answered in ${milliseconds.toFixed(0)} ms`;
  return [
    ["forcing G", `${about(signal.G * 1000, 4)} mm`, "fitted"],
    ["noise", x == null ? "–" : `${about(x * 1e6, 3)} µm`, a == null ? "" : `${about(a, 3)} m/s²`],
    [
      "pulse of an impact",
      `${about(pulse * 1000, 3)} ms`,
      `${about(pulse * rate, 2)} samples long`,
    ],
    ["sampling", `${about(rate, 5)} Hz`, `${count(samples, "sample")}, ${seconds} s; ${answered}`],
  ];
}

export function summariseMeasurement(answer, milliseconds) {
  const {parameters, restitution, b_fitted: fitted, signal, warnings} = answer;
  cards($("measure-summary"), [
    ...exponentCards(answer),
    impactsCard(answer),
    wall("+b", restitution.plus),
    wall("−b", restitution.minus),
    clearanceCard(fitted, parameters),
    ...signalCards(signal, milliseconds),
  ]);
  listWarnings($("measure-warnings"), warnings);
}

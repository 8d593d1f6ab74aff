// What a measurement came to, in words and numbers.

import {cards, listWarnings} from "../shared/cards.js";
import {$} from "../shared/dom.js";
import {count, digits, withError} from "../shared/numbers.js";
import {verdicts} from "../shared/quantities.js";
import {isLeftOut} from "./impact_list.js";

const about = (value, n) => (value == null ? "–" : Number(value.toPrecision(n)).toString());

const wall = (name, {R, standard_error: error, impacts}) => [
  `R at ${name}`,
  withError(R, error, 4),
  count(impacts, "impact"),
];

function exponentCards({parameters, exponents, slope, verdict, verdict_reason: reason, forward}) {
  const error = exponents.qr?.standard_error[0];
  const damping = `damping ζ = ${digits(parameters.derived.zeta, 4)}`;
  return [
    ["verdict", verdicts[verdict] ?? "–", reason.replace("damping zeta", damping)],
    [
      "λ₁ (qr)",
      exponents.qr ? digits(exponents.qr.final[0]) : "–",
      error == null ? "" : `± ${digits(error)}, at the last impact`,
    ],
    [
      "slope of λ₁ τ",
      slope.lambda1 == null ? "–" : digits(slope.lambda1),
      slope.low == null ? "" : `90 %: ${digits(slope.low)} to ${digits(slope.high)}`,
    ],
    [
      "λ₁ of the identified system",
      forward ? digits(forward.lambda[0]) : "–",
      forward ? "run forward from the first known state" : "no state is known",
    ],
  ];
}

function impactsCard({impacts: {status, tau}, sticking}) {
  const of = (text) => status.filter((v) => v === text).length;
  const left = status.filter(isLeftOut).length;
  const unknown = of("R is not known");
  const hidden = of("hidden");
  const stuck = sticking.side.length;
  const notes = [
    `${left} left out`,
    hidden && `${hidden} hidden`,
    stuck && `${count(stuck, "stuck phase")}, shaded`,
    unknown && `R of ${unknown} not known, at the ends`,
  ];
  return ["impacts", String(tau.length), notes.filter(Boolean).join("; ")];
}

/** The half clearance that the impacts fit, beside the given one, in mm. */
function clearanceCard({b, standard_error: error}, parameters) {
  if (parameters.origin.b === "fitted to the record")
    return ["b fitted", `${withError(b * 1000, error * 1000, 2)} mm`, "taken, not the given one"];
  const given = parameters.b * 1000;
  const remark = `given ${about(given, 5)} mm`;
  if (b == null) return ["b fitted", "–", remark];
  const off = ((b * 1000) / given - 1) * 100;
  const judged = Math.abs(off) < 0.05 ? "agrees" : `off by ${digits(off, 1)} %`;
  return ["b fitted", `${withError(b * 1000, error * 1000, 2)} mm`, `${remark}, ${judged}`];
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

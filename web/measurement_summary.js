// What a measurement came to, in words and numbers.
import {$} from "./dom.js";
import {isLeftOut} from "./impact_list.js";
import {cards, count, digits, listWarnings, verdicts} from "./summary.js";

const about = (value, n) => (value == null ? "–" : Number(value.toPrecision(n)).toString());

/** Of a value and its error, to two digits of the error. */
function withError(value, error, n) {
  if (value == null) return "–";
  if (!error) return digits(value, n);
  const places = Math.min(Math.max(1 - Math.floor(Math.log10(error)), 0), 8);
  return `${value.toFixed(places)} ± ${error.toFixed(places)}`;
}

const wall = (name, {R, standard_error: error, impacts}) => [
  `R at ${name}`,
  withError(R, error, 4),
  count(impacts, "impact"),
];

export function summariseMeasurement(
  {
    parameters,
    signal: s,
    impacts,
    restitution,
    b_fitted: b,
    exponents,
    slope,
    verdict,
    verdict_reason: reason,
    forward,
    warnings,
  },
  milliseconds,
) {
  const left = impacts.status.filter(isLeftOut).length;
  const unknown = impacts.status.filter((status) => status === "R is not known").length;
  const error = exponents.qr?.standard_error[0];
  const b0 = parameters.b * 1000;
  const off = b.b == null ? null : ((b.b * 1000) / b0 - 1) * 100;
  cards($("measure-summary"), [
    [
      "verdict",
      verdicts[verdict] ?? "–",
      reason.replace("damping zeta", `damping ζ = ${digits(parameters.derived.zeta, 4)}`),
    ],
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
    [
      "impacts",
      String(impacts.tau.length),
      `${left} left out${unknown ? `; R of ${unknown} not known, at the ends` : ""}`,
    ],
    wall("+b", restitution.plus),
    wall("−b", restitution.minus),
    [
      "b fitted",
      b.b == null ? "–" : `${withError(b.b * 1000, b.standard_error * 1000, 2)} mm`,
      `given ${about(b0, 5)} mm${off == null ? "" : `, ${Math.abs(off) < 0.05 ? "agrees" : `off by ${digits(off, 1)} %`}`}`,
    ],
    ["forcing G", `${about(s.G * 1000, 4)} mm`, "fitted"],
    [
      "noise",
      s.noise_displacement == null ? "–" : `${about(s.noise_displacement * 1e6, 3)} µm`,
      s.noise_acceleration == null ? "" : `${about(s.noise_acceleration, 3)} m/s²`,
    ],
    [
      "pulse of an impact",
      `${about(s.pulse_s * 1000, 3)} ms`,
      `${about(s.pulse_s * s.sampling_rate, 2)} samples long`,
    ],
    [
      "sampling",
      `${about(s.sampling_rate, 5)} Hz`,
      `${count(s.samples, "sample")}, ${(s.samples / s.sampling_rate).toFixed(1)} s; answered in ${milliseconds.toFixed(0)} ms`,
    ],
  ]);
  listWarnings($("measure-warnings"), warnings);
}

// What a run came to, in one sentence.
import {$, element} from "../shared/dom.js";
import {count, percent, withError} from "../shared/numbers.js";
import {regimes} from "../shared/quantities.js";
import {valueText} from "./sliders.js";

/** How the motion goes, and whether it is chaotic; of what both tell, only what they agree on. */
function motionText({regime, exponents}, units) {
  const {type, periodic, capture, period_cycles: cycles} = regime;
  if (type === "none")
    return regime.description === "no impacts" ? "the mass meets no wall" : regime.description;
  const name = `${regimes[type] ?? regime.description} (${type})`;
  if (periodic) {
    const period = cycles > 1 ? ` of ${count(cycles, "cycle")}` : "";
    const late = capture?.chaotic_before && capture.tau !== null;
    const before = late ? `, after a chaotic transient up to ${units.at(capture.tau)}` : "";
    return `${name}, ${regime.stable ? "" : "un"}stable periodic orbit${period}${before}`;
  }
  const {verdict} = exponents;
  return verdict && verdict !== "not_decided" ? `${name}, ${verdict}` : name;
}

function lambdaText({qr, verdict}, regime) {
  if (!qr || regime.type === "none" || qr.final[0] == null) return "";
  const value = `λ₁ = ${withError(qr.final[0], qr.standard_error[0], 3)}`;
  const open = verdict === "not_decided" && !regime.periodic;
  return open ? `${value}, too close to zero to decide` : value;
}

const amplitudeText = ({rms_ratio: ratio}) =>
  ratio == null ? "" : `x at ${percent(ratio)} of that without the absorber`;

/** slider: whose value the sentence begins with. */
export function showSentence(answer, slider, units) {
  const {exponents, regime, energy, parameters} = answer;
  const rest = [lambdaText(exponents, regime), amplitudeText(energy)].filter(Boolean).join("; ");
  const end = rest && ".";
  const motion = element("b", {textContent: motionText(answer, units) + end});
  $("sentence").replaceChildren(`${valueText(slider, parameters)}: `, motion, " ", rest + end);
}

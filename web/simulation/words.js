// The results of a run in words: a sentence, and descriptions of the plots.
import {$, attributes, element, setTexts} from "../shared/dom.js";
import {captionOf} from "../shared/export.js";
import {count, digits, joined, percent, withError} from "../shared/numbers.js";
import {PlotGroup} from "../shared/plot.js";
import {regimes} from "../shared/quantities.js";
import {run, viewport} from "./run.js";
import {parameterLine, valueText} from "./sliders.js";

function motionText({regime, exponents, energy}, units) {
  const {type, periodic, capture, period_cycles: cycles, impacts_per_period: impacts} = regime;
  if (energy.peak === 0) return "at rest: no forcing, no impact";
  if (type === "none" && regime.description === "no impacts")
    return exponents.verdict ? "no impacts in the window" : "the ball meets no wall";
  if (type === "none") return regime.description;
  const name = `${regimes[type] ?? regime.description} (${type})`;
  if (periodic) {
    const hits = type === "V" ? `, ${count(impacts, "impact")}` : "";
    const period = cycles > 1 || hits ? ` of ${count(cycles, "cycle")}${hits}` : "";
    const late = capture?.chaotic_before && capture.tau !== null;
    const before = late ? `, after a chaotic transient up to ${units.at(capture.tau)}` : "";
    return `${name}, ${regime.stable ? "" : "un"}stable periodic orbit${period}${before}`;
  }
  if (regime.quasi_periodic) return regime.description;
  const {verdict} = exponents;
  const window = verdict === "chaotic" ? " so far" : "";
  return verdict && verdict !== "not_decided" ? `${name}, ${verdict}${window}` : name;
}

/** The exponent of the orbit that the run converges to, from its largest multiplier. */
function orbitText({multipliers, period_cycles: cycles}, {Omega}) {
  const [largest] = multipliers?.modulus ?? [];
  if (largest === undefined) return "";
  const lambda = (Math.log(largest) * Omega) / (2 * Math.PI * cycles);
  return `λ₁ = ${largest ? digits(lambda, 4) : "−∞"} on this orbit`;
}

function lambdaText({qr, verdict}, regime, parameters) {
  if (regime.periodic) return orbitText(regime, parameters);
  if (!qr || regime.type === "none" || qr.final[0] == null) return "";
  const value = `λ₁ = ${withError(qr.final[0], qr.standard_error[0], 3)}`;
  return verdict === "not_decided" ? `${value}, not decided` : value;
}

/** slider: its value begins the sentence. */
export function showSentence(answer, slider, units) {
  const {exponents, regime, energy, parameters} = answer;
  const ratio = energy.rms_ratio;
  const amplitude = ratio == null ? "" : `rms x ${percent(ratio)} of that without absorber`;
  const rest = joined([lambdaText(exponents, regime, parameters), amplitude], "; ");
  const end = rest && ".";
  const motion = element("b", {textContent: motionText(answer, units) + end});
  $("sentence").replaceChildren(`${valueText(slider, parameters)}: `, motion, " ", rest + end);
}

/** Description, caption and file name of an exported plot of the run shown. */
function aboutFigure(name) {
  const {title, notes} = captionOf($(`figure-${name}`));
  const caption = run ? parameterLine(run.answer.parameters) : "";
  return {summary: `${title} ${notes}`, caption, name: `vines-${name}`};
}

export const plotsIn = (part) =>
  new PlotGroup(part, viewport, {
    about: aboutFigure,
    moments: () => run?.answer.impacts.tau ?? [],
  });

/** Describes the figures of the first screen; `system`: the parameters in brief. */
export function describe(answer, system) {
  const caption = parameterLine(answer.parameters);
  setTexts({"key-stuck": answer.sticking.tau_start.length ? ", orange: sticking" : ""});
  for (const figure of document.querySelectorAll("#instrument figure")) {
    const name = figure.id.replace("figure-", "");
    Object.assign(figure.querySelector(".params"), {textContent: system, title: caption});
    attributes($(`plot-${name}`), {"aria-label": `${aboutFigure(name).summary}. ${caption}`});
  }
}

// Texts of the plots: the parameters, and a description in words.
import {$, attributes, setTexts} from "../shared/dom.js";
import {captionOf} from "../shared/export_dialog.js";
import {count, inMm, percent, withError} from "../shared/numbers.js";
import {regimes} from "../shared/quantities.js";
import {run} from "./run.js";
import {parameterLine} from "./sliders.js";

/** Results per plot of the first screen. */
function factsOf({energy, impacts, regime, exponents, parameters, status}) {
  const {qr, verdict} = exponents;
  const part = energy.window[1] < status.tau || energy.window[0] > 0;
  const end = part ? "in the window" : `up to ${run.units.at(status.tau)}`;
  const hits = count(impacts.tau.length, "impact");
  const lambda = qr?.final[0] == null ? "none" : withError(qr.final[0], qr.standard_error[0], 4);
  return {
    x: `${end} at most ${inMm(energy.peak)}, rms ${inMm(energy.rms)}; ${hits} in the run`,
    relative: `at ±${inMm(parameters.b)}; ${percent(regime.synchronised.share)} of the contacts synchronised`,
    lambda: `λ₁ ends at ${lambda}${verdict ? `, ${verdict.replace("_", " ")}` : ""}`,
    section: `${hits} in the run`,
    manifold: regimes[regime.type] ?? regimes.none,
  };
}

/** Title, description, caption and file name of an exported plot of the run shown. */
export function aboutFigure(name) {
  const {title, notes} = captionOf($(`figure-${name}`));
  const facts = run && factsOf(run.answer)[name];
  const summary = [`${title} ${notes}`, facts].filter(Boolean).join(": ");
  const caption = run ? parameterLine(run.answer.parameters) : "";
  return {title, summary, caption, name: `vines-${name}`};
}

/** Describes the figures of the first screen; `system`: the parameters in brief. */
export function describe(answer, system) {
  const caption = parameterLine(answer.parameters);
  setTexts({"key-stuck": answer.sticking.tau_start.length ? ", orange sticking" : ""});
  for (const figure of document.querySelectorAll("#instrument figure")) {
    const name = figure.id.replace("figure-", "");
    const params = figure.querySelector(".params");
    Object.assign(params, {textContent: system, title: caption});
    params.dataset.all = system === caption ? "" : `: ${caption}`;
    attributes($(`plot-${name}`), {"aria-label": `${aboutFigure(name).summary}. ${caption}`});
  }
}

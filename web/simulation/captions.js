// What each plot says of itself: for which parameters it is, and in words what it shows.
import {$, attributes, write} from "../shared/dom.js";
import {captionOf} from "../shared/figure_menu.js";
import {count, inMm, percent, withError} from "../shared/numbers.js";
import {regimes} from "../shared/quantities.js";
import {run} from "./run.js";
import {parameterLine} from "./sliders.js";

/** What the plots of the first screen came to, by name. */
function factsOf({energy, impacts, regime, exponents, parameters, status}) {
  const {qr, verdict} = exponents;
  const part = energy.window[1] < status.tau || energy.window[0] > 0;
  const end = part ? "in the window" : `up to ${run.units.at(status.tau)}`;
  const hits = count(impacts.tau.length, "impact");
  const lambda = qr?.final[0] == null ? "none" : withError(qr.final[0], qr.standard_error[0], 4);
  return {
    x: `${end} at most ${inMm(energy.peak)}, rms ${inMm(energy.rms)}; ${hits} of the run`,
    relative: `at ±${inMm(parameters.b)}; ${percent(regime.synchronised.share)} of the contacts synchronised`,
    lambda: `the largest ends at ${lambda}${verdict ? `, ${verdict.replace("_", " ")}` : ""}`,
    section: `${hits} of the run`,
    manifold: regimes[regime.type] ?? regimes.none,
  };
}

let caption = "";
let facts = {};

/** What a plot that is taken away says of itself. */
export function aboutFigure(name) {
  const {title, notes} = captionOf($(`figure-${name}`));
  const summary = [`${title} ${notes}`, facts[name]].filter(Boolean).join(": ");
  return {title, summary, caption, name: `vines-${name}`};
}

/** Writes both to the figures of the first screen; system: what was computed, in a few words. */
export function describe(answer, system) {
  caption = parameterLine(answer.parameters);
  facts = factsOf(answer);
  write({"key-stuck": answer.sticking.tau_start.length ? ", orange: stuck" : ""});
  for (const figure of document.querySelectorAll("#instrument figure")) {
    const name = figure.id.replace("figure-", "");
    const params = figure.querySelector(".params");
    Object.assign(params, {textContent: system, title: caption});
    params.dataset.all = system === caption ? "" : `: ${caption}`;
    attributes($(`plot-${name}`), {"aria-label": `${aboutFigure(name).summary}. ${caption}`});
  }
}

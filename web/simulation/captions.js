// What each plot says of itself: for which parameters it is, and in words what it shows.
import {$, aria} from "../shared/dom.js";
import {count, inMm, percent, withError} from "../shared/numbers.js";
import {regimes} from "../shared/quantities.js";
import {parameterLine} from "./sliders.js";

/** The plots of the first screen in words, by name. */
function summaries({energy, impacts, regime, exponents, parameters, status}, units) {
  const {qr, verdict} = exponents;
  const end = units.at(status.tau);
  const hits = count(impacts.tau.length, "impact");
  const lambda = qr?.final[0] == null ? "none" : withError(qr.final[0], qr.standard_error[0], 4);
  return {
    x: `Displacement x of the oscillator up to ${end}: at most ${inMm(energy.peak)}, rms ${inMm(energy.rms)}, ${hits}.`,
    relative: `Relative displacement y − x between the walls at ±${inMm(parameters.b)}: ${percent(regime.synchronised.share)} of the contacts synchronised.`,
    largest: "Largest modulus of the eigenvalues of T at each impact.",
    lambda: `Exponents over the window; the largest ends at ${lambda}${verdict ? `, ${verdict.replace("_", " ")}` : ""}.`,
    section: `x and x′ after each of ${hits}, by wall.`,
    manifold: `Amplitude of x over the speed of the free mass, half cycle by half cycle: ${regimes[regime.type] ?? "no impacts"}.`,
  };
}

let caption = "";
let texts = {};

/** What a plot that is taken away says of itself. */
export function aboutFigure(name) {
  const nodes = [...$(`figure-${name}`).querySelector("figcaption").childNodes];
  const own = nodes.filter((node) => !node.classList?.length);
  const words = own.map((node) => node.textContent.trim()).filter(Boolean);
  return {title: words[0], summary: texts[name] ?? words.join(" "), caption, name: `vines-${name}`};
}

/** Writes both to the figures. */
export function describe(answer, units) {
  caption = parameterLine(answer.parameters);
  texts = summaries(answer, units);
  for (const node of document.querySelectorAll("#instrument .params")) node.textContent = caption;
  for (const [name, text] of Object.entries(texts))
    aria($(`plot-${name}`), {label: `${text} ${caption}`});
}

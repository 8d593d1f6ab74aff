// What each plot says of itself: for which parameters it is, and in words what it shows.
import {$} from "../shared/dom.js";
import {count, percent, short, withError} from "../shared/numbers.js";
import {regimes} from "../shared/quantities.js";
import {valueText} from "./sentence.js";
import {sliderOf} from "./sliders.js";

const reduced = ["b", "R", "G", "Omega", "zeta"];
const si = ["b", "R", "F", "f", "c1"];

/** The parameters that matter, in a line. */
export const parameterLine = (parameters) =>
  (parameters.si ? si : reduced)
    .map((name) => valueText(sliderOf(name, parameters), parameters))
    .join(", ");

const inMm = (metres) => `${short(Number((metres * 1000).toPrecision(3)))} mm`;

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

let told = {line: "", texts: {}};

/** What a plot that is taken away says of itself. */
export function aboutFigure(name) {
  const caption = $(`figure-${name}`).querySelector("figcaption");
  const own = [...caption.childNodes].filter((node) => !node.classList?.length);
  const words = own.map((node) => node.textContent.trim()).filter(Boolean);
  const [title] = words;
  const summary = told.texts[name] ?? words.join(" ");
  return {title, summary, caption: told.line, name: `vines-${name}`};
}

/** Writes both to the figures. */
export function describe(answer, units) {
  const line = parameterLine(answer.parameters);
  told = {line, texts: summaries(answer, units)};
  for (const node of document.querySelectorAll("#instrument .params")) node.textContent = line;
  for (const [name, text] of Object.entries(told.texts)) {
    const node = $(`plot-${name}`);
    node.setAttribute("aria-label", `${text} ${line}`);
  }
}

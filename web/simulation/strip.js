// The regime strip: regimes and lambda1 along the parameter moved last, computed by a sweep from
// coarse to fine. Its marker acts as the slider.
import {jsonLines, sweep} from "../shared/api.js";
import {$, attributes, countUp, element, setTexts} from "../shared/dom.js";
import {blank, Frame, font, Size} from "../shared/frame.js";
import {drawText, ink, stroke} from "../shared/ink.js";
import {isTemporary, retryInterval} from "../shared/job.js";
import {clamp, digits, withError} from "../shared/numbers.js";
import {regimeColour, regimeText, verdictColour, verdicts} from "../shared/quantities.js";
import {run} from "./run.js";
import {fieldsOf, moveSlider, spanOf, valueAt, written} from "./sliders.js";

const cycles = 300; // measured at each point
const transient = 150; // cycles discarded before
const points = 257; // computed coarse to fine
const pause = 180; // ms without an edit before it starts
const band = 13; // px, height of the regime band

const canvas = $("strip");
const marker = element("div", {className: "marker"});
const size = new Size(canvas, redraw);
let parameters;
let slider; // the one moved last
let range; // of the slider
let key = null;
let found = []; // points by position
let stale = false;
let abort;
let waiting = 0;
let drawing = 0;
let frame = null;
let pointed = false;

/** Updates the strip for a run: system fields of its request, parameters, slider. */
export function show(system, shown, turned) {
  parameters = shown;
  slider = turned;
  range = spanOf(slider);
  const [parameter, ...others] = Object.keys(fieldsOf(slider, 0, parameters));
  const base = {...system};
  for (const name of [parameter, ...others]) delete base[name];
  const wanted = JSON.stringify([base, parameter, range]);
  if (wanted === key) return place();
  if (key === null) listen();
  key = wanted;
  abort?.abort();
  clearTimeout(waiting);
  stale = true;
  waiting = setTimeout(fill, pause, base, parameter);
  setTexts({"strip-trouble": ""});
  const {symbol, unit} = slider;
  setTexts({"strip-parameter": unit ? `${symbol} (${unit})` : symbol});
  redraw();
}

/** Value at position i, in the slider's unit. */
function at(i) {
  const [from, to] = range;
  const least = 0.002 * (to - from); // 0 is invalid for a clearance or forcing
  return Math.max(from + ((to - from) * i) / (points - 1), from || least);
}

/** The position nearest to a value. */
function nearest(value) {
  const [from, to] = range;
  return Math.round(clamp((value - from) / (to - from), 0, 1) * (points - 1));
}

async function fill(base, parameter) {
  abort = new AbortController();
  const {signal} = abort;
  // The marker's point comes first: its errors are reported for the whole sweep; errors of other
  // points only at those points.
  const sequence = [...new Set([nearest(valueAt(slider, parameters)), ...Array(points).keys()])];
  const values = sequence.map((i) => fieldsOf(slider, at(i), parameters)[parameter]);
  try {
    const body = {base, axes: [{parameter, values}], cycles, transient_cycles: transient};
    const stream = await sweep(body, signal);
    found = [];
    stale = false;
    setTexts({"strip-trouble": ""});
    for await (const {value} of jsonLines(stream)) {
      if (signal.aborted) return;
      if (value.type !== "point" || value.error) continue;
      found[sequence[value.index]] = value;
      if (!drawing) drawing = requestAnimationFrame(redraw);
    }
    countUp(canvas);
  } catch (error) {
    if (signal.aborted) return;
    found = [];
    setTexts({"strip-trouble": error.message});
    if (isTemporary(error)) waiting = setTimeout(fill, retryInterval * 1000, base, parameter);
  }
  redraw();
}

export function redraw() {
  drawing = 0;
  const {width, height} = size;
  if (!range || !width) return;
  const c = blank(canvas, size);
  c.translate(0, band);
  frame = new Frame(width, height - band, {range}, {range: rangeOfExponents()}, 14);
  frame.draw(c);
  if (stale) c.globalAlpha = 0.5;
  drawExponents(c);
  for (const stretch of stretches()) drawStretch(c, stretch);
  c.globalAlpha = 1;
  place();
}

/** Intervals of equal regime; borders lie midway between points. */
function stretches() {
  const there = Object.keys(found).map(Number);
  const list = [];
  there.forEach((i, k) => {
    const {regime} = found[i];
    const to = (i + (there[k + 1] ?? i)) / 2;
    const last = list.at(-1);
    if (last?.regime === regime) last.to = to;
    else list.push({regime, from: last?.to ?? i, to});
  });
  return list;
}

/** Draws an interval, with its name if it fits. */
function drawStretch(c, {regime, from, to}) {
  const [left, right] = [from, to].map((i) => frame.px(at(i)));
  ink(c, regime ? regimeColour(regime) : "nothing");
  c.fillRect(left, frame.box.top - band, Math.max(right - left, 1) + 0.5, band);
  if (!regime || regime === "none" || right - left < 18) return;
  ink(c, "text");
  c.font = `600 ${font}`;
  drawText(c, regime, (left + right) / 2, frame.box.top + 2, "center", "top");
}

const lambdaOf = (p) => p?.lambda?.[0];

/** The range of lambda1 without outliers. */
function rangeOfExponents() {
  const values = found.map(lambdaOf).filter((v) => v != null);
  values.sort((a, b) => a - b);
  const quantile = (share) => values[Math.floor(values.length * share)];
  const most = Math.max(quantile(0.98) ?? 0.1, 0.02) * 1.15;
  return [Math.min(quantile(0.05) ?? 0, -0.15 * most), most];
}

function drawExponents(c) {
  const alpha = c.globalAlpha;
  const py = (v) => frame.py(clamp(v, ...frame.y.range));
  ink(c, "line");
  frame.across(c, 0);
  found.forEach((p, i) => {
    const lambda = lambdaOf(p);
    if (lambda == null) return;
    const x = frame.px(at(i));
    const error = p.standard_error?.[0] ?? 0;
    ink(c, verdictColour(p));
    c.globalAlpha = 0.4 * alpha;
    stroke(
      c,
      [-error, error].map((by) => [x, py(lambda + by)]),
    );
    c.globalAlpha = alpha;
    c.fillRect(x - 1.5, py(lambda) - 1.5, 3, 3);
  });
}

/** Moves the marker and describes its point. */
function place() {
  if (!frame) return;
  const value = valueAt(slider, parameters);
  const [least, most] = range;
  marker.style.transform = `translateX(${frame.px(value)}px)`;
  attributes(canvas, {
    "aria-valuemin": least,
    "aria-valuemax": most,
    "aria-valuenow": value,
    "aria-valuetext": textAt(value),
  });
  if (!pointed) tell();
}

/**
 * Text next to the title: the value under the pointer or, without one, how the point at the marker
 * (after its transient) differs from the run above.
 */
function tell(event) {
  pointed = Boolean(event);
  setTexts({"strip-tip": event ? textAt(valueUnder(event)) : differenceText()});
}

function differenceText() {
  const p = found[nearest(valueAt(slider, parameters))];
  if (stale || !p?.regime) return "";
  const {regime, exponents} = run.answer;
  const own = [regime.type, regime.periodic ? "regular" : exponents.verdict];
  const there = [p.regime, p.periodic ? "regular" : p.verdict];
  if (own.join() === there.join()) return "";
  const words = ([type, verdict]) => [type, verdicts[verdict]].filter(Boolean).join(", ");
  return `at the marker, after ${transient} cycles: ${words(there)}; the run above: ${words(own)}`;
}

/** A value and its point as text. */
function textAt(value) {
  const {symbol, unit} = slider;
  const where = `${symbol} = ${written(value, range)} ${unit}`.trim();
  const p = found[nearest(value)];
  if (!p?.regime) return where;
  const lambda = lambdaOf(p);
  const parts = [
    regimeText(p.regime),
    verdicts[p.verdict],
    lambda != null && `λ₁ = ${withError(lambda, p.standard_error?.[0], 3)}`,
    p.z != null && `z = ${digits(p.z, 2)}`,
  ];
  return `${where}: ${parts.filter(Boolean).join(", ")}`;
}

const turn = (value, dragging) => moveSlider(slider, clamp(value, at(0), range[1]), dragging);
/** The value under the pointer. */
function valueUnder({offsetX}) {
  const [from, to] = range;
  return from + ((offsetX - frame.box.left) / frame.width) * (to - from);
}
const steps = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  Home: -Infinity,
  End: Infinity,
};

canvas.parentNode.append(marker);

function listen() {
  Object.assign(canvas, {
    onpointerdown(event) {
      canvas.setPointerCapture(event.pointerId);
      turn(valueUnder(event), true);
    },
    onpointermove(event) {
      const value = valueUnder(event);
      if (event.buttons) turn(value, true);
      tell(event);
    },
    onpointerup: (event) => turn(valueUnder(event), false),
    onpointerleave: () => tell(),
    onkeydown(event) {
      const step = steps[event.key] * (event.shiftKey ? 10 : 1);
      if (!step) return;
      event.preventDefault();
      const [from, to] = range;
      turn(valueAt(slider, parameters) + (step * (to - from)) / (points - 1), false);
    },
  });
}

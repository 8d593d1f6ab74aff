// The regime strip: a bifurcation diagram along the parameter moved last, computed by a sweep from
// coarse to fine: the regimes, and lambda1, the largest |x| or x at the impacts. Its marker acts as
// the slider.
import {$, attributes, countUp, setTexts} from "../shared/dom.js";
import {Frame, rangeOf} from "../shared/frame.js";
import {Job} from "../shared/job.js";
import {blocks, density, dots, levels, line} from "../shared/marks.js";
import {clamp, digits, nearest, withError} from "../shared/numbers.js";
import {Plot} from "../shared/plot.js";
import {regimeColour, regimeText, verdictColour, verdicts} from "../shared/quantities.js";
import {Layers, receive, SweepData, stretches} from "../sweep/data.js";
import {run} from "./run.js";
import {fieldsOf, moveSlider, valueAt, written} from "./sliders.js";

const cycles = 300; // measured at each point
const transient = 150; // cycles discarded before
const points = 257; // computed coarse to fine
const impacts = 40; // listed of each point of a bifurcation diagram
const pause = 400; // ms without an edit before it starts
const mostKept = 20; // sweeps kept for parameters that return
const band = 13; // px, height of the regime band

const canvas = $("strip");
const menu = $("strip-quantity");
const marker = canvas.nextElementSibling;
const say = (text) => setTexts({"strip-trouble": text});
let parameters;
let slider; // the one moved last
let range; // of the slider
let parameter; // its field
let key = null;
let layers = null; // the sweep drawn
let stale = false;
let waiting = 0;
let drawing = 0;
const kept = new Map(); // layers of complete sweeps by their key, the oldest first
let pointed = false;

const job = new Job({
  ask: (fresh, signal) =>
    receive(fresh, signal, () => {
      if (layers?.base !== fresh) layers = new Layers(fresh);
      stale = false;
      say("");
      if (!drawing) drawing = requestAnimationFrame(redraw);
    }),
  show() {
    kept.set(key, layers);
    if (kept.size > mostKept) kept.delete(kept.keys().next().value);
    countUp(canvas);
  },
  fail(error) {
    layers = null;
    say(error.message);
    redraw();
  },
  later: say,
});

/** Updates the strip for a run: system fields of its request, parameters, slider. */
export function show(system, shown, turned) {
  menu.onchange = () => show(system, shown, turned);
  parameters = shown;
  slider = turned;
  range = slider.span;
  const set = Object.entries(fieldsOf(slider, 0, parameters));
  const [[swept], ...others] = set;
  if (parameter !== swept) layers = null;
  parameter = swept;
  const base = {...system, ...Object.fromEntries(others)};
  for (const [name, value] of set) if (name === swept || value === null) delete base[name];
  const more = menu.value === "section" ? {section: "impact", section_points: impacts} : {};
  const wanted = JSON.stringify([base, parameter, range, more]);
  if (wanted === key) return redraw();
  if (key === null) listen();
  key = wanted;
  job.cancel();
  clearTimeout(waiting);
  const known = kept.get(key);
  stale = !known;
  if (known) layers = known;
  else waiting = setTimeout(() => job.start(request({base, ...more})), pause);
  say("");
  const {symbol, unit} = slider;
  setTexts({"strip-parameter": unit ? `${symbol} (${unit})` : symbol});
  redraw();
}

/** A value of the slider as one of the parameter, which is proportional to it. */
const toParameter = (value) => fieldsOf(slider, value, parameters)[parameter];

/** The least value of the slider; 0 is invalid for a clearance or forcing. */
const least = () => range[0] || 0.002 * range[1];

/**
 * The sweep over the range. The marker's point comes first: its errors are reported for the whole
 * sweep; errors of other points only at those points.
 */
function request(fields) {
  const [from, to] = range;
  const step = (to - from) / (points - 1);
  const values = Array.from({length: points}, (_, i) => (i ? from + i * step : least()));
  const first = values[nearest(values, valueAt(slider, parameters))];
  const axis = {parameter, values: [...new Set([first, ...values])].map(toParameter)};
  return new SweepData({...fields, axes: [axis], cycles, transient_cycles: transient});
}

/** The point at a value of the slider, if it has been computed. */
function pointAt(value) {
  const data = layers?.base;
  return data?.points[data.index(nearest(data.axes[0].values, toParameter(value)))];
}

class StripPlot extends Plot {
  prepare(width, height) {
    if (!range) return null;
    const [from, to] = range.map(toParameter);
    const received = layers?.places(0) ?? [];
    const inRange = received.filter(({value}) => value >= from && value <= to);
    const ofX = {range: [from, to], factor: range[1] / to};
    const alpha = stale ? 0.5 : 1;
    const {marks, ...ofY} = drawn[menu.value](inRange, alpha);
    const frame = new Frame(width, height, ofX, ofY, 14, band + 5);
    return {frame, marks: [...marks, regimes(received, alpha)]};
  }

  place() {
    place();
  }
}

const plot = new StripPlot(canvas, canvas, canvas.parentNode);

export function redraw() {
  drawing = 0;
  plot.refresh();
}

/** Regimes as a band above the plot. */
function regimes(places, alpha) {
  const list = stretches(places).map(({regime, ...ends}) => ({
    ...ends,
    colour: regime ? regimeColour(regime) : "nothing",
    text: regime && regime !== "none" ? regime : "",
    hatched: regime === "none",
  }));
  return blocks({list, down: -band, height: band, textDown: 2, alpha, above: true});
}

const lambdaOf = (p) => p?.lambda?.[0];

/** Options along y and marks of each quantity of the menu, from places and an opacity. */
const drawn = {
  lambda1(places, alpha) {
    const exponents = places.filter(({p}) => lambdaOf(p) != null);
    const range = usualRange(exponents);
    return {label: "λ₁", range, marks: [levels({y: 0}), dotsOf(exponents, range, alpha)]};
  },
  x_max(places, alpha) {
    const x = places.map(({value}) => value);
    const column = (name) => places.map(({p}) => (p[name] == null ? null : p[name] * 1000));
    const [most, free] = ["x_max", "x_free"].map(column);
    const tints = places.map(({p}) => verdictColour(p));
    const range = [0, rangeOf([[0], most, free])[1]];
    const without = line({x, y: free, colour: "without", width: 2, dash: [6, 4], alpha});
    return {
      label: "|x| (mm)",
      range,
      marks: [without, dots({x, y: most, tints, size: 1.5, alpha})],
    };
  },
  section(places, alpha) {
    const values = ({p}) => p.section?.x ?? [];
    const columns = places.map((place) => ({
      from: place.low,
      to: place.high,
      values: values(place),
    }));
    const range = rangeOf(places.map(values)) ?? [-1, 1];
    return {label: "x (mm)", range, marks: [density({columns, colour: "c1", alpha})]};
  },
};

/** The range of lambda1 without outliers. */
function usualRange(exponents) {
  const values = exponents.map(({p}) => lambdaOf(p)).sort((a, b) => a - b);
  const quantile = (share) => values[Math.floor(values.length * share)];
  const most = Math.max(quantile(0.98) ?? 0.1, 0.02) * 1.15;
  return [Math.min(quantile(0.05) ?? 0, -0.15 * most), most];
}

/** lambda1 with its standard error; outliers lie at the edge of the range. */
const dotsOf = (exponents, ends, alpha) =>
  dots({
    x: exponents.map(({value}) => value),
    y: exponents.map(({p}) => clamp(lambdaOf(p), ...ends)),
    tints: exponents.map(({p}) => verdictColour(p)),
    errors: exponents.map(({p}) => p.standard_error?.[0]),
    size: 1.5,
    alpha,
    above: true,
  });

/** Moves the marker and describes its point. */
function place() {
  if (!plot.frame) return;
  const value = valueAt(slider, parameters);
  const [from, to] = range;
  marker.style.transform = `translateX(${plot.frame.px(toParameter(value))}px)`;
  attributes(canvas, {
    "aria-valuemin": from,
    "aria-valuemax": to,
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
  const p = pointAt(valueAt(slider, parameters));
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
  const p = pointAt(value);
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

const turn = (value, dragging) => moveSlider(slider, clamp(value, least(), range[1]), dragging);
/** The value under the pointer. */
function valueUnder({offsetX}) {
  const {box, width} = plot.frame;
  const [from, to] = range;
  return from + ((offsetX - box.left) / width) * (to - from);
}
const steps = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  Home: -Infinity,
  End: Infinity,
};

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

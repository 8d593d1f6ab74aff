// The regime strip: a bifurcation diagram along the parameter moved last, computed by a sweep from
// coarse to fine: the regimes, and lambda1, the largest |x| or x at the impacts. Its marker acts as
// the slider.
import {bisectCenter} from "d3-array";
import delay from "delay";
import {$, countUp, setTexts} from "../shared/dom.js";
import {usualRange} from "../shared/exponents.js";
import {rangeOf} from "../shared/frame.js";
import {Job} from "../shared/job.js";
import {Marker} from "../shared/marker.js";
import {levels} from "../shared/marks.js";
import {clamp, digits, joined, withError} from "../shared/numbers.js";
import {Plot} from "../shared/plot.js";
import * as q from "../shared/quantities.js";
import {placesOf, receive, SweepData} from "../sweep/data.js";
import {dotsOf, lineOf, regimesOf, sectionOf} from "../sweep/points.js";
import {run} from "./run.js";
import {fieldsOf, moveSlider, valueAt, written} from "./sliders.js";

const cycles = 300; // measured at each point
const transient = 150; // cycles discarded before
const points = 257; // computed coarse to fine
const impacts = 40; // listed of each point of a bifurcation diagram
const pause = 400; // ms without an edit before it starts
const band = 13; // px, height of the regime band

const menu = $("strip-quantity");
const say = (text) => setTexts({"strip-trouble": text});

const kept = new Map(); // complete sweeps by their request, up to 50

/** Axis and marks of each quantity of the menu, from places on an axis. */
const drawn = {
  lambda1(places) {
    const range = usualRange(places.map(({p}) => q.lambda1(p)));
    // Outliers lie at the edge of the range.
    const of = (p) => (q.lambda1(p) == null ? null : clamp(q.lambda1(p), ...range));
    const style = {tint: q.verdictColour, error: q.errorOf, size: 1.5, above: true};
    return {label: "λ₁", range, marks: [levels({y: 0}), dotsOf(places, of, style)]};
  },
  x_max(places) {
    const {of, free} = q.quantities.x_max;
    const values = [of, free].map((each) => places.map(({p}) => each(p)));
    return {
      label: "|x| (mm)",
      range: [0, rangeOf([[0], ...values])[1]],
      marks: [
        lineOf(places, free, "without", {width: 2, dash: [6, 4]}),
        dotsOf(places, of, {tint: q.verdictColour, size: 1.5}),
      ],
    };
  },
  section(places, axis) {
    const {x} = q.coordinates.impact;
    const of = q.valuesOf(x);
    const range = rangeOf(places.map(({p}) => of(p))) ?? [-1, 1];
    return {label: x.label, range, marks: axis ? [sectionOf(places, axis, of, "c1")] : []};
  },
};

export class Strip extends Plot {
  data = null; // the sweep drawn
  key = null; // of the sweep for the run shown
  pointed = false; // true while the text is about the pointer's place

  job = new Job({
    ask: async ({key, data}, signal) => {
      if (kept.has(key)) return this.take(kept.get(key));
      await delay(pause, {signal});
      await receive(data, signal, () => this.take(data));
      if (kept.size >= 50) kept.clear();
      kept.set(key, data);
    },
    show: () => countUp(this.canvas),
    fail: ({message}) => {
      this.data = null;
      say(message);
      this.refresh();
    },
    later: say,
  });

  constructor() {
    super($("regimes"));
    this.canvas.id = "strip";
    const turn = (value, dragging) =>
      moveSlider(this.slider, Math.max(value, this.least), dragging);
    const ariaLabel = "The parameter, over the regimes";
    this.marker = new Marker(this.canvas, turn, {ariaLabel});
    Object.assign(this.marker.node, {
      onpointermove: (event) => this.frame && this.tell(event),
      onpointerleave: () => this.frame && this.tell(),
    });
  }

  /** Updates the strip for a run: system fields of its request, parameters, the slider moved last. */
  show(system, parameters, slider) {
    menu.onchange = () => this.show(system, parameters, slider);
    const set = Object.entries(fieldsOf(slider, 0, parameters));
    const [[parameter], ...others] = set;
    if (this.parameter !== parameter) this.data = null;
    Object.assign(this, {parameters, slider, parameter, range: slider.span});
    const base = {...system, ...Object.fromEntries(others)};
    for (const [name, value] of set) if (name === parameter || value === null) delete base[name];
    const more = menu.value === "section" ? {section: "impact", section_points: impacts} : {};
    const key = JSON.stringify([base, parameter, this.range, more]);
    if (key !== this.key) {
      this.key = key;
      this.markStale(true);
      this.job.start({key, data: this.sweep({base, ...more})});
      say("");
    }
    const {symbol, unit} = slider;
    setTexts({"strip-parameter": unit ? `${symbol} (${unit})` : symbol});
    this.refresh();
  }

  /** Shows the points received. */
  take(data) {
    this.data = data;
    this.markStale(false);
    say("");
    this.soon();
  }

  /** stale: what is drawn belongs to other parameters. */
  markStale(stale) {
    this.stale = stale;
    this.canvas.style.opacity = stale ? 0.5 : 1;
  }

  /** A value of the slider as one of the parameter, which is proportional to it. */
  toParameter(value) {
    return fieldsOf(this.slider, value, this.parameters)[this.parameter];
  }

  /** The slider's value. */
  get value() {
    return valueAt(this.slider, this.parameters);
  }

  /** The least value of the slider; 0 is invalid for a clearance or forcing. */
  get least() {
    const [from, to] = this.range;
    return from || 0.002 * to;
  }

  /**
   * The sweep over the range. The marker's point comes first: its errors are reported for the whole
   * sweep; errors of other points only at those points.
   */
  sweep(fields) {
    const [from, to] = this.range;
    const step = (to - from) / (points - 1);
    const values = Array.from({length: points}, (_, i) => (i ? from + i * step : this.least));
    const first = values[bisectCenter(values, this.value)];
    const given = [...new Set([first, ...values])].map((value) => this.toParameter(value));
    const axes = [{parameter: this.parameter, values: given}];
    return new SweepData({...fields, axes, cycles, transient_cycles: transient});
  }

  /** The point at a value of the slider, if it has been computed. */
  pointAt(value) {
    const {data} = this;
    return data?.points[data.index(bisectCenter(data.axes[0].values, this.toParameter(value)))];
  }

  content() {
    if (!this.range) return null;
    const [from, to] = this.range.map((value) => this.toParameter(value));
    const all = this.data ? placesOf([this.data], 0) : [];
    const axis = this.data?.axes[0];
    const places = all.filter(({value}) => value >= from && value <= to);
    const {marks, ...y} = drawn[menu.value](places, axis);
    const x = {range: [from, to], factor: this.range[1] / to, aligned: true};
    const regimes = {down: -band, height: band, texts: true, textDown: 2, above: true};
    if (axis) marks.push(regimesOf(all, axis, regimes));
    return {x, y, marks, beside: 14, above: band + 5};
  }

  /** Moves the marker and describes its point. */
  point() {
    const {range, value} = this;
    this.marker.show(this.frame, range, value, this.textAt(value));
    if (!this.pointed) this.tell();
  }

  /**
   * Text next to the title: the value under the pointer or, without one, how the point at the marker
   * (after its transient) differs from the run above.
   */
  tell(event) {
    this.pointed = Boolean(event);
    const text = event ? this.textAt(this.marker.valueUnder(event)) : this.differenceText();
    setTexts({"strip-tip": text});
  }

  differenceText() {
    const p = this.pointAt(this.value);
    if (this.stale || !p?.regime) return "";
    const {regime, exponents} = run.answer;
    const own = [regime.type, regime.periodic ? "regular" : exponents.verdict];
    const there = [p.regime, p.periodic ? "regular" : p.verdict];
    if (own.join() === there.join()) return "";
    const words = ([type, verdict]) => joined([type, q.verdicts[verdict]]);
    return `at the marker, after ${transient} cycles: ${words(there)}; the run above: ${words(own)}`;
  }

  /** A value and its point as text. */
  textAt(value) {
    const {symbol, unit} = this.slider;
    const where = `${symbol} = ${written(value, this.range)} ${unit}`.trim();
    const p = this.pointAt(value);
    if (!p?.regime) return where;
    const lambda = q.lambda1(p);
    const rest = joined([
      q.regimeText(p.regime),
      q.verdicts[p.verdict],
      lambda != null && `λ₁ = ${withError(lambda, q.errorOf(p), 3)}`,
      p.z != null && `z = ${digits(p.z, 2)}`,
    ]);
    return `${where}: ${rest}`;
  }
}

// The plots of the first screen: the motion over time, made anew from the impacts for whatever is in
// view, the largest modulus of T, the exponents, the section and the manifold. One cursor goes
// through all of them, and the impact nearest to it is ringed in each.
import {$, aria, write} from "../shared/dom.js";
import {exponentRange} from "../shared/exponents.js";
import {inMm, short} from "../shared/numbers.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {logRange, mm, most, over, overRun, positive} from "./columns.js";
import {manifoldOptions} from "./manifold.js";
import {exponentLines, halves, Plots} from "./plots.js";

const mostSamples = 100000; // of the motion, as numbers
const alone = matchMedia("(max-width: 700px)"); // one plot at a time is on the screen
const walls = {plus: 1, minus: -1}; // by their colours
const overTime = ["x", "relative", "largest", "lambda"];

export class Instrument {
  constructor(axis) {
    Object.assign(this, {axis, answer: null, more: null});
    this.pinned = null; // {answer, motion} of a run to compare with
    const moments = () => this.answer?.impacts.tau ?? [];
    this.plots = new Plots(axis, overTime, ["section", "manifold"], moments);
    axis.onCursor((by) => this.light(by));
    axis.onView(() => this.light());
  }

  /** Of a run: its motion, impacts and exponents. marks: bands and lines over time. */
  set(answer, motion, units, marks) {
    Object.assign(this, {answer, motion, units, more: null});
    this.plots.marks = marks;
  }

  /** What shows it, step by step. */
  drawing() {
    return [
      () => this.begin(),
      () => this.plots.draw("x", this.displacement()),
      () => this.plots.draw("relative", this.relative()),
      () => this.plots.draw("lambda", this.exponents()),
      () => this.plots.draw("section", this.section()),
      () => this.light(),
    ];
  }

  /** What a second answer of the same run brings: eigenvalues, the raw product, the manifold. */
  showMore(more) {
    this.more = more;
    const {plots} = this;
    plots.draw("lambda", this.exponents());
    plots.draw("largest", this.largest());
    plots.draw(
      "manifold",
      manifoldOptions(more.manifold, this.units, (tau) => this.show(tau)),
    );
    this.light();
  }

  /** Moves the cursor. */
  show(tau) {
    this.axis.point(tau, "pick");
  }

  /** A run to compare with, or none. */
  pin(run) {
    this.pinned = run;
    if (this.answer) for (const step of this.drawing()) step();
  }

  /** The motions from..to in mm, that of the pinned run first. */
  traces(from, to, columns) {
    const motions = [this.pinned?.motion, this.motion].filter(Boolean);
    return motions.map((motion) => {
      const {x, gap, ...rest} = motion.trace(from, to, columns);
      return {...rest, x: mm(x), gap: mm(gap)};
    });
  }

  /** The same of what is in view, of which two plots draw a part each. */
  inView(...part) {
    const key = part.join();
    if (this.traced?.key !== key) this.traced = {key, lines: this.traces(...part)};
    return this.traced.lines;
  }

  /** The range of x over the whole run, which a zoom does not change. */
  begin() {
    this.traced = null;
    const lines = this.inView(0, this.motion.end, this.plots.all.x.columns);
    const reach = 1.08 * Math.max(...lines.map(({x}) => most(x) || 1));
    this.rangeOfX = [-reach, reach];
  }

  /**
   * A part of the motion, x or gap, as both plots over time draw it; at(i): where the i-th impact
   * lies.
   */
  partOf(name, label, at) {
    const data = (lines) => [lines[0].tau, ...lines.map((line) => line[name])];
    const trace = (...part) => {
      const lines = this.inView(...part);
      return {data: data(lines), dense: lines.at(-1).dense};
    };
    const samples = (from, to) => {
      const columns = Math.ceil((8 * (to - from)) / this.motion.cycle) + 200;
      return data(this.traces(from, to, Math.min(columns, mostSamples)));
    };
    const series = [{label, colour: "motion"}];
    if (this.pinned) series.unshift({label: `${label}, pinned`, colour: "pinned"});
    const {tau, side} = this.answer.impacts;
    const marks = Object.entries(walls).map(([colour, wall]) => {
      const mine = [...tau.keys()].filter((i) => side[i] === wall);
      return {x: mine.map((i) => tau[i]), y: mine.map(at), colour, shape: "dot", size: 2.2};
    });
    const bare = !alone.matches;
    return {bare, unit: "mm", label: `${label} (mm)`, trace, samples, series, marks};
  }

  displacement() {
    const {x} = this.answer.impacts;
    return {...this.partOf("x", "x", (i) => x[i] * 1000), range: this.rangeOfX};
  }

  relative() {
    const b = this.answer.parameters.b * 1000;
    const {side} = this.answer.impacts;
    return {
      ...this.partOf("gap", "y − x", (i) => -side[i] * b),
      range: [-1.14 * b, 1.14 * b],
      levels: [-b, b],
    };
  }

  largest() {
    const {eigenvalues} = this.more;
    const largest = eigenvalues.T.map((moduli) => positive(moduli[0]));
    return {
      bare: !alone.matches,
      series: [{label: "|μ₁|", colour: "c3", width: 0.8, dots: 4}],
      data: overRun(eigenvalues.tau, [largest], this.motion.end),
      label: "|μ| of T",
      log: true,
      range: logRange([largest]),
      levels: [1],
    };
  }

  /** And beside them the largest as rounding makes it, and that of the pinned run. */
  exponents() {
    const {qr} = this.answer.exponents;
    const lines = exponentLines(qr, this.motion.end);
    const pinned = this.pinned?.answer.exponents.qr?.history;
    const beside = (history, style) => {
      if (!history?.tau.length) return;
      const {tau, lambda1} = history;
      const at = (t) => (t <= tau.at(-1) ? lambda1[lastUpTo(tau, t)] : null) ?? null;
      lines.series.push(style);
      lines.data.push(lines.data[0].map(at));
    };
    beside(this.more?.exponents.raw_product?.history, {
      label: "λ₁ raw product",
      colour: "soft",
      width: 1.2,
      dash: [5, 4],
    });
    beside(pinned, {label: "λ₁ pinned", colour: "pinned", width: 1.6});
    return {...lines, range: exponentRange([qr?.history, pinned])};
  }

  /** After each impact, by wall. */
  section() {
    const {impacts} = this.answer;
    const {velocity} = this.units;
    const place = (of) => ({x: mm(of.x), y: over(of.x_dot_after, velocity)});
    const kinds = Object.entries(walls).map(([name, wall]) => [
      name,
      (i) => impacts.side[i] === wall,
    ]);
    const points = place(impacts);
    const groups = halves(points, kinds);
    const style = {colour: "pinned", label: "pinned", size: 3, alpha: 1};
    if (this.pinned) groups.unshift({...place(this.pinned.answer.impacts), ...style});
    return {
      groups,
      xLabel: "x (mm)",
      yLabel: `x′ after (${velocity.unit})`,
      pick: {...points, use: (i) => this.show(impacts.tau[i])},
    };
  }

  /** Rings the impact nearest to the cursor, and the half cycle that it lies in. */
  light(by) {
    const {answer, plots, more} = this;
    const {cursor} = this.axis;
    if (!answer || cursor === null) return;
    const {impacts, parameters} = answer;
    const i = this.motion.impactNear(cursor);
    const tau = impacts.tau[i];
    const modulus = this.modulusAt(tau);
    plots.all.x.light(tau, impacts.x[i] * 1000);
    plots.all.relative.light(tau, -impacts.side[i] * parameters.b * 1000);
    plots.ring("section", i);
    this.tell(modulus, by === "play");
    if (!more) return;
    plots.all.largest.light(tau, modulus);
    plots.ring("manifold", firstFrom(more.manifold.points.tau, cursor));
  }

  /** The largest modulus of T at an impact, where it is known. */
  modulusAt(tau) {
    const {tau: moments, T} = this.more?.eigenvalues ?? {tau: []};
    const k = firstFrom(moments, tau);
    return moments[k] === tau ? (T?.[k]?.[0] ?? null) : null;
  }

  /** The values at the cursor, beside the title of each plot. */
  tell(modulus, playing) {
    const {cursor} = this.axis;
    const {x, y} = this.motion.at(cursor);
    const values = {
      x: inMm(x, 4),
      relative: inMm(y - x, 4),
      largest: modulus == null ? "" : short(modulus),
    };
    for (const [name, text] of Object.entries(values)) write(`value-${name}`, text);
    if (playing) return; // a reader of the page is not told sixty times a second
    for (const name of overTime)
      aria($(`plot-${name}`), {valuetext: `${this.units.at(cursor)} ${values[name] ?? ""}`});
  }
}

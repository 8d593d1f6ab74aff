// The plots of the first screen: the motion over time, made anew from the impacts for whatever is in
// view, the largest modulus of T, the exponents, the section and the manifold. One cursor goes
// through all of them, and the impact nearest to it is ringed in each.
import {$} from "../shared/dom.js";
import {exponentRange, exponentSeries} from "../shared/exponents.js";
import {LinePlot} from "../shared/line_plot.js";
import {short} from "../shared/numbers.js";
import {operable} from "../shared/operable.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {firstFrom, lastUpTo} from "../shared/search.js";
import {logRange, mm, over, overRun, positive, scaled} from "./columns.js";
import {drawManifold} from "./manifold.js";

const mostSamples = 100000; // of the motion, as numbers
const alone = matchMedia("(max-width: 700px)"); // one plot at a time is on the screen
const wallColours = {1: "plus", [-1]: "minus"};

/** The range of x: the same on both sides of 0, and a margin. */
function around(lines) {
  const most = lines.reduce((a, v) => Math.max(a, Math.abs(v) || 0), 0) || 1;
  return [-1.08 * most, 1.08 * most];
}

/** The moments and the values of the impacts of each wall. */
function byWall({tau, side}, value) {
  return [1, -1].map((wall) => {
    const mine = [];
    for (let i = 0; i < tau.length; ++i) if (side[i] === wall) mine.push(i);
    return {
      x: mine.map((i) => tau[i]),
      y: mine.map(value),
      colour: wallColours[wall],
      shape: "dot",
      size: 2.2,
    };
  });
}

export class Instrument {
  constructor(axis) {
    this.axis = axis;
    const line = (name) => new LinePlot($(`plot-${name}`), axis);
    this.lines = {
      x: line("x"),
      relative: line("relative"),
      largest: line("largest"),
      lambda: line("lambda"),
    };
    this.section = new ScatterPlot($("plot-section"));
    this.manifold = new ScatterPlot($("plot-manifold"));
    this.answer = null;
    this.more = null;
    this.pinned = null; // {answer, motion} of a run to compare with
    for (const [name, plot] of this.plots())
      operable(plot, name, () => this.answer?.impacts.tau ?? []);
    axis.onCursor((by) => this.light(by));
    axis.onView(() => this.light());
  }

  /** Of a run: its motion, impacts and exponents. marks: bands and lines over time. */
  set(answer, motion, units, marks) {
    Object.assign(this, {answer, motion, units, marks, more: null});
  }

  /** What shows it, step by step. */
  drawing() {
    return [
      () => this.ranges(),
      () => this.drawDisplacement(),
      () => this.drawRelative(),
      () => this.drawExponents(),
      () => this.drawSection(),
      () => this.light(),
    ];
  }

  /** What a second answer of the same run brings: eigenvalues, the raw product, the manifold. */
  showMore(more) {
    this.more = more;
    this.drawExponents();
    this.drawLargest();
    drawManifold(this.manifold, more.manifold, this.units, (tau) => this.axis.point(tau, "pick"));
    this.light();
  }

  /** Each with its name. */
  plots() {
    const {lines, section, manifold} = this;
    return Object.entries({...lines, section, manifold});
  }

  redraw() {
    for (const plot of Object.values(this.lines)) plot.refresh();
    this.section.refresh();
    this.manifold.refresh();
  }

  /** x over the whole run, which a zoom does not change. */
  ranges() {
    const {x, other} = this.trace(0, this.motion.end, this.lines.x.columns);
    const most = Math.max(around(x)[1], other ? around(other.x)[1] : 0);
    this.rangeOfX = [-most, most];
  }

  /** A run to compare with, or none. */
  pin(run) {
    this.pinned = run;
    this.traced = null;
    if (this.answer) for (const step of this.drawing()) step();
  }

  /** The motion in view, of which two plots draw a part each. */
  trace(from, to, columns) {
    const key = [from, to, columns].join();
    if (this.traced?.key !== key || this.traced.motion !== this.motion) {
      const of = (motion) => {
        const {x, gap, ...rest} = motion.trace(from, to, columns);
        return {...rest, x: scaled(x, 1000), gap: scaled(gap, 1000)};
      };
      const other = this.pinned && of(this.pinned.motion);
      this.traced = {key, motion: this.motion, ...of(this.motion), other};
    }
    return this.traced;
  }

  /** A line, and before it that of the pinned run. */
  withPinned(line) {
    const pinned = {label: `${line.label}, pinned`, colour: "pinned"};
    return this.pinned ? [pinned, line] : [line];
  }

  /** A part of the motion, x or gap, as both plots over time draw it. */
  partOf(name) {
    const trace = (from, to, columns) => {
      const lines = this.trace(from, to, columns);
      const pinned = lines.other ? [lines.other[name]] : [];
      return {data: [lines.tau, ...pinned, lines[name]], dense: lines.dense};
    };
    const samples = (from, to) => {
      const {motion} = this;
      const columns = Math.min(Math.ceil((8 * (to - from)) / motion.cycle) + 200, mostSamples);
      const runs = [...(this.pinned ? [this.pinned.motion] : []), motion];
      const lines = runs.map((run) => run.trace(from, to, columns));
      return [lines[0].tau, ...lines.map((line) => scaled(line[name], 1000))];
    };
    return {...this.marks, bare: !alone.matches, unit: "mm", trace, samples};
  }

  drawDisplacement() {
    const {impacts} = this.answer;
    this.lines.x.draw({
      ...this.partOf("x"),
      series: this.withPinned({label: "x", colour: "motion"}),
      range: this.rangeOfX,
      label: "x (mm)",
      marks: byWall(impacts, (i) => impacts.x[i] * 1000),
    });
  }

  drawRelative() {
    const {impacts, parameters} = this.answer;
    const b = parameters.b * 1000;
    this.lines.relative.draw({
      ...this.partOf("gap"),
      series: this.withPinned({label: "y − x", colour: "motion"}),
      range: [-1.14 * b, 1.14 * b],
      label: "y − x (mm)",
      levels: [-b, b],
      levelColour: "line",
      marks: byWall(impacts, (i) => -impacts.side[i] * b),
    });
  }

  drawLargest() {
    const {eigenvalues} = this.more;
    const largest = eigenvalues.T.map((moduli) => positive(moduli[0]));
    this.lines.largest.draw({
      ...this.marks,
      bare: !alone.matches,
      series: [{label: "|μ₁|", colour: "c3", width: 0.8, dots: 4}],
      data: overRun(eigenvalues.tau, [largest], this.motion.end),
      label: "|μ| of T",
      log: true,
      range: logRange([largest]),
      levels: [1],
      levelColour: "line",
    });
  }

  drawExponents() {
    const {history, status} = this.answer.exponents.qr ?? {};
    const {series, columns} = exponentSeries(history, status);
    const tau = history?.tau ?? [];
    const lines = history ? columns : columns.map(() => []);
    const raw = this.more?.exponents.raw_product?.history;
    if (raw && raw.tau.length === tau.length) {
      series.push({label: "λ₁ raw product", colour: "soft", width: 1.2, dash: [5, 4]});
      lines.push(raw.lambda1);
    }
    const data = overRun(tau, lines, this.motion.end);
    const pinned = this.pinned?.answer.exponents.qr?.history;
    if (pinned?.tau.length) {
      series.push({label: "λ₁ pinned", colour: "pinned", width: 1.6});
      data.push(data[0].map((t) => pinned.lambda1[lastUpTo(pinned.tau, t)] ?? null));
    }
    this.lines.lambda.draw({
      ...this.marks,
      series,
      data,
      range: exponentRange([history, pinned]),
      label: "λ",
      levels: [0],
      levelColour: "line",
    });
  }

  /** After each impact, by wall; the first half of the run paler: what lasts stands out. */
  drawSection() {
    const {impacts} = this.answer;
    const {velocity} = this.units;
    const x = mm(impacts.x);
    const y = over(impacts.x_dot_after, velocity);
    const middle = x.length / 2;
    const part = (side, late) => {
      const keep = (_, i) => impacts.side[i] === side && i >= middle === late;
      const style = late ? {alpha: 0.75, size: 3} : {alpha: 0.3, size: 2.4};
      return {...style, colour: wallColours[side], x: x.filter(keep), y: y.filter(keep)};
    };
    const other = this.pinned?.answer.impacts;
    const pinned = other && {
      x: mm(other.x),
      y: over(other.x_dot_after, velocity),
      colour: "pinned",
      label: "pinned",
      size: 3,
      alpha: 1,
    };
    this.section.draw({
      groups: [
        ...(pinned ? [pinned] : []),
        part(1, false),
        part(-1, false),
        part(1, true),
        part(-1, true),
      ],
      xLabel: "x (mm)",
      yLabel: `x′ after (${velocity.unit})`,
      pick: {x, y, use: (i) => this.axis.point(impacts.tau[i], "pick")},
    });
    this.sectionPoints = {x, y};
  }

  /** Rings the impact nearest to the cursor, and the half cycle that it lies in. */
  light(by) {
    if (!this.answer || this.axis.cursor === null) return;
    const {impacts, parameters} = this.answer;
    const i = this.motion.impactNear(this.axis.cursor);
    const tau = impacts.tau[i];
    this.lines.x.light(tau, impacts.x[i] * 1000);
    this.lines.relative.light(tau, -impacts.side[i] * parameters.b * 1000);
    this.section.light(this.sectionPoints.x[i], this.sectionPoints.y[i]);
    this.tell(i, by === "play");
    if (!this.more) return;
    this.lines.largest.light(tau, this.modulusAt(tau));
    const {points} = this.more.manifold;
    const half = firstFrom(points.tau, this.axis.cursor);
    const {velocity} = this.units;
    this.manifold.light(velocity.of(points.V[half]), points.C[half] * 1000);
  }

  /** The largest modulus of T at an impact, where it is known. */
  modulusAt(tau) {
    const {tau: moments, T} = this.more?.eigenvalues ?? {tau: []};
    const k = firstFrom(moments, tau);
    return k < moments.length && moments[k] === tau ? T[k][0] : null;
  }

  /** The values at the cursor, beside the title of each plot. */
  tell(i, playing) {
    const {cursor} = this.axis;
    const {x, y} = this.motion.at(cursor);
    const inMm = (v) => `${short(Number((v * 1000).toPrecision(4)))} mm`;
    const modulus = this.modulusAt(this.answer.impacts.tau[i]);
    const values = {
      x: inMm(x),
      relative: inMm(y - x),
      largest: modulus == null ? "" : short(modulus),
    };
    for (const [name, text] of Object.entries(values)) $(`value-${name}`).textContent = text;
    if (playing) return; // a reader of the page is not told sixty times a second
    for (const name of Object.keys(this.lines)) {
      const text = `${this.units.at(cursor)} ${values[name] ?? ""}`;
      $(`plot-${name}`).setAttribute("aria-valuetext", text);
    }
  }
}

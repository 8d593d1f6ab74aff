// The plots of the first screen: the motion over time, made anew from the impacts for whatever is in
// view, the largest modulus of T, the exponents, the section and the manifold. One cursor goes
// through all of them, and the impact nearest to it is ringed in each.
import {$} from "../shared/dom.js";
import {exponentRange, exponentSeries} from "../shared/exponents.js";
import {followKeys} from "../shared/gestures.js";
import {LinePlot} from "../shared/line_plot.js";
import {short} from "../shared/numbers.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {logRange, mm, over, overRun, positive, scaled} from "./columns.js";
import {drawManifold} from "./manifold.js";

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
    const line = (name) => new LinePlot($(`plot-${name}`), {axis});
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
    axis.onCursor((by) => this.light(by));
    axis.onView(() => this.light());
    for (const name of Object.keys(this.lines))
      followKeys($(`plot-${name}`), axis, () => this.answer?.impacts.tau ?? []);
  }

  /** Of a run: its motion, impacts and exponents. marks: bands and lines over time. */
  show(answer, motion, units, marks) {
    Object.assign(this, {answer, motion, units, marks, more: null});
    this.ranges();
    this.drawMotion();
    this.drawExponents();
    this.drawSection();
    this.light();
  }

  /** What a second answer of the same run brings: eigenvalues, the raw product, the manifold. */
  showMore(more) {
    this.more = more;
    this.drawExponents();
    this.drawLargest();
    drawManifold(this.manifold, more.manifold, this.units, (tau) => this.axis.point(tau, "pick"));
    this.light();
  }

  redraw() {
    for (const plot of Object.values(this.lines)) plot.redraw();
    this.section.redraw();
    this.manifold.redraw();
  }

  /** x over the whole run, which a zoom does not change. */
  ranges() {
    const {x} = this.motion.trace(0, this.motion.end, 500);
    this.rangeOfX = around(scaled(x, 1000));
  }

  /** The motion in view, of which two plots draw a part each. */
  trace(from, to, columns) {
    const key = [from, to, columns].join();
    if (this.traced?.key !== key || this.traced.motion !== this.motion) {
      const {x, gap, ...rest} = this.motion.trace(from, to, columns);
      const inMm = {x: scaled(x, 1000), gap: scaled(gap, 1000)};
      this.traced = {key, motion: this.motion, ...rest, ...inMm};
    }
    return this.traced;
  }

  drawMotion() {
    const {impacts, parameters} = this.answer;
    const b = parameters.b * 1000;
    const part = (name) => (from, to, columns) => {
      const lines = this.trace(from, to, columns);
      return {data: [lines.tau, lines[name]], dense: lines.dense};
    };
    const common = {...this.marks, bare: !alone.matches};
    this.lines.x.draw({
      ...common,
      series: [{label: "x", colour: "motion"}],
      trace: part("x"),
      range: this.rangeOfX,
      label: "x (mm)",
      marks: byWall(impacts, (i) => impacts.x[i] * 1000),
    });
    this.lines.relative.draw({
      ...common,
      series: [{label: "y − x", colour: "motion"}],
      trace: part("gap"),
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
    const {exponents} = this.answer;
    const {history, status} = exponents.qr ?? {};
    const {series, columns} = exponentSeries(history, status);
    const raw = this.more?.exponents.raw_product?.history;
    const [tau, ...lines] = history?.tau.length
      ? [history.tau, ...columns]
      : [[], ...columns.map(() => [])];
    if (raw && raw.tau.length === tau.length) {
      series.push({label: "λ₁ raw product", colour: "soft", width: 1.2, dash: [5, 4]});
      lines.push(raw.lambda1);
    }
    this.lines.lambda.draw({
      ...this.marks,
      series,
      data: overRun(tau, lines, this.motion.end),
      range: exponentRange([history]),
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
    this.section.draw({
      groups: [part(1, false), part(-1, false), part(1, true), part(-1, true)],
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
    const {T, tau: moments} = this.more.eigenvalues;
    const k = moments.indexOf(tau);
    this.lines.largest.light(tau, T[k]?.[0]);
    const {points} = this.more.manifold;
    const half = points.tau.findIndex((end) => end >= this.axis.cursor);
    const {velocity} = this.units;
    this.manifold.light(velocity.of(points.V[half]), points.C[half] * 1000);
  }

  /** The values at the cursor, beside the title of each plot. */
  tell(i, playing) {
    const {cursor} = this.axis;
    const {x, y} = this.motion.at(cursor);
    const inMm = (v) => `${short(Number((v * 1000).toPrecision(4)))} mm`;
    const modulus =
      this.more?.eigenvalues.T[this.more.eigenvalues.tau.indexOf(this.answer.impacts.tau[i])];
    const values = {
      x: inMm(x),
      relative: inMm(y - x),
      largest: modulus ? short(modulus[0]) : "",
    };
    for (const [name, text] of Object.entries(values)) $(`value-${name}`).textContent = text;
    if (playing) return; // a reader of the page is not told sixty times a second
    for (const name of Object.keys(this.lines)) {
      const node = $(`plot-${name}`);
      node.setAttribute("aria-valuenow", cursor);
      node.setAttribute("aria-valuetext", `${this.units.at(cursor)} ${values[name] ?? ""}`);
    }
  }
}

// The diagrams over the axis of a sweep, one class each: what they draw, and of what values.
import {colour} from "../shared/colours.js";
import {count, density} from "../shared/density.js";
import {Frame} from "../shared/frame.js";
import {short} from "../shared/numbers.js";
import {Panel} from "../shared/panel.js";
import {
  otherMotion,
  quantities,
  regimeColour,
  regimes,
  verdictColour,
  verdicts,
} from "../shared/quantities.js";
import {quarters} from "./axes.js";

const startColours = ["c1", "before", "c2", "c4", "c3"];
const startColour = (s) => startColours[s % startColours.length];

/** Corners of the symbols of the starts but for the first, a disc, in units of its radius. */
const corners = [
  [],
  [
    [-0.9, -0.9],
    [0.9, -0.9],
    [0.9, 0.9],
    [-0.9, 0.9],
  ],
  [
    [0, -1.25],
    [1.15, 1],
    [-1.15, 1],
  ],
  [
    [0, -1.3],
    [1.3, 0],
    [0, 1.3],
    [-1.3, 0],
  ],
  [
    [0, 1.25],
    [1.15, -1],
    [-1.15, -1],
  ],
];

function symbol(c, start, x, y, r) {
  const list = corners[start % corners.length];
  c.beginPath();
  for (const [dx, dy] of list) c.lineTo(x + dx * r, y + dy * r);
  if (!list.length) c.arc(x, y, r, 0, 2 * Math.PI);
  c.closePath();
  c.fill();
}

const untouched = (p) => p.verdict === null && p.regime === "none";

/** The extent of values and a margin; a logarithmic one keeps above `least`. */
function extent(values, {log = false, from0 = false, least = 0} = {}) {
  let min = from0 ? 0 : Infinity;
  let max = -Infinity;
  for (const v of values) {
    if (!Number.isFinite(v) || (log && v <= least)) continue;
    if (v < min) min = v;
    if (v > max) max = v;
  }
  if (!(min <= max) || (from0 && max <= 0)) return log ? [0.1, 10] : [from0 ? 0 : -1, 1];
  if (log) return [min / 1.3, max * 1.3];
  const margin = (max - min) * 0.06 || Math.abs(max) * 0.06 || 1;
  return [from0 ? 0 : min - margin, max + margin];
}

/** The values of another motion of a point, of those of the point. */
const ofOther = (of) => (p) => {
  const m = otherMotion(p);
  return m && of(m);
};

class Diagram extends Panel {
  /** plots: SweepPlots, whose points are drawn. */
  constructor(container, plots) {
    super(container, plots.axis);
    this.plots = plots;
  }

  click(at, _, place) {
    this.plots.click(this, at, place);
  }

  cursorText() {
    return "";
  }

  prepare(width, height) {
    const {plots} = this;
    if (!plots.places) return null;
    const x = plots.naming.frameAxis(plots.data.axes[0], plots.axis.view);
    return {frame: new Frame(width, height, x, this.y())};
  }

  paint(c, {frame}) {
    frame.draw(c);
    frame.clip(c);
    this.draw(c, frame);
    this.strip(c, frame);
    c.restore();
  }

  /** The value of a point that is drawn as one; null of one that has many. */
  drawn() {
    return null;
  }

  /** Of the dots: smaller where there are many. */
  radius(frame) {
    const [from, to] = this.axis.view;
    const shown = this.plots.places[0].filter(({at}) => at >= from && at <= to).length;
    const room = (frame.width / Math.max(shown, 1)) * 0.62;
    return Math.max(1.3, Math.min(3.4, room)) * (this.plots.several ? 1.15 : 1);
  }

  rule(c, frame, levels, name) {
    c.strokeStyle = colour(name);
    c.lineWidth = 1;
    c.setLineDash([]);
    for (const level of levels) frame.across(c, level);
  }

  /** A line through the points of a start; a failed one, or one without the value, breaks it. */
  line(c, frame, start, of, name, {width = 1, alpha = 1, dash = []} = {}) {
    c.setLineDash(dash);
    Object.assign(c, {strokeStyle: colour(name), lineWidth: width, globalAlpha: alpha});
    c.beginPath();
    let broken = true;
    for (const {p, value} of this.plots.places[start]) {
      const v = p.error ? null : (of(p) ?? null);
      if (v !== null) c[broken ? "moveTo" : "lineTo"](frame.px(value), frame.py(v));
      broken = v === null;
    }
    c.stroke();
    c.setLineDash([]);
    c.globalAlpha = 1;
  }

  /**
   * The best of a point's motions, or one from another start that ends elsewhere, as rings on a
   * thin line.
   */
  rings(c, frame, of) {
    const r = this.radius(frame);
    this.line(c, frame, 0, ofOther(of), "best", {alpha: 0.6});
    c.strokeStyle = colour("best");
    c.lineWidth = 1.5;
    this.plots.each(0, (p, {value}) => {
      const v = ofOther(of)(p);
      if (v === null || v === undefined) return;
      c.beginPath();
      c.arc(frame.px(value), frame.py(v), r, 0, 2 * Math.PI);
      c.stroke();
    });
  }

  dots(c, frame, start, of, nameOfPoint, errorOf = () => null) {
    const r = this.radius(frame);
    c.lineWidth = Math.max(1, r / 2);
    this.plots.each(start, (p, {value}) => {
      const v = of(p) ?? null;
      if (v === null) return;
      const [x, y] = [frame.px(value), frame.py(v)];
      const error = errorOf(p);
      c.fillStyle = c.strokeStyle = colour(nameOfPoint(p));
      if (error) {
        c.globalAlpha = 0.45;
        c.beginPath();
        c.moveTo(x, frame.py(v - error));
        c.lineTo(x, frame.py(v + error));
        c.stroke();
        c.globalAlpha = 1;
      }
      symbol(c, start, x, y, r);
    });
  }

  /** Neighbours of the same regime as one stretch: f(regime, from, to) in pixels. */
  stretches(frame, start, f) {
    const {from: value} = this.plots.data.axes[0];
    const {left, right} = frame.box;
    const px = (at) => Math.min(Math.max(frame.px(value(at)), left), right);
    let open = null;
    const close = () => {
      if (open?.regime && px(open.high) > px(open.low)) f(open.regime, px(open.low), px(open.high));
    };
    for (const {p, low, high} of this.plots.places[start]) {
      const regime = p.error ? null : p.regime;
      if (open?.regime === regime) open.high = high;
      else {
        close();
        open = {regime, low, high};
      }
    }
    close();
  }

  /** The regimes as a narrow strip along the top, a lane for each start. */
  strip(c, frame) {
    for (const s of this.plots.starts())
      this.stretches(frame, s, (regime, from, to) => {
        c.fillStyle = colour(regimeColour(regime));
        c.fillRect(from, frame.box.top + 6 * s, to - from, 5);
      });
  }

  /** {names, columns}: the numbers of what is in view. */
  numbers() {
    const {plots} = this;
    const {parameter} = plots.data.axes[0];
    const [from, to] = this.axis.view;
    const rows = plots
      .starts()
      .flatMap((s) =>
        plots.places[s]
          .filter(({at, p}) => at >= from && at <= to && !p.error)
          .flatMap((place) =>
            this.rows(place).map((row) => [
              plots.naming.number(parameter, place.value),
              s + 1,
              ...row,
            ]),
          ),
      );
    const names = [plots.naming.label(parameter), "start", ...this.names()];
    const kept = names.map((_, i) => i).filter((i) => i !== 1 || plots.several);
    return {
      names: kept.map((i) => names[i]),
      columns: kept.map((i) => rows.map((row) => row[i])),
    };
  }
}

/**
 * How often the section comes to each pixel, as opacity: a periodic orbit is a few full dots, chaos
 * a cloud.
 */
export class SectionDiagram extends Diagram {
  label() {
    const shown = this.plots.coordinate();
    return (this.plots.seconds() ? shown.seconds.label : shown?.label) ?? "";
  }

  /** The coordinate of a point's section. */
  section(p) {
    const {plots} = this;
    return p.section?.[`${plots.choice.coordinate}${plots.seconds() ? "_SI" : ""}`] ?? [];
  }

  *all() {
    for (const p of this.plots.layers.points()) yield* this.section(p);
  }

  y() {
    const shown = this.plots.coordinate();
    const range = shown?.range ?? (shown ? extent(this.all(), shown) : [0, 1]);
    return {range, log: shown?.log, label: this.label(), labels: shown?.turns && quarters};
  }

  draw(c, frame) {
    const shown = this.plots.coordinate();
    if (!shown) return;
    this.rule(c, frame, shown.levels ?? [], "line");
    const {from: value} = this.plots.data.axes[0];
    const {left, top} = frame.box;
    for (const s of this.plots.starts()) {
      const columns = this.plots.places[s]
        .filter(({p}) => !p.error)
        .map(({p, low, high}) => ({
          from: frame.px(value(low)) - left,
          to: frame.px(value(high)) - left,
          values: this.section(p),
        }));
      const counts = count(columns, frame, Boolean(shown.log));
      const image = density(counts, this.plots.several ? startColour(s) : "c1");
      c.drawImage(image, left, top, frame.width, frame.height);
    }
  }

  names() {
    return [this.label()];
  }

  rows({p}) {
    return Array.from(this.section(p), (v) => [v]);
  }

  about() {
    const {plots} = this;
    const n = plots.places[0].length;
    return {
      title: `Section: ${plots.coordinate()?.title ?? ""}`,
      summary: `${this.label()} of the section at ${n} points`,
    };
  }
}

const lambda = (i) => (p) => p.lambda?.[i] ?? null;

export class LambdaDiagram extends Diagram {
  drawn(p) {
    return untouched(p) ? 0 : quantities.lambda1.of(p);
  }

  /** What the axis has to hold of a point. */
  held(p) {
    const [first = null, second] = p.lambda ?? [];
    const error = p.standard_error?.[0] ?? 0;
    if (first === null) return [];
    return [first - error, first + error, second, otherMotion(p)?.lambda?.[0]];
  }

  y() {
    const range = extent([0, ...this.plots.values((p) => this.held(p))]);
    return {range, label: "λ"};
  }

  draw(c, frame) {
    const {several} = this.plots;
    this.rule(c, frame, [0], "soft");
    const errorOf = (p) => p.standard_error?.[0];
    const ofUntouched = (p) => (untouched(p) ? 0 : null);
    for (const s of this.plots.starts()) {
      const name = several ? () => startColour(s) : verdictColour;
      const second = several ? startColour(s) : "second";
      this.line(c, frame, s, lambda(1), second, {alpha: several ? 0.5 : 1});
      this.dots(c, frame, s, lambda(0), name, errorOf);
      this.dots(c, frame, s, ofUntouched, name);
    }
    if (!several) this.rings(c, frame, lambda(0));
  }

  names() {
    return ["λ₁", "standard error", "λ₂", "verdict"];
  }

  rows({p}) {
    const [first, second] = p.lambda ?? [];
    const [error] = p.standard_error ?? [];
    return [[first ?? null, error ?? null, second ?? null, verdicts[p.verdict] ?? "–"]];
  }

  about() {
    const points = this.plots.places[0].map(({p}) => p).filter((p) => p.lambda);
    const chaotic = points.filter((p) => p.verdict === "chaotic").length;
    const values = points.map((p) => p.lambda[0]).filter((v) => v != null);
    const ends = values.length
      ? `λ₁ from ${short(Math.min(...values))} to ${short(Math.max(...values))}; `
      : "";
    return {
      title: "Largest exponent λ₁",
      summary: `${ends}chaotic at ${chaotic} of ${points.length} points`,
    };
  }
}

export class OtherDiagram extends Diagram {
  drawn(p) {
    return this.plots.quantity().of(p);
  }

  y() {
    const {of, levels = [], free = () => null, from0 = false, label} = this.plots.quantity();
    const held = (p) => [of(p), free(p), ofOther(of)(p)];
    const [min, max] = extent(this.plots.values(held), {from0});
    if (!from0) return {range: [min, max], label};
    const most = Math.max(max, Math.min(levels[0] ?? 0, max * 1.5)) * 1.02;
    return {range: [min, most], label};
  }

  /** Pale bands with the regimes' numbers; several starts have none: theirs may differ. */
  bands(c, frame) {
    if (this.plots.several) return;
    const {top} = frame.box;
    c.font = "600 12px system-ui, sans-serif";
    Object.assign(c, {textAlign: "center", textBaseline: "top"});
    this.stretches(frame, 0, (regime, from, to) => {
      c.globalAlpha = 0.2;
      c.fillStyle = colour(regimeColour(regime));
      c.fillRect(from, top, to - from, frame.height);
      c.globalAlpha = 1;
      c.fillStyle = colour("text");
      if (7 * regime.length + 4 < to - from) c.fillText(regime, (from + to) / 2, top + 12);
    });
  }

  draw(c, frame) {
    const {of, levels = [], free} = this.plots.quantity();
    const {several} = this.plots;
    this.bands(c, frame);
    this.rule(c, frame, levels, "line");
    for (const s of this.plots.starts()) {
      const name = several ? startColour(s) : "text";
      this.line(c, frame, s, of, name, {alpha: 0.35});
      this.dots(c, frame, s, of, () => name);
      if (free) this.line(c, frame, s, free, "wall", {width: 1.4, dash: [6, 4]});
    }
    if (!several) this.rings(c, frame, of);
  }

  names() {
    const {label, free} = this.plots.quantity();
    return [label, ...(free ? ["without the absorber"] : []), "regime"];
  }

  rows({p}) {
    const {of, free} = this.plots.quantity();
    return [[of(p), ...(free ? [free(p)] : []), p.regime ?? "–"]];
  }

  about() {
    const {title} = this.plots.quantity();
    const counts = Object.keys(regimes)
      .map((regime) => [regime, this.plots.places[0].filter(({p}) => p.regime === regime).length])
      .filter(([, n]) => n);
    const told = counts.map(([regime, n]) => `${regime === "none" ? "no impacts" : regime}: ${n}`);
    return {title: `Regimes and ${title}`, summary: `points of each regime: ${told.join(", ")}`};
  }
}

/** The keys of the starts: their symbol and state. */
export const startKey = (state, s, naming) => ({
  className: `key start start${s % startColours.length}`,
  style: `color: var(--${startColour(s)})`,
  textContent: `${s + 1}: ${Object.entries(state)
    .map(([name, v]) => naming.place({parameter: name}, v).join(" = "))
    .join(", ")}`,
});

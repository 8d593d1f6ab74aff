// The diagrams over the single axis of a sweep.
import {colour} from "../shared/colours.js";
import {count, density} from "../shared/density.js";
import {rangeOf} from "../shared/frame.js";
import {short} from "../shared/numbers.js";
import {
  coordinates,
  otherMotion,
  quantities,
  quantityOf,
  regimeColour,
  regimes,
  untouched,
  verdictColour,
  verdicts,
} from "../shared/quantities.js";
import {inSeconds} from "../shared/units.js";
import {phaseLabels} from "./axis_labels.js";
import {SweepPlot} from "./sweep_view.js";

const startColours = ["c1", "before", "c2", "c4", "c3"];
const startColour = (s) => startColours[s % startColours.length];

/** Symbols of the starts after the first (a disc): number of corners and first angle. */
const polygons = [
  [0, 0],
  [4, Math.PI / 4],
  [3, -Math.PI / 2],
  [4, 0],
  [3, Math.PI / 2],
];

function trace(c, start, x, y, r) {
  const [n, turn] = polygons[start % polygons.length];
  c.beginPath();
  for (let i = 0; i < n; ++i) {
    const angle = turn + (2 * Math.PI * i) / n;
    c.lineTo(x + 1.3 * r * Math.cos(angle), y + 1.3 * r * Math.sin(angle));
  }
  if (!n) c.arc(x, y, r, 0, 2 * Math.PI);
  c.closePath();
}

/** Applies `of` to the best or second motion of a point. */
const ofOtherMotion = (of) => (p) => {
  const m = otherMotion(p);
  return m && of(m);
};

/** Number of points of each regime: [regime, number]. */
export const countRegimes = (points) =>
  Object.keys(regimes).map((regime) => [regime, points.filter((p) => p?.regime === regime).length]);

/** A plot of `view`, the DiagramView. Subclasses implement y() (as in Frame) and draw(). */
class Diagram extends SweepPlot {
  prepare(width, height) {
    return this.view.byStart ? {frame: this.frameOf(width, height)} : null;
  }

  paint(c, {frame}) {
    frame.draw(c);
    frame.clip(c);
    this.draw(c, frame);
    this.strip(c, frame);
    c.restore();
  }

  /** The value of a point drawn as a single dot; null if it has several. */
  drawn() {
    return null;
  }

  /** Values of all points, a list of each, for the range. */
  values(of) {
    return this.view.places().map(({p}) => of(p));
  }

  /** Colour of a start; `alone` if there is only one. */
  tint(start, alone) {
    return this.view.several ? startColour(start) : alone;
  }

  /** Radius of the dots; smaller where there are many. */
  radius(frame) {
    const {data, several} = this.view;
    const room = (frame.width / Math.max(this.view.visiblePlaces().length / data.starts, 1)) * 0.62;
    return Math.max(1.3, Math.min(3.4, room)) * (several ? 1.15 : 1);
  }

  rule(c, frame, levels, name) {
    c.strokeStyle = colour(name);
    c.lineWidth = 1;
    c.setLineDash([]);
    for (const level of levels) frame.across(c, level);
  }

  /**
   * Positions of a start's points: {p, v, x, y}; v is null for a failed point or without a value.
   */
  spots(frame, start, of) {
    return this.view.byStart[start].map(({p, value}) => {
      const v = p.error ? null : (of(p) ?? null);
      return {p, v, x: frame.px(value), y: frame.py(v)};
    });
  }

  /** A line through the points of a start; missing values interrupt it. */
  line(c, frame, start, of, name, {width = 1, alpha = 1, dash = []} = {}) {
    c.setLineDash(dash);
    Object.assign(c, {strokeStyle: colour(name), lineWidth: width, globalAlpha: alpha});
    c.beginPath();
    let broken = true;
    for (const {v, x, y} of this.spots(frame, start, of)) {
      if (v !== null) c[broken ? "moveTo" : "lineTo"](x, y);
      broken = v === null;
    }
    c.stroke();
    c.setLineDash([]);
    c.globalAlpha = 1;
  }

  /**
   * The best motion of each point, or one from another start that differs, as rings on a thin line.
   * Not drawn for several starts.
   */
  rings(c, frame, of) {
    if (this.view.several) return;
    const r = this.radius(frame);
    this.line(c, frame, 0, ofOtherMotion(of), "best", {alpha: 0.6});
    c.lineWidth = 1.5;
    for (const {v, x, y} of this.spots(frame, 0, ofOtherMotion(of))) {
      if (v === null) continue;
      trace(c, 0, x, y, r);
      c.stroke();
    }
  }

  dots(c, frame, start, nameOf, errorOf = () => null) {
    const r = this.radius(frame);
    c.lineWidth = Math.max(1, r / 2);
    for (const {p, v, x, y} of this.spots(frame, start, (point) => this.drawn({p: point}))) {
      if (v === null) continue;
      const error = errorOf(p);
      c.fillStyle = c.strokeStyle = colour(nameOf(p));
      if (error) {
        c.globalAlpha = 0.45;
        c.beginPath();
        c.moveTo(x, frame.py(v - error));
        c.lineTo(x, frame.py(v + error));
        c.stroke();
        c.globalAlpha = 1;
      }
      trace(c, start, x, y, r);
      c.fill();
    }
  }

  /** Merges neighbours of the same regime: f(regime, from, to) in px. */
  stretches(frame, start, f) {
    const {from: value} = this.view.data.axes[0];
    const {left, right} = frame.box;
    const px = (at) => Math.min(Math.max(frame.px(value(at)), left), right);
    const list = [];
    for (const {p, low, high} of this.view.byStart[start]) {
      const regime = p.regime ?? null;
      const last = list.at(-1);
      if (last?.regime === regime) last.high = high;
      else list.push({regime, low, high});
    }
    for (const {regime, low, high} of list) {
      const [from, to] = [px(low), px(high)];
      if (regime && to > from) f(regime, from, to);
    }
  }

  /** Regimes as a narrow strip along the top, a row for each start. */
  strip(c, frame) {
    for (const s of this.view.starts())
      this.stretches(frame, s, (regime, from, to) => {
        c.fillStyle = colour(regimeColour(regime));
        c.fillRect(from, frame.box.top + 6 * s, to - from, 5);
      });
  }
}

/** A column of a point's section, from SweepData. */
const section = (p, column) => p.section?.[column] ?? [];

/** Density of the section: periodic orbits are a few opaque dots, chaos is a cloud. */
export class SectionDiagram extends Diagram {
  /** The coordinate drawn and its column; velocities can be in mm/s. */
  shown() {
    const {data, choice} = this.view;
    const name = choice.coordinate;
    const own = coordinates[data.section]?.[name] ?? {label: "", title: ""};
    const seconds = data.parameters.si && inSeconds() && own.seconds;
    return {...own, ...(seconds ? {label: seconds.label, column: `${name}_SI`} : {column: name})};
  }

  y() {
    const {column, range, log, least = -Infinity, turns, label} = this.shown();
    const large = (p) => section(p, column).filter((v) => !(v <= least));
    const held = range ?? rangeOf(this.values(large), {log}) ?? (log ? [0.1, 10] : [-1, 1]);
    return {range: held, log, label, labels: turns && phaseLabels};
  }

  draw(c, frame) {
    const {column, levels = [], log = false} = this.shown();
    this.rule(c, frame, levels, "line");
    const {from: value} = this.view.data.axes[0];
    const {left, top} = frame.box;
    for (const s of this.view.starts()) {
      const columns = this.view.byStart[s].map(({p, low, high}) => ({
        from: frame.px(value(low)) - left,
        to: frame.px(value(high)) - left,
        values: section(p, column),
      }));
      const image = density(count(columns, frame, log), this.tint(s, "c1"));
      c.drawImage(image, left, top, frame.width, frame.height);
    }
  }

  columns() {
    return {[this.shown().label]: null};
  }

  rows(p) {
    return Array.from(section(p, this.shown().column), (v) => [v]);
  }

  about() {
    const {title, label} = this.shown();
    const n = this.view.byStart[0].length;
    return {
      title: `Section: ${title}`,
      summary: `${label} of the section at ${n} points`,
    };
  }
}

const lambda = (i) => (p) => p.lambda?.[i] ?? null;
const errorOf = (p) => p.standard_error?.[0] ?? null;

export class LambdaDiagram extends Diagram {
  drawn({p}) {
    return untouched(p) ? 0 : quantities.lambda1.of(p);
  }

  y() {
    const held = (p) => {
      const first = lambda(0)(p);
      const error = errorOf(p);
      return first === null
        ? []
        : [first - error, first + error, lambda(1)(p), ofOtherMotion(lambda(0))(p)];
    };
    return {range: rangeOf([[0], ...this.values(held)]), label: "λ"};
  }

  draw(c, frame) {
    this.rule(c, frame, [0], "soft");
    const alpha = this.view.several ? 0.5 : 1;
    for (const s of this.view.starts()) {
      this.line(c, frame, s, lambda(1), this.tint(s, "second"), {alpha});
      this.dots(c, frame, s, (p) => this.tint(s, verdictColour(p)), errorOf);
    }
    this.rings(c, frame, lambda(0));
  }

  columns() {
    return {
      "λ₁": lambda(0),
      "standard error": errorOf,
      "λ₂": lambda(1),
      verdict: (p) => verdicts[p.verdict] ?? "–",
    };
  }

  about() {
    const points = this.view.byStart[0].map(({p}) => p).filter((p) => p.lambda);
    const chaotic = points.filter((p) => p.verdict === "chaotic").length;
    const values = points.map(lambda(0)).filter((v) => v !== null);
    const ends = values.length
      ? `λ₁ from ${short(Math.min(...values))} to ${short(Math.max(...values))}; `
      : "";
    return {
      title: "Largest exponent λ₁",
      summary: `${ends}chaotic at ${chaotic} of ${points.length} points`,
    };
  }
}

export class QuantityDiagram extends Diagram {
  quantity() {
    return quantityOf(this.view.choice.quantity, this.view.data);
  }

  drawn({p}) {
    return this.quantity().of(p);
  }

  y() {
    const {of, levels = [], free = () => null, from0, label} = this.quantity();
    const held = (p) => [of(p), free(p), ofOtherMotion(of)(p)];
    const [min, max] = rangeOf([from0 ? [0] : [], ...this.values(held)]) ?? [-1, 1];
    if (!from0) return {range: [min, max], label};
    const most = Math.max(max, Math.min(levels[0] ?? 0, max * 1.5)) * 1.02;
    return {range: [0, most], label};
  }

  /** Pale bands labelled with the regimes; omitted for several starts, whose regimes can differ. */
  bands(c, frame) {
    if (this.view.several) return;
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
    const {of, levels = [], free} = this.quantity();
    this.bands(c, frame);
    this.rule(c, frame, levels, "line");
    for (const s of this.view.starts()) {
      const name = this.tint(s, "text");
      this.line(c, frame, s, of, name, {alpha: 0.35});
      this.dots(c, frame, s, () => name);
      if (free) this.line(c, frame, s, free, "wall", {width: 1.4, dash: [6, 4]});
    }
    this.rings(c, frame, of);
  }

  columns() {
    const {label, of, free} = this.quantity();
    return {
      [label]: of,
      ...(free && {"without the absorber": free}),
      regime: (p) => p.regime ?? "–",
    };
  }

  about() {
    const counts = countRegimes(this.view.byStart[0].map(({p}) => p)).filter(([, n]) => n);
    const texts = counts.map(([regime, n]) => `${regime === "none" ? regimes.none : regime}: ${n}`);
    const {title} = this.quantity();
    return {title: `Regimes and ${title}`, summary: `points of each regime: ${texts.join(", ")}`};
  }
}

/** Legend entry of a start: its symbol and state. */
export const startKey = (state, s, labels) => ({
  className: `key start start${s % startColours.length}`,
  style: `color: var(--${startColour(s)})`,
  textContent: `${s + 1}: ${labels.fields(state)}`,
});

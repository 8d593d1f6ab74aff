// The diagrams over the axis of a sweep, one class each: what they draw, and of what values.
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
import {quarters} from "./axes.js";
import {SweepPanel} from "./view.js";

const startColours = ["c1", "before", "c2", "c4", "c3"];
const startColour = (s) => startColours[s % startColours.length];

/** Corners of the symbols of the starts but for the first, a disc: how many, and where they begin. */
const polygons = [
  [0, 0],
  [4, Math.PI / 4],
  [3, -Math.PI / 2],
  [4, 0],
  [3, Math.PI / 2],
];

/** The symbol of a start as a path. */
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

/** The values of another motion of a point, of those of the point. */
const ofOther = (of) => (p) => {
  const m = otherMotion(p);
  return m && of(m);
};

/** How many of some points are of each regime: [regime, number]. */
export const countRegimes = (points) =>
  Object.keys(regimes).map((regime) => [regime, points.filter((p) => p?.regime === regime).length]);

/** view: SweepPlots, whose points are drawn. Who extends this has y(), as of a Frame, and draw(). */
class Diagram extends SweepPanel {
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

  /** The value of a point that is drawn as one; null of one that has many. */
  drawn() {
    return null;
  }

  /** The values of all points, a list of each, for a range. */
  values(of) {
    return this.view.places().map(({p}) => of(p));
  }

  /** The colour of a start, or what a single one has in its place. */
  tint(start, alone) {
    return this.view.several ? startColour(start) : alone;
  }

  /** Of the dots: smaller where there are many. */
  radius(frame) {
    const {data, several} = this.view;
    const room = (frame.width / Math.max(this.view.seen().length / data.starts, 1)) * 0.62;
    return Math.max(1.3, Math.min(3.4, room)) * (several ? 1.15 : 1);
  }

  rule(c, frame, levels, name) {
    c.strokeStyle = colour(name);
    c.lineWidth = 1;
    c.setLineDash([]);
    for (const level of levels) frame.across(c, level);
  }

  /** Where the points of a start lie: {p, v, x, y}, v null where one failed or has no value. */
  spots(frame, start, of) {
    return this.view.byStart[start].map(({p, value}) => {
      const v = p.error ? null : (of(p) ?? null);
      return {p, v, x: frame.px(value), y: frame.py(v)};
    });
  }

  /** A line through the points of a start; one without the value breaks it. */
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
   * The best of a point's motions, or one from another start that ends elsewhere, as rings on a
   * thin line; several starts have none.
   */
  rings(c, frame, of) {
    if (this.view.several) return;
    const r = this.radius(frame);
    this.line(c, frame, 0, ofOther(of), "best", {alpha: 0.6});
    c.lineWidth = 1.5;
    for (const {v, x, y} of this.spots(frame, 0, ofOther(of))) {
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

  /** Neighbours of the same regime as one stretch: f(regime, from, to) in pixels. */
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

  /** The regimes as a narrow strip along the top, a lane for each start. */
  strip(c, frame) {
    for (const s of this.view.starts())
      this.stretches(frame, s, (regime, from, to) => {
        c.fillStyle = colour(regimeColour(regime));
        c.fillRect(from, frame.box.top + 6 * s, to - from, 5);
      });
  }
}

/** A column of a point's section, as seen in SweepData. */
const section = (p, column) => p.section?.[column] ?? [];

/**
 * How often the section comes to each pixel, as opacity: a periodic orbit is a few full dots, chaos
 * a cloud.
 */
export class SectionDiagram extends Diagram {
  /** The coordinate that is drawn, and its column; velocities may be in mm/s. */
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
    return {range: held, log, label, labels: turns && quarters};
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
        : [first - error, first + error, lambda(1)(p), ofOther(lambda(0))(p)];
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

export class OtherDiagram extends Diagram {
  quantity() {
    return quantityOf(this.view.choice.quantity, this.view.data);
  }

  drawn({p}) {
    return this.quantity().of(p);
  }

  y() {
    const {of, levels = [], free = () => null, from0, label} = this.quantity();
    const held = (p) => [of(p), free(p), ofOther(of)(p)];
    const [min, max] = rangeOf([from0 ? [0] : [], ...this.values(held)]) ?? [-1, 1];
    if (!from0) return {range: [min, max], label};
    const most = Math.max(max, Math.min(levels[0] ?? 0, max * 1.5)) * 1.02;
    return {range: [0, most], label};
  }

  /** Pale bands with the regimes' numbers; several starts have none: theirs may differ. */
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
    const told = counts.map(([regime, n]) => `${regime === "none" ? regimes.none : regime}: ${n}`);
    const {title} = this.quantity();
    return {title: `Regimes and ${title}`, summary: `points of each regime: ${told.join(", ")}`};
  }
}

/** The keys of the starts: their symbol and state. */
export const startKey = (state, s, naming) => ({
  className: `key start start${s % startColours.length}`,
  style: `color: var(--${startColour(s)})`,
  textContent: `${s + 1}: ${naming.fields(state)}`,
});

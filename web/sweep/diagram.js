// A sweep over one axis: the bifurcation diagram of its section, lambda1, and another quantity with
// the regimes, stacked. They share the axis and the tooltip.
import {rangeOf} from "../shared/frame.js";
import {blocks, density, dots, levels, line} from "../shared/marks.js";
import {clamp, short} from "../shared/numbers.js";
import {
  coordinates,
  describe,
  otherMotion,
  quantities,
  quantityOf,
  regimeColour,
  regimes,
  startNames,
  untouched,
  verdictColour,
  verdicts,
} from "../shared/quantities.js";
import {inSeconds} from "../shared/units.js";
import {Viewport} from "../shared/viewport.js";
import * as labels from "./axis_labels.js";
import {stretches} from "./data.js";
import {missingPoint, SweepPlot, SweepView} from "./sweep_view.js";

const startColours = ["c1", "minus", "c2", "c4", "c3"];
const startColour = (s) => startColours[s % startColours.length];

const startShapes = ["dot", "box", "triangle", "diamond", "pointed"];

/** Applies `of` to the best or second motion of a point. */
const ofOtherMotion = (of) => (p) => {
  const m = otherMotion(p);
  return m && of(m);
};

/** Number of points of each regime: [regime, number]. */
export const countRegimes = (points) =>
  Object.keys(regimes).map((regime) => [regime, points.filter((p) => p?.regime === regime).length]);

/** A plot of `view`, the DiagramView. Subclasses implement y() (as in Frame) and marks(frame). */
class Diagram extends SweepPlot {
  prepare(width, height) {
    if (!this.view.byStart) return null;
    const frame = this.frameOf(width, height);
    return {frame, marks: [...this.marks(frame), ...this.strips()]};
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
    return clamp(room, 1.3, 3.4) * (several ? 1.15 : 1);
  }

  /** {x, y} of a start's points; y is null for a failed point or without a value. */
  columnsOf(start, of) {
    const places = this.view.byStart[start];
    const y = places.map(({p}) => (p.error ? null : (of(p) ?? null)));
    return {x: places.map(({value}) => value), y};
  }

  line(start, of, colour, more) {
    return line({...this.columnsOf(start, of), colour, ...more});
  }

  /** Dots of a start, in the colours nameOf(point) and with bars of errorOf(point). */
  dots(frame, start, nameOf, errorOf = () => null) {
    const [tints, errors] = [nameOf, errorOf].map((of) =>
      this.view.byStart[start].map(({p}) => of(p)),
    );
    const shape = startShapes[start % startShapes.length];
    const columns = this.columnsOf(start, (p) => this.drawn({p}));
    return dots({...columns, tints, errors, shape, size: this.radius(frame)});
  }

  /**
   * The best motion of each point, or one from another start that differs, as rings on a thin line.
   * Not drawn for several starts.
   */
  rings(frame, of) {
    if (this.view.several) return [];
    const columns = {...this.columnsOf(0, ofOtherMotion(of)), colour: "best"};
    const ring = {shape: "ring", size: this.radius(frame), width: 1.5};
    return [line({...columns, alpha: 0.6}), dots({...columns, ...ring})];
  }

  /** Stretches of the same regime of a start, as a list for blocks(). */
  stretches(start) {
    const {from: value} = this.view.data.axes[0];
    return stretches(this.view.byStart[start])
      .filter(({regime}) => regime)
      .map(({regime, from, to}) => ({
        from: value(from),
        to: value(to),
        colour: regimeColour(regime),
        hatched: regime === "none",
        regime,
      }));
  }

  /** Regimes as a narrow strip along the top, a row for each start. */
  strips() {
    return this.view.starts().map((s) => blocks({list: this.stretches(s), down: 6 * s, height: 5}));
  }
}

const turns = ["0", "π/2", "π", "3π/2", "2π"];
/** Labels of a phase axis at quarter turns. */
const phaseLabels = (min, max) =>
  turns
    .map((text, i) => ({at: (i * Math.PI) / 2, text}))
    .filter(({at}) => at >= min - 1e-9 && at <= max + 1e-9);

/** A column of a point's section, from SweepData. */
const section = (p, column) => p.section?.[column] ?? [];

/** Density of the section: periodic orbits are a few opaque dots, chaos is a cloud. */
class SectionDiagram extends Diagram {
  /** The coordinate drawn and its column; velocities can be in mm/s. */
  shown() {
    const {data, choice} = this.view;
    const name = choice.coordinate;
    const own = coordinates[data.section]?.[name] ?? {label: "", title: ""};
    const seconds = data.parameters.si && inSeconds() && own.seconds;
    return {...own, ...(seconds ? {label: seconds.label, column: `${name}_SI`} : {column: name})};
  }

  y() {
    const {column, range, log, least = -Infinity, turns: phase, label} = this.shown();
    const large = (p) => section(p, column).filter((v) => !(v <= least));
    const held = range ?? rangeOf(this.values(large), {log}) ?? (log ? [0.1, 10] : [-1, 1]);
    return {range: held, log, label, labels: phase && phaseLabels};
  }

  marks() {
    const {column, levels: y = []} = this.shown();
    const {from: value} = this.view.data.axes[0];
    const cell = ({p, low, high}) => ({
      from: value(low),
      to: value(high),
      values: section(p, column),
    });
    const ofStart = (s) =>
      density({columns: this.view.byStart[s].map(cell), colour: this.tint(s, "c1")});
    return [levels({y}), ...this.view.starts().map(ofStart)];
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

class LambdaDiagram extends Diagram {
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

  marks(frame) {
    const alpha = this.view.several ? 0.5 : 1;
    const ofStart = (s) => {
      const colour = (p) => this.tint(s, verdictColour(p));
      return [
        this.line(s, lambda(1), this.tint(s, "second"), {alpha}),
        this.dots(frame, s, colour, errorOf),
      ];
    };
    const zero = levels({y: 0, colour: "soft"});
    return [zero, ...this.view.starts().flatMap(ofStart), ...this.rings(frame, lambda(0))];
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

class QuantityDiagram extends Diagram {
  quantity() {
    return quantityOf(this.view.choice.beside, this.view.data);
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
  bands() {
    if (this.view.several) return [];
    const list = this.stretches(0).map((one) => ({...one, text: one.regime}));
    return [blocks({list, alpha: 0.2, textDown: 12, size: 12})];
  }

  marks(frame) {
    const {of, levels: y = [], free} = this.quantity();
    const ofStart = (s) => {
      const name = this.tint(s, "text");
      const marks = [this.line(s, of, name, {alpha: 0.35}), this.dots(frame, s, () => name)];
      if (free) marks.push(this.line(s, free, "wall", {width: 1.4, dash: [6, 4]}));
      return marks;
    };
    const ofStarts = this.view.starts().flatMap(ofStart);
    return [...this.bands(), levels({y}), ...ofStarts, ...this.rings(frame, of)];
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
export const startKey = (state, s) => ({
  className: `key start start${s % startColours.length}`,
  style: `color: var(--${startColour(s)})`,
  textContent: `${s + 1}: ${labels.fields(state)}`,
});

/** Steps of the keys along the axis. */
const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

/** The first place with the smallest distance away(place). */
const closest = (places, away) =>
  places.reduce((best, place) => (away(place) < away(best) ? place : best), places[0]);

export class DiagramView extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Viewport()], ...rest);
    this.plots = [
      new SectionDiagram(this, "section"),
      new LambdaDiagram(this, "lambda"),
      new QuantityDiagram(this, "other"),
    ];
  }

  refresh(choice) {
    this.byStart = this.starts().map((s) => this.layers.places(s));
    super.refresh(choice);
  }

  starts() {
    return Array.from({length: this.data.starts}, (_, s) => s);
  }

  get several() {
    return this.data.starts > 1;
  }

  places() {
    return this.byStart.flat().filter(({p}) => !p.error);
  }

  /** The points of all starts at a place; undefined where one is missing. */
  placesAt({at: [at]}) {
    return this.byStart.map((list) => list.find((place) => place.at[0] === at));
  }

  /**
   * The nearest point of the first start or, given a height in px, of the start drawn nearest to
   * it.
   */
  nearest({plot, at, top}) {
    const place = closest(this.byStart[0], (other) => Math.abs(other.at[0] - at[0]));
    if (!place || top === undefined) return place;
    const away = (other) => {
      const v = other.p.error ? null : plot.drawn(other);
      return v == null ? Infinity : Math.abs(plot.frame.py(v) - plot.frame.box.top - top);
    };
    return closest(this.placesAt(place).filter(Boolean), away);
  }

  /** Tooltip rows of each start; at most five each when there are several. */
  rowsOf(place) {
    const {data, several} = this;
    const rows = this.placesAt(place).map((found, s) => {
      const own = found ? describe(found.p, labels.where(data)) : missingPoint;
      return several ? [[`start ${s + 1}`, ""], ...own.slice(0, 5)] : own;
    });
    return [labels.place(data.axes[0], place.value), ...rows.flat()];
  }

  startOf({p, data}) {
    const {start} = data.defaultSet ? p : {};
    return start ? `, from its start: ${startNames[start]}` : super.startOf({data});
  }

  move(key) {
    if (!(key in steps)) return false;
    const [list] = this.byStart;
    const i = this.current ? list.indexOf(this.nearest(this.current)) : -1;
    const next = Math.max(0, Math.min(list.length - 1, i + steps[key]));
    if (list.length) this.goTo(...list[next].at);
    return true;
  }
}

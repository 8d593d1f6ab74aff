// A sweep over one axis: its section, lambda1, and another quantity with the regimes, stacked.
import {rangeOf} from "../shared/frame.js";
import {levels} from "../shared/marks.js";
import {clamp, short} from "../shared/numbers.js";
import * as q from "../shared/quantities.js";
import {inSeconds} from "../shared/units.js";
import {Viewport} from "../shared/viewport.js";
import * as labels from "./axis_labels.js";
import {dotsOf, lineOf, regimesOf, sectionOf} from "./points.js";
import {missingPoint, SweepPlot, SweepView} from "./sweep_view.js";

const startStyles = [
  {colour: "c1", shape: "dot", mark: "●"},
  {colour: "minus", shape: "box", mark: "■"},
  {colour: "c2", shape: "triangle", mark: "▲"},
  {colour: "c4", shape: "diamond", mark: "◆"},
  {colour: "c3", shape: "pointed", mark: "▼"},
];
export const startStyle = (s) => startStyles[s % startStyles.length];

/** Applies `of` to the best or second motion of a point. */
const ofOtherMotion = (of) => (p) => {
  const m = q.otherMotion(p);
  return m && of(m);
};

/** Number of points of each regime: [regime, number]. */
export function countRegimes(points) {
  const count = (regime) => points.filter((p) => p?.regime === regime).length;
  return Object.keys(q.regimes).map((regime) => [regime, count(regime)]);
}

/** A plot of a DiagramView. kind: its methods y() (as in Frame), marks(frame), and of a SweepPlot. */
class Diagram extends SweepPlot {
  constructor(view, name, kind) {
    super(view, name);
    Object.assign(this, kind);
  }

  prepare(width, height) {
    if (!this.view.byStart) return null;
    const frame = this.frameOf(width, height);
    const strips = this.view.starts().map((s) => this.regimes(s, {down: 6 * s, height: 5}));
    return {frame, marks: [...this.marks(frame), ...strips]};
  }

  /** Values of all points, a list of each, for the range. */
  values(of) {
    return this.view.places().map(({p}) => of(p));
  }

  /** Colour of a start; `alone` if there is only one. */
  tint(start, alone) {
    return this.view.several ? startStyle(start).colour : alone;
  }

  line(start, of, colour, more) {
    return lineOf(this.view.byStart[start], of, colour, more);
  }

  /** Dots of a start, in the colours tint(point); smaller where there are many. */
  dots(frame, start, of, more) {
    const {data, several} = this.view;
    const count = this.view.visiblePlaces().length / data.starts;
    const size = clamp((0.62 * frame.width) / Math.max(count, 1), 1.3, 3.4) * (several ? 1.15 : 1);
    const {shape} = startStyle(start);
    return dotsOf(this.view.byStart[start], of, {shape, size, ...more});
  }

  /** The best motion of each point, or one from another start that differs, as rings on a line. */
  rings(frame, of) {
    if (this.view.several) return [];
    const other = ofOtherMotion(of);
    const ring = {tint: () => "best", shape: "ring", width: 1.5};
    return [this.line(0, other, "best", {alpha: 0.6}), this.dots(frame, 0, other, ring)];
  }

  regimes(start, more) {
    return regimesOf(this.view.byStart[start], this.view.data.axes[0], more);
  }

  get points() {
    return this.view.byStart[0].map(({p}) => p);
  }
}

const turns = ["0", "π/2", "π", "3π/2", "2π"];
/** Labels of a phase axis at quarter turns. */
const phaseLabels = (min, max) =>
  turns
    .map((text, i) => ({at: (i * Math.PI) / 2, text}))
    .filter(({at}) => at >= min - 1e-9 && at <= max + 1e-9);

const sectionDiagram = {
  drawn: () => null, // several values
  /** The coordinate drawn and its column; velocities can be in mm/s. */
  shown() {
    const {data, choice} = this.view;
    const name = choice.coordinate;
    const own = q.coordinates[data.section]?.[name] ?? {label: "", title: ""};
    const seconds = data.parameters.si && inSeconds() && own.seconds;
    return {...own, ...(seconds ? {label: seconds.label, column: `${name}_SI`} : {column: name})};
  },
  y() {
    const {column, range, log, least = -Infinity, turns: phase, label} = this.shown();
    const large = (p) => p.section?.[column]?.filter((v) => !(v <= least)) ?? [];
    const held = range ?? rangeOf(this.values(large), log) ?? (log ? [0.1, 10] : [-1, 1]);
    return {range: held, log, label, labels: phase && phaseLabels};
  },
  marks() {
    const {column, levels: y = []} = this.shown();
    const [axis] = this.view.data.axes;
    const ofStart = (s) => sectionOf(this.view.byStart[s], axis, column, this.tint(s, "c1"));
    return [levels({y}), ...this.view.starts().map(ofStart)];
  },
  columns() {
    return {[this.shown().label]: null};
  },
  rows(p) {
    return Array.from(p.section?.[this.shown().column] ?? [], (v) => [v]);
  },
  words() {
    const {title, label} = this.shown();
    const summary = `${label} of the section at ${this.points.length} points`;
    return {title: `Section: ${title}`, summary};
  },
};

const lambda = (i) => (p) => p.lambda?.[i] ?? null;
const errorOf = (p) => p.standard_error?.[0] ?? null;
const drawnLambda = (p) => (q.untouched(p) ? 0 : lambda(0)(p));

const lambdaDiagram = {
  drawn: ({p}) => drawnLambda(p),
  y() {
    const held = (p) => {
      const [first, error] = [lambda(0)(p), errorOf(p)];
      if (first === null) return [];
      return [first - error, first + error, lambda(1)(p), ofOtherMotion(lambda(0))(p)];
    };
    return {range: rangeOf([[0], ...this.values(held)]), label: "λ"};
  },
  marks(frame) {
    const alpha = this.view.several ? 0.5 : 1;
    const ofStart = (s) => {
      const tint = (p) => this.tint(s, q.verdictColour(p));
      return [
        this.line(s, lambda(1), this.tint(s, "second"), {alpha}),
        this.dots(frame, s, drawnLambda, {tint, error: errorOf}),
      ];
    };
    const zero = levels({y: 0, colour: "soft"});
    return [zero, ...this.view.starts().flatMap(ofStart), ...this.rings(frame, lambda(0))];
  },
  columns: () => ({
    "λ₁": lambda(0),
    "standard error": errorOf,
    "λ₂": lambda(1),
    verdict: (p) => q.verdicts[p.verdict] ?? "–",
  }),
  words() {
    const points = this.points.filter((p) => p.lambda);
    const chaotic = points.filter((p) => p.verdict === "chaotic").length;
    const values = points.map(lambda(0)).filter((v) => v !== null);
    const [least, most] = [Math.min(...values), Math.max(...values)].map(short);
    const ends = values.length ? `λ₁ from ${least} to ${most}; ` : "";
    const summary = `${ends}chaotic over the measured cycles at ${chaotic} of ${points.length} points`;
    return {title: "Largest exponent λ₁", summary};
  },
};

const quantityDiagram = {
  quantity() {
    return q.quantityOf(this.view.choice.beside, this.view.data);
  },
  drawn({p}) {
    return this.quantity().of(p);
  },
  y() {
    const {of, levels = [], free = () => null, from0, label} = this.quantity();
    const held = (p) => [of(p), free(p), ofOtherMotion(of)(p)];
    const [min, max] = rangeOf([from0 ? [0] : [], ...this.values(held)]) ?? [-1, 1];
    if (!from0) return {range: [min, max], label};
    const most = Math.max(max, Math.min(levels[0] ?? 0, max * 1.5)) * 1.02;
    return {range: [0, most], label};
  },
  marks(frame) {
    const {of, levels: y = [], free} = this.quantity();
    const ofStart = (s) => {
      const name = this.tint(s, "text");
      const dots = this.dots(frame, s, of, {tint: () => name});
      const without = free ? [this.line(s, free, "wall", {width: 1.4, dash: [6, 4]})] : [];
      return [this.line(s, of, name, {alpha: 0.35}), dots, ...without];
    };
    // Labelled bands of the regimes; omitted for several starts, whose regimes can differ.
    const named = {alpha: 0.2, textDown: 12, size: 12, texts: true};
    const bands = this.view.several ? [] : [this.regimes(0, named)];
    const ofStarts = this.view.starts().flatMap(ofStart);
    return [...bands, levels({y}), ...ofStarts, ...this.rings(frame, of)];
  },
  columns() {
    const {label, of, free} = this.quantity();
    const without = free && {"without the absorber": free};
    return {[label]: of, ...without, regime: (p) => p.regime ?? "–"};
  },
  words() {
    const texts = countRegimes(this.points)
      .filter(([, n]) => n)
      .map(([regime, n]) => `${regime === "none" ? q.regimes.none : regime}: ${n}`);
    const summary = `points of each regime: ${texts.join(", ")}`;
    return {title: `Regimes and ${this.quantity().title}`, summary};
  },
};

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
    const kinds = {section: sectionDiagram, lambda: lambdaDiagram, other: quantityDiagram};
    this.plots = Object.entries(kinds).map(([name, kind]) => new Diagram(this, name, kind));
  }

  refresh(choice) {
    this.byStart = this.starts().map((s) => this.layers.places(s));
    super.refresh(choice);
  }

  starts() {
    return [...Array(this.data.starts).keys()];
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

  /** The nearest point of the first start or, given a height, of the start drawn nearest to it. */
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
      const own = found ? q.describe(found.p, labels.where(data)) : missingPoint;
      return several ? [[`start ${s + 1}`, ""], ...own.slice(0, 5)] : own;
    });
    return [labels.place(data.axes[0], place.value), ...rows.flat()];
  }

  startOf({p, data}) {
    const {start} = data.defaultSet ? p : {};
    return start ? `, from its start: ${q.startNames[start]}` : super.startOf({data});
  }

  move(key) {
    if (!(key in steps)) return false;
    const [list] = this.byStart;
    const i = this.current ? list.indexOf(this.nearest(this.current)) : -1;
    if (list.length) this.goTo(...list[clamp(i + steps[key], 0, list.length - 1)].at);
    return true;
  }
}

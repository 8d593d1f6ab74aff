// A sweep over one axis: its section, lambda1, and another quantity with the regimes, stacked.
import {extent, least} from "d3-array";
import {rangeOf} from "../shared/frame.js";
import {levels} from "../shared/marks.js";
import {clamp, short} from "../shared/numbers.js";
import * as q from "../shared/quantities.js";
import {Viewport} from "../shared/viewport.js";
import * as labels from "./axis_labels.js";
import {placesOf} from "./data.js";
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

/** Labels of a phase axis at quarter turns. */
const quarters = ["0", "π/2", "π", "3π/2", "2π"].map((text, i) => ({at: (i * Math.PI) / 2, text}));

/** A coordinate of the section. */
function section(view) {
  const {data, choice} = view;
  const own = q.coordinates[data.section]?.[choice.coordinate];
  const chosen = {...own, ...(data.parameters.si && own?.si)};
  const {title, label, range, log, least: lowest = -Infinity, levels: y = []} = chosen;
  const of = q.valuesOf(chosen);
  const large = (p) => of(p).filter((v) => !(v <= lowest));
  const held = range ?? rangeOf(view.values(large), log) ?? (log ? [0.1, 10] : [-1, 1]);
  const ofStart = (places, s) => sectionOf(places, data.axes[0], of, view.tint(s, "c1"));
  return {
    title: `Section: ${title}`,
    summary: `${label} of the section at ${view.points.length} points`,
    y: {range: held, log, label, labels: chosen.turns && quarters},
    marks: [levels({y}), ...view.byStart.map(ofStart)],
    height: () => null, // several values
    columns: {[label]: null},
    rows: (p) => Array.from(of(p), (v) => [Number.isNaN(v) ? null : v]),
  };
}

const lambda2 = (p) => p.lambda?.[1] ?? null;
const {lambda1, errorOf} = q;
const drawnLambda = (p) => (q.untouched(p) ? 0 : lambda1(p));

function lambda(view) {
  const held = (p) => {
    const [first, error] = [lambda1(p), errorOf(p)];
    if (first === null) return [];
    return [first - error, first + error, lambda2(p), ofOtherMotion(lambda1)(p)];
  };
  const alpha = view.several ? 0.5 : 1;
  const ofStart = (places, s) => {
    const tint = (p) => view.tint(s, q.verdictColour(p));
    return [
      lineOf(places, lambda2, view.tint(s, "second"), {alpha}),
      view.dots(s, drawnLambda, {tint, error: errorOf}),
    ];
  };
  const points = view.points.filter((p) => p.lambda);
  const chaotic = points.filter((p) => p.verdict === "chaotic").length;
  const [from, to] = extent(points, lambda1);
  const ends = from === undefined ? "" : `λ₁ from ${short(from)} to ${short(to)}; `;
  return {
    title: "Largest exponent λ₁",
    summary: `${ends}chaotic over the measured cycles at ${chaotic} of ${points.length} points`,
    y: {range: rangeOf([[0], ...view.values(held)]), label: "λ"},
    marks: [
      levels({y: 0, colour: "soft"}),
      ...view.byStart.flatMap(ofStart),
      ...view.rings(lambda1),
    ],
    height: ({p}) => drawnLambda(p),
    columns: {
      "λ₁": lambda1,
      "standard error": errorOf,
      "λ₂": lambda2,
      verdict: (p) => q.verdicts[p.verdict] ?? "–",
    },
  };
}

/** The range of a quantity that starts at 0, with its first level where that is near. */
const from0Range = ([, max], level = 0) => [0, Math.max(max, Math.min(level, max * 1.5)) * 1.02];

function quantity(view) {
  const chosen = q.quantityOf(view.choice.beside, view.data);
  const {of, levels: y = [], free, from0 = true, label, title} = chosen;
  const held = (p) => [of(p), free?.(p) ?? null, ofOtherMotion(of)(p)];
  const range = rangeOf([from0 ? [0] : [], ...view.values(held)]) ?? [-1, 1];
  const ofStart = (places, s) => {
    const name = view.tint(s, "text");
    const without = free ? [lineOf(places, free, "wall", {width: 1.4, dash: [6, 4]})] : [];
    const dots = view.dots(s, of, {tint: () => name});
    return [...without, lineOf(places, of, name, {alpha: 0.35}), dots];
  };
  // Labelled bands of the regimes; omitted for several starts, whose regimes can differ.
  const named = {alpha: 0.2, textDown: 12, size: 12, texts: true};
  const bands = view.several ? [] : [view.regimes(0, named)];
  const counts = countRegimes(view.points)
    .filter(([, n]) => n)
    .map(([regime, n]) => `${regime === "none" ? q.regimes.none : regime}: ${n}`);
  return {
    title: `Regimes and ${title}`,
    summary: `points of each regime: ${counts.join(", ")}`,
    y: {range: from0 ? from0Range(range, y[0]) : range, label},
    marks: [...bands, levels({y}), ...view.byStart.flatMap(ofStart), ...view.rings(of)],
    height: ({p}) => of(p),
    columns: {
      [label]: of,
      ...(free && {"without the absorber": free}),
      regime: (p) => p.regime ?? "–",
    },
  };
}

/** A diagram with the regimes of each start along its upper edge. */
const withRegimes = (kind) => (view) => {
  const {marks, ...content} = kind(view);
  const strips = view.byStart.map((_, s) => view.regimes(s, {down: 6 * s, height: 5}));
  return {...content, marks: [...marks, ...strips]};
};

const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

export class DiagramView extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Viewport()], steps, ...rest);
    const kinds = {section, lambda, other: quantity};
    this.plots = Object.entries(kinds).map(
      ([name, kind]) => new SweepPlot(this, name, withRegimes(kind)),
    );
  }

  refresh(choice) {
    this.byStart = this.data.states.map((_, s) => placesOf(this.layers, s));
    super.refresh(choice);
  }

  get several() {
    return this.data.starts > 1;
  }

  places() {
    return this.byStart.flat().filter(({p}) => !p.error);
  }

  /** The points of the first start. */
  get points() {
    return this.byStart[0].map(({p}) => p);
  }

  /** Values of all points, a list of each, for the range. */
  values(of) {
    return this.places().map(({p}) => of(p));
  }

  /** Colour of a start; `alone` if there is only one. */
  tint(start, alone) {
    return this.several ? startStyle(start).colour : alone;
  }

  /** Dots of a start, in the colours tint(point); smaller where there are many. */
  dots(start, of, more) {
    const {shape} = startStyle(start);
    const size = clamp((600 * this.data.starts) / this.visiblePlaces().length, 1.3, 3.4);
    return dotsOf(this.byStart[start], of, {shape, size, fitted: true, ...more});
  }

  /** The best motion of each point, or one from another start that differs, as rings on a line. */
  rings(of) {
    if (this.several) return [];
    const other = ofOtherMotion(of);
    const ring = {tint: () => "best", shape: "ring", width: 1.5};
    return [lineOf(this.byStart[0], other, "best", {alpha: 0.6}), this.dots(0, other, ring)];
  }

  regimes(start, more) {
    return regimesOf(this.byStart[start], this.data.axes[0], more);
  }

  /** The points of all starts at a place; undefined where one is missing. */
  placesAt({at: [at]}) {
    return this.byStart.map((list) => list.find((place) => place.at[0] === at));
  }

  /** The nearest point of the first start or, given a height, of the start drawn nearest to it. */
  nearest({plot, at, top}) {
    const place = least(this.byStart[0], (other) => Math.abs(other.at[0] - at[0]));
    if (!place || top === undefined) return place;
    const away = (other) => {
      const v = other.p.error ? null : plot.shown.height(other);
      return v == null ? Infinity : Math.abs(plot.frame.py(v) - plot.frame.box.top - top);
    };
    return least(this.placesAt(place).filter(Boolean), away);
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

  move(step) {
    const [list] = this.byStart;
    const i = this.current ? list.indexOf(this.nearest(this.current)) : -1;
    if (list.length) this.goTo(...list[clamp(i + step, 0, list.length - 1)].at);
  }
}

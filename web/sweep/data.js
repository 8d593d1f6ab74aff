// The points of a sweep: their axes, and receiving them as lines of JSON.
import {linesOf, TemporaryError} from "../shared/api.js";
import {defaultSet} from "../shared/form.js";

/** Borders of the cells of ascending places: the midpoints, and one beyond each end. */
function borders(at, log) {
  const room = log ? 0.1 : Math.abs(at[0]) * 0.1 || 1;
  const [first, second = first + room] = at;
  const [last, before = last - room] = at.toReversed();
  const all = [2 * first - second, ...at, 2 * last - before];
  return all.slice(1).map((v, i) => (v + all[i]) / 2);
}

/**
 * An axis in ascending order of the requested entries `order`; at: places, on a logarithmic axis
 * logarithms; borders: of their cells; to(value): a place; from(place): a value.
 */
function arrange({parameter, values}, scale) {
  const order = [...values.keys()].sort((a, b) => values[a] - values[b]);
  const sorted = order.map((i) => values[i]);
  const log = scale === "log";
  const [to, from] = log ? [Math.log, Math.exp] : [Number, Number];
  const at = sorted.map(to);
  const edges = borders(at, log);
  return {parameter, log, order, given: values, values: sorted, at, borders: edges, to, from};
}

/** A line of a reduction, and its motions, as points: x_max is the peak, `where` its place. */
function unfold({worst, best, starts, ...line}, parameter) {
  const peak = ({x_peak, x_free_peak, ...rest}) => ({
    ...rest,
    x_max: x_peak,
    x_free: x_free_peak ?? null,
    where: rest[parameter],
  });
  const motions = best ? {worst: peak(worst), best: peak(best), starts: starts.map(peak)} : {};
  return {...peak(line), ...motions};
}

/** Half a forcing period from the fields of a point and the sweep's resolved parameters. */
function halfPeriod({Omega, f, f0, k1, m1}, {Omega: standard, si}) {
  if (Omega || !(f ?? f0 ?? k1 ?? m1)) return Math.PI / (Omega ?? standard);
  const natural = f0 ?? Math.sqrt((k1 ?? si.k1) / (m1 ?? si.m1)) / (2 * Math.PI); // Hz
  return (Math.PI * natural) / (f ?? si.f);
}

const enough = 500; // lines collected as strings before they become a Blob

/** The points of a sweep. Serialises as its request. */
export class SweepData {
  axes = null; // those that remain after a reduction
  parameters = null;
  warnings = new Set();
  points = [];
  received = 0;
  slice = null; // position on the third axis that a refinement belongs to
  ranges = null; // visible ranges that a refinement covers; null for a sweep that can be downloaded
  blobs = [];
  texts = [];

  constructor(request) {
    this.request = request;
    const {section = "none", starts, reduce = "", carry_state: carried = "none"} = request;
    this.section = section;
    this.defaultSet = starts === defaultSet;
    this.states = Array.isArray(starts) && starts.length ? starts : [{}]; // initial states
    // Parameter of the axis that is reduced.
    this.reduced = /^(?:max|min) over (.+)$/.exec(reduce)?.[1] ?? null;
    this.carried = carried !== "none"; // each point starts from its neighbour's final state
  }

  toJSON() {
    return this.request;
  }

  get starts() {
    return this.states.length;
  }

  get total() {
    return this.points.length;
  }

  get complete() {
    return this.axes !== null && this.received === this.total;
  }

  take(line, text) {
    if (line.type === "start") {
      for (const warning of line.warnings) this.warnings.add(warning);
      if (this.axes) return; // a further stream with the missing points
      this.begin(line);
    } else if (line.type === "point") {
      if (this.points[line.index]) return;
      this.points[line.index] = this.trim(line);
      ++this.received;
    } else {
      if (line.type === "warning") this.warnings.add(line.message);
      return; // progress and end lines are not part of the result
    }
    if (this.ranges) return;
    this.texts.push(text, "\n");
    if (this.texts.length > 2 * enough)
      this.blobs = [...this.blobs, new Blob(this.texts.splice(0))];
  }

  begin({axes, parameters, points}) {
    const arranged = axes.map((axis, i) => arrange(axis, this.request.axes[i].scale));
    this.axes = arranged.filter((axis) => axis.parameter !== this.reduced);
    const [first = [{}], ...others] = this.axes.map(({parameter, given}) =>
      given.map((value) => ({[parameter]: value})),
    );
    this.entries = [first, this.states, ...others]; // fields that differ, fastest first
    this.parameters = parameters;
    this.points = new Array(points).fill(null);
  }

  /** Converts a section to columns of floats; a map drops it. */
  trim(point) {
    if (this.reduced) return unfold(point, this.reduced);
    if (!point.section) return point;
    const {section, ...rest} = point;
    if (this.axes.length > 1) return rest;
    const floats = ([name, values]) => [name, Float32Array.from(values, (v) => v ?? NaN)];
    const half = halfPeriod(this.fields(point.index), this.parameters);
    return {...rest, half, section: Object.fromEntries(Object.entries(section).map(floats))};
  }

  /** Index of a point: the first axis varies fastest, then the starts, then the other axes. */
  index(k = 0, l = 0, start = 0, m = 0) {
    const [first = 0, second = 0, third = 0] = [k, l, m].map((i, n) => this.axes[n]?.order[i]);
    const entries = [first, start, second, third];
    return this.entries.reduceRight((index, {length}, n) => index * length + entries[n], 0);
  }

  /** Fields of /v1/simulate for a point; best: for its best motion, where it has several. */
  fields(index, best = false) {
    const all = this.points[index];
    const point = (best && all?.best) || all;
    const fields = {...this.request.base, ...(this.defaultSet && point?.state)};
    let rest = index;
    for (const list of this.entries) {
      Object.assign(fields, list[rest % list.length]);
      rest = Math.floor(rest / list.length);
    }
    if (this.reduced && point?.where != null) fields[this.reduced] = point.where;
    return fields;
  }

  file() {
    return new Blob([...this.blobs, ...this.texts], {type: "application/x-ndjson"});
  }
}

/** Requests the points that a SweepData lacks. Throws if the stream ends early. */
export async function receive(data, signal, onLine) {
  const indices = data.points.flatMap((point, i) => (point ? [] : [i]));
  const missing = data.received ? {indices} : {};
  for await (const {text, value} of linesOf("v1/sweep", {...data.request, ...missing}, signal)) {
    data.take(value, text);
    if (!signal.aborted) onLine(value);
  }
  if (!data.complete) throw new TemporaryError("the response ended early");
}

/** Points of a start on a single axis, ascending. */
function pointsOf(data, start) {
  const [axis] = data.axes;
  return axis.at.flatMap((at, k) => {
    const index = data.index(k, 0, start);
    const p = data.points[index];
    return p ? [{at: [at], value: axis.values[k], p, data, index, start}] : [];
  });
}

/**
 * Ascending points {at, low, high, value, p, data, index, start} of a start, with borders of their
 * cells; layers: a sweep and finer ones of parts of its axis.
 */
export function placesOf(layers, start) {
  const list = layers.flatMap((data) => pointsOf(data, start));
  if (layers.length > 1) list.sort((a, b) => a.at[0] - b.at[0]);
  const {borders} = layers[0].axes[0];
  list.forEach((place, i) => {
    const next = list[i + 1];
    place.low = i ? list[i - 1].high : borders[0];
    place.high = next ? (place.at[0] + next.at[0]) / 2 : borders.at(-1);
  });
  return list;
}

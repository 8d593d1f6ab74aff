// The points of a sweep, where they lie, and the lines they came in.
import {coordinates} from "./quantities.js";

const ascending = (values) => values.map((_, i) => i).sort((a, b) => values[a] - values[b]);

/** The borders between ascending values and around them: the middles, of the logarithms where the axis is logarithmic. */
function borders(values, log) {
  const to = log ? Math.log : (v) => v, from = log ? Math.exp : (v) => v;
  const at = values.map(to), n = at.length;
  const half = n > 1 ? 0 : log ? 0.05 : Math.abs(at[0]) * 0.05 || 0.5;
  const first = n > 1 ? at[0] - (at[1] - at[0]) / 2 : at[0] - half, last = n > 1 ? at[n - 1] + (at[n - 1] - at[n - 2]) / 2 : at[0] + half;
  return [first, ...at.slice(1).map((v, i) => (v + at[i]) / 2), last].map(from);
}

/** An axis in ascending order: position k shows entry order[k] of the request's axis. */
function arrange({parameter, values}, scale) {
  const order = ascending(values), sorted = order.map((i) => values[i]), log = scale === "log";
  return {parameter, log, order, given: values, values: sorted, borders: borders(sorted, log)};
}

const enough = 500;  // lines that are kept as texts before they go into a Blob

export class SweepData {
  /** halfPeriod(fields): half a forcing period of a point's fields. */
  constructor(request, halfPeriod) {
    this.request = request;
    this.halfPeriod = halfPeriod;
    this.section = request.section ?? "none";
    this.starts = Math.max(1, request.starts?.length ?? 0);
    this.axes = null;
    this.points = [];
    this.received = 0;
    this.faults = new Map();
    this.early = 0;
    this.blobs = [];
    this.texts = [];
  }

  get total() { return this.points.length; }
  get complete() { return this.axes !== null && this.received === this.total; }

  take(line, text) {
    if (line.type === "start") {
      if (this.axes) return;  // of a stream that brings the rest
      this.axes = line.axes.map((axis, i) => arrange(axis, this.request.axes[i].scale));
      this.points = new Array(line.points).fill(null);
    } else if (line.type === "point") {
      if (this.points[line.index]) return;
      this.points[line.index] = this.trim(line);
      ++this.received;
    } else {
      return;  // progress and the end are not part of the result
    }
    this.texts.push(text, "\n");
    if (this.texts.length > 2 * enough) this.blobs = [...this.blobs, new Blob(this.texts.splice(0))];
  }

  /** A point with the coordinates of its section as columns of floats; over two axes there is no place for them. */
  trim(point) {
    if (point.error) this.faults.set(point.error, (this.faults.get(point.error) ?? 0) + 1);
    if (point.reason && point.reason !== "complete") ++this.early;
    if (!point.section) return point;
    const {section, ...rest} = point;
    if (this.axes.length > 1) return rest;
    const half = this.halfPeriod(this.fields(point.index));
    rest.section = Object.fromEntries(Object.entries(coordinates[this.section]).map(([name, {columns, value}]) => {
      const [first, second] = columns(section);
      return [name, Float32Array.from(first, (v, i) => value(v, half, second?.[i]))];
    }));
    return rest;
  }

  missing() { return this.points.flatMap((point, i) => point ? [] : [i]); }

  /** The index of the point at positions k, l of the (ascending) axes. The first axis counts fastest, then the starts. */
  index(k, l = 0, start = 0) {
    const [first, second] = this.axes;
    return ((second ? second.order[l] : 0) * this.starts + start) * first.order.length + first.order[k];
  }
  at(k, l, start) { return this.points[this.index(k, l, start)]; }

  /** The fields of /v1/simulate of a point. */
  fields(index) {
    const n = this.axes[0].values.length, row = Math.floor(index / n), [first, second] = this.axes;
    const value = (axis, i) => ({[axis.parameter]: axis.given[i]});
    return {...this.request.base, ...this.request.starts?.[row % this.starts], ...value(first, index % n), ...(second ? value(second, Math.floor(row / this.starts)) : {})};
  }

  /** What has come, as lines of JSON. */
  file() { return new Blob([...this.blobs, ...this.texts], {type: "application/x-ndjson"}); }
}

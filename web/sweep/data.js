// The points of a sweep, where they lie, and the lines they came in.
import {defaultSet} from "../shared/form.js";
import {coordinates} from "../shared/quantities.js";

/** The positions of values in their order. */
export const ascending = (values) => values.map((_, i) => i).sort((a, b) => values[a] - values[b]);

const same = (v) => v;

/**
 * The borders between ascending places and around them: the middles between each and the next. An
 * only one has some room around it.
 */
function borders(at, log) {
  const room = log ? 0.1 : Math.abs(at[0]) * 0.1 || 1;
  const [first, second = first + room] = at;
  const [last, before = last - room] = at.toReversed();
  const all = [2 * first - second, ...at, 2 * last - before];
  return all.slice(1).map((v, i) => (v + all[i]) / 2);
}

/**
 * An axis in ascending order: position k shows entry order[k] of the request's axis. at: its places,
 * logarithms where it is logarithmic, and the borders between and around them; to(value): a place;
 * from(place): a value.
 */
function arrange({parameter, values}, scale) {
  const order = ascending(values);
  const sorted = order.map((i) => values[i]);
  const log = scale === "log";
  const [to, from] = log ? [Math.log, Math.exp] : [same, same];
  const at = sorted.map(to);
  const edges = borders(at, log);
  return {parameter, log, order, given: values, values: sorted, at, borders: edges, to, from};
}

/**
 * A line of a reduction, and each motion in it, as a point whose largest |x| is the peak: `where`
 * along the axis that is folded.
 */
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

/** Half a forcing period, pi/Omega, of a point's fields. */
function halfPeriod({Omega, f, f0, k1, m1}) {
  const natural = f0 ?? Math.sqrt(k1 / m1) / (2 * Math.PI); // in Hz
  return Math.PI / (Omega ?? (f ? f / natural : 1));
}

const enough = 500; // lines that are kept as texts before they go into a Blob

/** The points of a sweep; as JSON it is its request. */
export class SweepData {
  axes = null; // those that are left
  parameters = null;
  warnings = new Set();
  points = [];
  received = 0;
  slice = null; // of the third axis of another sweep, the one that this sweep is a part of
  views = null; // of its axes, what this sweep is of; such a part is no file
  blobs = [];
  texts = [];

  constructor(request) {
    this.request = request;
    const {section = "none", starts, reduce = "", carry_state: carried = "none"} = request;
    this.section = section;
    this.defaultSet = starts === defaultSet;
    this.states = Array.isArray(starts) && starts.length ? starts : [{}]; // to start from
    // The parameter of the axis that is folded.
    this.reduced = /^(?:max|min) over (.+)$/.exec(reduce)?.[1] ?? null;
    this.carried = carried !== "none"; // each point begins where its neighbour ended
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
      if (this.axes) return; // of a stream that brings the rest
      this.begin(line);
    } else if (line.type === "point") {
      if (this.points[line.index]) return;
      this.points[line.index] = this.trim(line);
      ++this.received;
    } else {
      if (line.type === "warning") this.warnings.add(line.message);
      return; // progress and the end are not part of the result
    }
    if (this.views) return;
    this.texts.push(text, "\n");
    if (this.texts.length > 2 * enough)
      this.blobs = [...this.blobs, new Blob(this.texts.splice(0))];
  }

  /** The axes, and places for the points. */
  begin({axes, parameters, points}) {
    const arranged = axes.map((axis, i) => arrange(axis, this.request.axes[i].scale));
    this.axes = arranged.filter((axis) => axis.parameter !== this.reduced);
    this.parameters = parameters;
    this.points = new Array(points).fill(null);
  }

  /**
   * A point with the coordinates of its section as columns of floats; over two axes there is no
   * place for them.
   */
  trim(point) {
    if (this.reduced) return unfold(point, this.reduced);
    if (!point.section) return point;
    const {section, ...rest} = point;
    if (this.axes.length > 1) return rest;
    const half = halfPeriod(this.fields(point.index));
    rest.section = {};
    for (const [name, {columns, value, seconds}] of Object.entries(coordinates[this.section])) {
      const [first, second] = columns(section);
      rest.section[name] = Float32Array.from(first, (v, i) => value(v, half, second?.[i]));
      if (seconds && section[seconds.column])
        rest.section[`${name}_SI`] = Float32Array.from(section[seconds.column], (v) => v * 1000);
    }
    return rest;
  }

  missing() {
    return this.points.flatMap((point, i) => (point ? [] : [i]));
  }

  /**
   * The index of the point at positions k, l, m of the (ascending) axes. The first axis counts
   * fastest, then the starts, then the others.
   */
  index(k = 0, l = 0, start = 0, m = 0) {
    const [first, second, third] = this.axes;
    const size = (axis) => axis?.values.length ?? 1;
    const entry = (axis, i) => (axis ? axis.order[i] : 0);
    const before = entry(third, m) * size(second) + entry(second, l);
    return (before * this.starts + start) * size(first) + entry(first, k);
  }

  /** The fields of /v1/simulate of a point; best: of its best motion, where it has several. */
  fields(index, best = false) {
    const all = this.points[index];
    const point = (best && all?.best) || all;
    const [first, second, third] = this.axes;
    let rest = index;
    const take = (list) => {
      const i = rest % list.length;
      rest = Math.floor(rest / list.length);
      return list[i];
    };
    const place = (axis) => axis && {[axis.parameter]: take(axis.given)};
    return {
      ...this.request.base,
      ...(this.defaultSet && point?.state),
      ...place(first),
      ...take(this.states),
      ...place(second),
      ...place(third),
      ...(this.reduced && point?.where != null && {[this.reduced]: point.where}),
    };
  }

  /** What has come, as lines of JSON. */
  file() {
    return new Blob([...this.blobs, ...this.texts], {type: "application/x-ndjson"});
  }
}

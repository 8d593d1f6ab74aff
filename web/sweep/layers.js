// A sweep, and over it what was computed once more, finer, where one zoomed in.

const most = 4; // sweeps over each other

/** Where the points of one axis lie, of one start, in ascending order. */
function placesOf(data, start) {
  const [axis] = data.axes;
  return axis.at.flatMap((at, k) => {
    const index = data.index(k, 0, start);
    const p = data.points[index];
    return p ? [{at: [at], value: axis.values[k], p, data, index, start}] : [];
  });
}

export class Layers {
  /** base: a SweepData. */
  constructor(base) {
    this.base = base;
    this.all = [base];
    this.ends = {}; // of the colours of a map, by its quantity
  }

  /** A finer sweep on top. */
  add(data) {
    if (this.all.includes(data)) return; // a stream that brings the rest
    this.all.push(data);
    if (this.all.length > most) this.all.splice(1, 1);
  }

  /** Those whose points lie over a slice of the third axis, the coarsest first. */
  over(slice) {
    return this.all.filter((data) => data.axes && (data.slice ?? slice) === slice);
  }

  /**
   * Of a single axis: the points of a start that have come, in ascending order, with the borders
   * between them: {at, low, high, value, p, data, index, start}.
   */
  places(start) {
    const list = this.all.flatMap((data) => (data.axes ? placesOf(data, start) : []));
    if (this.all.length > 1) list.sort((a, b) => a.at[0] - b.at[0]);
    const {borders} = this.base.axes[0];
    list.forEach((place, i) => {
      place.low = i ? list[i - 1].high : borders[0];
      place.high = i + 1 < list.length ? (place.at[0] + list[i + 1].at[0]) / 2 : borders.at(-1);
    });
    return list;
  }
}

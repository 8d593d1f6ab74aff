// A sweep and its refinements: finer sweeps of ranges that were zoomed into.

const most = 4; // sweeps kept

/** Points of a start on a single axis, ascending. */
function placesOf(data, start) {
  const [axis] = data.axes;
  return axis.at.flatMap((at, k) => {
    const index = data.index(k, 0, start);
    const p = data.points[index];
    return p ? [{at: [at], value: axis.values[k], p, data, index, start}] : [];
  });
}

/** Stretches of neighbouring places with the same regime, null without: {regime, from, to}. */
export function stretches(places) {
  const list = [];
  for (const {p, low, high} of places) {
    const regime = p.regime ?? null;
    const last = list.at(-1);
    if (last?.regime === regime) last.to = high;
    else list.push({regime, from: low, to: high});
  }
  return list;
}

export class Layers {
  /** base: a SweepData. */
  constructor(base) {
    this.base = base;
    this.all = [base];
    this.ends = {}; // ends of a map's colour scale, by quantity
  }

  add(data) {
    if (this.all.includes(data)) return; // a further stream of the same sweep
    this.all.push(data);
    if (this.all.length > most) this.all.splice(1, 1);
  }

  /** Layers that show a position of the third axis, the coarsest first. */
  over(slice) {
    return this.all.filter((data) => data.axes && (data.slice ?? slice) === slice);
  }

  /**
   * Points of a start on a single axis, in ascending order, with the borders of their cells: {at,
   * low, high, value, p, data, index, start}.
   */
  places(start) {
    const list = this.all.flatMap((data) => (data.axes ? placesOf(data, start) : []));
    if (this.all.length > 1) list.sort((a, b) => a.at[0] - b.at[0]);
    const {borders} = this.base.axes[0];
    list.forEach((place, i) => {
      const next = list[i + 1];
      place.low = i ? list[i - 1].high : borders[0];
      place.high = next ? (place.at[0] + next.at[0]) / 2 : borders.at(-1);
    });
    return list;
  }
}

// Where one zooms into a sweep it is computed once more for what is in view, with as many points.
import {Job} from "../shared/job.js";
import {SweepData} from "./data.js";
import {receive} from "./stream.js";

const pause = 350; // ms of rest before it begins
const mostPoints = 20000;

/** Whether the points on an axis are as dense in view as those asked for, as far as the whole has any. */
const suffices = ({at, borders}, whole, [from, to], count) => {
  const inside = at.filter((place) => place >= from && place <= to).length;
  const least = 1e-9 * (to - from);
  const begins = borders[0] <= Math.max(from, whole.at[0]) + least;
  const ends = borders.at(-1) >= Math.min(to, whole.at.at(-1)) - least;
  return begins && ends && inside >= 0.6 * count;
};

/** An axis of a request, over what is in view: the middles of so many cells, within the whole. */
function axisOf({parameter, scale}, {from, at}, [low, high], count) {
  const half = (high - low) / count / 2;
  const inside = (place) => Math.min(Math.max(place, at[0]), at.at(-1));
  const ends = [low + half, high - half].map((v) => Number(from(inside(v)).toPrecision(12)));
  return {parameter, from: ends[0], to: ends[1], count, ...(scale ? {scale} : {})};
}

export class Refiner {
  /**
   * axes(data): the Axis of each axis that is drawn; drawn(): more points are there; settled(): all
   * that were asked for are; say(text).
   */
  constructor({axes, drawn, settled, say}) {
    Object.assign(this, {axes, drawn, say, layers: null, waiting: 0});
    this.job = new Job({
      ask: (data, signal) => this.ask(data, signal),
      show: () => {
        this.say("");
        settled();
      },
      fail: (error) => this.say(`not refined: ${error.message}`),
      busy() {},
      later: (text) => this.say(text),
    });
  }

  /** Another sweep. */
  follow(layers) {
    this.layers = layers;
    this.stop();
  }

  stop() {
    clearTimeout(this.waiting);
    this.job.cancel();
    this.say("");
  }

  /** Something else is in view. slice: of the third axis, where there is one. */
  look(slice) {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.begin(slice), pause);
  }

  begin(slice) {
    const {base} = this.layers ?? {};
    const carried = (base?.request.carry_state ?? "none") !== "none"; // its points hang together
    if (!base?.complete || !base.axes.length || carried) return;
    const views = this.axes(base);
    const shown = base.axes.slice(0, views.length);
    const counts = countsOf(shown, base.starts);
    const third = base.axes[2] ? slice : null;
    const covers = ({data}) =>
      shown.every((whole, i) => suffices(data.axes[i], whole, views[i].view, counts[i]));
    const there = this.layers.over(slice).findLast(covers)?.data;
    if (!views.some(({zoomed}) => zoomed) || there?.complete) {
      this.stop();
      return;
    }
    if (there) {
      this.job.start(there); // what of it is missing, unless it runs already
      return;
    }
    const finer = new Map(
      shown.map((axis, i) => [
        axis.parameter,
        (given) => axisOf(given, axis, views[i].view, counts[i]),
      ]),
    );
    if (third !== null) {
      const {parameter, values} = base.axes[2];
      finer.set(parameter, () => ({parameter, values: [values[third]]}));
    }
    const axes = base.request.axes.map((given) => finer.get(given.parameter)?.(given) ?? given);
    const data = new SweepData({...base.request, axes}, base.halfPeriod, {keep: false});
    data.slice = third;
    this.job.start(data);
  }

  async ask(data, signal) {
    await receive(data, signal, ({type}) => {
      if (signal.aborted) return;
      if (type === "start") this.layers.add(data, data.slice);
      if (type !== "point") return;
      this.say(`finer where you look: ${data.received} of ${data.total} points`);
      this.drawn();
    });
  }
}

/** As many points along each axis as before, or fewer where that would be too many. */
function countsOf(axes, starts) {
  const counts = axes.map(({at}) => at.length);
  const product = counts.reduce((a, n) => a * n, starts);
  const share = Math.min((mostPoints / product) ** (1 / axes.length), 1);
  return counts.map((n) => Math.max(Math.floor(n * share), 2));
}

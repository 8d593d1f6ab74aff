// Refinement: the visible range of a zoomed sweep is computed again with the same number of points.
import {Job} from "../shared/job.js";
import {receive, SweepData} from "./data.js";

const pause = 350; // ms without zooming before it starts
const mostPoints = 20000;

/** An axis of the request for a visible range: centres of `count` cells, inside the full range. */
function axisOf(given, {from: value, at}, [low, high], count) {
  const half = (high - low) / count / 2;
  const inside = (place) => Math.min(Math.max(place, at[0]), at.at(-1));
  const [from, to] = [low + half, high - half].map((v) => Number(value(inside(v)).toPrecision(12)));
  return {parameter: given.parameter, from, to, count, scale: given.scale};
}

export class Refiner {
  /** drawn(): points were received; settled(): all points were received; say(text). */
  constructor({drawn, settled, say}) {
    Object.assign(this, {drawn, say, view: null, waiting: 0});
    this.job = new Job({
      ask: (data, signal) => this.ask(data, signal),
      show: () => {
        this.say("");
        settled();
      },
      fail: (error) => this.say(`not refined: ${error.message}`),
      later: say,
    });
  }

  /** Follows a SweepView with a new sweep; null: none. */
  follow(view) {
    this.view = view;
    this.stop();
  }

  stop() {
    clearTimeout(this.waiting);
    this.job.cancel();
    this.say("");
  }

  /** Called when the visible range changes. */
  schedule() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.begin(), pause);
  }

  begin() {
    if (!this.view) return;
    const {layers, data, viewports, choice} = this.view;
    if (!data.complete || data.carried) return;
    const counts = countsOf(data, viewports.length);
    // True when a layer has at least 60 % of the density that a new request would have.
    const covers = (finer) =>
      viewports.every(({range: [from, to], full}, i) => {
        const [first, last] = finer.ranges?.[i] ?? full;
        const inside = (finer.axes[i].at.length * (to - from)) / (last - first);
        return first <= from && to <= last && inside >= 0.6 * counts[i];
      });
    const there = layers.over(choice.slice).findLast(covers);
    if (!viewports.some(({zoomed}) => zoomed) || there?.complete) this.stop();
    else this.job.start(there ?? this.finer(counts)); // unless it is running already
  }

  /** A sweep of the visible range; of the third axis only the slice shown. */
  finer(counts) {
    const {data, viewports, choice} = this.view;
    const request = data.request.axes.map((given) => {
      const i = data.axes.findIndex(({parameter}) => parameter === given.parameter);
      const {parameter, values} = data.axes[i] ?? {};
      if (viewports[i]) return axisOf(given, data.axes[i], viewports[i].range, counts[i]);
      return i < 0 ? given : {parameter, values: [values[choice.slice]]};
    });
    const finer = new SweepData({...data.request, axes: request});
    finer.ranges = viewports.map(({range}) => range);
    if (data.axes[2]) finer.slice = choice.slice;
    return finer;
  }

  async ask(data, signal) {
    await receive(data, signal, ({type}) => {
      if (type === "start") this.view.layers.add(data);
      if (type !== "point") return;
      this.say(`refining: ${data.received} of ${data.total} points`);
      this.drawn();
    });
  }
}

/** The number of points along each visible axis as before, or fewer to stay within mostPoints. */
function countsOf({axes, starts}, n) {
  const counts = axes.slice(0, n).map(({at}) => at.length);
  const product = counts.reduce((a, b) => a * b, starts);
  const share = Math.min((mostPoints / product) ** (1 / n), 1);
  return counts.map((count) => Math.max(Math.floor(count * share), 2));
}

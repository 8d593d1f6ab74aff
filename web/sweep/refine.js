// Where one zooms into a sweep it is computed once more for what is in view, with as many points.
import {Job} from "../shared/job.js";
import {SweepData} from "./data.js";
import {receive} from "./stream.js";

const pause = 350; // ms of rest before it begins
const mostPoints = 20000;

/** An axis of a request, over what is in view: the middles of so many cells, within the whole. */
function axisOf(given, {from: value, at}, [low, high], count) {
  const half = (high - low) / count / 2;
  const inside = (place) => Math.min(Math.max(place, at[0]), at.at(-1));
  const [from, to] = [low + half, high - half].map((v) => Number(value(inside(v)).toPrecision(12)));
  return {parameter: given.parameter, from, to, count, scale: given.scale};
}

export class Refiner {
  /** drawn(): more points are there; settled(): all that were asked for are; say(text). */
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

  /** A SweepView that shows another sweep, or null. */
  follow(view) {
    this.view = view;
    this.stop();
  }

  stop() {
    clearTimeout(this.waiting);
    this.job.cancel();
    this.say("");
  }

  /** Something else is in view. */
  look() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.begin(), pause);
  }

  begin() {
    if (!this.view) return;
    const {layers, data, axes, choice} = this.view;
    if (!data.complete || data.carried) return;
    const counts = countsOf(data, axes.length);
    // As dense in view as what would be asked for, or almost.
    const covers = (finer) =>
      axes.every(({view: [from, to], whole}, i) => {
        const [first, last] = finer.views?.[i] ?? whole;
        const inside = (finer.axes[i].at.length * (to - from)) / (last - first);
        return first <= from && to <= last && inside >= 0.6 * counts[i];
      });
    const there = layers.over(choice.slice).findLast(covers);
    if (!axes.some(({zoomed}) => zoomed) || there?.complete) this.stop();
    else this.job.start(there ?? this.finer(counts)); // what is missing, unless it runs already
  }

  /** A sweep of what is in view: of the third axis the value that is shown. */
  finer(counts) {
    const {data, axes, choice} = this.view;
    const request = data.request.axes.map((given) => {
      const i = data.axes.findIndex(({parameter}) => parameter === given.parameter);
      const {parameter, values} = data.axes[i] ?? {};
      if (axes[i]) return axisOf(given, data.axes[i], axes[i].view, counts[i]);
      return i < 0 ? given : {parameter, values: [values[choice.slice]]};
    });
    const finer = new SweepData({...data.request, axes: request});
    finer.views = axes.map(({view}) => view);
    if (data.axes[2]) finer.slice = choice.slice;
    return finer;
  }

  async ask(data, signal) {
    await receive(data, signal, ({type}) => {
      if (type === "start") this.view.layers.add(data);
      if (type !== "point") return;
      this.say(`finer where you look: ${data.received} of ${data.total} points`);
      this.drawn();
    });
  }
}

/** As many points along each axis that is drawn as before, or fewer where that would be too many. */
function countsOf({axes, starts}, n) {
  const counts = axes.slice(0, n).map(({at}) => at.length);
  const product = counts.reduce((a, b) => a * b, starts);
  const share = Math.min((mostPoints / product) ** (1 / n), 1);
  return counts.map((count) => Math.max(Math.floor(count * share), 2));
}

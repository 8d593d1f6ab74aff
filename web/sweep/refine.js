// Refinement: the visible range of a zoomed sweep is computed again with the same number of points.
import {countUp, setTexts} from "../shared/dom.js";
import {Job} from "../shared/job.js";
import {clamp} from "../shared/numbers.js";
import {receive, SweepData} from "./data.js";

const pause = 350; // ms without zooming before it starts
const maxPoints = 20000;

/** An axis of the request with the centres of `count` equal cells of visible places (data.js). */
function axisOf(given, {from: valueAt, at}, [low, high], count) {
  const half = (high - low) / count / 2;
  const rounded = (place) => Number(valueAt(clamp(place, at[0], at.at(-1))).toPrecision(12));
  const [from, to] = [low + half, high - half].map(rounded);
  return {parameter: given.parameter, from, to, count, scale: given.scale};
}

export class Refiner extends Job {
  waiting = 0; // timer

  /** tab: its view is refined, and draws the received points. */
  constructor(tab) {
    super({tab, later: (text) => setTexts({"sweep-refined": text})});
  }

  ask(data, signal) {
    return receive(data, signal, (line) => this.take(data, line));
  }

  show() {
    this.later("");
    this.tab.redraw();
    countUp(this.tab.results, "refined");
  }

  fail({message}) {
    this.later(`not refined: ${message}`);
  }

  stop() {
    clearTimeout(this.waiting);
    this.cancel();
    this.later("");
  }

  /** Called when the visible range changes. */
  schedule() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.begin(), pause);
  }

  begin() {
    if (!this.tab.view) return;
    const {data, viewports} = this.tab.view;
    // A point of a carried sweep depends on its neighbours, so that it cannot be refined.
    if (!data.complete || data.carried) return;
    const counts = countsOf(data, viewports.length);
    // True when a layer has at least 60 % of the density that a new request would have.
    const covers = (layer) =>
      viewports.every(({range: [from, to], full}, i) => {
        const [first, last] = layer.ranges?.[i] ?? full;
        const inside = (layer.axes[i].at.length * (to - from)) / (last - first);
        return first <= from && to <= last && inside >= 0.6 * counts[i];
      });
    const existing = this.tab.view.layersShown().findLast(covers);
    if (!viewports.some(({zoomed}) => zoomed) || existing?.complete) this.stop();
    else this.start(existing ?? this.makeRefined(counts)); // start() ignores a running request
  }

  /** Sweep of the visible range. A third axis is fixed at the slice shown, a reduced axis stays. */
  makeRefined(counts) {
    const {data, viewports, choice} = this.tab.view;
    const axes = data.request.axes.map((given) => {
      const i = data.axes.findIndex(({parameter}) => parameter === given.parameter);
      const {parameter, values} = data.axes[i] ?? {};
      if (viewports[i]) return axisOf(given, data.axes[i], viewports[i].range, counts[i]);
      return i < 0 ? given : {parameter, values: [values[choice.slice]]};
    });
    const ranges = viewports.map(({range}) => range);
    const slice = data.axes[2] ? choice.slice : null;
    return Object.assign(new SweepData({...data.request, axes}), {ranges, slice});
  }

  take(data, {type}) {
    if (type === "start") this.tab.view.add(data);
    if (type !== "point") return;
    this.later(`refining: ${data.received} of ${data.total} points`);
    this.tab.drawSoon();
  }
}

/** Points along each axis, scaled down so that all stay within maxPoints, but at least 2. */
function countsOf({axes, starts}, n) {
  const counts = axes.slice(0, n).map(({at}) => at.length);
  const product = counts.reduce((a, b) => a * b, starts);
  const scale = Math.min((maxPoints / product) ** (1 / n), 1);
  return counts.map((count) => Math.max(Math.floor(count * scale), 2));
}

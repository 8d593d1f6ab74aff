// The plots of a run by name: lines over time, and planes.
import {$} from "../shared/dom.js";
import {exponentSeries} from "../shared/exponents.js";
import {addExportButton} from "../shared/export_dialog.js";
import {makeAccessible} from "../shared/gestures.js";
import {LinePlot} from "../shared/line_plot.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {aboutFigure} from "./captions.js";
import {alongRun} from "./columns.js";
import {run, viewport} from "./run.js";

export class PlotGroup {
  /** lines, planes: names. */
  constructor(lines, planes) {
    this.all = {};
    const add = (name, Kind) => {
      const plot = new Kind($(`plot-${name}`), viewport);
      const about = () => aboutFigure(name);
      addExportButton($(`figure-${name}`), plot, about);
      makeAccessible(plot, about().title, () => run?.answer.impacts.tau ?? [], viewport);
      this.all[name] = plot;
    };
    for (const name of lines) add(name, LinePlot);
    for (const name of planes) add(name, ScatterPlot);
  }

  /** marks: common to all plots over time, as from marksOf. */
  draw(name, options) {
    this.all[name].draw({...this.marks, levelColour: "line", ...options});
  }

  /** Rings the i-th pickable point of a plane. */
  ring(name, i) {
    const plot = this.all[name];
    const {x, y} = plot.last.pick;
    plot.light(x[i], y[i]);
  }

  refresh() {
    for (const plot of Object.values(this.all)) plot.refresh();
  }
}

/** Options that draw the exponents of an estimator. */
export function exponentLines(estimator) {
  const {history, status} = estimator ?? {};
  const {series, columns} = exponentSeries(history, status);
  const lines = history ? columns : columns.map(() => []);
  return {series, data: alongRun(history?.tau ?? [], lines), label: "λ", levels: [0]};
}

/**
 * Groups points by the halves of the run, the first paler, so that the steady state stands out.
 * kinds: [colour, test(i), name in tables].
 */
export function halves({x, y}, kinds) {
  const style = (late) => (late ? {alpha: 1, size: 3} : {alpha: 0.35, size: 2.4});
  const group = (late, [colour, is, label]) => {
    const keep = (_, i) => is(i) && i >= x.length / 2 === late;
    return {...style(late), colour, label, x: x.filter(keep), y: y.filter(keep)};
  };
  return [false, true].flatMap((late) => kinds.map((kind) => group(late, kind)));
}

/** Sticking phases, synchronised intervals, and borders of the requested windows. */
export function marksOf({sticking, exponents, regime, parameters, status, windows = []}) {
  const {stretches} = regime;
  const pairs = ({tau_start: from, tau_end: to}) => from.map((tau, i) => [tau, to[i]]);
  const [from, to] = parameters.window ?? [0, Infinity];
  const part = from > 0 || to < status.tau;
  return {
    x: run.units.x,
    bands: pairs(sticking),
    calm: pairs(stretches).filter((_, i) => stretches.synchronised[i]),
    lines: [...((part && exponents.window) || []), ...windows.flatMap((w) => w.asked)],
  };
}

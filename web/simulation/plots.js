// Plots of a run, by their names: lines over its time, and planes; and what all of them share.
import {$} from "../shared/dom.js";
import {exponentSeries} from "../shared/exponents.js";
import {addMenu} from "../shared/figure_menu.js";
import {LinePlot} from "../shared/line_plot.js";
import {operable} from "../shared/operable.js";
import {ScatterPlot} from "../shared/scatter_plot.js";
import {aboutFigure} from "./captions.js";
import {overRun} from "./columns.js";
import {axis, run} from "./run.js";

export class Plots {
  /** The names of those over time, and of the planes. */
  constructor(lines, planes) {
    this.all = {};
    const add = (name, Kind) => {
      const plot = new Kind($(`plot-${name}`), axis);
      const about = () => aboutFigure(name);
      addMenu($(`figure-${name}`), plot, about);
      operable(plot, about().title, () => run?.answer.impacts.tau ?? [], axis);
      this.all[name] = plot;
    };
    for (const name of lines) add(name, LinePlot);
    for (const name of planes) add(name, ScatterPlot);
  }

  /** marks: what lies over all plots over time, as of marksOf. */
  draw(name, options) {
    this.all[name].draw({...this.marks, levelColour: "line", ...options});
  }

  /** Rings the i-th of the points of a plane that can be pointed at. */
  ring(name, i) {
    const plot = this.all[name];
    const {x, y} = plot.last.pick;
    plot.light(x[i], y[i]);
  }

  refresh() {
    for (const plot of Object.values(this.all)) plot.refresh();
  }
}

/** What draws the exponents of an estimator. */
export function exponentLines(estimator) {
  const {history, status} = estimator ?? {};
  const {series, columns} = exponentSeries(history, status);
  const lines = history ? columns : columns.map(() => []);
  return {series, data: overRun(history?.tau ?? [], lines), label: "λ", levels: [0]};
}

/**
 * Points as groups by the halves of the run, the first paler: what lasts stands out. kinds: [colour,
 * whether the i-th point is one of them, their name in tables] each.
 */
export function halves({x, y}, kinds) {
  const style = (late) => (late ? {alpha: 1, size: 3} : {alpha: 0.35, size: 2.4});
  const group = (late, [colour, is, label]) => {
    const keep = (_, i) => is(i) && i >= x.length / 2 === late;
    return {...style(late), colour, label, x: x.filter(keep), y: y.filter(keep)};
  };
  return [false, true].flatMap((late) => kinds.map((kind) => group(late, kind)));
}

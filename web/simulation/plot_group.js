// The plots of a run: lines over time and planes.
import {exponentSeries} from "../shared/exponents.js";
import {addExportButton} from "../shared/export.js";
import {makeAccessible} from "../shared/gestures.js";
import {bands, dots, levels, lines, uprights} from "../shared/marks.js";
import {LinePlot, ScatterPlot} from "../shared/plot.js";
import {alongRun, run, viewport} from "./run.js";
import {aboutFigure} from "./words.js";

/** The plots inside an element by name: canvases are planes, the others lines over time. */
export class PlotGroup {
  constructor(container) {
    this.all = {};
    for (const node of container.querySelectorAll("[id^=plot-]")) {
      const Kind = node.matches("canvas") ? ScatterPlot : LinePlot;
      const name = node.id.replace("plot-", "");
      const plot = new Kind(node, viewport);
      const about = () => aboutFigure(name);
      addExportButton(node.closest("figure"), plot, about);
      makeAccessible(plot, about().title, () => run?.answer.impacts.tau ?? [], viewport);
      this.all[name] = plot;
    }
  }

  /** common: options of all plots over time, as from commonOptions. */
  draw(name, options) {
    this.all[name].draw({...this.common, ...options});
  }

  refresh() {
    for (const plot of Object.values(this.all)) plot.refresh();
  }
}

/** Options that draw the exponents of an estimator; range: of y. */
export function exponentLines(estimator, range) {
  const {history, status} = estimator ?? {};
  const {series, columns} = exponentSeries(history, status);
  const own = history ? columns : columns.map(() => []);
  const [tau, ...padded] = alongRun(history?.tau ?? [], own);
  return {marks: [levels({y: 0}), ...lines(tau, padded, series)], y: {label: "λ", range}};
}

/**
 * Groups points by the halves of the run, the first paler, so that the steady state stands out.
 * kinds: [colour, test(i), name in tables].
 */
export function halves({x, y}, kinds) {
  const style = (late) => (late ? {alpha: 1, size: 1.5} : {alpha: 0.35, size: 1.2});
  const group = (late, [colour, is, label]) => {
    const keep = (_, i) => is(i) && i >= x.length / 2 === late;
    return dots({...style(late), colour, label, x: x.filter(keep), y: y.filter(keep)});
  };
  return [false, true].flatMap((late) => kinds.map((kind) => group(late, kind)));
}

/** Points at the times t; a picked one moves the cursor, and a click also scrolls to it. */
export const picked = (points, t) => ({
  ...points,
  t,
  use(i, clicked) {
    if (clicked) viewport.reveal(t[i]);
    if (viewport.holds(t[i])) viewport.point(t[i], "pick");
  },
});

/** The time axis, sticking phases, synchronised intervals, and borders of the requested windows. */
export function commonOptions({sticking, exponents, regime, parameters, status, windows = []}) {
  const {stretches} = regime;
  const pairs = ({tau_start: from, tau_end: to}) => from.map((tau, i) => [tau, to[i]]);
  const [from, to] = parameters.window ?? [0, Infinity];
  const part = from > 0 || to < status.tau;
  const calm = pairs(stretches).filter((_, i) => stretches.synchronised[i]);
  const borders = [...((part && exponents.window) || []), ...windows.flatMap((w) => w.asked)];
  return {
    x: run.units.x,
    under: [
      bands({intervals: calm, colour: "calm"}),
      bands({intervals: pairs(sticking), colour: "shade"}),
      uprights({at: borders}),
    ],
  };
}

// Options that several plots of a run share.
import {exponentMarks} from "../shared/exponents.js";
import {bands, dots, levels, uprights} from "../shared/marks.js";
import {run, viewport} from "./run.js";

/** Options that draw the exponents of an estimator; range: of y. */
export const exponentLines = (estimator, range) => ({
  marks: [levels({y: 0}), ...exponentMarks(estimator)],
  y: {label: "λ", range},
});

/** Points by halves of the run, the first paler. kinds: [colour, test(i), name in tables]. */
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
    if (viewport.holds(t[i])) viewport.point(t[i]);
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

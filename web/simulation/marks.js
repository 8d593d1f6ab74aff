// What lies over all plots over time.
import {run} from "./run.js";

/** Of an answer: stuck phases, synchronised stretches, and the borders of the windows asked for. */
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

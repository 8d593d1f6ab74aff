// Columns of an answer on their way into a plot.
import {run} from "./run.js";

export const mm = (metres) => metres.map((v) => v * 1000);

/** A column in other units. */
export const over = (column, quantity) => column.map(quantity.of);

/** What a logarithmic axis can show. */
export const positive = (v) => (v > 0 ? v : null);

/** The largest |value|; 0 where there is none. */
export const most = (values) => values.reduce((a, v) => Math.max(a, Math.abs(v) || 0), 0);

/**
 * Columns over tau without repeats of tau, as a line over it needs them, from the start of the run
 * to its end: plots over tau lie under each other.
 */
export function overRun(tau, columns) {
  const {end} = run.motion;
  let last = -Infinity;
  const keep = tau.map((t) => {
    const later = t > last;
    last = Math.max(last, t);
    return later;
  });
  const before = !(tau[0] <= 0);
  const after = !(last >= end);
  const padded = (column, first, final) => [
    ...(before ? [first] : []),
    ...column.filter((_, i) => keep[i]),
    ...(after ? [final] : []),
  ];
  return [padded(tau, 0, end), ...columns.map((column) => padded(column, null, null))];
}

/**
 * A range for a logarithmic axis that holds all values and 1; a value that is not positive has no
 * place on it.
 */
export function logRange(columns) {
  const values = [1, ...columns.flat().filter((v) => v > 0)];
  const extreme = (of) => values.reduce((a, v) => of(a, v));
  return [extreme(Math.min) / 1.6, extreme(Math.max) * 1.6];
}

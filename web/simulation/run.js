// The run shown, and the time axis shared by its plots.
import {Viewport} from "../shared/viewport.js";

export const viewport = new Viewport();

/** {fields, answer, motion, units, deferred}; the last is an answer that arrives later. */
export let run = null;

export function setRun(newest) {
  run = newest;
}

// Preparing columns of an answer for plots.
export const inUnits = (column, quantity) => column.map(quantity.of);

/** null for values that a logarithmic axis cannot show. */
export const positive = (v) => (v > 0 ? v : null);

/** The largest |value|; 0 without values. */
export const largestMagnitude = (values) =>
  values.reduce((a, v) => Math.max(a, Math.abs(v) || 0), 0);

/** Columns over tau without repeated times, extended to the whole run so that plots align. */
export function alongRun(tau, columns) {
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

/** A range of a logarithmic axis that holds 1 and all positive values. */
export function logRange(columns) {
  const values = [1, ...columns.flat().filter((v) => v > 0)];
  const extreme = (of) => values.reduce((a, v) => of(a, v));
  return [extreme(Math.min) / 1.6, extreme(Math.max) * 1.6];
}

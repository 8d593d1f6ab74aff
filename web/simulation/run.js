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
  const isLater = (_, i) => !(tau[i] <= tau[i - 1]);
  const before = !(tau[0] <= 0);
  const after = !(tau.at(-1) >= end);
  const padded = (column, first, final) => [
    ...(before ? [first] : []),
    ...column.filter(isLater),
    ...(after ? [final] : []),
  ];
  return [padded(tau, 0, end), ...columns.map((column) => padded(column, null, null))];
}

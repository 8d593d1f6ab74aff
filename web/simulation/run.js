// The run shown, and the time axis shared by its plots.
import {max} from "d3-array";
import {Viewport} from "../shared/viewport.js";

export const viewport = new Viewport();

/** {fields, answer, motion, units, deferred}; the last is an answer that arrives later. */
export let run = null;

export function setRun(newest) {
  run = newest;
}

// Preparing columns of an answer for plots.
export const inUnits = (column, quantity) => column.map(quantity.of);

/** The largest |value|; 0 without values. */
export const largestMagnitude = (values) => max(values, Math.abs) ?? 0;

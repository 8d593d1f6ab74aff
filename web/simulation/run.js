// The run shown, and the time axis shared by its plots.
import {Viewport} from "../shared/viewport.js";

export const viewport = new Viewport();

/** {fields, answer, motion, units, deferred, details}; the last two are answers that arrive later. */
export let run = null;

export function setRun(newest) {
  run = newest;
}

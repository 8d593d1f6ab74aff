// The run that is shown, and the axis of its time, which all of its plots share.
import {Axis} from "../shared/axis.js";

export const axis = new Axis();

/** {asked, answer, motion, units, more}; more: what a second answer brings, once it is there. */
export let run = null;

export function setRun(newest) {
  run = newest;
}

/** The cursor goes to a moment that was chosen in a plot. */
export const pick = (tau) => axis.point(tau, "pick");

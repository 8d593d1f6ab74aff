// The run that is shown, and the axis of its time, which all of its plots share.
import {Axis} from "../shared/axis.js";

export const axis = new Axis();

/** {asked, answer, motion, units, more}; more: what a second answer brings, once it is there. */
export let run = null;

export function setRun(newest) {
  run = newest;
}

/** The cursor goes to a moment that is pointed at in a plane; to one out of view by a click alone. */
export function pick(tau, clicked) {
  if (clicked) axis.reveal(tau);
  if (axis.holds(tau)) axis.point(tau, "pick");
}

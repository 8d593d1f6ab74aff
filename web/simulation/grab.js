// Grabbing parts of the machine: a drag of the ball sets its initial position y0, a drag of a wall
// sets the clearance b.
import {on} from "../shared/dom.js";
import {clamp} from "../shared/numbers.js";
import * as machine from "./machine.js";
import {run, viewport} from "./run.js";

const reach = 14; // px within which a part is grabbed

/** The part at a position of the drawing with the absorber: "ball", "wall" or undefined. */
function partAt({ball, wall, along}, event) {
  const x = along(event);
  if (Math.abs(ball - x) < reach) return "ball";
  return [1, -1].some((side) => Math.abs(wall(side) - x) < reach) ? "wall" : undefined;
}

/**
 * set(fields, dragging) is called with y0 (m) or b (m). The scale is held during a drag, so that the
 * part stays under the pointer.
 */
export function start(canvas, set) {
  let part;
  let drawing;
  const drag = (event, dragging) => {
    const {b, parameters} = run.motion;
    const away = (drawing.along(event) - drawing.px(drawing.x)) / drawing.scale; // y - x
    const most = 0.999 * b;
    const fields =
      part === "ball"
        ? {y0: parameters.x0 + clamp(away, -most, most)}
        : {b: Math.max(Math.abs(away), 1e-4)};
    const [[name, value]] = Object.entries(fields);
    set({[name]: Number(value.toPrecision(4))}, dragging);
  };
  const end = (event) => {
    if (part) drag(event, false);
    part = undefined;
    machine.holdScale(null);
  };
  on(canvas, {
    pointerdown(event) {
      drawing = machine.drawn();
      part = drawing && partAt(drawing, event);
      if (!part) return;
      event.preventDefault();
      canvas.setPointerCapture(event.pointerId);
      machine.holdScale(drawing.scale);
      if (part === "ball") viewport.point(0, "grab");
      drawing = machine.drawn();
    },
    pointermove(event) {
      if (part) return drag(event, true);
      const at = machine.drawn() && partAt(machine.drawn(), event);
      canvas.style.cursor = at ? "ew-resize" : "";
    },
    pointerup: end,
    pointercancel: end,
  });
}

// What one draws with: on a canvas' context, or on what has its methods.
import {colour} from "./colours.js";

/** The colour, the width and the dashes of what is drawn from here on. */
export function ink(c, name, width = 1, dash = []) {
  c.strokeStyle = c.fillStyle = colour(name);
  c.lineWidth = width;
  c.setLineDash(dash);
}

/** A line through points [x, y]. */
export function stroke(c, points) {
  c.beginPath();
  for (const [x, y] of points) c.lineTo(x, y);
  c.stroke();
}

/** A text at a place, by default about it. */
export function write(c, text, x, y, align = "center", baseline = "middle") {
  c.textAlign = align;
  c.textBaseline = baseline;
  c.fillText(text, x, y);
}

/** The same from below upwards. */
export function writeUpwards(c, text, x, y) {
  c.save();
  c.translate(x, y);
  c.rotate(-Math.PI / 2);
  write(c, text, 0, 0);
  c.restore();
}

// Drawing primitives for a canvas context or an SvgPen.
import {colour} from "./colours.js";

export function ink(c, name, width = 1, dash = []) {
  c.strokeStyle = c.fillStyle = colour(name);
  c.lineWidth = width;
  c.setLineDash(dash);
}

/** Draws a polyline through points [x, y]. */
export function stroke(c, ...points) {
  c.beginPath();
  for (const [x, y] of points) c.lineTo(x, y);
  c.stroke();
}

/** Draws a text, centred by default. */
export function drawText(c, text, x, y, align = "center", baseline = "middle") {
  c.textAlign = align;
  c.textBaseline = baseline;
  c.fillText(text, x, y);
}

export function drawTextUpwards(c, text, x, y) {
  c.save();
  c.translate(x, y);
  c.rotate(-Math.PI / 2);
  drawText(c, text, 0, 0);
  c.restore();
}

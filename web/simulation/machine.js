// The machine at the cursor, to scale, with and without the absorber; ball and walls are dragged.
import {$, on, setTexts} from "../shared/dom.js";
import {lawsInSi} from "../shared/form.js";
import {blank, font, sizeOf} from "../shared/frame.js";
import {drawText, ink} from "../shared/ink.js";
import {clamp, inMm, percent, shortTo} from "../shared/numbers.js";
import {run, viewport} from "./run.js";

const flashDuration = 0.12; // cycles

const anchor = 14; // px
const ballRadius = 11; // px
const rim = 14; // px of the oscillator outside its walls
const bandHeight = 9; // px of the band below the machine

let drawn = null; // geometry of the machine with the absorber
let held = null; // the same at the start of a drag, and the part that is dragged

const [leastTilt, mostTilt] = [4, 12].map((degrees) => (degrees * Math.PI) / 180);

/** {text, angle drawn} of an inclined track; null without gravity. Its sign alone can be known. */
function tiltOf(parameters) {
  const {gravity, si} = parameters;
  if (!gravity) return null;
  const {inclination} = si ? lawsInSi(parameters) : {inclination: null};
  const size = clamp(Math.abs(inclination ?? leastTilt), leastTilt, mostTilt);
  const degrees = (radians) => `${shortTo(3, (radians * 180) / Math.PI)}°`;
  const angle = Math.sign(gravity) * size;
  if (inclination === null) return {angle, text: `, gravity ${inMm(gravity)}`};
  const scale = angle === inclination ? "" : `, drawn at ${degrees(angle)}`;
  return {angle, text: `, inclined by ${degrees(inclination)}${scale}`};
}

/** Draws a path in the notation of SVG. */
const line = (c, path) => c.stroke(new Path2D(path));

function spring(c, to, y) {
  const turns = 8;
  const ends = 10;
  const step = (to - anchor - 2 * ends) / turns;
  const coil = (_, k) => `L${anchor + ends + (k + 0.5) * step} ${y + (k % 2 ? 7 : -7)}`;
  ink(c, "text", 2);
  const coils = Array.from({length: turns}, coil).join("");
  line(c, `M${anchor} ${y}h${ends}${coils}L${to - ends} ${y}h${ends}`);
}

function damper(c, to, y) {
  const piston = anchor + 0.55 * (to - anchor);
  const [from, end] = [piston - 14, piston + 10];
  ink(c, "text", 1.5);
  line(c, `M${anchor} ${y}H${from}M${end} ${y - 6}H${from}v12H${end}`);
  line(c, `M${piston} ${y - 4}v8m0 -4H${to}`);
}

/** Rays at the wall of the last impact. */
function flash(c, x, y, inwards, share) {
  c.globalAlpha = 1 - share;
  ink(c, "flash", 2.5);
  for (const angle of [-0.9, -0.35, 0.35, 0.9]) {
    const [cos, sin] = [Math.cos(angle) * inwards, Math.sin(angle)];
    const end = `${x + (12 + 6 * share) * cos} ${y + (26 + 8 * share) * sin}`;
    line(c, `M${x + 5 * cos} ${y + 16 * sin}L${end}`);
  }
  c.globalAlpha = 1;
}

function label(c, colour, text, x, y, baseline, as = font) {
  c.font = as;
  ink(c, colour);
  drawText(c, text, x, y, "center", baseline);
}

/** Turns what is drawn afterwards, made smaller to fit. Returns along(event), px of the track. */
function turn(c, {width, height}, angle) {
  const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
  const [x, y, top] = [width / 2, height / 2, 16];
  const fit = Math.min(1, (height - top) / (width * Math.abs(sin) + (height - top) * cos));
  c.translate(x, y + top / 2);
  c.transform(fit * cos, fit * sin, -fit * sin, fit * cos, 0, 0);
  c.translate(-x, -y - top / 2);
  return ({offsetX, offsetY}) => x + ((offsetX - x) * cos + (offsetY - y - top / 2) * sin) / fit;
}

/** Draws what both machines share, and the range of the oscillator; returns the geometry. */
function drawShared(canvas, size, {x, peak, title, colour}) {
  const {width, height} = size;
  const c = blank(canvas, size);
  const {motion, answer} = run;
  const length = Math.max(width * 0.16, 48); // of the spring
  const room = (width - length - 24) / 2;
  const reach = Math.max(motion.reach, answer.energy.without_absorber.peak ?? 0);
  const scale = held?.scale ?? Math.max(room - rim - ballRadius, 10) / (motion.b + reach);
  const px = (at) => length + 12 + room + at * scale;
  const wall = (side) => px(x - side * motion.b);
  const [top, floor] = [24, height - bandHeight - 8];
  const [left, right] = [wall(1) - ballRadius, wall(-1) + ballRadius];
  const level = (top + floor - 12) / 2;
  const tilt = tiltOf(answer.parameters);
  const text = `${title}: ± ${inMm(peak, 2)}${tilt?.text ?? ""}`;
  label(c, "text", text, width / 2, 1, "top", `600 ${font}`);
  const along = tilt ? turn(c, size, tilt.angle) : ({offsetX}) => offsetX;
  ink(c, "soft");
  line(c, `M${anchor} ${floor + 0.5}H${width - 8}`);
  ink(c, "soft", 3);
  line(c, `M${anchor} 14V${floor}`);
  spring(c, left - rim, level - 8);
  damper(c, left - rim, level + 10);
  c.beginPath();
  c.roundRect(left - rim, top - 8, right - left + 2 * rim, floor - top + 6, 5);
  ink(c, "oscillator");
  c.fill();
  ink(c, colour, 1.2);
  c.stroke();
  ink(c, colour, 2);
  c.globalAlpha = 0.35;
  c.fillRect(px(-peak), floor + 5, px(peak) - px(-peak), bandHeight);
  c.globalAlpha = 1;
  line(c, `M${px(x)} ${floor + 3}v${bandHeight + 4}`);
  return {c, px, wall, scale, x, top, bottom: floor - 12, level, left, right, along};
}

function drawWith(canvas, size, cursor) {
  const {motion, answer} = run;
  const {x, y} = motion.at(cursor);
  const about = {x, peak: answer.energy.peak, title: "with absorber", colour: "accent"};
  const drawing = drawShared(canvas, size, about);
  const {c, px, wall, level, top, bottom, left, right} = drawing;
  drawn = {...drawing, ball: px(y)};
  const fill = (name, from, width) => {
    ink(c, name);
    c.fillRect(from, top, width, bottom - top);
  };
  fill("panel", left - 3, right - left + 6);
  fill("plus", left - 6, 3);
  fill("minus", right + 3, 3);
  ink(c, "mass");
  c.beginPath();
  c.arc(px(y), level, ballRadius, 0, 2 * Math.PI);
  c.fill();
  const {impacts, cycle} = motion;
  const i = motion.impactBefore(cursor);
  const side = impacts.side[i];
  const share = (cursor - impacts.tau[i]) / (flashDuration * cycle);
  if (share < 1) flash(c, wall(side) - side * (ballRadius + 2), level, side, share);
  if (right - left < 150 || size.height < 100) return;
  label(c, "plus", "x − y = b", left + 30, bottom - 1, "bottom");
  label(c, "minus", "−b", right - 10, bottom - 1, "bottom");
  label(c, "mass", "ball", px(y), level - ballRadius - 1, "bottom");
}

function drawWithout(canvas, size, cursor) {
  const x = run.motion.withoutAbsorber(cursor);
  if (x === null) return blank(canvas, size); // not known yet
  const {peak} = run.answer.energy.without_absorber;
  const about = {x, peak, title: "without", colour: "without"};
  const {c, level, left, right} = drawShared(canvas, size, about);
  ink(c, "without");
  c.globalAlpha = 0.2;
  c.fillRect(left, level - 3, right - left, 6);
  c.globalAlpha = 1;
}

const machines = [
  [$("machine"), drawWith],
  [$("machine-without"), drawWithout],
].map(([canvas, draw]) => ({canvas, draw, size: sizeOf(canvas, redraw)}));

export function redraw() {
  const {cursor} = viewport;
  if (!run || cursor === null) return;
  for (const {canvas, draw, size} of machines) if (size.width) draw(canvas, size, cursor);
}

/** Shows in large figures by how much the absorber reduces the rms of x. */
export function showReduction({rms_ratio: ratio, rms, without_absorber: without}) {
  const known = ratio != null;
  $("reduction").hidden = !known;
  if (!known) return;
  setTexts({
    "reduction-figure": percent(Math.abs(1 - ratio)),
    "reduction-word": ratio <= 1 ? "less vibration" : "more vibration",
    "reduction-rms": `rms of x ${inMm(rms, 3)} instead of ${inMm(without.rms, 3)}`,
  });
}

const reach = 14; // px within which a part is grabbed

/** The part at the place of a pointer: "ball", "wall" or undefined. */
function partAt(event) {
  const {ball, wall} = drawn;
  const x = drawn.along(event);
  if (Math.abs(ball - x) < reach) return "ball";
  return [1, -1].some((side) => Math.abs(wall(side) - x) < reach) ? "wall" : undefined;
}

/** set(fields, dragging) is called with y0 or b, m. A drag holds the scale. */
export function start(set) {
  const [{canvas}] = machines;
  const drag = (event, dragging) => {
    const {b, parameters} = run.motion;
    const away = (held.along(event) - held.px(held.x)) / held.scale; // y - x
    const most = 0.999 * b;
    const [name, value] =
      held.part === "ball"
        ? ["y0", parameters.x0 + clamp(away, -most, most)]
        : ["b", Math.max(Math.abs(away), 1e-4)];
    set({[name]: Number(value.toPrecision(4))}, dragging);
  };
  const end = (event) => {
    if (held) drag(event, false);
    held = null;
    redraw();
  };
  on(canvas, {
    pointerdown(event) {
      const part = drawn && partAt(event);
      if (!part) return;
      event.preventDefault();
      canvas.setPointerCapture(event.pointerId);
      if (part === "ball") viewport.point(0);
      held = {...drawn, part};
    },
    pointermove(event) {
      if (held) return drag(event, true);
      canvas.style.cursor = drawn && partAt(event) ? "ew-resize" : "";
    },
    pointerup: end,
    pointercancel: end,
  });
}

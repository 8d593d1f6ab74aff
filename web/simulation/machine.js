// Drawing of the machine to scale at the cursor: spring, damper, oscillator, walls, and the ball
// with a short trail; impacts flash.
import {$} from "../shared/dom.js";
import {blank, font, Size} from "../shared/frame.js";
import {drawText, ink} from "../shared/ink.js";
import {clamp} from "../shared/numbers.js";
import {run, viewport} from "./run.js";

const flashDuration = 0.12; // cycles
const trail = [0.12, 0.08, 0.04, 0]; // positions of the trail, cycles ago

const anchor = 14; // px
const top = 30; // px of the cavity
const ballRadius = 11; // px
const nameWidth = 76; // px of the ball's name, which stays over the cavity
const rim = 14; // px of the oscillator outside its walls

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

function ground(c, floor, width) {
  ink(c, "soft");
  line(c, `M${anchor} ${floor + 0.5}H${width - 8}`);
  for (let x = anchor + 8; x < width - 8; x += 14) line(c, `M${x} ${floor + 1}l-6 7`);
  ink(c, "soft", 3);
  line(c, `M${anchor} 14V${floor}`);
}

function body(c, left, right, floor) {
  c.beginPath();
  c.roundRect(left, top - 12, right - left, floor + 11 - top, 5);
  ink(c, "oscillator");
  c.fill();
  ink(c, "accent", 1.2);
  c.stroke();
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

function label(c, name, ...text) {
  ink(c, name);
  drawText(c, ...text);
}

const canvas = $("machine");
const size = new Size(canvas, redraw);

/** Draws the state at the cursor. */
export function redraw() {
  const {cursor} = viewport;
  const {width, height} = size;
  if (!run || cursor === null || !width) return;
  const {motion} = run;
  const c = blank(canvas, size);
  const length = Math.max(width * 0.16, 60); // of the spring
  const room = (width - length - 24) / 2;
  const scale = Math.max(room - rim - ballRadius, 10) / (motion.b + motion.reach);
  const px = (at) => length + 12 + room + at * scale;
  const {x, y} = motion.at(cursor);
  const wall = (side) => px(x - side * motion.b);
  const floor = height - 16;
  const bottom = floor - 22;
  const level = (top + bottom) / 2;
  const [left, right] = [wall(1) - ballRadius, wall(-1) + ballRadius];
  ground(c, floor, width);
  spring(c, left - rim, level - 9);
  damper(c, left - rim, level + 13);
  body(c, left - rim, right + rim, floor);
  cavity(c, left, right, bottom);
  mass(c, px, x, level);
  impact(c, wall, level);
  c.font = font;
  if (motion.parameters.G) label(c, "soft", "↔ base", 4, 8, "left", "middle");
  c.font = "italic 13px system-ui";
  label(c, "accent", "oscillator x", px(x), top - 14, "center", "bottom");
  const reach = Math.min(nameWidth / 2, (right - left) / 2);
  const middle = clamp(px(y), left + reach, right - reach);
  label(c, "mass", "ball y", middle, top + 1, "center", "bottom");
  c.font = font;
  const [at, opposite] = right - left > 2 * nameWidth ? ["y − x = −b", "y − x = b"] : ["−b", "b"];
  label(c, "plus", at, left, bottom + 3, "left", "top");
  label(c, "minus", opposite, right, bottom + 3, "right", "top");
}

function cavity(c, left, right, bottom) {
  const fill = (name, from, width) => {
    ink(c, name);
    c.fillRect(from, top, width, bottom - top);
  };
  fill("panel", left - 3, right - left + 6);
  fill("plus", left - 6, 3);
  fill("minus", right + 3, 3);
}

/** The ball and its trail, relative to the current position of the cavity. */
function mass(c, px, x, level) {
  ink(c, "mass");
  trail.forEach((cycles, k) => {
    const moment = viewport.cursor - cycles * run.motion.cycle;
    if (moment < 0) return;
    c.globalAlpha = cycles ? 0.1 + 0.08 * k : 1;
    c.beginPath();
    const then = run.motion.at(moment);
    c.arc(px(x + then.y - then.x), level, ballRadius, 0, 2 * Math.PI);
    c.fill();
  });
}

function impact(c, wall, level) {
  const {impacts, cycle} = run.motion;
  const i = run.motion.impactBefore(viewport.cursor);
  const side = impacts.side[i];
  const share = (viewport.cursor - impacts.tau[i]) / (flashDuration * cycle);
  if (share < 1) flash(c, wall(side) - side * (ballRadius + 2), level, side, share);
}

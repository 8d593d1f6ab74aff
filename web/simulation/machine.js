// The machine itself, to scale, at one moment of the run: spring, oscillator, walls, the free mass
// and where it just came from; a flash at an impact.
import {colour} from "../shared/colours.js";
import {blank, Size} from "../shared/frame.js";

const flashes = 0.12; // cycles that a flash lasts
const ghosts = [0.12, 0.08, 0.04]; // cycles back at which the mass is shown, too

const ball = 11; // px
const rim = 14; // px of the oscillator's body beyond its walls

/** Pixels of a drawing: its middle, its floor, and how many of them are a metre. */
function placing(width, height, {b, peak}) {
  const spring = Math.max(width * 0.16, 60);
  const room = (width - spring - 24) / 2;
  const scale = Math.max(room - rim - ball, 10) / (b + peak);
  return {anchor: 14, middle: spring + 12 + room, floor: height - 16, scale, width, height};
}

function spring(c, from, to, y) {
  const turns = 8;
  const ends = 10;
  const step = (to - from - 2 * ends) / turns;
  c.beginPath();
  c.moveTo(from, y);
  c.lineTo(from + ends, y);
  for (let k = 0; k < turns; ++k) c.lineTo(from + ends + (k + 0.5) * step, y + (k % 2 ? 9 : -9));
  c.lineTo(to - ends, y);
  c.lineTo(to, y);
  c.stroke();
}

function ground(c, {anchor, floor, width}) {
  c.strokeStyle = colour("soft");
  c.lineWidth = 1;
  c.beginPath();
  c.moveTo(anchor, floor + 0.5);
  c.lineTo(width - 8, floor + 0.5);
  for (let x = anchor + 8; x < width - 8; x += 14) {
    c.moveTo(x, floor + 1);
    c.lineTo(x - 6, floor + 8);
  }
  c.stroke();
  c.lineWidth = 3;
  c.beginPath();
  c.moveTo(anchor, 14);
  c.lineTo(anchor, floor);
  c.stroke();
}

function body(c, left, right, top, {floor}) {
  c.fillStyle = colour("body");
  c.strokeStyle = colour("accent");
  c.lineWidth = 1.2;
  c.beginPath();
  c.roundRect(left, top, right - left, floor - 1 - top, 5);
  c.fill();
  c.stroke();
}

/** The wall at which the mass was met last: a few rays. */
function flash(c, x, y, inwards, share) {
  c.globalAlpha = 1 - share;
  c.strokeStyle = colour("flash");
  c.lineWidth = 2.5;
  c.beginPath();
  for (const angle of [-0.9, -0.35, 0.35, 0.9]) {
    const [cos, sin] = [Math.cos(angle) * inwards, Math.sin(angle)];
    c.moveTo(x + 5 * cos, y + 16 * sin);
    c.lineTo(x + (12 + 6 * share) * cos, y + (26 + 8 * share) * sin);
  }
  c.stroke();
  c.globalAlpha = 1;
}

function cavity(c, x, row, {scale, middle}, {b}) {
  const wall = (side) => middle + (x - side * b) * scale;
  const half = (row.bottom - row.top) / 2;
  const outer = ball + 3;
  c.fillStyle = colour("panel");
  c.fillRect(wall(1) - outer, row.top, wall(-1) - wall(1) + 2 * outer, 2 * half);
  for (const [side, name] of [
    [1, "plus"],
    [-1, "minus"],
  ]) {
    c.fillStyle = colour(name);
    c.fillRect(wall(side) - side * outer - (side > 0 ? 3 : 0), row.top, 3, 2 * half);
  }
  return wall;
}

export class Machine {
  constructor(canvas) {
    this.canvas = canvas;
    this.size = new Size(canvas, () => this.draw(this.last));
  }

  /** Of a run: its Motion and the largest |x|, m. */
  show(motion, peak) {
    this.motion = motion;
    this.extent = {b: motion.b, peak};
  }

  /** At a moment. */
  draw(tau) {
    this.last = tau;
    const {width, height} = this.size;
    if (!this.motion || tau == null || !width) return;
    const c = blank(this.canvas, this.size);
    const place = placing(width, height, this.extent);
    const {x, y} = this.motion.at(tau);
    const row = {top: 30, bottom: place.floor - 22};
    const left = place.middle + (x - this.extent.b) * place.scale - ball - rim;
    const right = place.middle + (x + this.extent.b) * place.scale + ball + rim;
    ground(c, place);
    c.strokeStyle = colour("text");
    c.lineWidth = 2;
    spring(c, place.anchor, left, (row.top + row.bottom) / 2);
    body(c, left, right, row.top - 12, place);
    const wall = cavity(c, x, row, place, this.extent);
    this.mass(c, tau, y, row, place);
    this.impact(c, tau, wall, row);
    this.labels(c, x, y, wall, row, place);
  }

  mass(c, tau, y, row, {middle, scale}) {
    const level = (row.top + row.bottom) / 2;
    const disc = (at, alpha) => {
      c.globalAlpha = alpha;
      c.beginPath();
      c.arc(middle + at * scale, level, ball, 0, 2 * Math.PI);
      c.fill();
    };
    c.fillStyle = colour("mass");
    ghosts.forEach((cycles, k) => {
      const before = tau - cycles * this.motion.cycle;
      if (before > 0) disc(this.motion.at(before).y, 0.1 + 0.08 * k);
    });
    disc(y, 1);
  }

  /** The flash of the last impact, while it lasts. */
  impact(c, tau, wall, row) {
    const {tau: moments, side} = this.motion.impacts;
    const i = this.motion.impactBefore(tau);
    const share = i < 0 ? 1 : (tau - moments[i]) / (flashes * this.motion.cycle);
    if (share < 1)
      flash(c, wall(side[i]) - side[i] * (ball + 2), (row.top + row.bottom) / 2, side[i], share);
  }

  labels(c, x, y, wall, row, {middle, scale}) {
    c.font = "italic 13px system-ui";
    c.textAlign = "center";
    c.textBaseline = "bottom";
    c.fillStyle = colour("accent");
    c.fillText("x", middle + x * scale, row.top - 14);
    c.strokeStyle = colour("accent");
    c.lineWidth = 1;
    c.fillStyle = colour("mass");
    c.fillText("y", middle + y * scale, row.top + 1);
    c.textBaseline = "top";
    c.font = "11px system-ui";
    c.textAlign = "left";
    c.fillStyle = colour("plus");
    c.fillText("x − y = b", wall(1) - ball, row.bottom + 3);
    c.textAlign = "right";
    c.fillStyle = colour("minus");
    c.fillText("x − y = −b", wall(-1) + ball, row.bottom + 3);
  }
}

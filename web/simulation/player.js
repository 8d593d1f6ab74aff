// Time that goes by: plays what is in view, over and over, at so many cycles a second; a click of
// each impact if one asks for it.
import {$} from "../shared/dom.js";
import {count, short} from "../shared/numbers.js";

const patience = 150; // ms that it stands still after an edit
const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 20]; // forcing cycles a second

/** A short knock, the louder the harder. */
class Knock {
  constructor() {
    this.audio = null;
  }

  get on() {
    return this.audio !== null;
  }

  toggle() {
    if (this.on) {
      this.audio.close();
      this.audio = null;
    } else this.audio = new AudioContext();
  }

  /** strength: 0 to 1. */
  sound(strength) {
    if (!this.on || this.audio.state !== "running") return;
    const {currentTime: now} = this.audio;
    const tone = this.audio.createOscillator();
    const volume = this.audio.createGain();
    tone.frequency.value = 900;
    volume.gain.setValueAtTime(0.05 + 0.35 * Math.min(strength, 1), now);
    volume.gain.exponentialRampToValueAtTime(0.001, now + 0.05);
    tone.connect(volume).connect(this.audio.destination);
    tone.start(now);
    tone.stop(now + 0.06);
  }
}

export class Player {
  /** axis: whose cursor goes along; draw(tau): the machine at a moment. */
  constructor(axis, draw) {
    Object.assign(this, {axis, draw, motion: null, frame: 0, before: 0, held: 0});
    this.knock = new Knock();
    this.speed = 1;
    $("speed").append(...speeds.map((v) => new Option(`${count(short(v), "cycle")}/s`, String(v))));
    $("speed").value = String(this.speed);
    $("speed").addEventListener("change", () => {
      this.speed = Number($("speed").value);
    });
    $("play").addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    $("restart").addEventListener("click", () => axis.point(this.begin(...axis.view), "restart"));
    $("sound").addEventListener("click", () => this.toggleSound());
    $("scrub").addEventListener("input", () => {
      const [from, to] = axis.view;
      axis.point(from + (Number($("scrub").value) / 1000) * (to - from), "scrub");
    });
    axis.onCursor((by) => this.pointed(by));
    axis.onView(() => this.showPlace());
  }

  get playing() {
    return this.frame !== 0;
  }

  /** Of a run; units: as of unitsOf. */
  show(motion, units) {
    Object.assign(this, {motion, units});
    const [from, to] = this.axis.view;
    const {cursor} = this.axis;
    const outside = cursor === null || cursor < from || cursor > to;
    this.axis.point(outside ? this.begin(from, to) : cursor, "show");
  }

  /** Where something is about to happen: just before the first impact in view. */
  begin(from, to) {
    const {tau} = this.motion.impacts;
    const first = tau[this.motion.impactBefore(from) + 1];
    return first <= to ? Math.max(first - this.motion.cycle / 2, from) : from;
  }

  play() {
    $("play").textContent = "❚❚";
    $("play").setAttribute("aria-label", "Pause");
    this.before = performance.now();
    const next = (now) => {
      this.frame = requestAnimationFrame(next);
      this.advance((now - this.before) / 1000);
      this.before = now;
    };
    this.frame = requestAnimationFrame(next);
  }

  pause() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    $("play").textContent = "▶";
    $("play").setAttribute("aria-label", "Play");
    this.showPlace();
  }

  toggleSound() {
    this.knock.toggle();
    $("sound").setAttribute("aria-pressed", String(this.knock.on));
  }

  /** Stands still for a moment: there is more to do than to play. */
  hold() {
    this.held = performance.now() + patience;
  }

  advance(seconds) {
    if (!this.motion || seconds > 1) return; // another tab was in front
    if (performance.now() < this.held) return;
    const [from, to] = this.axis.view;
    const {cursor} = this.axis;
    const next = cursor + seconds * this.speed * this.motion.cycle;
    if (next > to || next < from) return this.axis.point(this.begin(from, to), "play");
    this.hear(cursor, next);
    this.axis.point(next, "play");
  }

  hear(from, to) {
    const {impacts} = this.motion;
    const i = this.motion.impactBefore(to);
    if (i < 0 || impacts.tau[i] <= from) return;
    this.knock.sound(impacts.relative_speed_ratio[i] / 2);
  }

  pointed(by) {
    if (!this.motion) return;
    if (this.playing && by === "pointer") return; // it goes its own way
    this.draw(this.axis.cursor);
    this.showPlace();
  }

  /** What moment it is, in words, for all; where on the way, for the eye. */
  showPlace() {
    const {axis, motion} = this;
    if (!motion || axis.cursor === null) return;
    const [from, to] = axis.view;
    const impacts = motion.impactBefore(axis.cursor) + 1;
    const {y_dot: speed, side} = motion.at(axis.cursor);
    const {velocity} = this.units;
    const how = side
      ? "stuck to the wall"
      : `y′ = ${short(Number(velocity.of(speed).toPrecision(3)))} ${velocity.unit}`;
    const text = `${this.units.at(axis.cursor)} · ${count(impacts, "impact")} so far · ${how}`;
    if ($("moment").textContent !== text) $("moment").textContent = text;
    $("scrub").value = String(Math.round(((axis.cursor - from) / (to - from)) * 1000));
    if (!this.playing) $("scrub").setAttribute("aria-valuetext", text);
  }
}

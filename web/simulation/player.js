// Time that goes by: plays what is in view, over and over, at so many cycles a second; a click of
// each impact if one asks for it.
import {$, aria, write} from "../shared/dom.js";
import {count, significant} from "../shared/numbers.js";

const patience = 150; // ms that it stands still after an edit
const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 20]; // forcing cycles a second

/** A short knock, the louder the harder; strength: 0 to 1. */
function knock(audio, strength) {
  const {currentTime: now, destination} = audio;
  const tone = new OscillatorNode(audio, {frequency: 900});
  const volume = new GainNode(audio);
  volume.gain.setValueAtTime(0.05 + 0.35 * Math.min(strength, 1), now);
  volume.gain.exponentialRampToValueAtTime(0.001, now + 0.05);
  tone.connect(volume).connect(destination);
  tone.start(now);
  tone.stop(now + 0.06);
}

export class Player {
  /** axis: whose cursor goes along; draw(tau): the machine at a moment. */
  constructor(axis, draw) {
    Object.assign(this, {axis, draw, motion: null, frame: 0, held: 0, audio: null});
    $("speed").append(...speeds.map((v) => new Option(`${count(v, "cycle")}/s`, v)));
    $("speed").value = 1;
    $("play").onclick = () => (this.playing ? this.pause() : this.play());
    $("restart").onclick = () => this.restart("restart");
    $("sound").onclick = () => this.toggleSound();
    $("scrub").oninput = () => {
      const [from, to] = axis.view;
      axis.point(from + ($("scrub").value / 1000) * (to - from), "scrub");
    };
    axis.onCursor((by) => this.pointed(by));
    axis.onView(() => this.showPlace());
  }

  get playing() {
    return this.frame !== 0;
  }

  /** Of a run; units: as of unitsOf. */
  show(motion, units) {
    Object.assign(this, {motion, units});
    if (this.inView(this.axis.cursor)) this.axis.point(this.axis.cursor, "show");
    else this.restart("show");
  }

  inView(moment) {
    const [from, to] = this.axis.view;
    return moment !== null && moment >= from && moment <= to;
  }

  /** To where something is about to happen: just before the first impact in view. */
  restart(by) {
    const [from] = this.axis.view;
    const {impacts, cycle} = this.motion;
    const first = impacts.tau[this.motion.impactBefore(from) + 1];
    this.axis.point(first && this.inView(first) ? Math.max(first - cycle / 2, from) : from, by);
  }

  play() {
    let before = performance.now();
    const next = (now) => {
      this.frame = requestAnimationFrame(next);
      this.advance((now - before) / 1000);
      before = now;
    };
    this.frame = requestAnimationFrame(next);
    this.showButton("❚❚", "Pause");
  }

  pause() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.showButton("▶", "Play");
    this.showPlace();
  }

  showButton(text, label) {
    write("play", text);
    aria($("play"), {label});
  }

  toggleSound() {
    this.audio?.close();
    this.audio = this.audio ? null : new AudioContext();
    aria($("sound"), {pressed: this.audio !== null});
  }

  /** Stands still for a moment: there is more to do than to play. */
  hold() {
    this.held = performance.now() + patience;
  }

  advance(seconds) {
    if (!this.motion || seconds > 1) return; // another tab was in front
    if (performance.now() < this.held) return;
    const {cursor} = this.axis;
    const next = cursor + seconds * $("speed").value * this.motion.cycle;
    if (!this.inView(next)) return this.restart("play");
    this.hear(cursor, next);
    this.axis.point(next, "play");
  }

  hear(from, to) {
    const {impacts} = this.motion;
    const i = this.motion.impactBefore(to);
    if (this.audio?.state === "running" && impacts.tau[i] > from)
      knock(this.audio, impacts.relative_speed_ratio[i] / 2);
  }

  pointed(by) {
    if (!this.motion || (this.playing && by === "pointer")) return; // it goes its own way
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
      : `y′ = ${significant(velocity.of(speed), 3)} ${velocity.unit}`;
    const text = `${this.units.at(axis.cursor)} · ${count(impacts, "impact")} so far · ${how}`;
    if ($("moment").textContent !== text) write("moment", text);
    $("scrub").value = ((axis.cursor - from) / (to - from)) * 1000;
    if (!this.playing) aria($("scrub"), {valuetext: text});
  }
}

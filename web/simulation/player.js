// Time that goes by: plays what is in view, over and over, at so many cycles a second; a click of
// each impact if one asks for it.
import {$, attributes, write} from "../shared/dom.js";
import {count, shortTo} from "../shared/numbers.js";
import * as machine from "./machine.js";
import {axis, run} from "./run.js";

const patience = 150; // ms that it stands still after an edit
const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 20]; // forcing cycles a second

let frame = 0;
let held = 0;
let audio = null;

/** A short knock, the louder the harder; strength: 0 to 1. */
function knock(strength) {
  const {currentTime: now, destination} = audio;
  const tone = new OscillatorNode(audio, {frequency: 900});
  const volume = new GainNode(audio);
  volume.gain.setValueAtTime(0.05 + 0.35 * Math.min(strength, 1), now);
  volume.gain.exponentialRampToValueAtTime(0.001, now + 0.05);
  tone.connect(volume).connect(destination);
  tone.start(now);
  tone.stop(now + 0.06);
}

export function start() {
  $("speed").append(...speeds.map((v) => new Option(`${count(v, "cycle")}/s`, v)));
  $("speed").value = 1;
  $("play").onclick = () => (frame ? pause() : play());
  $("restart").onclick = () => restart("restart");
  $("sound").onclick = toggleSound;
  $("scrub").oninput = () => {
    const [from, to] = axis.view;
    axis.point(from + ($("scrub").value / 1000) * (to - from), "scrub");
  };
  axis.onCursor(pointed);
  axis.onView(showPlace);
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();
}

/** Another run is there. */
export function show() {
  if (inView(axis.cursor)) axis.point(axis.cursor, "show");
  else restart("show");
}

const inView = (moment) => moment !== null && axis.holds(moment);

/** To where something is about to happen: just before the first impact in view. */
function restart(by) {
  const [from] = axis.view;
  const {motion} = run;
  const first = motion.impacts.tau[motion.impactBefore(from) + 1];
  axis.point(inView(first) ? Math.max(first - motion.cycle / 2, from) : from, by);
}

function play() {
  let before = performance.now();
  const next = (now) => {
    frame = requestAnimationFrame(next);
    advance((now - before) / 1000);
    before = now;
  };
  frame = requestAnimationFrame(next);
  showButton("❚❚", "Pause");
}

function pause() {
  cancelAnimationFrame(frame);
  frame = 0;
  showButton("▶", "Play");
  showPlace();
}

function showButton(text, label) {
  write({play: text});
  attributes($("play"), {"aria-label": label});
}

function toggleSound() {
  audio?.close();
  audio = audio ? null : new AudioContext();
  attributes($("sound"), {"aria-pressed": audio !== null});
}

/** Stands still for a moment: there is more to do than to play. */
export function hold() {
  held = performance.now() + patience;
}

function advance(seconds) {
  if (!run || seconds > 1) return; // another tab was in front
  if (performance.now() < held) return;
  const {cursor} = axis;
  const next = cursor + seconds * $("speed").value * run.motion.cycle;
  if (!inView(next)) return restart("play");
  hear(cursor, next);
  axis.point(next, "play");
}

function hear(from, to) {
  const {impacts} = run.motion;
  const i = run.motion.impactBefore(to);
  if (audio?.state === "running" && impacts.tau[i] > from)
    knock(impacts.relative_speed_ratio[i] / 2);
}

function pointed(by) {
  if (!run || (frame && by === "pointer")) return; // it goes its own way
  machine.redraw();
  showPlace();
}

/** What moment it is, in words, for all; where on the way, for the eye. */
function showPlace() {
  const {cursor} = axis;
  if (!run || cursor === null) return;
  const {motion, units} = run;
  const {velocity} = units;
  const [from, to] = axis.view;
  const {y_dot: speed, side} = motion.at(cursor);
  const how = side
    ? "stuck to the wall"
    : `y′ = ${shortTo(3, velocity.of(speed))} ${velocity.unit}`;
  const impacts = count(motion.impactBefore(cursor) + 1, "impact");
  const text = `${units.at(cursor)} · ${impacts} so far · ${how}`;
  if ($("moment").textContent !== text) write({moment: text});
  $("scrub").value = ((cursor - from) / (to - from)) * 1000;
  if (!frame) attributes($("scrub"), {"aria-valuetext": text});
}

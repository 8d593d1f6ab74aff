// The player: moves the cursor through the visible range in a loop, with a knock at each impact.
import {$, attributes, setTexts} from "../shared/dom.js";
import {count, shortTo} from "../shared/numbers.js";
import * as machine from "./machine.js";
import {run, viewport} from "./run.js";

let frame = 0;
let audio = null;

/** A short knock; strength: 0 to 1. */
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

/** Called when another run is shown. */
export function show() {
  if (inView(viewport.cursor)) viewport.point(viewport.cursor);
  else restart();
}

const inView = (moment) => moment !== null && viewport.holds(moment);

/** Moves the cursor half a cycle before the first impact in view. */
function restart(by) {
  const [from] = viewport.range;
  const {motion} = run;
  const first = motion.impacts.tau[motion.impactBefore(from) + 1];
  viewport.point(inView(first) ? Math.max(first - motion.cycle / 2, from) : from, by);
}

function play() {
  let before = performance.now();
  const next = (now) => {
    frame = requestAnimationFrame(next);
    advance((now - before) / 1000);
    before = now;
  };
  frame = requestAnimationFrame(next);
  Object.assign($("play"), {textContent: "❚❚", ariaLabel: "Pause"});
}

function pause() {
  cancelAnimationFrame(frame);
  frame = 0;
  Object.assign($("play"), {textContent: "▶", ariaLabel: "Play"});
  showPlace();
}

function toggleSound() {
  audio?.close();
  audio = audio ? null : new AudioContext();
  attributes($("sound"), {"aria-pressed": audio !== null});
}

function advance(seconds) {
  if (!run || seconds > 1) return; // the browser tab was in the background
  const {cursor} = viewport;
  const next = cursor + seconds * $("speed").value * run.motion.cycle;
  if (!inView(next)) return restart("play");
  const {impacts} = run.motion;
  const i = run.motion.impactBefore(next);
  if (audio?.state === "running" && impacts.tau[i] > cursor)
    knock(impacts.relative_speed_ratio[i] / 2);
  viewport.point(next, "play");
}

function cursorMoved(by) {
  if (!run || (frame && by === "pointer")) return; // a playing cursor ignores the pointer
  machine.redraw();
  showPlace();
}

function showPlace() {
  const {cursor} = viewport;
  if (!run || cursor === null) return;
  const {motion, units} = run;
  const {velocity} = units;
  const [from, to] = viewport.range;
  const {y_dot: speed, side} = motion.at(cursor);
  const how = side
    ? "sticking to the wall"
    : `y′ = ${shortTo(3, velocity.of(speed))} ${velocity.unit}`;
  const impacts = count(motion.impactBefore(cursor) + 1, "impact");
  const text = `${units.at(cursor)} · ${impacts} so far · ${how}`;
  if ($("moment").textContent !== text) setTexts({moment: text});
  $("scrub").value = ((cursor - from) / (to - from)) * 1000;
  if (!frame) attributes($("scrub"), {"aria-valuetext": text});
}

$("play").onclick = () => (frame ? pause() : play());
$("restart").onclick = () => restart();
$("sound").onclick = toggleSound;
$("scrub").oninput = () => {
  const [from, to] = viewport.range;
  viewport.point(from + ($("scrub").value / 1000) * (to - from));
};
viewport.onCursor(cursorMoved);
viewport.onZoom(showPlace);
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();

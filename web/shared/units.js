// The units in which an answer is shown. Where its system was given in SI: s, mm/s, m/s², N s and
// J, or as one likes those of tau = omega0 t; else those of tau.
import {attributes, button} from "./dom.js";

const key = "vines-units";
const tau = "τ";
const seconds = "s, mm/s";

/** What is remembered, where the browser lets us; else it holds for this page alone. */
function remembered(f) {
  try {
    return f(localStorage);
  } catch {
    return null;
  }
}

let chosen = remembered((store) => store.getItem(key)) === tau ? tau : seconds;
const heard = [];
const buttons = [];

/** Whether seconds are asked for, where there are any. */
export const inSeconds = () => chosen === seconds;

/** f: called when other units are chosen. */
export const onUnits = (f) => heard.push(f);

function choose(units) {
  if (units === chosen) return;
  chosen = units;
  remembered((store) => store.setItem(key, units));
  showChosen();
  for (const f of heard) f();
}

function showChosen() {
  for (const each of buttons) attributes(each, {"aria-pressed": each.textContent === chosen});
}

const titles = {
  [seconds]: "as they are in SI",
  [tau]: "time as τ = ω₀t, velocities per unit of it",
};

/** Fills a container with the switch. */
export function unitsSwitch(container) {
  const own = Object.entries(titles).map(([units, title]) =>
    button(units, () => choose(units), {className: "small", title}),
  );
  container.append(...own);
  buttons.push(...own);
  showChosen();
}

/** of(value): the value in `unit`. */
const quantity = (unit, factor) => ({unit, of: (v) => (v == null ? v : v * factor)});

// Velocities per unit of tau are lengths, energies over m1 omega0² are squares of them.
const length = quantity("mm", 1000);
const ofTau = {
  si: false,
  x: {label: tau, factor: 1},
  time: quantity("", 1),
  at: (t) => `τ = ${t.toFixed(1)}`,
  velocity: length,
  acceleration: length,
  impulse: length,
  energy: quantity("mm²", 1e6),
};

/**
 * The units for an answer with these parameters. x: the axis of time; at(tau): a moment
 * in words.
 */
export function unitsOf({si, derived: {omega0}}) {
  if (!si || !inSeconds()) return ofTau;
  return {
    si: true,
    x: {label: "t (s)", factor: 1 / omega0},
    time: quantity("s", 1 / omega0),
    at: (t) => `t = ${(t / omega0).toFixed(2)} s`,
    velocity: quantity("mm/s", 1000 * omega0),
    acceleration: quantity("m/s²", omega0 ** 2),
    impulse: quantity("N s", si.m1 * omega0),
    energy: quantity("J", si.m1 * omega0 ** 2),
  };
}

/**
 * A unit of the service as the page has it, and by what values are multiplied: lengths are in mm.
 */
export function unitShown(unit = "") {
  const plain = unit === "dimensionless" ? "" : unit.replace("per unit of tau", "per τ");
  return /^m($|[ /])/.test(plain) ? {unit: `m${plain}`, factor: 1000} : {unit: plain, factor: 1};
}

// The units in which an answer is shown. Where its system was given in SI: s, mm/s, m/s², N s and
// J, or as one likes those of tau = omega0 t; else those of tau.
import {element} from "./dom.js";

const key = "vines-units";
const tau = "τ";
const seconds = "s, mm/s";

/** What is remembered, where the browser lets us. */
function recall() {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

function remember(value) {
  try {
    localStorage.setItem(key, value);
  } catch {
    // Then it holds for this page alone.
  }
}

let chosen = recall() === tau ? tau : seconds;
const heard = new Set();
const buttons = new Set();

/** Whether seconds are asked for, where there are any. */
export const inSeconds = () => chosen === seconds;

/** f: called when other units are chosen. */
export const onUnits = (f) => heard.add(f);

function choose(units) {
  if (units === chosen) return;
  chosen = units;
  remember(units);
  showChosen();
  for (const f of heard) f();
}

function showChosen() {
  for (const button of buttons)
    button.setAttribute("aria-pressed", String(button.textContent === chosen));
}

/** Fills a container with the switch. */
export function unitsSwitch(container) {
  for (const units of [seconds, tau]) {
    const button = element("button", {type: "button", className: "small", textContent: units});
    button.title =
      units === tau ? "time as τ = ω₀t, velocities per unit of it" : "as they are in SI";
    button.addEventListener("click", () => choose(units));
    buttons.add(button);
    container.append(button);
  }
  showChosen();
}

/** of(value): the value in `unit`. */
const quantity = (factor, unit) => ({
  unit,
  of: factor === 1 ? (v) => v : (v) => (v == null ? null : v * factor),
});

// Velocities per unit of tau are lengths, energies over m1 omega0² are squares of them.
const ofTau = {
  si: false,
  x: {label: "τ", factor: 1},
  time: quantity(1, ""),
  at: (t) => `τ = ${t.toFixed(1)}`,
  velocity: quantity(1000, "mm"),
  acceleration: quantity(1000, "mm"),
  impulse: quantity(1000, "mm"),
  energy: quantity(1e6, "mm²"),
};

/**
 * The units for an answer with these parameters. x: the axis of time; at(tau): a moment
 * in words.
 */
export function unitsOf({si, derived}) {
  if (!si || !inSeconds()) return ofTau;
  const omega0 = derived.omega0;
  const {m1} = si;
  return {
    si: true,
    x: {label: "t (s)", factor: 1 / omega0},
    time: quantity(1 / omega0, "s"),
    at: (t) => `t = ${(t / omega0).toFixed(2)} s`,
    velocity: quantity(1000 * omega0, "mm/s"),
    acceleration: quantity(omega0 ** 2, "m/s²"),
    impulse: quantity(m1 * omega0, "N s"),
    energy: quantity(m1 * omega0 ** 2, "J"),
  };
}

/**
 * A unit of the service as the page has it, and by what values are multiplied: lengths are in mm.
 */
export function unitShown(unit = "") {
  const plain = unit === "dimensionless" ? "" : unit.replace("per unit of tau", "per τ");
  return /^m($|[ /])/.test(plain) ? {unit: `m${plain}`, factor: 1000} : {unit: plain, factor: 1};
}

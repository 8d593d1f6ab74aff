// What the record says of the sensors, of the forcing and of the system: each value with its error.
import {$, element} from "../shared/dom.js";
import {minus, withError} from "../shared/numbers.js";

/** Key of the answer's `fitted`: what it is, its unit, and by what its SI value is multiplied. */
const rows = [
  ["f", "frequency of the forcing", "Hz", 1],
  ["F", "amplitude F of the base", "mm", 1e3],
  ["phase", "its phase at t = 0", "rad", 1],
  ["displacement_offset", "offset of the displacement", "µm", 1e6],
  ["displacement_drift", "its drift over the record", "µm", 1e6],
  ["displacement_gain", "its scale against the acceleration's", "", 1],
  ["displacement_delay_s", "its delay behind the acceleration", "ms", 1e3],
  ["acceleration_offset", "offset of the acceleration", "m/s²", 1],
  ["acceleration_drift", "its drift over the record", "m/s²", 1],
  ["omega0", "ω₀ of the oscillator", "rad/s", 1],
  ["zeta", "its damping ratio ζ", "", 1],
  ["b", "half clearance b", "mm", 1e3],
  ["R_plus", "R at +b", "", 1],
  ["R_minus", "R at −b", "", 1],
];

function row([key, name, unit, factor], fitted) {
  const {value, standard_error: error, fixed} = fitted[key];
  const shown = fixed
    ? Number((value * factor).toPrecision(6)).toString()
    : withError(value * factor, error * factor, 4);
  const text = `${minus(shown)}${unit && ` ${unit}`}${fixed ? ", as given" : ""}`;
  const tr = element("tr");
  tr.append(element("td", {textContent: name}), element("td", {textContent: text}));
  return tr;
}

export function showFit({fitted, signal}) {
  $("measure-fitted").replaceChildren(...rows.map((r) => row(r, fitted)));
  const {forcing} = signal;
  $("measure-channel").textContent = forcing
    ? `By the channel of the forcing f = ${forcing.f.toPrecision(7)} Hz and ` +
      `F = ${(forcing.F * 1000).toPrecision(4)} mm; the motion shows it ` +
      `${forcing.phase.toFixed(3)} rad later.`
    : "";
}

// What the record says of the sensors, of the forcing and of the system: each value with its error.
import {$, element} from "../shared/dom.js";
import {minus, withError} from "../shared/numbers.js";
import {about} from "./measurement_summary.js";

/** Key of the answer's `fitted`: what it is, its unit, and by what its SI value is multiplied. */
const rows = [
  ["f", "frequency of the forcing", "Hz"],
  ["F", "amplitude F of the base", "mm", 1e3],
  ["phase", "its phase at t = 0", "rad"],
  ["displacement_offset", "offset of the displacement", "µm", 1e6],
  ["displacement_drift", "its drift over the record", "µm", 1e6],
  ["displacement_gain", "its scale against the acceleration's"],
  ["displacement_delay_s", "its delay behind the acceleration", "ms", 1e3],
  ["acceleration_offset", "offset of the acceleration", "m/s²"],
  ["acceleration_drift", "its drift over the record", "m/s²"],
  ["omega0", "ω₀ of the oscillator", "rad/s"],
  ["zeta", "its damping ratio ζ"],
  ["b", "half clearance b", "mm", 1e3],
  ["R_plus", "R at +b"],
  ["R_minus", "R at −b"],
];

export function showFit({fitted, signal: {forcing}}) {
  const row = ([key, name, unit = "", factor = 1]) => {
    const {value, standard_error: error, fixed} = fitted[key];
    const shown = fixed
      ? minus(about(value * factor, 6))
      : withError(value * factor, error * factor, 4);
    const text = `${shown} ${unit}`.trim() + (fixed ? ", as given" : "");
    return element("tr", {}, element("td", {}, name), element("td", {}, text));
  };
  $("measure-fitted").replaceChildren(...rows.map(row));
  $("measure-channel").textContent = forcing
    ? `By the channel of the forcing f = ${forcing.f.toPrecision(7)} Hz and ` +
      `F = ${(forcing.F * 1000).toPrecision(4)} mm; the motion shows it ` +
      `${forcing.phase.toFixed(3)} rad later.`
    : "";
}

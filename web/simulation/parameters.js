// Table of a run's parameters: symbol, value with unit, and origin.
import {$} from "../shared/dom.js";
import {resolved} from "../shared/form.js";
import {minus} from "../shared/numbers.js";
import {symbolOf} from "../shared/quantities.js";
import {tableOf} from "../shared/tables.js";

// Derived parameters: unit and what they follow from.
const derived = {
  zeta: ["", "epsilon, lambda, damping"],
  omega0: ["rad/s", "k1, m1"],
  omega_d: ["", "zeta"],
  A: ["m", "G, epsilon, lambda, Omega"],
  phi: ["rad", "epsilon, lambda, Omega"],
  cycle: ["", "Omega"],
  cycle_s: ["s", "f"],
  time_end_s: ["s", "tau_end, omega0"],
  window_s: ["s", "window, omega0"],
};

function precise(value) {
  if (Array.isArray(value)) return value.map(precise).join(" to ");
  if (typeof value === "number") return minus(String(Number(value.toPrecision(6))));
  return String(value).replaceAll("_", " ");
}

export function listParameters(parameters, fieldOf) {
  const {values, origins} = resolved(parameters);
  const all = {...values, ...parameters.derived};
  const known = [...Object.keys(fieldOf), ...Object.keys(derived)].filter(
    (name) => name !== "R" && all[name] != null, // R: each wall has its own row
  );
  const rows = known.map((name) => {
    const [unit, from] = derived[name] ?? [fieldOf[name].unit ?? ""];
    const shown = unit === "dimensionless" ? "" : unit.replace("tau", "τ");
    const origin = origins[name] ?? (from && `follows from ${from}`) ?? "";
    return [name, symbolOf(name), `${precise(all[name])} ${shown}`.trim(), origin];
  });
  $("parameters").replaceChildren(...tableOf(["name", "symbol", "value", "origin"], rows));
}

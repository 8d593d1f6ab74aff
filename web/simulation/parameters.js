// Table of a run's parameters: symbol, value, unit and origin.
import {$, element} from "../shared/dom.js";
import {groups, resolved} from "../shared/form.js";
import {inMm, minus} from "../shared/numbers.js";
import {symbolOf} from "../shared/quantities.js";

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

/** The unit after a value, and a length in m also in mm. */
function unitText(value, unit) {
  if (!unit || unit === "dimensionless") return "";
  const isLength = unit === "m" && typeof value === "number" && value !== 0;
  return ` ${unit.replace("tau", "τ")}${isLength ? ` (${inMm(value, 5)})` : ""}`;
}

function symbolText(name) {
  if (name === "damping_ratio") return "c₁/\u200b(2m₁ω₀)";
  const symbol = symbolOf(name);
  return symbol === name && name.length > 1 ? "" : symbol;
}

/** A name that can be broken after its underscores. */
const breakable = (name) => name.split(/(?<=_)/).flatMap((part) => [part, element("wbr")]);

export function listParameters(parameters, fieldOf) {
  const {values, origins} = resolved(parameters);
  const all = {...parameters.derived, ...values, R: null}; // each wall has its own row
  const row = (name) => {
    const {unit, description = ""} = fieldOf[name] ?? {};
    const [ownUnit, from] = derived[name] ?? [unit, ""];
    const shown = element("span", {className: "unit", textContent: unitText(all[name], ownUnit)});
    const origin = origins[name]?.replace("follows from", "from") ?? (from && `from ${from}`);
    const cells = [
      element("td", {}, ...breakable(name)),
      element("td", {textContent: symbolText(name)}),
      element("td", {}, precise(all[name]), shown),
      element("td", {textContent: origin}),
    ];
    return element("tr", {title: description}, ...cells);
  };
  const table = (title, names) => {
    const rows = names.filter((name) => all[name] != null).map(row);
    const parts = [element("caption", {}, title), element("tbody", {}, ...rows)];
    return element("table", {className: "table parameters", hidden: !rows.length}, ...parts);
  };
  const fields = Object.values(fieldOf);
  const ofGroup = (group) => fields.filter((f) => f.group === group).map((f) => f.name);
  const given = ["system", "reduced", "SI", "start", "run"];
  const tables = given.map((group) => table(groups[group][0], ofGroup(group)));
  $("parameters-tables").replaceChildren(...tables, table("Derived", Object.keys(derived)));
}

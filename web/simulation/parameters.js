// The parameters of a run as a table: each with its symbol, value, unit and where it comes from.
import {$, element} from "../shared/dom.js";
import {resolved} from "../shared/origins.js";

const symbols = {
  b: "b",
  R_plus: "R₊",
  R_minus: "R₋",
  damping: "",
  epsilon: "ε",
  lambda: "λ",
  G: "G",
  Omega: "Ω",
  m1: "m₁",
  c1: "c₁",
  k1: "k₁",
  m2: "m₂",
  F: "F",
  f: "f",
  f0: "f₀",
  damping_ratio: "c₁/\u200b(2m₁ω₀)",
  mass_ratio: "m₂/m₁",
  x0: "x(0)",
  x_dot0: "x′(0)",
  y0: "y(0)",
  y_dot0: "y′(0)",
  x_velocity0: "ẋ(0)",
  y_velocity0: "ẏ(0)",
  tau_end: "τ",
  time_end_s: "t",
  cycles: "",
  window: "",
  window_s: "",
  zeta: "ζ",
  omega_d: "ω_d/ω₀",
  A: "A",
  phi: "φ",
  cycle: "2π/Ω",
  omega0: "ω₀",
  cycle_s: "1/f",
};
const parts = {
  "Walls and damping": ["b", "R_plus", "R_minus", "damping"],
  Reduced: ["epsilon", "lambda", "G", "Omega"],
  SI: ["m1", "k1", "f0", "c1", "damping_ratio", "m2", "mass_ratio", "F", "f"],
  "Start and run": [
    "x0",
    "x_dot0",
    "x_velocity0",
    "y0",
    "y_dot0",
    "y_velocity0",
    "tau_end",
    "time_end_s",
    "cycles",
    "window",
    "window_s",
  ],
  Derived: ["zeta", "omega0", "omega_d", "A", "phi", "cycle", "cycle_s"],
};
// Those that are no fields of a request.
const derivedUnits = {
  omega0: "rad/s",
  A: "m",
  phi: "rad",
  cycle_s: "s",
  time_end_s: "s",
  window_s: "s",
};
const derivedOrigins = {
  zeta: "follows from epsilon, lambda, damping",
  omega0: "follows from k1, m1",
  omega_d: "follows from zeta",
  A: "follows from G, epsilon, lambda, Omega",
  phi: "follows from epsilon, lambda, Omega",
  cycle: "follows from Omega",
  cycle_s: "follows from f",
  time_end_s: "follows from tau_end, omega0",
  window_s: "follows from window, omega0",
};

function precise(value) {
  if (Array.isArray(value)) return value.map(precise).join(" to ");
  if (typeof value === "number") return String(Number(value.toPrecision(6))).replace("-", "−");
  return String(value).replaceAll("_", " ");
}

/** A unit behind a value, and a length in m in mm, too. */
function unitText(value, unit) {
  if (!unit) return "";
  const isLength = unit === "m" && typeof value === "number" && value !== 0;
  const inMm = isLength ? ` (${precise(Number((value * 1000).toPrecision(5)))} mm)` : "";
  return ` ${unit.replace("tau", "τ")}${inMm}`;
}

/** A name that may break after its underscores. */
const breakable = (name) => name.split(/(?<=_)/).flatMap((part) => [part, element("wbr")]);

export function listParameters(parameters, fieldOf) {
  const {values, origins} = resolved(parameters);
  const all = {...parameters.derived, ...values};
  const row = (name) => {
    const unit = (fieldOf[name]?.unit ?? derivedUnits[name] ?? "").replace("dimensionless", "");
    const shown = element("span", {className: "unit", textContent: unitText(all[name], unit)});
    const origin = (origins[name] ?? derivedOrigins[name] ?? "").replace("follows from", "from");
    const cells = [
      element("td", {}, ...breakable(name)),
      element("td", {textContent: symbols[name] ?? ""}),
      element("td", {}, precise(all[name]), shown),
      element("td", {textContent: origin}),
    ];
    return element("tr", {title: fieldOf[name]?.description ?? ""}, ...cells);
  };
  const table = ([title, names]) => {
    const present = names.filter((name) => all[name] != null);
    if (!present.length) return [];
    const caption = element("caption", {textContent: title});
    const body = element("tbody", {}, ...present.map(row));
    return [element("table", {className: "table parameters"}, caption, body)];
  };
  $("parameters-tables").replaceChildren(...Object.entries(parts).flatMap(table));
}

// Origins of the parameters of a run, as the form and the parameter table show them.

/** Pairs of SI fields of one quantity. The origin of one shows whether the other was given. */
export const equivalents = {
  f0: "k1",
  damping_ratio: "c1",
  mass_ratio: "m2",
  x_velocity0: "x_dot0",
  y_velocity0: "y_dot0",
};

function originOfEquivalent(name, origin) {
  const other = equivalents[name];
  const text = origin[other] ?? "";
  if (text.startsWith(`follows from ${name}`)) return "given";
  if (text === "default") return text;
  return `follows from ${other}${name === "f0" || name === "mass_ratio" ? ", m1" : ""}`;
}

/** {values, origins} by field name, from `parameters` of an answer. */
export function resolved({si, derived = {}, origin = {}, ...own}) {
  const values = {...own, ...si};
  const origins = {...origin};
  if (own.R_plus === own.R_minus && origin.R_plus === origin.R_minus)
    [values.R, origins.R] = [own.R_plus, origin.R_plus];
  if (si) {
    for (const name of ["f0", "damping_ratio", "mass_ratio"]) values[name] = derived[name];
    for (const name of Object.keys(equivalents)) origins[name] = originOfEquivalent(name, origin);
  }
  return {values, origins};
}

/** Short text for the form; empty for given values. */
export function originText(origin) {
  if (!origin || origin === "given") return "";
  return origin
    .replace(/^preset /, "")
    .replace(/^follows from/, "from")
    .replace(/^swept:.*/, "swept");
}

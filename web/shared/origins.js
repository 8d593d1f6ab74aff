// Where the values of a run come from: `parameters` of an answer, by the names of the form's
// fields.

/**
 * A field that stands for another one: which of both was given shows in where the other follows
 * from.
 */
export const standing = {
  f0: "k1",
  damping_ratio: "c1",
  mass_ratio: "m2",
  x_velocity0: "x_dot0",
  y_velocity0: "y_dot0",
};

function ofStanding(name, origin) {
  const other = standing[name];
  const text = origin[other] ?? "";
  if (text.startsWith(`follows from ${name}`)) return "given";
  if (text === "default") return text;
  return `follows from ${other}${name === "f0" || name === "mass_ratio" ? ", m1" : ""}`;
}

/** {values, origins} by name. */
export function resolved({si, derived = {}, origin = {}, ...own}) {
  const values = {...own, ...si};
  const origins = {...origin};
  if (own.R_plus === own.R_minus && origin.R_plus === origin.R_minus)
    [values.R, origins.R] = [own.R_plus, origin.R_plus];
  if (si) {
    for (const name of ["f0", "damping_ratio", "mass_ratio"]) values[name] = derived[name];
    for (const name of Object.keys(standing)) origins[name] = ofStanding(name, origin);
  }
  return {values, origins};
}

/** As the form shows it: nothing for what was typed. */
export function originText(origin) {
  if (!origin || origin === "given") return "";
  return origin
    .replace(/^preset /, "")
    .replace(/^follows from/, "from")
    .replace(/^swept:.*/, "swept");
}

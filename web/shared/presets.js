// What of a preset still holds where other fields are given, as the service has it.

/** Masses, spring and damper. A preset's damping goes with them. */
const ownSystem = new Set([
  "epsilon",
  "lambda",
  "m1",
  "c1",
  "damping_ratio",
  "k1",
  "f0",
  "m2",
  "mass_ratio",
]);
export const isOfSystem = (name) => ownSystem.has(name);

/** A value as a query has it; intervals: a,b;c,d. */
export const queryText = (value) => (Array.isArray(value?.[0]) ? value.join(";") : String(value));

/** Whether a field of /v1/parameters is one of the motion. */
export const isOfMotion = (field) =>
  ["system", "reduced", "SI", "start"].includes(field?.group) ||
  ["tau_end", "cycles"].includes(field?.name);

/** The fields of a preset that hold beside the given ones. fieldOf: the table of fields by name. */
export function holding(preset, given, fieldOf) {
  const replaced = Object.keys(given).filter(
    (name) => name !== "preset" && queryText(given[name]) !== queryText(preset[name]),
  );
  const gone = new Set();
  if (replaced.some(isOfSystem)) gone.add("damping");
  if (replaced.some((name) => isOfMotion(fieldOf[name]))) gone.add("window").add("windows");
  if (replaced.some((name) => name === "tau_end" || name === "cycles"))
    gone.add("tau_end").add("cycles");
  return Object.fromEntries(Object.entries(preset).filter(([name]) => !gone.has(name)));
}

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

const ends = ["tau_end", "cycles"];

/** Whether a field of /v1/parameters is one of the motion. */
export const isOfMotion = (field) =>
  ["system", "reduced", "SI", "start"].includes(field?.group) || ends.includes(field?.name);

/** The fields of a preset that hold beside the given ones. fieldOf: the table of fields by name. */
export function holding(preset, given, fieldOf) {
  const replaced = Object.keys(given).filter(
    (name) => name !== "preset" && queryText(given[name]) !== queryText(preset[name]),
  );
  const lost = [
    [isOfSystem, ["damping"]],
    [(name) => isOfMotion(fieldOf[name]), ["window", "windows"]],
    [(name) => ends.includes(name), ends],
  ];
  const gone = lost.flatMap(([replaces, names]) => (replaced.some(replaces) ? names : []));
  return Object.fromEntries(Object.entries(preset).filter(([name]) => !gone.includes(name)));
}

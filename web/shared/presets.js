// Which fields of a preset stay valid when other fields are given; the same rules as in the
// service.

/** Masses, spring and damper. A preset's `damping` belongs to them. */
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

/** A value as text in a query; a list of intervals becomes a,b;c,d. */
export const queryText = (value) => (Array.isArray(value?.[0]) ? value.join(";") : String(value));

const ends = ["tau_end", "cycles"];

/** True for fields of /v1/parameters that affect the motion. */
export const isOfMotion = (field) =>
  ["system", "reduced", "SI", "start"].includes(field?.group) || ends.includes(field?.name);

/** Fields of a preset that stay valid next to the given ones. fieldOf: the field table by name. */
export function validFields(preset, given, fieldOf) {
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

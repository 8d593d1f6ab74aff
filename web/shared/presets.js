// Groups of fields by what they change; the service treats the fields of a preset by the same
// groups.

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

/** True for fields of /v1/parameters that affect the motion. */
export const isOfMotion = (field) =>
  ["system", "reduced", "SI", "start"].includes(field?.group) ||
  ["tau_end", "cycles"].includes(field?.name);

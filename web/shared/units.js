// Units of the results: SI (s, mm/s, m/s², N s, J) or, of a system without SI, of tau = omega0 t.

/** of(value) converts a value to `unit`. */
const quantity = (unit, factor) => ({unit, of: (v) => (v == null ? v : v * factor)});

// A velocity per unit of tau is a length, an energy over m1 omega0² a squared length.
const length = quantity("mm", 1000);
const ofTau = {
  x: {label: "τ", factor: 1},
  time: quantity("", 1),
  at: (t) => `τ = ${t.toFixed(1)}`,
  velocity: length,
  acceleration: length,
  impulse: length,
  energy: quantity("mm²", 1e6),
};

/** Units for an answer with these parameters. x: the time axis; at(tau): a time as text. */
export function unitsOf({si, derived: {omega0}}) {
  if (!si) return ofTau;
  return {
    x: {label: "t (s)", factor: 1 / omega0},
    time: quantity("s", 1 / omega0),
    at: (t) => `t = ${(t / omega0).toFixed(2)} s`,
    velocity: quantity("mm/s", 1000 * omega0),
    acceleration: quantity("m/s²", omega0 ** 2),
    impulse: quantity("N s", si.m1 * omega0),
    energy: quantity("J", si.m1 * omega0 ** 2),
  };
}

/** The unit shown for a unit of the service, and the factor: lengths are shown in mm. */
export function unitShown(unit = "") {
  const plain = unit === "dimensionless" ? "" : unit.replace("per unit of tau", "per τ");
  return /^m($|[ /])/.test(plain) ? {unit: `m${plain}`, factor: 1000} : {unit: plain, factor: 1};
}

// Quantities of sweep points, for menus, axes, colours and tooltips. Lengths are shown in mm.
import {count, inMm, joined, percent, short, withError} from "./numbers.js";

export const regimes = {
  VI: "dense, irregular",
  V: "other periodic",
  IV: "two asymmetric",
  III: "two symmetric",
  II: "strongly modulated",
  I: "sparse, irregular",
  none: "no impacts, or no harmonic forcing",
};
export const regimeColour = (regime) => `regime-${regime}`;
export const verdicts = {chaotic: "chaotic", regular: "regular", not_decided: "not decided"};
/** True for a motion without contact; a free decay also has no verdict, but has impacts. */
export const untouched = ({verdict, z}) => verdict === null && !z;
/** Colour name of a point's verdict. */
export const verdictColour = ({verdict, z}) => {
  if (untouched({verdict, z})) return "untouched";
  return verdict === "chaotic" || verdict === "regular" ? verdict : "undecided";
};

export const lambda1 = (p) => p.lambda?.[0] ?? null;
export const errorOf = (p) => p.standard_error?.[0] ?? null;

const mm = (metres) => (metres == null ? null : metres * 1000);

/**
 * of: the value at a point, by default the field of the same name; levels: horizontal lines; free:
 * the value without the absorber; from0: false if its axis need not contain 0; diverging: the colour
 * scale is centred on 0; categories: the values are names; si: what differs for a system in SI.
 */
export const quantities = {
  lambda1: {
    label: "λ₁",
    title: "largest exponent λ₁",
    of: lambda1,
    diverging: true,
  },
  z: {label: "z", title: "impacts per cycle z", levels: [1, 2, 3]},
  regime: {label: "", title: "regime", categories: true},
  attractor: {
    label: "",
    title: "attractor",
    // Chaotic and quasi-periodic motions have statistics in their names, rounded from a finite run.
    of: (p) => p.attractor?.replace(/^(chaotic|quasi_periodic)-.*/, "$1") ?? null,
    categories: true,
  },
  x_rms_ratio: {
    label: "rms of x / without absorber",
    title: "rms of x relative to that without absorber",
    levels: [1],
  },
  x_rms: {label: "rms of x (mm)", title: "rms of x", of: (p) => mm(p.x_rms)},
  x_max: {
    label: "largest |x| (mm)",
    title: "largest |x|",
    of: (p) => mm(p.x_max),
    free: (p) => mm(p.x_free),
  },
  share_impacts: {label: "fraction by impacts", title: "fraction dissipated by impacts"},
  synchronised: {
    label: "fraction synchronised",
    title: "fraction of contacts synchronised",
    levels: [1],
  },
  impact_speed: {
    label: "fastest impact (mm per unit of τ)",
    title: "fastest impact",
    of: (p) => mm(p.relative_speed_max),
    si: {label: "fastest impact (mm/s)", of: (p) => mm(p.impact_speed_max)},
  },
  impact_rate: {
    label: "impacts per unit of τ",
    title: "rate of impacts",
    si: {label: "impacts per second", of: (p) => p.impacts_per_second ?? null},
  },
};
// Quantities of the lowest diagram over one axis.
const oneAxisQuantities = Object.keys(quantities).filter(
  (name) => !quantities[name].diverging && !quantities[name].categories,
);
for (const [name, quantity] of Object.entries(quantities)) quantity.of ??= (p) => p[name] ?? null;

const reducedTo = ["x_max", "where", "z"];

/** A quantity of a sweep's points; `where` is a value of the axis removed by a reduction. */
export function quantityOf(name, {parameters, folded}) {
  if (name !== "where") return {...quantities[name], ...(parameters.si && quantities[name].si)};
  const {symbol, unit, factor} = folded;
  const title = `${symbol} of the peak`;
  const of = ({where}) => (where == null ? null : where * factor);
  return {label: unit ? `${title} (${unit})` : title, title, of, from0: false};
}

/** Entries of the quantity menus: [name, title]. */
export function menuOf(data) {
  const [whole, reduced] =
    data.axes.length > 1
      ? [Object.keys(quantities), [...reducedTo, "regime"]]
      : [oneAxisQuantities, reducedTo];
  const names = data.reduced ? reduced : whole;
  return names.map((name) => [name, quantityOf(name, data).title]);
}

/** The best motion of a point, or that of its second start, as a point; null if all are equal. */
export function otherMotion(p) {
  const m = p?.depends_on_start ? (p.best ?? p.second_start) : null;
  if (m?.x_max == null) return null;
  const lambda = m.lambda1 == null ? null : [m.lambda1];
  return {...m, lambda, x_rms_ratio: p.x_rms ? (p.x_rms_ratio * m.x_rms) / p.x_rms : null};
}

export const bestMotion = (p) => otherMotion(p) ?? p;

export const startNames = {
  middle: "middle",
  wall: "at the wall",
  moving: "moving",
  untouched: "no contact",
  previous: "previous point",
  next: "next point",
};

/** A coordinate from a column in m, or in m/s. */
const inMilli = (title, column, unit = "mm") => ({
  title,
  label: `${title} (${unit})`,
  values: (section) => section[column].map((v) => v * 1000),
});

/** A velocity, after impacts or at any time. */
const velocity = (of, after = "") => {
  const title = `${of}′${after && " after"}`;
  const si = inMilli(title, `${of}_velocity${after}`, "mm/s");
  return {...inMilli(title, `${of}_dot${after}`), si};
};

/**
 * Coordinates of a section. values(section, half): from its columns, where half is half a forcing
 * period; si: what differs for a system in SI; turns: labels at quarter turns; least: the smallest
 * value drawn, since chatter tends to zero.
 */
export const coordinates = {
  impact: {
    phase: {
      title: "phase of the forcing",
      label: "phase (rad)",
      values: ({phase}) => phase,
      range: [0, 2 * Math.PI],
      turns: true,
    },
    x: inMilli("x", "x"),
    x_dot_after: velocity("x", "_after"),
    y_dot_after: velocity("y", "_after"),
    time_difference: {
      title: "time between impacts / half period",
      label: "half periods",
      values: ({time_difference: times}, half) => times.map((v) => v / half),
      log: true,
      least: 0.1,
      levels: [1],
    },
  },
  stroboscopic: {
    x: inMilli("x", "x"),
    x_dot: velocity("x"),
    y_dot: velocity("y"),
    gap: {
      ...inMilli("x − y"),
      values: ({x, y}) => x.map((v, i) => (v - y[i]) * 1000),
    },
  },
};

/** The values of a coordinate at a point. */
export const valuesOf =
  ({values}) =>
  ({section, half}) =>
    section ? values(section, half) : [];

const symbols = {
  damping_ratio: "damping ratio",
  mass_ratio: "m₂/m₁",
  f0: "f₀",
  m1: "m₁",
  c1: "c₁",
  k1: "k₁",
  m2: "m₂",
  x_velocity0: "ẋ(0)",
  y_velocity0: "ẏ(0)",
  epsilon: "ε",
  lambda: "λ",
  Omega: "Ω",
  x0: "x(0)",
  x_dot0: "x′(0)",
  y0: "y(0)",
  y_dot0: "y′(0)",
  R_plus: "R₊",
  R_minus: "R₋",
  tau_end: "τ end",
  gravity: "g′",
  friction: "f′",
  mu: "μ",
  zeta: "ζ",
  omega0: "ω₀",
  omega_d: "ω_d/ω₀",
  phi: "φ",
  cycle: "2π/Ω",
  cycle_s: "1/f",
  time_end_s: "t",
};
export const symbolOf = (parameter) => symbols[parameter] ?? parameter;

/** Type and description of a regime; the one without impacts has no type. */
export const regimeText = (regime) => joined([regime !== "none" && regime, regimes[regime]]);

const named = (regime) => (regime === "none" ? regimes.none : `Type ${regime}`);

/** The largest |x| of a motion and its place on the axis removed by a reduction. */
const peakOf = (m, where) =>
  inMm(m.x_max) + (where && m.where != null ? ` at ${where(m.where)}` : "");

/** Motions from several starts as text; where(value) names the place of a peak. */
function describeStarts(p, where) {
  const motion = (m) =>
    m.x_max == null ? "not measured" : `${peakOf(m, where)}, ${named(m.regime)}`;
  if (p.starts) return p.starts.map((m) => [startNames[m.start] ?? m.start, motion(m)]);
  const second = p.depends_on_start ? p.second_start : null;
  return second ? [[`from the ${second.start}`, `different: ${motion(second)}`]] : [];
}

const exponentText = ({lambda, status, standard_error: errors}) =>
  status?.[0] === "minus_infinity" ? "−∞" : withError(lambda[0], errors?.[0], 4);

/** A motion that ends on an orbit is regular, even if its transient, part of λ₁, was not. */
function verdictText({verdict, periodic, lambda, standard_error: errors}) {
  const way = periodic && lambda?.[0] > 2 * (errors?.[0] ?? 0);
  if (way) return "regular in the end; λ₁ includes the transient";
  return verdict === "chaotic" ? "chaotic over the measured cycles" : verdicts[verdict];
}

/** Describes a point: [term, value]. */
export function describe(p, where) {
  if (p.error) return [["failed", p.error]];
  if (p.regime == null) return [["", "not measured: stopped at max_impacts"]];
  const {x_rms_ratio: ratio, share_impacts: share, impacts_per_period: impacts} = p;
  const period = [count(p.period_cycles, "cycle"), count(impacts, "impact")];
  const rows = [
    ["regime", regimeText(p.regime)],
    ["", p.periodic && impacts && `period ${joined([...period, p.symmetric && "symmetric"])}`],
    ["attractor", p.periodic && p.attractor],
    ["z", short(p.z)],
    ["λ₁", p.lambda && exponentText(p)],
    ["", verdictText(p)],
    ["rms of x", ratio == null ? inMm(p.x_rms, 5) : `${percent(ratio)} of that without`],
    ["largest |x|", peakOf(p, where)],
    ["without absorber", p.x_free != null && inMm(p.x_free)],
    ["by impacts", share != null && `${percent(share)} of the dissipation`],
    ["sticks", p.sticks && String(p.sticks)],
  ];
  return [...rows.filter(([, value]) => value), ...describeStarts(p, where)];
}

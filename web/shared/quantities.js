// What the points of a sweep tell: one table for menus, axes, colours and tooltips. Lengths are
// drawn in mm.
import {count, short} from "./numbers.js";

export const regimes = {
  VI: "dense, irregular",
  V: "other periodic",
  IV: "two asymmetric",
  III: "two symmetric",
  II: "strongly modulated",
  I: "sparse, irregular",
  none: "no impacts",
};
export const regimeColour = (regime) => `regime-${regime}`;
export const verdicts = {chaotic: "chaotic", regular: "regular", not_decided: "not decided"};
const verdictColours = {chaotic: "chaotic", regular: "regular", not_decided: "undecided"};
/** A ball that touches nothing has no verdict, and a colour of its own. */
export const verdictColour = (p) =>
  p.verdict === null ? "untouched" : (verdictColours[p.verdict] ?? "undecided");

const mm = (metres) => (metres == null ? null : metres * 1000);

/**
 * of: the value at a point, where it is not the point's own of that name; from0: its axis begins at 0; levels: lines across the plot; free: the
 * same without the absorber; diverging: its colours change sides at 0.
 */
export const quantities = {
  lambda1: {
    label: "λ₁",
    title: "largest exponent λ₁",
    of: (p) => p.lambda?.[0] ?? null,
    diverging: true,
  },
  z: {
    label: "z",
    title: "impacts per cycle z",
    from0: true,
    levels: [1, 2, 3],
  },
  regime: {
    label: "",
    title: "regime",
    categories: Object.keys(regimes),
  },
  x_rms_ratio: {
    label: "rms of x / without absorber",
    title: "rms of x over that without absorber",
    from0: true,
    levels: [1],
  },
  x_max: {
    label: "largest |x| (mm)",
    title: "largest |x|",
    of: (p) => mm(p.x_max),
    from0: true,
    free: (p) => mm(p.x_free),
  },
  share_impacts: {
    label: "share of the impacts",
    title: "dissipated by the impacts, share",
    from0: true,
  },
  synchronised: {
    label: "share synchronised",
    title: "contacts synchronised, share",
    from0: true,
    levels: [1],
  },
};
for (const [name, quantity] of Object.entries(quantities)) quantity.of ??= (p) => p[name] ?? null;

const besideLambda = ["z", "x_rms_ratio", "share_impacts", "x_max", "synchronised"];
const overTwoAxes = Object.keys(quantities);
const reducedTo = ["x_max", "where", "z"];

/** A quantity of a sweep's points; `where` is that of the axis that a reduction folds. */
export function quantityOf(name, data) {
  if (name !== "where") return quantities[name];
  const {symbol, unit, factor} = data.folded;
  const title = `${symbol} of the peak`;
  const of = ({where}) => (where == null ? null : where * factor);
  return {label: unit ? `${title} (${unit})` : title, title, of};
}

/** What the menus of a sweep offer: [name, title] each. */
export function menuOf(data) {
  const map = data.axes.length > 1;
  const whole = map ? overTwoAxes : besideLambda;
  const reduced = map ? [...reducedTo, "regime"] : reducedTo;
  const names = data.reduced ? reduced : whole;
  return names.map((name) => [name, quantityOf(name, data).title]);
}

/**
 * The best of the motions that a point was started to, or one that ends elsewhere, as a point of
 * its own; null where all end alike.
 */
export function otherMotion(p) {
  const m = p?.depends_on_start ? (p.best ?? p.second_start) : null;
  if (m?.x_max == null) return null;
  const lambda = m.lambda1 == null ? null : [m.lambda1];
  return {...m, lambda, x_rms_ratio: p.x_rms ? (p.x_rms_ratio * m.x_rms) / p.x_rms : null};
}

/** The best motion of a point, whether or not the others are the same. */
export const bestMotion = (p) => otherMotion(p) ?? p;

export const startNames = {
  middle: "middle",
  wall: "at the wall",
  moving: "moving",
  untouched: "untouched",
  previous: "previous point",
  next: "next point",
};

const columns =
  (...names) =>
  (section) =>
    names.map((name) => section[name]);
const thousandfold = (name) => ({columns: columns(name), value: (v) => v * 1000});

/**
 * The coordinates of a section. columns: what they are computed from, by value, which also gets
 * half a forcing period; seconds: its column in m/s, where there is one; least: the smallest that
 * is drawn, as chatter goes down to nothing.
 */
export const coordinates = {
  impact: {
    phase: {
      label: "phase (rad)",
      title: "phase of the forcing",
      columns: columns("phase"),
      value: (v) => v,
      range: [0, 2 * Math.PI],
      turns: true,
    },
    x: {label: "x (mm)", title: "x", ...thousandfold("x")},
    x_dot_after: {
      label: "x′ after (mm)",
      title: "x′ after the impact",
      ...thousandfold("x_dot_after"),
      seconds: {column: "x_velocity_after", label: "x′ after (mm/s)"},
    },
    y_dot_after: {
      label: "y′ after (mm)",
      title: "y′ after the impact",
      ...thousandfold("y_dot_after"),
      seconds: {column: "y_velocity_after", label: "y′ after (mm/s)"},
    },
    time_difference: {
      label: "half periods",
      title: "time between impacts / half period",
      columns: columns("time_difference"),
      value: (v, half) => (v === null ? NaN : v / half),
      log: true,
      least: 0.1,
      levels: [1],
    },
  },
  stroboscopic: {
    x: {label: "x (mm)", title: "x", ...thousandfold("x")},
    x_dot: {
      label: "x′ (mm)",
      title: "x′",
      ...thousandfold("x_dot"),
      seconds: {column: "x_velocity", label: "x′ (mm/s)"},
    },
    y_dot: {
      label: "y′ (mm)",
      title: "y′",
      ...thousandfold("y_dot"),
      seconds: {column: "y_velocity", label: "y′ (mm/s)"},
    },
    gap: {
      label: "y − x (mm)",
      title: "y − x",
      columns: columns("y", "x"),
      value: (y, _, x) => (y - x) * 1000,
    },
  },
};

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
};
export const symbolOf = (parameter) => symbols[parameter] ?? parameter;

function period({period_cycles: cycles, impacts_per_period: impacts, symmetric}) {
  const counts = `${count(cycles, "cycle")}, ${count(impacts, "impact")}`;
  return `period ${counts}${symmetric ? ", symmetric" : ""}`;
}

/** A regime's type and description; that without impacts has no type. */
export const regimeText = (regime) =>
  `${regime === "none" ? "" : `${regime}, `}${regimes[regime] ?? ""}`;

const inMm = (metres) => (metres == null ? "–" : `${short(Number(mm(metres).toPrecision(4)))} mm`);
const named = (regime) => (regime === "none" ? regimes.none : `Type ${regime}`);

/** Where a peak lies on the axis that is folded, as where() names it. */
const placeOf = (m, where) => (where && m.where != null ? ` at ${where(m.where)}` : "");

/** The motions from several starts in words; where: names the place of a peak. */
function describeStarts(p, where) {
  const peak = (m) => `${inMm(m.x_max)}${placeOf(m, where)}`;
  const motion = (m) => (m.x_max == null ? "not measured" : `${peak(m)}, ${named(m.regime)}`);
  if (p.starts) return p.starts.map((m) => [startNames[m.start] ?? m.start, motion(m)]);
  const second = p.depends_on_start ? p.second_start : null;
  return second ? [[`from the ${second.start}`, `elsewhere: ${motion(second)}`]] : [];
}

/** The largest exponent and its standard error. */
function exponentText({lambda, status, standard_error: errors}) {
  if (status?.[0] === "minus_infinity") return "−∞";
  if (lambda[0] == null) return "–";
  const value = short(Number(lambda[0].toPrecision(4)));
  return errors?.[0] == null ? value : `${value} ± ${short(Number(errors[0].toPrecision(2)))}`;
}

const rmsText = ({x_rms: rms, x_rms_ratio: ratio}) =>
  ratio == null ? `${short(mm(rms))} mm` : `${(ratio * 100).toFixed(0)} % of that without`;

/** A point in words: [term, value] each. */
export function describe(p, where) {
  if (p.error) return [["failed", p.error]];
  if (p.regime == null) return [["", "not measured: max_impacts ended it"]];
  const rows = [["regime", regimeText(p.regime)]];
  if (p.periodic && p.impacts_per_period) rows.push(["", period(p)]);
  rows.push(["z", short(p.z)]);
  if (p.lambda) rows.push(["λ₁", exponentText(p)]);
  rows.push(["", verdicts[p.verdict] ?? ""]);
  rows.push(["rms of x", rmsText(p)]);
  rows.push(["largest |x|", `${inMm(p.x_max)}${placeOf(p, where)}`]);
  if (p.x_free != null) rows.push(["without", inMm(p.x_free)]);
  if (p.share_impacts != null)
    rows.push(["by impacts", `${(p.share_impacts * 100).toFixed(0)} % of the dissipation`]);
  if (p.sticks) rows.push(["sticks", String(p.sticks)]);
  return [...rows.filter(([term, value]) => term || value), ...describeStarts(p, where)];
}

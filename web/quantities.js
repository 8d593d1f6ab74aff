// What the points of a sweep tell: one table for menus, axes, colours and tooltips. Lengths are drawn in mm.
import {short} from "./plots.js";

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

/** of: the value at a point; from0: its axis begins at 0; levels: lines across the plot; free: the same without the absorber; diverging: its colours change sides at 0. */
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
    of: (p) => p.z ?? null,
    from0: true,
    levels: [1, 2, 3],
  },
  regime: {
    label: "",
    title: "regime",
    of: (p) => p.regime ?? null,
    categories: Object.keys(regimes),
  },
  x_rms_ratio: {
    label: "rms of x / without absorber",
    title: "rms of x over that without absorber",
    of: (p) => p.x_rms_ratio ?? null,
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
    of: (p) => p.share_impacts ?? null,
    from0: true,
  },
  synchronised: {
    label: "share synchronised",
    title: "contacts synchronised, share",
    of: (p) => p.synchronised ?? null,
    from0: true,
    levels: [1],
  },
};
export const besideLambda = ["z", "x_rms_ratio", "share_impacts", "x_max", "synchronised"];
export const overTwoAxes = [
  "lambda1",
  "z",
  "regime",
  "x_rms_ratio",
  "x_max",
  "share_impacts",
  "synchronised",
];
const reducedTo = ["x_max", "where", "z"];

/** A quantity of a sweep's points; `where` is that of the axis that a reduction folds. */
export const quantityOf = (name, data) =>
  name !== "where"
    ? quantities[name]
    : {
        label: `${symbolOf(data.reduced)} of the peak`,
        title: `${symbolOf(data.reduced)} of the peak`,
        of: (p) => p.where ?? null,
      };

/** What the menus of a sweep offer: [name, title] each. */
export const menuOf = (data) => {
  const names =
    data.axes.length > 1
      ? data.reduced
        ? [...reducedTo, "regime"]
        : overTwoAxes
      : data.reduced
        ? reducedTo
        : besideLambda;
  return names.map((name) => [name, quantityOf(name, data).title]);
};

/** The best of the motions that a point was started to, or one that ends elsewhere, as a point of its own; null where all end alike. */
export function otherMotion(p) {
  const m = !p?.depends_on_start ? null : (p.best ?? p.second_start);
  return m && m.x_max != null
    ? {
        ...m,
        lambda: m.lambda1 == null ? null : [m.lambda1],
        x_rms_ratio: p.x_rms ? (p.x_rms_ratio * m.x_rms) / p.x_rms : null,
      }
    : null;
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

/** The coordinates of a section. columns: what they are computed from, by value, which also gets half a forcing period;
    seconds: its column in m/s, where there is one; least: the smallest that is drawn, as chatter goes down to nothing. */
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
};
export const symbolOf = (parameter) => symbols[parameter] ?? parameter;

const period = (p) =>
  `period ${p.period_cycles} cycle${p.period_cycles === 1 ? "" : "s"}, ${p.impacts_per_period} impact${p.impacts_per_period === 1 ? "" : "s"}${p.symmetric ? ", symmetric" : ""}`;

const inMm = (metres) => (metres == null ? "–" : `${short(Number(mm(metres).toPrecision(4)))} mm`);
const named = (regime) => (regime === "none" ? regimes.none : `Type ${regime}`);

/** The motions from several starts in words; where: names the place of a peak. */
function describeStarts(p, where) {
  const place = (m) => (where && m.where != null ? ` at ${where(m.where)}` : "");
  const motion = (m) =>
    m.x_max == null ? "not measured" : `${inMm(m.x_max)}${place(m)}, ${named(m.regime)}`;
  if (p.starts) return p.starts.map((m) => [startNames[m.start] ?? m.start, motion(m)]);
  return p.second_start && p.depends_on_start
    ? [[`from the ${p.second_start.start}`, `elsewhere: ${motion(p.second_start)}`]]
    : [];
}

/** A point in words: [term, value] each. */
export function describe(p, where) {
  if (p.error) return [["failed", p.error]];
  if (p.regime == null) return [["", "not measured: max_impacts ended it"]];
  const rows = [
    ["regime", `${p.regime === "none" ? "" : `${p.regime}, `}${regimes[p.regime] ?? ""}`],
  ];
  if (p.periodic && p.impacts_per_period) rows.push(["", period(p)]);
  rows.push(["z", short(p.z)]);
  if (p.lambda) {
    const error =
      p.standard_error?.[0] == null
        ? ""
        : ` ± ${short(Number(p.standard_error[0].toPrecision(2)))}`;
    rows.push([
      "λ₁",
      p.status?.[0] === "minus_infinity"
        ? "−∞"
        : p.lambda[0] == null
          ? "–"
          : short(Number(p.lambda[0].toPrecision(4))) + error,
    ]);
  }
  rows.push(["", verdicts[p.verdict] ?? ""]);
  rows.push([
    "rms of x",
    p.x_rms_ratio == null
      ? `${short(mm(p.x_rms))} mm`
      : `${(p.x_rms_ratio * 100).toFixed(0)} % of that without`,
  ]);
  rows.push([
    "largest |x|",
    inMm(p.x_max) + (where && p.where != null ? ` at ${where(p.where)}` : ""),
  ]);
  if (p.x_free != null) rows.push(["without", inMm(p.x_free)]);
  if (p.share_impacts != null)
    rows.push(["by impacts", `${(p.share_impacts * 100).toFixed(0)} % of the dissipation`]);
  if (p.sticks) rows.push(["sticks", String(p.sticks)]);
  return [...rows.filter(([term, value]) => term || value), ...describeStarts(p, where)];
}

// Requests to all routes and subcommands. An internal change of the program must not change a bit of their
// answers.
//
// {name, path, body?, type?, limited?}: request to the service (limited: with a small answer limit). {name, args, input?, environment?, files?}:
// subcommand, run in a folder of its own; its `files` are part of the answer.
import {csvOf, sensed} from "../record.mjs";

const machine = {
  m1: 12,
  f0: 14,
  damping_ratio: 0.006,
  mass_ratio: 0.01,
  F: 0.0004,
  R: 0.4,
  b: 0.03,
};
const platform = {...machine, f: 14};
const {F: _, ...unforced} = machine;
const all = [
  "series",
  "impacts",
  "exponents",
  "eigenvalues",
  "matrices",
  "section",
  "energy",
  "regime",
  "manifold",
];

const simulate = (name, body) => ({name: `simulate ${name}`, path: "/v1/simulate", body});
const manifold = (name, body) => ({name: `manifold ${name}`, path: "/v1/manifold", body});
const sweep = (name, body) => ({name: `sweep ${name}`, path: "/v1/sweep", body});
const get = (path) => ({name: `GET ${path}`, path});

const figures = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14].map((n) =>
  simulate(`figure ${n}`, {preset: `fig${n}`, tau_end: 700, include: all, max_points: 600}),
);

const runs = [
  simulate("defaults", {}),
  simulate("default with b", {b: 0.015, tau_end: 100}),
  simulate("a table's whole run", {preset: "fig3", include: ["exponents", "regime", "energy"]}),
  simulate("windows", {
    preset: "fig3",
    tau_end: 4000,
    windows: [
      [0, 1932],
      [0, 3764],
      [2000, 3900],
      [10, 30],
    ],
    include: ["impacts"],
  }),
  simulate("one estimator", {
    b: 0.022,
    damping: "closed_form",
    exponents: ["eigenvalues"],
    include: ["exponents"],
    tau_end: 500,
  }),
  simulate("raw product that overflows", {
    b: 0.034,
    damping: "closed_form",
    exponents: ["raw_product", "qr"],
    include: ["exponents"],
    tau_end: 9000,
  }),
  simulate("in SI", {...platform, tau_end: 1500, include: all, max_points: 400}),
  ...["shock", "chirp", "vertical", "friction"].map((preset) =>
    simulate(`preset ${preset}`, {preset, include: all, max_points: 300}),
  ),
  simulate("a record, friction and R of the speed", {
    ...unforced,
    inclination: 0.05,
    mu: 0.02,
    restitution: {speed_m_s: [0, 0.2], R: [0.8, 0.5]},
    forcing: {time_s: [0, 0.1, 0.2, 0.3, 3], acceleration_m_s2: [0, 60, -60, 0, 0]},
    include: all,
    max_points: 300,
  }),
  simulate("noise", {
    ...unforced,
    forcing: {kind: "noise", rms_m_s2: 2, f_low: 5, f_high: 25, duration_s: 10, seed: 3},
    include: ["impacts", "energy"],
  }),
  simulate("harmonics", {
    ...unforced,
    forcing: {kind: "harmonics", f: [13, 14, 29], F: [2e-4, 3e-4, 1e-5], phase: [0, 1, 2]},
    include: ["impacts", "energy"],
    tau_end: 200,
  }),
  simulate("in SI over a preset", {
    preset: "fig20",
    f: 8.2,
    include: ["impacts", "regime", "energy"],
    cycles: 300,
  }),
  simulate("reduced over a preset in SI", {
    preset: "fig16",
    Omega: 0.99,
    include: ["regime"],
    cycles: 200,
    window: [100, 1000],
  }),
  simulate("start in m/s", {
    ...platform,
    x_velocity0: 0.2,
    y_velocity0: -0.1,
    x0: 0.001,
    y0: 0.002,
    cycles: 40,
    include: ["series", "energy"],
  }),
  simulate("start per tau beside SI", {...platform, x_dot0: 0.001, cycles: 5}),
  simulate("two walls", {
    R_plus: 0.8,
    R_minus: 0.5,
    b: 0.02,
    tau_end: 800,
    include: all,
    max_points: 300,
  }),
  simulate("sticking", {
    b: 0.003,
    tau_end: 300,
    include: ["impacts", "eigenvalues", "exponents", "regime"],
  }),
  simulate("R = 0", {b: 0.01, R: 0, tau_end: 300, include: all}),
  simulate("R = 1", {b: 0.01, R: 1, tau_end: 300, include: all, max_points: 300}),
  simulate("undamped at resonance", {lambda: 0, b: 0.02, tau_end: 200, include: all}),
  simulate("overdamped", {epsilon: 1, lambda: 6, b: 0.002, tau_end: 300, include: all}),
  simulate("free decay", {G: 0, x0: 0.05, y0: 0.04, b: 0.015, tau_end: 400, include: all}),
  simulate("untouched", {...platform, F: 0.00004, b: 0.2, y0: 0, cycles: 50, include: all}),
  simulate("max_impacts", {b: 0.01, max_impacts: 50, include: all}),
  simulate("a window behind the end", {
    b: 0.01,
    max_impacts: 10,
    tau_end: 500,
    window: [400, 500],
    include: all,
  }),
  simulate("few points", {
    b: 0.015,
    max_points: 256,
    samples_per_cycle: 100,
    section_phase: 1.5,
    include: ["series", "section", "eigenvalues", "regime", "manifold"],
  }),
  simulate("a capture", {
    b: 0.018,
    damping: "equation_of_motion",
    tau_end: 5000,
    include: ["regime", "exponents"],
    exponents: ["qr"],
  }),
  simulate("beside a perturbed run", {
    b: 0.015,
    damping: "closed_form",
    tau_end: 900,
    perturbation: {y: -1e-9},
  }),
  simulate("beside a run that parts, in SI", {
    ...platform,
    cycles: 150,
    max_points: 400,
    include: [],
    perturbation: {seed: 3, size: 1e-7},
  }),
  simulate("a perturbation at fault", {perturbation: {x: 1, y_dot: "a"}}),
  {
    name: "simulate thinned",
    path: "/v1/simulate",
    body: {preset: "fig3", include: all},
    limited: true,
  },
  get(
    "/v1/simulate?preset=fig11&include=impacts,exponents&window=100,1700&windows=100,500;500,900",
  ),
  get("/v1/simulate?b=0.015&tau_end=50&include=series&x0=0.001&y0=0"),
  get("/v1/simulate?b=0.022&tau_end=200&include=&perturbation.size=1e-9&perturbation.seed=2"),
];

const manifolds = [
  manifold("defaults", {}),
  manifold("in SI", {...platform, points: 20}),
  manifold("small R", {R: 0.05, b: 0.01, points: 10, V_max: 1}),
  manifold("two walls", {R_plus: 0.5, R_minus: 0.6}),
  get("/v1/manifold?preset=fig11&points=5"),
];

const sweeps = [
  sweep("b", {
    base: {damping: "closed_form"},
    axes: [{parameter: "b", from: 0.003, to: 0.04, count: 13}],
    cycles: 200,
  }),
  {
    name: "basins of twins",
    path: "/v1/basins",
    body: {
      base: {damping: "closed_form", y0: 0},
      box: {x0: [-0.003, 0.003], y_dot0: [-0.02, 0.02]},
      count: 100,
      pairs: 20,
      axis: {parameter: "b", values: [0.0065, 0.0066]},
    },
  },
  {
    name: "continue b",
    path: "/v1/continue",
    body: {
      base: {b: 0.015, damping: "closed_form"},
      parameter: "b",
      from: 0.0045,
      to: 0.02,
      switch: 1,
    },
  },
  {
    name: "design with tolerances",
    path: "/v1/design",
    body: {
      base: {m1: 2, f0: 8, damping_ratio: 0.01, m2: 0.04},
      f: [7, 9],
      acceleration: 5,
      ...{b: 0.05, R: 0.2, f_count: 5, starts: "one", transient_cycles: 20, cycles: 40},
      tolerances: {f0: {normal: [8, 0.1]}, b: {uniform: [0.9, 1.1], of: "factor"}},
      samples: 6,
    },
  },
  sweep("impact section", {
    axes: [{parameter: "b", values: [0.008, 0.015, 0.022]}],
    cycles: 100,
    section: "impact",
    section_points: 7,
  }),
  sweep("stroboscopic section in SI", {
    base: machine,
    axes: [{parameter: "f", from: 13.8, to: 14.2, count: 3}],
    cycles: 50,
    section: "stroboscopic",
    section_points: 4,
    section_phase: 1,
  }),
  sweep("two axes", {
    axes: [
      {parameter: "b", from: 0.01, to: 0.03, count: 3, scale: "log"},
      {parameter: "R", from: 0.3, to: 0.9, count: 4},
    ],
    cycles: 60,
    transient_cycles: 20,
  }),
  sweep("three axes", {
    axes: [
      {parameter: "b", values: [0.01, 0.02]},
      {parameter: "R", values: [0.4, 0.8]},
      {parameter: "Omega", values: [0.98, 1, 1.02]},
    ],
    cycles: 40,
    transient_cycles: 10,
  }),
  sweep("starts", {
    axes: [{parameter: "b", values: [0.008, 0.02]}],
    starts: [{}, {x0: 0.01, y0: 0.01}, {y_dot0: 0.02, y0: 0}],
    cycles: 80,
  }),
  sweep("carried up", {
    axes: [{parameter: "b", from: 0.008, to: 0.016, count: 6}],
    carry_state: "up",
    cycles: 60,
    transient_cycles: 30,
  }),
  sweep("carried down in part", {
    axes: [
      {parameter: "b", from: 0.008, to: 0.016, count: 6},
      {parameter: "R", values: [0.5, 0.6]},
    ],
    carry_state: "down",
    cycles: 60,
    transient_cycles: 30,
    indices: [2, 3, 8],
  }),
  sweep("default set", {
    base: machine,
    axes: [{parameter: "f", from: 13.6, to: 14.4, count: 5}],
    starts: "default set",
    include: ["peaks"],
    cycles: 100,
  }),
  sweep("default set without SI", {
    axes: [
      {parameter: "b", values: [0.01, 0.02]},
      {parameter: "R", values: [0.5, 0.7]},
    ],
    starts: "default set",
    cycles: 60,
    transient_cycles: 40,
  }),
  sweep("reduced", {
    base: {...machine, b: undefined},
    axes: [
      {parameter: "b", values: [0.01, 0.03]},
      {parameter: "f", from: 13.6, to: 14.4, count: 5},
    ],
    reduce: "max over f",
    objective: "impact_speed_max",
    cycles: 60,
  }),
  sweep("reduced over the default set", {
    base: machine,
    axes: [{parameter: "f", from: 13.6, to: 14.4, count: 4}],
    starts: "default set",
    reduce: "min over f",
    cycles: 60,
  }),
  sweep("reduced and carried", {
    axes: [
      {parameter: "Omega", from: 0.97, to: 1.03, count: 5},
      {parameter: "b", values: [0.012, 0.02]},
    ],
    carry_state: "up",
    reduce: "max over Omega",
    cycles: 60,
    transient_cycles: 30,
  }),
  sweep("transients that do not end", {
    base: {R: 1, b: 0.0001, max_impacts: 3000},
    axes: [{parameter: "lambda", values: [1, 1.4]}],
    cycles: 10,
    transient_cycles: 5,
  }),
  sweep("of a preset", {
    base: {preset: "fig20"},
    axes: [{parameter: "b", from: 0.009, to: 0.015, count: 3}],
    cycles: 100,
  }),
  sweep("of a start", {
    base: {b: 0.02, y0: 0.002},
    axes: [{parameter: "x0", from: -0.01, to: 0.01, count: 5}],
    cycles: 50,
    indices: [0, 4],
  }),
  sweep("points that are no system", {
    base: {m1: 3, k1: 10000, c1: 2, m2: 0.03, F: 0.0001, f: 9},
    axes: [{parameter: "y0", values: [0, 0.05, 0]}],
    cycles: 20,
  }),
];

const faults = [
  simulate("with faults", {
    b: -1,
    Omga: 2,
    include: ["series", "sound"],
    window: [5, 1],
    cycles: 3,
    tau_end: 4,
  }),
  simulate("an unknown preset", {preset: "fig99"}),
  simulate("half a system in SI", {m1: 3, f: 8}),
  simulate("mixed systems", {m1: 3, epsilon: 0.1}),
  simulate("too much damping", {epsilon: 10, lambda: 10}),
  {name: "simulate no JSON", path: "/v1/simulate", body: "{"},
  {name: "simulate a name twice", path: "/v1/simulate", body: '{"b":1,"b":2}'},
  sweep("with faults", {
    base: {b: -1, q: 2},
    axes: [{parameter: "c"}, {parameter: "b", from: 1, to: 2}],
    reduce: "max over z",
    indices: [7],
  }),
  sweep("corners at fault", {
    axes: [{parameter: "b", from: -1, to: 0.02, count: 3}],
    starts: [{x0: 2}],
  }),
  sweep("too many points", {
    axes: [
      {parameter: "b", from: 0.01, to: 0.02, count: 100000},
      {parameter: "R", from: 0.1, to: 0.2, count: 100},
    ],
  }),
  get("/v1/simulate?b=x&b0=3"),
  get("/v1/nothing"),
];

/** Record of the given length in seconds, without noise; rate: Hz. */
const record = (answer, rate, seconds) => {
  const {omega0} = answer.parameters.derived;
  const moments = Array.from({length: rate * seconds}, (_, k) => ({
    t: k / rate,
    tau: (k / rate) * omega0,
  }));
  const written = ({t, x, a}) => [t.toFixed(6), x.toFixed(7), a.toFixed(4)];
  return csvOf(sensed(answer, moments, 0.001).map(written));
};

/** Requests that depend on another answer. `ask` posts to /v1/simulate. */
export const identifications = async (ask) => {
  const fig20 = await ask({
    preset: "fig20",
    cycles: 120,
    samples_per_cycle: 400,
    max_points: 100000,
    include: ["series", "impacts"],
  });
  const {impacts} = fig20;
  const {omega0} = fig20.parameters.derived;
  const csv = record(fig20, 2048, 6);
  const [header, ...lines] = csv.trim().split("\n");
  const column = (k) => lines.map((line) => Number(line.split(",")[k]));
  const columns = Object.fromEntries(header.split(",").map((name, k) => [name, column(k)]));
  const {acceleration_m_s2: _, ...without} = columns;
  const as = (name, path, body, type) => ({name: `identify ${name}`, path, body, type});
  return [
    as("CSV", "/v1/identify?preset=fig20&b=0.015", csv, "text/csv"),
    as("CSV with R", "/v1/identify?preset=fig20&b=0.015&R=0.85&exponents=qr", csv, "text/csv"),
    as(
      "the motion and the direct exponents",
      "/v1/identify?preset=fig20&b=0.015&include=motion,direct_exponents&max_points=3000",
      csv,
      "text/csv",
    ),
    as("another b", "/v1/identify?preset=fig20&b=0.012", csv, "text/csv"),
    as("JSON", "/v1/identify", {
      preset: "fig20",
      b: 0.015,
      record: columns,
      threshold: 8,
      exponents: ["qr", "eigenvalues"],
    }),
    as("known moments", "/v1/identify", {
      preset: "fig20",
      b: 0.015,
      record: without,
      impact_times_s: impacts.tau.filter((tau) => tau < 5 * omega0).map((tau) => tau / omega0),
    }),
    as("impacts", "/v1/identify", {preset: "fig20", impacts}),
    as("impacts without SI", "/v1/identify", {b: 0.015, R: 0.85, impacts, max_points: 300}),
    as(
      "a word among numbers",
      "/v1/identify?preset=fig20&b=0.015",
      "time_s,x_m,a\n0,1,2\n0.001,1,x\n",
      "text/csv",
    ),
    as(
      "an unknown unit",
      "/v1/identify?preset=fig20&b=0.015",
      csv.replace("displacement_m,", "displacement_inch,"),
      "text/csv",
    ),
  ];
};

export const requests = [
  ...figures,
  ...runs,
  ...manifolds,
  ...sweeps,
  ...faults,
  ...[
    "/v1/presets",
    "/v1/parameters",
    "/v1/openapi.json",
    "/healthz",
    "/livez",
    "/readyz",
    "/version",
    "/system.svg",
  ].map(get),
];

const swept = {
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 9}],
  cycles: 60,
};
export const commands = [
  {name: "vines simulate", args: ["simulate"], input: {b: 0.015, tau_end: 100}},
  {
    name: "vines simulate to a file",
    args: ["simulate", "-o", "answer.json"],
    input: {preset: "fig11", tau_end: 60},
    files: ["answer.json"],
  },
  {name: "vines simulate with faults", args: ["simulate"], input: {b: 0}},
  {name: "vines simulate no file", args: ["simulate", "none.json"]},
  {name: "vines sweep", args: ["sweep", "--threads", "1"], input: swept},
  {
    name: "vines sweep to a file",
    args: ["sweep", "-o", "sweep.ndjson"],
    input: swept,
    files: ["sweep.ndjson"],
  },
  {
    name: "vines sweep a shard",
    args: ["sweep", "--shard", "1/2", "-o", "part.ndjson"],
    input: swept,
    files: ["part.ndjson"],
  },
  {
    name: "vines sweep a shard of rows",
    args: ["sweep", "--shard", "auto", "-o", "part.ndjson"],
    input: {...swept, carry_state: "up"},
    environment: {SLURM_ARRAY_TASK_ID: "0", SLURM_ARRAY_TASK_COUNT: "2"},
    files: ["part.ndjson"],
  },
  {
    name: "vines sweep that depends on the start",
    args: ["sweep"],
    input: {base: machine, axes: [{parameter: "f", from: 13.8, to: 14.2, count: 3}], cycles: 100},
  },
  {name: "vines sweep with faults", args: ["sweep", "--shard", "2/2"], input: swept},
  {name: "vines merge nothing", args: ["merge", "none.ndjson"]},
  {name: "vines openapi", args: ["openapi"]},
  {name: "vines reproduce", args: ["reproduce", "--output", "report"], files: ["report"]},
  {name: "vines --version", args: ["--version"]},
];

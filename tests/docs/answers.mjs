// Collects all keys of real answers, by section of the documents.
import assert from "node:assert/strict";
import {measured} from "../record.mjs";
import {startService} from "../service.mjs";

export const everything = [
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
const parts = [...everything, "status", "sticking", "touches", "perturbation"];
const machine = {m1: 12, f0: 14, damping_ratio: 0.006, mass_ratio: 0.01, F: 0.0004, R: 0.4};
const platform = {...machine, b: 0.03, f: 14};

export const simulations = [
  // Reduced and periodic; SI and periodic, with windows; a free decay in SI.
  {preset: "fig11", tau_end: 300, include: everything},
  {preset: "fig16", include: everything, windows: [[100, 300]], perturbation: {size: 1e-8}},
  {...platform, F: 0, x0: 0.01, y0: 0.02, tau_end: 400, include: everything},
  // Tangent contacts: the oscillator's amplitude is b up to rounding, in units where omega0 = 1.
  {m1: 1, k1: 1, c1: 0, m2: 0.0084, F: 0, b: 0.01, R: 0.6, x0: 0.01 - 3e-17, y0: 0, tau_end: 21},
  // The laws of the ball and of its walls.
  {
    ...platform,
    R: undefined,
    inclination: 0.01,
    mu: 0.01,
    restitution: {speed_m_s: [0, 1], R: [0.8, 0.5]},
    cycles: 50,
  },
  // A recorded load.
  {
    ...platform,
    F: undefined,
    f: undefined,
    forcing: {time_s: [0, 0.1, 0.2, 0.3, 3], acceleration_m_s2: [0, 60, -60, 0, 0]},
    include: everything,
  },
  // Quasi-periodic.
  {b: 0.019898, cycles: 2000, include: ["regime", "exponents"], max_points: 300},
];

const b = (values) => [{parameter: "b", values}];
const f = [{parameter: "f", from: 13.8, to: 14.2, count: 3}];
const short = {cycles: 50, transient_cycles: 30};
export const sweeps = [
  {axes: b([0.008, 0.015]), section: "impact", ...short},
  {axes: b([0.008, 0.015]), section: "stroboscopic", ...short},
  {axes: f, base: {...machine, b: 0.03}, section: "impact", ...short},
  {axes: f, base: {...machine, b: 0.03}, section: "stroboscopic", ...short},
  {axes: b([0.008, 0.02]), starts: [{}, {x0: 0.01, y0: 0.01}], ...short},
  {axes: f, base: {...machine, b: 0.03}, starts: "default set", include: ["peaks"], cycles: 100},
  {axes: f, base: {...machine, b: 0.03}, include: ["peaks"], cycles: 100},
  {axes: b([0.008, 0.02]), starts: [{}, {x0: 0.01, y0: 0.01}], reduce: "max over b", ...short},
  {
    axes: f,
    base: {...machine, b: 0.03},
    starts: "default set",
    reduce: "max over f",
    include: ["peaks"],
    cycles: 60,
  },
  // A state that cannot be carried, a transient that does not end, a point that is no system.
  {axes: b([1e-8, 0.015]), carry_state: "up", base: {R: 1}, cycles: 5, transient_cycles: 5},
  {axes: b([1e-8, 0.015]), starts: "default set", base: {R: 1}, cycles: 5, transient_cycles: 5},
  {axes: [{parameter: "y0", values: [0, 0.05, 0]}], cycles: 20},
];

const twins = {base: {b: 0.0065, damping: "closed_form", y0: 0}, count: 40, pairs: 10};
const box = {x0: [-0.003, 0.003], y_dot0: [-0.02, 0.02]};
export const basins = [
  {...twins, box},
  {
    base: {damping: "closed_form", y0: 0},
    box,
    count: 30,
    pairs: 0,
    axis: {parameter: "b", values: [0.006, 0.03]},
  },
];

export const continuations = [
  {base: {b: 0.0065, damping: "closed_form"}, parameter: "b", from: 0.0045, to: 0.008, switch: 1},
  {base: {damping: "closed_form", b: 0.015}, parameter: "b", from: 0.014, to: 0.018},
  {base: {...platform, b: 0.02}, parameter: "f", from: 13.9, to: 14.1, points: 5},
  {base: {b: 0.05, G: 0.001}, parameter: "R", from: 0.4, to: 0.8},
  {
    base: {damping: "closed_form", b: 0.015},
    parameter: "b",
    from: 0.014,
    to: 0.018,
    curve: "fold",
    second: "R",
    second_from: 0.59,
    second_to: 0.61,
  },
];

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Adds the paths of a value's leaves; `opaque` paths are leaves whatever they hold. */
function walk(value, path, opaque, paths) {
  const entries = Array.isArray(value) ? value.filter(isObject) : [];
  if (path && opaque.includes(path)) paths.add(path);
  else if (isObject(value))
    for (const [name, inner] of Object.entries(value))
      walk(inner, path ? `${path}.${name}` : name, opaque, paths);
  else if (entries.length) for (const entry of entries) walk(entry, `${path}[]`, opaque, paths);
  else paths.add(path);
}

/** Collects by part: a Map of Sets of paths. */
class Keys extends Map {
  note(part, value, opaque = []) {
    if (!this.has(part)) this.set(part, new Set());
    walk(value, "", opaque, this.get(part));
  }
  noteTop(part, value) {
    this.note(part, value, Object.keys(value));
  }
}

const json = async (url, path, body, type = "application/json") => {
  const post = {method: "POST", body, headers: {"Content-Type": type}};
  const response = await fetch(url + path, body === undefined ? {} : post);
  return response.json();
};

function noteSimulation(keys, answer) {
  keys.noteTop("simulate", answer);
  keys.note("provenance", answer.provenance, ["request"]);
  keys.note("parameters", answer.parameters, ["origin"]);
  for (const part of parts)
    if (part in answer) keys.note(part === "manifold" ? part : `simulate.${part}`, answer[part]);
  for (const window of answer.windows ?? []) keys.note("simulate.windows", window);
}

function noteManifold(keys, answer) {
  keys.noteTop("manifold-answer", answer);
  keys.note("parameters", answer.parameters, ["origin"]);
  keys.note("manifold", answer.manifold);
}

function noteLine(keys, line, axes) {
  const own = ({...object}) => {
    for (const name of axes) delete object[name];
    return object;
  };
  if (line.type === "start") {
    keys.note("parameters", line.parameters, ["origin"]);
    keys.note("sweep.start", line, ["parameters", "request"]);
  } else if (line.type !== "point") {
    keys.note(line.type === "progress" ? "sweep.progress" : "sweep.end", line);
  } else if (line.reduce) {
    const reduced = own(line);
    for (const name of ["worst", "best"]) if (line[name]) reduced[name] = own(line[name]);
    if (line.starts) reduced.starts = line.starts.map(own);
    keys.note("sweep.reduced", reduced);
  } else {
    keys.note("sweep.point", own(line), ["section", "second_start", "worst", "best", "starts"]);
    const motions = [line.worst, line.best, line.second_start, ...(line.starts ?? [])];
    for (const motion of motions) if (motion) keys.note("sweep.motion", motion);
    if (line.section) keys.note("sweep.section", line.section);
  }
}

async function noteSweep(keys, url, request) {
  const response = await fetch(`${url}/v1/sweep`, {method: "POST", body: JSON.stringify(request)});
  const text = await response.text();
  assert.equal(response.status, 200, text);
  for (const line of text.trim().split("\n"))
    noteLine(
      keys,
      JSON.parse(line),
      request.axes.map((axis) => axis.parameter),
    );
}

const spread = {uniform: [0.99, 1.01], of: "factor"};
const toleranced = [
  {m1: spread, k1: spread, c1: spread, m2: spread, acceleration: spread},
  {f0: spread, damping_ratio: spread, b: spread, R: spread, F: spread},
];

/** Small searches, one for each objective. */
const designs = ["x_max", "x_rms", "x_relative_max", "x_acceleration_max", "impact_speed_max"].map(
  (objective, k) => ({
    base: {m1: 2, f0: 8, damping_ratio: 0.01, m2: 0.04},
    f: [7.8, 8.2],
    ...(k % 2 ? {F: 0.002} : {acceleration: [2, 5]}),
    objective,
    R: 0.4,
    b_count: 3,
    f_count: 3,
    starts: "one",
    transient_cycles: 10,
    cycles: 20,
    samples: 2,
    tolerances: toleranced[k % 2],
  }),
);

designs.push({
  base: designs[0].base,
  forcing: {kind: "half_sine", acceleration_m_s2: 30, duration_s: 0.03},
  R: 0.4,
  b_count: 3,
  cycles: 20,
  samples: 2,
  tolerances: {load_factor: spread},
});
designs.push({
  base: designs[0].base,
  initial_velocity: 0.3,
  R: 0.4,
  b_count: 3,
  samples: 2,
  tolerances: {initial_velocity: spread},
});

/** The lines of a stream. */
async function linesOf(url, request) {
  const response = await fetch(url, {method: "POST", body: JSON.stringify(request)});
  const text = await response.text();
  assert.equal(response.status, 200, text);
  return text
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));
}

async function noteDesign(keys, url, request) {
  for (const line of await linesOf(`${url}/v1/design`, request))
    keys.note(`design.${line.type}`, line, ["request"]);
}

async function noteBasins(keys, url, request) {
  for (const line of await linesOf(`${url}/v1/basins`, request)) {
    for (const one of [line, ...(line.attractors ?? []), ...(line.basins ?? [])])
      delete one[request.axis?.parameter];
    if (line.type === "point") keys.note("basins.point", line);
    else if (line.type === "done") {
      keys.note("basins.end", line, ["attractors", "basins"]);
      for (const one of line.attractors) keys.note("basins.attractors", one);
      for (const one of line.basins) keys.note("basins.basins", one);
    } else noteLine(keys, line, []);
  }
}

async function noteContinuation(keys, url, request) {
  for (const line of await linesOf(`${url}/v1/continue`, request)) {
    delete line[request.parameter];
    delete line[request.second];
    if (line.type === "start") {
      keys.note("parameters", line.parameters, ["origin"]);
      keys.note("continue.start", line, ["parameters", "request"]);
    } else if (line.type === "branch") keys.note("continue.branch", line);
    else if (["point", "special"].includes(line.type)) keys.note("continue.point", line);
    else keys.note("continue.end", line);
  }
}

/** A progress line of a design that takes minutes. */
async function noteProgressOfDesign(keys, url) {
  const body = JSON.stringify({...designs[0], b_count: 400, f_count: 41, cycles: 2000});
  const leaving = new AbortController();
  const response = await fetch(`${url}/v1/design`, {method: "POST", body, signal: leaving.signal});
  let text = "";
  for await (const piece of response.body.pipeThrough(new TextDecoderStream())) {
    text += piece;
    const [progress] = text.match(/^\{"type":"progress".*\n/m) ?? [];
    if (!progress) continue;
    keys.note("design.progress", JSON.parse(progress), ["request"]);
    break;
  }
  leaving.abort();
}

/** A progress line of a long sweep, and the last line of its stream when the service is told to stop. */
async function noteBrokenSweep(keys) {
  const service = await startService(["--sweeps", "1"]);
  const body = JSON.stringify({axes: [{parameter: "b", from: 0.008, to: 0.03, count: 20000}]});
  const response = await fetch(`${service.url}/v1/sweep`, {method: "POST", body});
  keys.note("problem", await json(service.url, "/v1/sweep", body)); // no room for a second one
  let text = "";
  let stopped;
  for await (const piece of response.body.pipeThrough(new TextDecoderStream())) {
    text += piece;
    if (text.includes('"type":"progress"')) stopped ??= service.stop();
  }
  await stopped;
  const lines = text
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));
  for (const line of [lines.find((l) => l.type === "progress"), lines.at(-1)])
    noteLine(keys, line, ["b"]);
}

/** The record with a channel of a force of 8.35 Hz. */
export const withForce = (csv) =>
  csv
    .trimEnd()
    .split("\n")
    .map((line, k) => `${line},${k ? Math.sin(2 * Math.PI * 8.35 * parseFloat(line)) : "force_N"}`)
    .join("\n");

function noteIdentification(keys, answer) {
  keys.noteTop("identify", answer);
  keys.note("provenance", answer.provenance, ["request"]);
  keys.note("parameters", answer.parameters, ["origin"]);
  for (const part of [
    "signal",
    "fitted",
    "laws",
    "impacts",
    "sticking",
    "restitution",
    "b_fitted",
    "exponents",
    "slope",
    "motion",
    "direct",
    "forward",
  ])
    if (part in answer) keys.note(`identify.${part}`, answer[part], ["exponents"]);
  if (answer.direct?.exponents) keys.note("identify.exponents", answer.direct.exponents);
}

async function noteService(keys, url) {
  const parameters = await json(url, "/v1/parameters");
  const lists = Object.keys(parameters).filter((name) => name !== "model");
  keys.note("parameters-answer", parameters, ["model.symbols", ...lists]);
  for (const field of lists.flatMap((list) => parameters[list]))
    keys.note("parameters-answer", field, Object.keys(field));
  keys.note("presets-answer", await json(url, "/v1/presets"), ["presets[].parameters"]);
  for (const path of ["/version", "/healthz", "/livez", "/readyz"])
    keys.note("health-answer", await json(url, path));
  keys.note("problem", await json(url, "/v1/simulate", '{"b":-1,"q":2}'));
  const without = await startService(["--sweeps", "0"]);
  keys.note("problem", await json(without.url, "/v1/sweep", JSON.stringify(sweeps[0])));
  await without.stop();
}

/** By part of the documents: the paths of all keys. */
export async function answeredKeys(url) {
  const keys = new Keys();
  for (const request of simulations)
    noteSimulation(keys, await json(url, "/v1/simulate", JSON.stringify(request)));
  for (const request of [{b: 0.015}, platform])
    noteManifold(keys, await json(url, "/v1/manifold", JSON.stringify(request)));
  for (const request of sweeps) await noteSweep(keys, url, request);
  for (const request of basins) await noteBasins(keys, url, request);
  for (const request of continuations) await noteContinuation(keys, url, request);
  for (const request of designs) await noteDesign(keys, url, request);
  await noteProgressOfDesign(keys, url);
  await noteBrokenSweep(keys);
  const csv = await measured(url, "fig20", 6);
  const identify = "/v1/identify?preset=fig20&b=0.015";
  for (const [path, record] of [
    [`${identify}&include=motion,direct_exponents&fit=mu,R_of_speed`, csv],
    [identify, withForce(csv)],
  ])
    noteIdentification(keys, await json(url, path, record, "text/csv"));
  await noteService(keys, url);
  return keys;
}

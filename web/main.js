// The page: preset and form in, one request, plots out. The address holds the request, so a link shows the same run.
import {get, simulate, Problem} from "./api.js";
import {Form} from "./form.js";
import {LinePlot, ScatterPlot} from "./plots.js";

const $ = (id) => document.getElementById(id);
const mm = (metres) => metres.map((v) => v * 1000);
const estimators = ["qr", "eigenvalues", "raw_product"];

const plots = {
  x: new LinePlot($("plot-x"), {synced: true}),
  relative: new LinePlot($("plot-relative"), {synced: true}),
  ...Object.fromEntries(estimators.map((e) => [e, new LinePlot($(`plot-${e}`))])),
  portrait: new ScatterPlot($("plot-portrait")),
  velocities: new ScatterPlot($("plot-velocities")),
};

let form, presets, running = null;

/** y - x over tau, with the contacts put between the samples: there it reaches the walls. */
function relativeDisplacement({series, impacts, parameters}) {
  const tau = [], gap = [];
  const push = (t, g) => { if (!tau.length || t > tau[tau.length - 1]) { tau.push(t); gap.push(g); } };  // uPlot: ascending, no repeats
  let i = 0;
  for (let k = 0; k < series.tau.length; ++k) {
    for (; i < impacts.tau.length && impacts.tau[i] <= series.tau[k]; ++i) push(impacts.tau[i], -impacts.side[i] * parameters.b * 1000);
    push(series.tau[k], (series.y[k] - series.x[k]) * 1000);
  }
  return [tau, gap];
}

/** The exponents differ by little once they have settled: the range that shows that, and what led there leaves it. */
function exponentRange(exponents) {
  const values = [0];
  for (const name of estimators) {
    const history = exponents[name]?.history;
    if (!history) continue;
    const from = Math.floor(history.tau.length / 4);
    for (const key of ["lambda1", "lambda2", "lambda3", "lambda4"]) for (const v of history[key].slice(from)) if (v !== null) values.push(v);
  }
  values.sort((a, b) => a - b);
  const low = values[Math.floor(values.length * 0.01)], high = values[Math.ceil(values.length * 0.99) - 1];
  const margin = (high - low || 0.1) * 0.15;
  return [low - margin, high + margin];
}

function ascending(history, keys) {
  const keep = history.tau.map((t, i) => i === 0 || t > history.tau[i - 1]);
  return [history.tau, ...keys.map((k) => history[k])].map((column) => column.filter((_, i) => keep[i]));
}

function drawExponents(exponents) {
  const range = exponentRange(exponents);
  for (const name of estimators) {
    const estimator = exponents[name];
    const keys = ["lambda1", "lambda2", "lambda3", "lambda4", ...(estimator?.history.rounding_floor ? ["rounding_floor"] : [])];
    const data = estimator ? ascending(estimator.history, keys) : [[], ...keys.map(() => [])];
    const series = keys.map((k, i) => k === "rounding_floor" ? {label: "floor", colour: "soft", dash: [5, 4]} : {label: `λ${i + 1}`, colour: `c${i + 1}`, width: 1.5});
    plots[name].draw({series, data, range, zero: true});
  }
}

const digits = (value, n = 4) => value == null ? "–" : Math.abs(value) < 1e-3 && value !== 0 ? value.toExponential(2) : value.toFixed(n);

function summarise(answer, milliseconds) {
  const {exponents: e, impacts, sticking, parameters: p, status} = answer;
  const entries = [];
  const add = (term, value, small = "") => entries.push([term, value, small]);
  if (e.qr) {
    const error = e.qr.standard_error[0];
    add("λ₁ (qr)", digits(e.qr.final[0]), error == null ? "" : `± ${digits(error)}`);
    add("positive exponents (qr)", e.qr.final[0] == null ? "–" : String(e.qr.final.filter((v) => v > 0).length), `of 4; λ₂ ${digits(e.qr.final[1])}`);
  }
  if (e.raw_product) add("positive (raw_product)", e.raw_product.final[0] == null ? "–" : String(e.raw_product.final.filter((v) => v > 0).length), "as the paper counted");
  add("impacts", String(impacts.tau.length), `${digits(impacts.tau.length / (status.tau * p.Omega / 2 / Math.PI), 3)} per cycle`);
  add("stuck phases", String(sticking.side.length), sticking.side.length ? "shaded in the plots" : "");
  add("sum rule residual", e.sum_rule_residual == null ? "–" : e.sum_rule_residual.toExponential(1), e.sum_rule_residual == null && e.impacts > 1 ? "not defined after a stick" : "");
  add("window", e.window ? `${e.window[0].toFixed(1)} to ${e.window[1].toFixed(1)}` : "–", `${e.impacts} impacts`);
  add("answered in", `${milliseconds.toFixed(0)} ms`, `damping ζ = ${digits(p.derived.zeta, 5)}`);
  $("summary").replaceChildren(...entries.map(([term, value, small]) => {
    const box = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd"), s = document.createElement("small");
    dt.textContent = term;
    s.textContent = small ? ` ${small}` : "";
    dd.append(value, s);
    box.append(dt, dd);
    return box;
  }));
  $("warnings").replaceChildren(...answer.warnings.map((w) => Object.assign(document.createElement("li"), {textContent: w})));
}

function draw(answer) {
  const {series, impacts, sticking, exponents, parameters} = answer;
  const bands = sticking.tau_start.map((t, i) => [t, sticking.tau_end[i]]);
  const lines = exponents.window && answer.request.window ? exponents.window : [];
  plots.x.draw({series: [{label: "x", colour: "c1"}], data: [series.tau, mm(series.x)], bands, lines});
  const b = parameters.b * 1000;
  plots.relative.draw({series: [{label: "y − x", colour: "c2"}], data: relativeDisplacement(answer), range: [-1.12 * b, 1.12 * b], walls: [-b, b], bands, lines});
  drawExponents(exponents);
  const before = {colour: "before"}, after = {colour: "after"};
  plots.portrait.draw([{...before, x: mm(impacts.x), y: mm(impacts.x_dot_before)}, {...after, x: mm(impacts.x), y: mm(impacts.x_dot_after)}], "x", "x′");
  plots.velocities.draw([{...before, x: mm(impacts.x_dot_before), y: mm(impacts.y_dot_before)}, {...after, x: mm(impacts.x_dot_after), y: mm(impacts.y_dot_after)}], "x′", "y′");
}

function say(text, fault = false) {
  $("message").textContent = text;
  $("message").classList.toggle("fault", fault);
}

async function run() {
  running?.abort();
  const mine = running = new AbortController();
  const request = form.values();
  form.showErrors([]);
  $("run").disabled = true;
  $("cancel").hidden = false;
  $("results").classList.add("stale");
  say("computing …");
  const started = performance.now();
  try {
    const answer = await simulate(request, mine.signal);
    if (running !== mine) return;
    answer.request = request;
    summarise(answer, performance.now() - started);
    draw(answer);
    remember(request);
    say(answer.status.reason === "tau_end" ? "" : answer.status.message);
    $("results").dataset.done = String(Number($("results").dataset.done ?? 0) + 1);
  } catch (error) {
    if (error.name === "AbortError") { if (running === mine) say("cancelled"); return; }
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say([error.message, ...left.map((e) => e.detail).filter((d) => d !== error.message)].join("; "), true);
  } finally {
    if (running === mine) {
      running = null;
      $("run").disabled = false;
      $("cancel").hidden = true;
      $("results").classList.remove("stale");
    }
  }
}

/** The request in the address, as the GET route would take it. */
function remember(request) {
  const query = new URLSearchParams(Object.entries(request).map(([k, v]) => [k, String(v)]));
  if ($("preset").value) query.set("preset", $("preset").value);
  history.replaceState(null, "", `?${query}`);
}

function choosePreset(name) {
  const preset = presets.find((p) => p.name === name);
  $("preset").value = preset ? name : "";
  $("preset-note").textContent = preset?.note ?? "";
  if (preset) form.set(preset.parameters);
}

/** What the address asks for, or the paper's Fig. 3. */
function fromAddress() {
  const query = new URLSearchParams(location.search);
  const name = query.get("preset") ?? (query.size ? "" : "fig3");
  choosePreset(name);
  query.delete("preset");
  if (!query.size) return;
  form.set(Object.fromEntries([...query].map(([key, text]) => [key, text.includes(",") ? text.split(",") : text])));
}

async function start() {
  const [fields, list, version] = await Promise.all([get("v1/parameters"), get("v1/presets"), get("version")]);
  presets = list.presets;
  $("version").textContent = `vines ${version.version}`;
  form = new Form($("fields"), fields.fields);
  $("preset").append(new Option("own parameters", ""), ...presets.map((p) => new Option(`${p.source}: ${p.title}`, p.name)));
  fromAddress();
  $("preset").addEventListener("change", () => { choosePreset($("preset").value); if ($("preset").value) run(); });
  $("form").addEventListener("submit", (event) => { event.preventDefault(); run(); });
  $("cancel").addEventListener("click", () => { running?.abort(); });
  $("copy").addEventListener("click", async () => {
    const command = `curl -s ${new URL("v1/simulate", location.href.split("?")[0])} -d '${JSON.stringify(form.values())}'`;
    try { await navigator.clipboard.writeText(command); say("copied"); } catch { say(command); }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { for (const plot of Object.values(plots)) plot.redraw(); });
  await run();
}

start().catch((error) => say(`the page could not start: ${error.message}`, true));

// The tab of a sweep: form in, a stream of points out, drawn as they come. Its query is the request
// and what the menus show.
import {asCurl, Problem, wholeMessage} from "../shared/api.js";
import {listWarnings} from "../shared/cards.js";
import {$, countUp, element} from "../shared/dom.js";
import {addMenu} from "../shared/figure_menu.js";
import {textOf} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {coordinates, menuOf, otherMotion, regimes, symbolOf} from "../shared/quantities.js";
import {copy, save} from "../shared/take_away.js";
import {onUnits, unitsSwitch} from "../shared/units.js";
import {Naming} from "./axes.js";
import {SweepData} from "./data.js";
import {startKey} from "./diagram.js";
import {SweepPlots} from "./diagrams.js";
import {Layers} from "./layers.js";
import {SweepMap} from "./map.js";
import {showPeaks} from "./peaks.js";
import {Refiner} from "./refine.js";
import {receive} from "./stream.js";
import {examples, halfPeriod, SweepForm} from "./sweep_form.js";

const cyclesOfPoint = 272; // of the simulation of a point: the paper's tau of 1709

let form;
let naming;
let plots;
let map;
let refiner;
let data = null;
let shown = null;
let wantedView = null;
let opened = false; // what is asked for comes from the address
let changed = () => {};

function say(text, fault = false) {
  $("sweep-message").textContent = text;
  $("sweep-message").classList.toggle("fault", fault);
}

// The menus, by their name in the query. Their first entry needs no mention there.
const menus = {coordinate: "sweep-coordinate", beside: "sweep-quantity", map: "sweep-mapped"};
const choice = () => ({
  coordinate: $("sweep-coordinate").value,
  quantity: $("sweep-quantity").value,
  map: $("sweep-mapped").value,
  start: Number($("sweep-start").value) || 0,
  best: $("sweep-start").value === "best",
  slice: Number($("sweep-slice").value),
});

function fillMenu(id, entries, wanted) {
  $(id).replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
  if (entries.some(([value]) => value === wanted)) $(id).value = wanted;
}

/** What a menu is to show: what the query asked for, once, else what it shows. */
function wish(id) {
  const {wanted} = $(id).dataset;
  $(id).dataset.wanted = "";
  return wanted || $(id).value;
}

/** The query of the sweep that is shown, or null before the first. */
export function query() {
  if (shown === null) return null;
  const menu = Object.entries(menus)
    .filter(([, id]) => $(id).selectedIndex > 0)
    .map(([name, id]) => `${name}=${$(id).value}`);
  const zoomed = data?.axes?.length && axesOf(data).some((axis) => axis.zoomed);
  const view = wantedView ?? (zoomed ? viewOf(data) : []);
  return [shown, ...menu, ...(view.length ? [`view=${view.join(",")}`] : [])].join("&");
}

/** Those of the plots that show a sweep. */
const axesOf = ({axes}) => [[], [plots.axis]][axes.length] ?? [map.axis, map.across];

/** The ends of what is in view, as values. */
const viewOf = (of) =>
  axesOf(of).flatMap(({view}, i) => {
    const ends = view.map(of.axes[i].from);
    const step = Math.abs(ends[1] - ends[0]) / 1e4; // as many digits as that takes
    return ends.map((v) => Number(v.toPrecision(digitsFor(v, step))));
  });
const digitsFor = (v, step) =>
  Math.min(Math.max(Math.ceil(Math.log10(Math.abs(v) / step)) + 1, 2), 15);

/** Zooms to such ends; without any the whole is shown. */
function zoomTo(view) {
  axesOf(data).forEach((axis, i) => {
    if (!view.length && axis.away) axis.reset();
    const [from, to] = view.slice(2 * i, 2 * i + 2).map(data.axes[i].to);
    if (from < to) axis.zoom(from, to);
  });
}

const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, " ");

function showSize() {
  const {counts, starts, points, cycles} = form.size();
  const factors = [...counts, ...(starts > 1 ? [`${starts} starts`] : [])];
  const product = factors.length > 1 ? `${factors.join(" × ")} = ` : "";
  const size = `${product}${grouped(points)} points, ${grouped(cycles)} cycles`;
  $("sweep-size").textContent = Number.isFinite(points) ? size : "";
}

function time(seconds) {
  if (seconds < 1) return "less than a second";
  if (seconds < 90) return `${seconds.toFixed(0)} s`;
  if (seconds < 5400) return `${(seconds / 60).toFixed(0)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

function progress({per_second: rate, seconds_left: left}) {
  if (left == null) return showCount();
  const remaining = data.complete ? "" : ` · ${time(left)} left`;
  showCount(` · ${rate.toFixed(rate < 10 ? 1 : 0)} per second${remaining}`);
}

function showCount(more = "") {
  $("sweep-bar").max = data.total || 1;
  $("sweep-bar").value = data.received;
  $("sweep-rate").textContent = `${grouped(data.received)} of ${grouped(data.total)} points${more}`;
}

// At most ten drawings a second, and no more than a fifth of the time.
let waiting = 0;
let cost = 0;
function drawSoon() {
  waiting ||= setTimeout(draw, Math.max(100, 4 * cost));
}

function draw() {
  clearTimeout(waiting);
  waiting = 0;
  if (!data?.axes) return;
  const began = performance.now();
  drawPlots();
  showPeaks(data, naming);
  showMotions();
  countRegimes();
  cost = performance.now() - began;
}

/** No more points come for now. */
function settle() {
  draw();
  if (data?.axes) namePlots();
}

function drawPlots() {
  if (data.axes.length > 1) map.refresh();
  else plots.refresh();
}

/** The keys of the worst and the best motion, or of one from another start, where there are any. */
function showMotions() {
  const {defaultSet} = data;
  const several = defaultSet || (data.starts === 1 && data.points.some(otherMotion));
  $("sweep-motions").hidden = data.axes.length !== 1 || !several;
  $("sweep-worst").hidden = !defaultSet;
  $("sweep-other").textContent = defaultSet
    ? "the best, where they end apart"
    : "from another start, where it was tried and ends elsewhere";
}

function countRegimes() {
  const counts = {};
  for (const p of data.points) if (p?.regime) counts[p.regime] = (counts[p.regime] ?? 0) + 1;
  for (const regime of Object.keys(regimes)) {
    const node = $(`sweep-regime-${regime}`);
    const item = node.closest("li");
    node.textContent = counts[regime] ?? "";
    item.classList.toggle("absent", !counts[regime]);
    item.hidden = regime === "none" && !counts.none;
  }
}

/** Which of the starts a map shows; of the default set, the worst or the best. */
const ofDefaultSet = [
  ["0", "worst"],
  ["best", "best"],
];
function offerStarts(n) {
  const {defaultSet} = data;
  const numbered = Array.from({length: Math.max(n, 1)}, (_, s) => [String(s), String(s + 1)]);
  fillMenu("sweep-start", defaultSet ? ofDefaultSet : numbered, $("sweep-start").value);
  $("sweep-start-of").hidden = n < 2 && !defaultSet;
  $("sweep-start-word").textContent = defaultSet ? "of the start that is" : "from start";
}

/** Which value of the third axis a map shows. */
function offerSlices() {
  const third = data.axes[2];
  const text = (v) => naming.value(third.parameter, v);
  const slices = third ? third.values.map((v, m) => [String(m), text(v)]) : [["0", ""]];
  fillMenu("sweep-slice", slices, $("sweep-slice").value);
  $("sweep-slice-of").hidden = !third;
  $("sweep-slice-word").textContent = third ? `where ${symbolOf(third.parameter)} =` : "";
}

/** The plots of a sweep that has just begun, still empty. */
function present(fresh) {
  const edit = shown !== null && !opened;
  opened = false;
  data = fresh;
  data.folded = data.reduced && naming.of(data.reduced);
  shown = String(SweepForm.toQuery(data.request));
  const {section, defaultSet, reduced} = data;
  const starts = defaultSet ? [] : (data.request.starts ?? []);
  $("sweep-stack").hidden = data.axes.length !== 1;
  $("sweep-map").hidden = data.axes.length < 2;
  $("figure-sweep-section").hidden = section === "none";
  $("figure-sweep-lambda").hidden = reduced !== null;
  $("sweep-units").hidden = !data.parameters.si;
  form.base.showOrigins(data.parameters);
  $("sweep-where").textContent = section === "impact" ? "at impact:" : "once a cycle:";
  const titles = Object.entries(coordinates[section] ?? {}).map(([name, {title}]) => [name, title]);
  fillMenu("sweep-coordinate", titles, wish("sweep-coordinate"));
  for (const id of ["sweep-quantity", "sweep-mapped"]) fillMenu(id, menuOf(data), wish(id));
  offerStarts(starts.length);
  offerSlices();
  $("sweep-starts").hidden = starts.length < 2;
  listWarnings($("sweep-warnings"), [...data.warnings]);
  $("sweep-verdicts").hidden = starts.length > 1; // the colours are those of the starts, then
  const keys = starts.map((state, s) => element("span", startKey(state, s, naming)));
  $("sweep-starts").replaceChildren(...keys.map((key) => element("li", {}, key)));
  $("sweep-keys").hidden = false;
  $("sweep-download").hidden = false;
  const layers = new Layers(data);
  if (data.axes.length === 1) plots.show(layers, choice());
  if (data.axes.length > 1) map.show(layers, choice());
  refiner.follow(layers);
  if (wantedView) zoomTo(wantedView);
  wantedView = null;
  showFreeKey();
  compare();
  changed({edit});
}

function showFreeKey() {
  $("sweep-free").hidden = $("sweep-quantity").value !== "x_max";
}

/** What is shown is of another request than the form's. */
function compare() {
  const own = String(SweepForm.toQuery(form.request()));
  $("sweep-results").classList.toggle("stale", shown !== null && own !== shown);
}

function busy(is) {
  $("sweep-cancel").hidden = !is;
  $("sweep-resume").hidden = is || !data?.axes || data.complete;
  $("sweep-bar").hidden = !is && (!data || data.complete);
}

/** What is worth saying of a complete sweep. */
function remarks() {
  const list = [...data.faults].map(([fault, n]) => `${grouped(n)} points failed: ${fault}`);
  if (data.early) list.push(`${grouped(data.early)} points ended early, at max_impacts`);
  return list.join("; ");
}

const job = new Job({
  ask: (into, signal) =>
    receive(into, signal, (line) => {
      if (!signal.aborted) hear(into, line);
    }),
  show: finish,
  fail(error) {
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say(wholeMessage(error, left), true);
    if (data) showCount();
    settle();
  },
  busy(is, cancelled) {
    busy(is);
    if (cancelled) {
      say("cancelled");
      if (data) showCount();
      settle();
    }
  },
  later: (text) => say(text, true),
});

/** The points that `into` still lacks. */
function complete(into) {
  refiner.stop();
  busy(true);
  job.start(into);
}

function hear(into, line) {
  if (line.type === "start") {
    if (data !== into) present(into);
    say("");
    showCount();
  } else if (line.type === "progress") progress(line);
  else drawSoon();
}

function finish() {
  say(remarks());
  listWarnings($("sweep-warnings"), [...data.warnings]);
  settle();
  refine();
  countUp($("sweep-results"));
}

/** Where the plots lie below the form, one who asks for them is led there. */
function lead() {
  const panel = $("sweep-form");
  const results = $("sweep-results");
  if (results.offsetLeft < panel.offsetLeft + panel.offsetWidth) results.scrollIntoView();
}

function run() {
  form.showErrors([]);
  compare();
  complete(new SweepData(form.request(), halfPeriod));
}

const refine = () => refiner.look(choice().slice);

const sorted = (text) => {
  const q = new URLSearchParams(text);
  q.sort();
  return String(q);
};
const exampleOf = (query) => examples.findIndex(([, q]) => sorted(q) === sorted(query));
const markExample = () => {
  $("sweep-example").value = String(exampleOf(SweepForm.toQuery(form.request())));
};

/** The sweep that is there, as another entry of the history had it. */
function showAgain(view) {
  for (const id of Object.values(menus)) {
    const {wanted} = $(id).dataset;
    $(id).value = wanted;
    if (!wanted || $(id).selectedIndex < 0) $(id).selectedIndex = 0;
    $(id).dataset.wanted = "";
  }
  zoomTo(view);
  chooseFromMenu();
}

/** Shows what a query asks for; without one the first example. */
export function open(given) {
  const rest = new URLSearchParams(given);
  for (const [name, id] of Object.entries(menus)) {
    $(id).dataset.wanted = rest.get(name) ?? "";
    rest.delete(name);
  }
  const view = rest.get("view")?.split(",").map(Number) ?? [];
  rest.delete("view");
  const wantedNow = view.every(Number.isFinite) ? view : [];
  if (String(rest) === shown) return showAgain(wantedNow);
  wantedView = wantedNow;
  opened = true;
  const first = new URLSearchParams(examples[0][1]);
  const wanted = rest.size ? rest : first;
  form.setQuery(wanted, exampleOf(wanted) >= 0);
  markExample();
  showSize();
  run();
}

export function redraw() {
  plots.refresh();
  map.refresh();
}

function download() {
  const names = data.request.axes.map((a) => a.parameter).join("-");
  save(data.file(), `sweep-${names}.ndjson`);
}

const command = () => asCurl("v1/sweep", form.request(), "-sN");

function legend() {
  const item = ([regime, what]) => {
    const className = "key regime";
    const style = `--key: var(--regime-${regime})`;
    const textContent = regime === "none" ? what : `${regime} ${what}`;
    const number = element("small", {id: `sweep-regime-${regime}`});
    const title = `Type ${regime}`;
    return element("li", {title}, element("span", {className, style, textContent}), number);
  };
  $("sweep-regimes").replaceChildren(...Object.entries(regimes).map(item));
}

/** What a picture of a plot says below its title: what all points share. */
function captionOf() {
  const {base, axes, ...run} = data.request;
  const told = Object.entries({...base, ...run}).map(([name, v]) => {
    const value = typeof v === "number" ? naming.value(name, v) : textOf(v);
    return `${symbolOf(name)} = ${value}`;
  });
  return told.join(", ");
}

const allPlots = () => Object.entries({...plots.panels, map});

function namePlots() {
  const {axes} = data;
  const shownPlots = [[], Object.values(plots.panels)][axes.length] ?? [map];
  for (const plot of shownPlots) {
    const {title, summary} = plot.about();
    plot.container.setAttribute("role", "img");
    plot.container.setAttribute("aria-label", `${title}: ${summary}`);
  }
}

function addMenus() {
  for (const [name, plot] of allPlots())
    addMenu($(`figure-sweep-${name}`), plot, () => ({
      ...plot.about(),
      caption: captionOf(),
      name: `sweep-${name}`,
    }));
}

/**
 * tables: the answer of /v1/parameters; tell: called when there is another query; simulate(fields):
 * shows the run of a point.
 */
export function start(tables, tell, {simulate}) {
  changed = tell;
  form = new SweepForm($("sweep-fields"), tables, () => {
    showSize();
    markExample();
    compare();
  });
  const openPoint = ({data: of, index, best}) =>
    simulate({...of.fields(index, best), cycles: cyclesOfPoint});
  naming = new Naming((parameter) => form.parameters.get(parameter)?.unit);
  const panels = {
    section: $("plot-sweep-section"),
    lambda: $("plot-sweep-lambda"),
    other: $("plot-sweep-other"),
  };
  plots = new SweepPlots($("sweep-stack"), panels, naming, openPoint);
  map = new SweepMap($("sweep-map"), $("plot-sweep-map"), naming, openPoint);
  refiner = new Refiner({
    axes: axesOf,
    drawn: drawSoon,
    settled: () => {
      settle();
      countUp($("sweep-results"), "refined");
    },
    say: (text) => {
      $("sweep-refined").textContent = text;
    },
  });
  for (const axis of [plots.axis, map.axis, map.across]) axis.onView(viewed);
  addMenus();
  legend();
  $("sweep-keys").hidden = true;
  $("sweep-example").append(
    new Option("own sweep", "-1"),
    ...examples.map(([title], i) => new Option(title, String(i))),
  );
  unitsSwitch($("sweep-units"));
  onUnits(() => {
    if (!data?.axes) return;
    plots.refresh();
    namePlots();
  });
  listen();
}

function viewed() {
  changed({soon: true});
  refine();
}

/** Runs the example that the menu shows. */
function runExample() {
  const example = examples[$("sweep-example").value];
  if (!example) return;
  const [, given, wishes = {}] = example;
  for (const [name, wanted] of Object.entries(wishes)) $(menus[name]).dataset.wanted = wanted;
  form.setQuery(new URLSearchParams(given), true);
  showSize();
  run();
  lead();
}

function chooseFromMenu() {
  if (!data) return;
  (data.axes.length > 1 ? map : plots).showAs(choice());
  namePlots();
  refine();
  showFreeKey();
  changed();
}

function listen() {
  for (const id of [...Object.values(menus), "sweep-start", "sweep-slice"])
    $(id).addEventListener("change", chooseFromMenu);
  $("sweep-example").addEventListener("change", runExample);
  $("sweep-form").addEventListener("submit", (event) => {
    event.preventDefault();
    run();
    lead();
  });
  $("sweep-cancel").addEventListener("click", () => job.cancel());
  $("sweep-resume").addEventListener("click", () => complete(data));
  $("sweep-download").addEventListener("click", (event) => {
    event.preventDefault();
    download();
  });
  $("sweep-copy").addEventListener("click", () => copy(command(), say));
}

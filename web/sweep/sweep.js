// The sweep tab: the form starts a stream of points, drawn while they arrive. The query holds the
// request and the menus.
import {asCurl, wholeMessage} from "../shared/api.js";
import {
  $,
  choose,
  countUp,
  element,
  fillMenu,
  reveal,
  sayIn,
  scrollToResults,
  setTexts,
} from "../shared/dom.js";
import {copy, save} from "../shared/export.js";
import {Job} from "../shared/job.js";
import {coordinates, menuOf, otherMotion, regimes, symbolOf} from "../shared/quantities.js";
import {showRemarks} from "../shared/tables.js";
import {onUnits, unitsSwitch} from "../shared/units.js";
import {AxisLabels} from "./axis_labels.js";
import {receive, SweepData} from "./data.js";
import {countRegimes, startKey} from "./diagram.js";
import {DiagramView} from "./diagram_view.js";
import {Layers} from "./layers.js";
import {MapView} from "./map_view.js";
import {showPeaks} from "./peaks.js";
import {Refiner} from "./refine.js";
import {examples, SweepForm} from "./sweep_form.js";

const cyclesOfPoint = 272; // for the simulation of a point; tau = 1709 as in the paper

let form;
let labels;
let views; // by the number of axes
let refiner;
let data = null;
let view = null; // view of the sweep; null if no axis remains
let wanted = {}; // menu values for the next sweep, by name in the query
let changed = () => {};

const say = sayIn("sweep-message");

// Menus by their name in the query. The first entry is the default and not mentioned there.
const menus = {
  coordinate: $("sweep-coordinate"),
  beside: $("sweep-quantity"),
  map: $("sweep-mapped"),
};
const startMenu = $("sweep-start");
const sliceMenu = $("sweep-slice");
const choice = () => ({
  coordinate: menus.coordinate.value,
  quantity: menus.beside.value,
  map: menus.map.value,
  start: Number(startMenu.value) || 0,
  best: startMenu.value === "best",
  slice: Number(sliceMenu.value),
});

/** The part of a query that is the request, in canonical order. */
function requestOf(query) {
  const request = new URLSearchParams(query);
  for (const name of [...Object.keys(menus), "view"]) request.delete(name);
  request.sort();
  return request;
}

/** The request of the sweep shown, as a query; null before the first. */
const shown = () => data && String(SweepForm.toQuery(data.request));

/** The query of the sweep shown; null before the first. */
export function query() {
  if (!data) return null;
  const menu = Object.entries(menus)
    .filter(([, {selectedIndex}]) => selectedIndex > 0)
    .map(([name, {value}]) => `${name}=${value}`);
  const ends = view?.ends().join(",");
  return [shown(), ...menu, ...(ends ? [`view=${ends}`] : [])].join("&");
}

const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, " ");

/**
 * Shows the size of the requested sweep and its example, and marks the results as stale if the form
 * differs.
 */
function compare() {
  const {counts, starts, points, cycles} = form.size();
  const factors = [...counts, ...(starts > 1 ? [`${starts} starts`] : [])];
  const product = factors.length > 1 ? `${factors.join(" × ")} = ` : "";
  const size = `${product}${grouped(points)} points, ${grouped(cycles)} cycles`;
  setTexts({"sweep-size": Number.isFinite(points) ? size : ""});
  const own = SweepForm.toQuery(form.request());
  $("sweep-example").value = exampleOf(own);
  $("sweep-results").classList.toggle("stale", data && String(own) !== shown());
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
  Object.assign($("sweep-bar"), {max: data.total || 1, value: data.received});
  setTexts({"sweep-rate": `${grouped(data.received)} of ${grouped(data.total)} points${more}`});
}

// Redraws at most ten times a second, using at most a fifth of the time.
let waiting = 0;
let cost = 0;
function drawSoon() {
  waiting ||= setTimeout(draw, Math.max(100, 4 * cost));
}

function draw() {
  clearTimeout(waiting);
  waiting = 0;
  const began = performance.now();
  view?.refresh(choice());
  showPeaks(data, labels);
  showParts();
  showRegimes();
  cost = performance.now() - began;
}

/** Draws a complete or interrupted sweep, or another choice. */
function settle() {
  if (!data) return;
  draw();
  view?.describe();
  showRemarks("sweep-remarks", [...data.warnings]);
}

/** Shows the parts that the sweep has, and their texts. */
function showParts() {
  const {axes, section, defaultSet, starts, parameters, reduced} = data;
  const third = axes[2];
  const overOne = axes.length === 1;
  const several = starts > 1;
  const apart = defaultSet || (!several && data.points.some(otherMotion));
  reveal({
    "sweep-download": true,
    "sweep-keys": true,
    "sweep-stack": overOne,
    "sweep-map": axes.length > 1,
    "figure-sweep-section": section !== "none",
    "figure-sweep-lambda": reduced === null,
    "sweep-units": parameters.si,
    "sweep-free": menus.beside.value === "x_max",
    "sweep-start-of": several || defaultSet, // of a map
    "sweep-slice-of": third,
    "sweep-starts": several,
    "sweep-verdicts": !several, // the colours then distinguish the starts
    "sweep-motions": overOne && apart,
    "sweep-worst": defaultSet,
  });
  setTexts({
    "sweep-where": section === "impact" ? "at impact:" : "once a cycle:",
    "sweep-start-word": defaultSet ? "start:" : "from start",
    "sweep-slice-word": third ? `where ${symbolOf(third.parameter)} =` : "",
    "sweep-other": defaultSet
      ? "best start, where the motions differ"
      : "from a second start, where the motion differs",
  });
}

function showRegimes() {
  const item = ([regime, n]) => {
    const none = regime === "none";
    const className = "key regime";
    const style = `--key: var(--regime-${regime})`;
    const textContent = none ? regimes.none : `${regime} ${regimes[regime]}`;
    const key = element("span", {className, style, textContent});
    const number = element("small", {id: `sweep-regime-${regime}`, textContent: n || ""});
    const about = {title: `Type ${regime}`, className: n ? "" : "absent", hidden: none && !n};
    return element("li", about, key, number);
  };
  $("sweep-regimes").replaceChildren(...countRegimes(data.points).map(item));
}

/** Fills the menus for a new sweep; unused ones are empty. */
function fillMenus() {
  const {section, defaultSet, axes} = data;
  const titles = Object.entries(coordinates[section] ?? {}).map(([name, {title}]) => [name, title]);
  const entries = {coordinate: titles, [axes.length > 1 ? "map" : "beside"]: menuOf(data)};
  for (const [name, menu] of Object.entries(menus))
    fillMenu(menu, entries[name] ?? [], wanted[name]);
  wanted = {};
  const numbered = data.states.map((_, s) => [s, s + 1]);
  const ofDefaultSet = [[0, "worst"], ["best"]];
  fillMenu(startMenu, defaultSet ? ofDefaultSet : numbered);
  const {parameter, values} = axes[2] ?? {values: []};
  fillMenu(
    sliceMenu,
    values.map((v, m) => [m, labels.value(parameter, v)]),
  );
}

/** Shows the empty diagrams of a new sweep. */
function present(fresh) {
  const edit = data && !fresh.ends;
  data = fresh;
  data.folded = data.reduced && labels.of(data.reduced);
  view = views[data.axes.length];
  form.base.showOrigins(data.parameters);
  fillMenus();
  const key = (state, s) => element("li", {}, element("span", startKey(state, s, labels)));
  $("sweep-starts").replaceChildren(...data.states.map(key));
  view?.show(new Layers(data));
  refiner.follow(view);
  settle();
  if (fresh.ends) view?.zoomTo(fresh.ends);
  compare();
  changed({edit});
}

function busy(is) {
  const lacking = data && !data.complete;
  reveal({
    "sweep-cancel": is,
    "sweep-resume": !is && lacking,
    "sweep-bar": is || lacking,
  });
}

/** Failed and truncated points of a complete sweep, as text. */
function remarks() {
  const found = new Map();
  for (const {error, reason} of data.points) {
    const early = reason && reason !== "complete" && "stopped at max_impacts";
    const what = error ? `failed: ${error}` : early;
    if (what) found.set(what, (found.get(what) ?? 0) + 1);
  }
  return [...found].map(([what, n]) => `${grouped(n)} points ${what}`).join("; ");
}

const job = new Job({
  ask: (into, signal) => receive(into, signal, (line) => receiveLine(into, line)),
  show: finish,
  fail(error) {
    stop(wholeMessage(error, form.showErrors(error.errors ?? [])), true);
  },
  busy(is, cancelled) {
    busy(is);
    if (cancelled) stop("cancelled");
  },
  later: (text) => say(text, true),
});

function complete(into) {
  refiner.stop();
  busy(true);
  job.start(into);
}

function receiveLine(into, line) {
  if (line.type === "start") {
    if (data !== into) present(into);
    say("");
    showCount();
  } else if (line.type === "progress") progress(line);
  else drawSoon();
}

function stop(why, fault) {
  say(why, fault);
  if (data) showCount();
  settle();
}

function finish() {
  say(remarks());
  settle();
  refiner.schedule();
  countUp($("sweep-results"));
}

/** ends: the range to show, for a sweep from the address. */
function run(ends) {
  form.showErrors([]);
  compare();
  complete(Object.assign(new SweepData(form.request()), {ends}));
}

const isSame = (one, other) => String(requestOf(one)) === String(requestOf(other));
const exampleOf = (given) => examples.findIndex(([, example]) => isSame(example, given));

/** Runs the sweep of a query, or the first example if it names none. */
function ask(given, ends) {
  const named = requestOf(given);
  const request = String(named) ? named : requestOf(examples[0][1]);
  const standard = Object.keys(menus).map((name) => [name, ""]); // the first entry
  wanted = Object.fromEntries([...standard, ...given]);
  form.setQuery(request, exampleOf(request) >= 0);
  run(ends);
}

export function open(given) {
  const numbers = given.get("view")?.split(",").map(Number) ?? [];
  const ends = numbers.every(Number.isFinite) ? numbers : [];
  if (data && isSame(given, shown())) {
    // The same sweep with other menus: Back or Forward.
    for (const [name, menu] of Object.entries(menus)) choose(menu, given.get(name));
    view?.zoomTo(ends);
    chooseFromMenu();
  } else ask(given, ends);
}

export const redraw = settle;

function download() {
  const names = data.request.axes.map((a) => a.parameter).join("-");
  save(data.file(), `sweep-${names}.ndjson`);
}

/**
 * tables: the answer of /v1/parameters; tell: called when the query changes; simulate(fields):
 * opens the simulation of a point.
 */
export function start(tables, tell, {simulate}) {
  changed = tell;
  form = new SweepForm($("sweep-fields"), tables, compare);
  labels = new AxisLabels((parameter) => form.parameters.get(parameter)?.unit);
  const openPoint = ({data: of, index, best}) =>
    simulate({...of.fields(index, best), cycles: cyclesOfPoint});
  const diagrams = new DiagramView($("sweep-stack"), labels, openPoint);
  const map = new MapView($("sweep-map"), labels, openPoint);
  views = [null, diagrams, map, map];
  refiner = new Refiner({
    drawn: drawSoon,
    settled: () => {
      settle();
      countUp($("sweep-results"), "refined");
    },
    say: (text) => setTexts({"sweep-refined": text}),
  });
  for (const viewport of [...diagrams.viewports, ...map.viewports])
    viewport.onZoom(() => {
      changed({soon: true});
      refiner.schedule();
    });
  reveal({"sweep-keys": false});
  fillMenu($("sweep-example"), [
    ["-1", "custom sweep"],
    ...examples.map(([title], i) => [i, title]),
  ]);
  unitsSwitch($("sweep-units"));
  onUnits(settle);
  listen();
}

function chooseFromMenu() {
  settle();
  refiner.schedule();
  changed();
}

function listen() {
  $("sweep-results").onchange = chooseFromMenu; // its menus
  $("sweep-example").onchange = ({target}) => {
    if (!examples[target.value]) return;
    ask(new URLSearchParams(examples[target.value][1]));
    scrollToResults("sweep");
  };
  $("sweep-form").onsubmit = (event) => {
    event.preventDefault();
    run();
    scrollToResults("sweep");
  };
  $("sweep-cancel").onclick = () => job.cancel();
  $("sweep-resume").onclick = () => complete(data);
  $("sweep-download").onclick = (event) => {
    event.preventDefault();
    download();
  };
  $("sweep-copy").onclick = () => copy(asCurl("v1/sweep", form.request(), "-sN"), say);
}

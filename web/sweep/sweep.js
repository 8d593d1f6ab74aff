// The tab of a sweep: form in, a stream of points out, drawn as they come. Its query is the request
// and what the menus show.
import {asCurl, wholeMessage} from "../shared/api.js";
import {showRemarks} from "../shared/cards.js";
import {$, countUp, element, reveal, sayIn, write} from "../shared/dom.js";
import {Job} from "../shared/job.js";
import {coordinates, menuOf, otherMotion, regimes, symbolOf} from "../shared/quantities.js";
import {copy, save} from "../shared/take_away.js";
import {onUnits, unitsSwitch} from "../shared/units.js";
import {Naming} from "./axes.js";
import {SweepData} from "./data.js";
import {countRegimes, startKey} from "./diagram.js";
import {SweepPlots} from "./diagrams.js";
import {Layers} from "./layers.js";
import {SweepMap} from "./map.js";
import {choose, fillMenu} from "./menu.js";
import {showPeaks} from "./peaks.js";
import {Refiner} from "./refine.js";
import {receive} from "./stream.js";
import {examples, SweepForm} from "./sweep_form.js";

const cyclesOfPoint = 272; // of the simulation of a point: the paper's tau of 1709

let form;
let naming;
let views; // by the number of axes
let refiner;
let data = null;
let view = null; // that of the sweep; null where no axis is left
let wanted = {}; // what the menus are to show of the next sweep, by their name in the query
let changed = () => {};

const say = sayIn("sweep-message");

// The menus that are in the query, by their name there. Their first entry needs no mention.
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

/** What of a query is the request, in an order of its own. */
function requestOf(query) {
  const request = new URLSearchParams(query);
  for (const name of [...Object.keys(menus), "view"]) request.delete(name);
  request.sort();
  return request;
}

/** The request of the sweep that is shown, as a query; null before the first. */
const shown = () => data && String(SweepForm.toQuery(data.request));

/** The query of the sweep that is shown, or null before the first. */
export function query() {
  if (!data) return null;
  const menu = Object.entries(menus)
    .filter(([, {selectedIndex}]) => selectedIndex > 0)
    .map(([name, {value}]) => `${name}=${value}`);
  const ends = view?.ends().join(",");
  return [shown(), ...menu, ...(ends ? [`view=${ends}`] : [])].join("&");
}

const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, " ");

/** What the form says is another request: how large it is, which example, and what it is not. */
function compare() {
  const {counts, starts, points, cycles} = form.size();
  const factors = [...counts, ...(starts > 1 ? [`${starts} starts`] : [])];
  const product = factors.length > 1 ? `${factors.join(" × ")} = ` : "";
  const size = `${product}${grouped(points)} points, ${grouped(cycles)} cycles`;
  write({"sweep-size": Number.isFinite(points) ? size : ""});
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
  write({"sweep-rate": `${grouped(data.received)} of ${grouped(data.total)} points${more}`});
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
  const began = performance.now();
  view?.refresh(choice());
  showPeaks(data, naming);
  showParts();
  showRegimes();
  cost = performance.now() - began;
}

/** No more points come for now, or others are shown. */
function settle() {
  if (!data) return;
  draw();
  view?.describe();
  showRemarks("sweep-remarks", [...data.warnings]);
}

/** What of the results is there, and its words. */
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
    "sweep-verdicts": !several, // the colours are those of the starts, then
    "sweep-motions": overOne && apart,
    "sweep-worst": defaultSet,
  });
  write({
    "sweep-where": section === "impact" ? "at impact:" : "once a cycle:",
    "sweep-start-word": defaultSet ? "of the start that is" : "from start",
    "sweep-slice-word": third ? `where ${symbolOf(third.parameter)} =` : "",
    "sweep-other": defaultSet
      ? "the best, where they end apart"
      : "from another start, where it was tried and ends elsewhere",
  });
}

/** The regimes, and how many points are of each. */
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

/** The menus of a sweep that has just begun; those that it does not show are empty. */
function offer() {
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
    values.map((v, m) => [m, naming.value(parameter, v)]),
  );
}

/** The plots of a sweep that has just begun, still empty. */
function present(fresh) {
  const edit = data && !fresh.ends;
  data = fresh;
  data.folded = data.reduced && naming.of(data.reduced);
  view = views[data.axes.length];
  form.base.showOrigins(data.parameters);
  offer();
  const key = (state, s) => element("li", {}, element("span", startKey(state, s, naming)));
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

/** What is worth saying of a complete sweep. */
function remarks() {
  const found = new Map();
  for (const {error, reason} of data.points) {
    const early = reason && reason !== "complete" && "ended early, at max_impacts";
    const what = error ? `failed: ${error}` : early;
    if (what) found.set(what, (found.get(what) ?? 0) + 1);
  }
  return [...found].map(([what, n]) => `${grouped(n)} points ${what}`).join("; ");
}

const job = new Job({
  ask: (into, signal) => receive(into, signal, (line) => hear(into, line)),
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

/** Some points do not come. */
function stop(why, fault) {
  say(why, fault);
  if (data) showCount();
  settle();
}

function finish() {
  say(remarks());
  settle();
  refiner.look();
  countUp($("sweep-results"));
}

/** Where the plots lie below the form, one who asks for them is led there. */
function lead() {
  const panel = $("sweep-form");
  const results = $("sweep-results");
  if (results.offsetLeft < panel.offsetLeft + panel.offsetWidth) results.scrollIntoView();
}

/** ends: what is to be in view, of a sweep that comes from the address. */
function run(ends) {
  form.showErrors([]);
  compare();
  complete(Object.assign(new SweepData(form.request()), {ends}));
}

const isSame = (one, other) => String(requestOf(one)) === String(requestOf(other));
const exampleOf = (asked) => examples.findIndex(([, example]) => isSame(example, asked));

/** Runs what a query asks for, or the first example where it names no sweep. */
function ask(asked, ends) {
  const named = requestOf(asked);
  const request = String(named) ? named : requestOf(examples[0][1]);
  const standard = Object.keys(menus).map((name) => [name, ""]); // the first
  wanted = Object.fromEntries([...standard, ...asked]);
  form.setQuery(request, exampleOf(request) >= 0);
  run(ends);
}

/** Shows what a query asks for. */
export function open(given) {
  const numbers = given.get("view")?.split(",").map(Number) ?? [];
  const ends = numbers.every(Number.isFinite) ? numbers : [];
  if (data && isSame(given, shown())) {
    // The sweep that is there, as another entry of the history had it.
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
 * tables: the answer of /v1/parameters; tell: called when there is another query; simulate(fields):
 * shows the run of a point.
 */
export function start(tables, tell, {simulate}) {
  changed = tell;
  form = new SweepForm($("sweep-fields"), tables, compare);
  naming = new Naming((parameter) => form.parameters.get(parameter)?.unit);
  const openPoint = ({data: of, index, best}) =>
    simulate({...of.fields(index, best), cycles: cyclesOfPoint});
  const plots = new SweepPlots($("sweep-stack"), naming, openPoint);
  const map = new SweepMap($("sweep-map"), naming, openPoint);
  views = [null, plots, map, map];
  refiner = new Refiner({
    drawn: drawSoon,
    settled: () => {
      settle();
      countUp($("sweep-results"), "refined");
    },
    say: (text) => write({"sweep-refined": text}),
  });
  for (const axis of [...plots.axes, ...map.axes])
    axis.onView(() => {
      changed({soon: true});
      refiner.look();
    });
  reveal({"sweep-keys": false});
  fillMenu($("sweep-example"), [["-1", "own sweep"], ...examples.map(([title], i) => [i, title])]);
  unitsSwitch($("sweep-units"));
  onUnits(settle);
  listen();
}

function chooseFromMenu() {
  settle();
  refiner.look();
  changed();
}

function listen() {
  $("sweep-results").onchange = chooseFromMenu; // its menus
  $("sweep-example").onchange = ({target}) => {
    if (!examples[target.value]) return;
    ask(new URLSearchParams(examples[target.value][1]));
    lead();
  };
  $("sweep-form").onsubmit = (event) => {
    event.preventDefault();
    run();
    lead();
  };
  $("sweep-cancel").onclick = () => job.cancel();
  $("sweep-resume").onclick = () => complete(data);
  $("sweep-download").onclick = (event) => {
    event.preventDefault();
    download();
  };
  $("sweep-copy").onclick = () => copy(asCurl("v1/sweep", form.request(), "-sN"), say);
}

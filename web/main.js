// The page: its tabs, and the address, which names the tab and holds its request. So a link shows
// the same, and Back leads back.

import * as measurement from "./measurement/measurement.js";
import {get} from "./shared/api.js";
import {onColours} from "./shared/colours.js";
import {$} from "./shared/dom.js";
import * as tabs from "./shared/tabs.js";
import * as simulation from "./simulation/simulation.js";
import * as sweep from "./sweep/sweep.js";

// A tab is a module with start(tables, changed, others), open(query), query() and redraw(); it is
// started when one goes there first. others: {simulate(fields), measure(answer)}, what one tab asks
// of another.
const modules = {simulation, sweep, measurement};
const started = new Set();
const queryOf = (name) => (started.has(name) ? modules[name].query() : "");
const scrolled = {};
let tables;
let current = null;

// In a frame of another page: plots only.
const embedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embedded", embedded);

function address(name, query) {
  const parts = [embedded ? "embed=1" : "", name === "simulation" ? "" : `tab=${name}`, query];
  return `?${parts.filter(Boolean).join("&")}`;
}

function show(name) {
  if (current === name) return;
  if (current) scrolled[current] = scrollY;
  current = name;
  tabs.select(name);
  scrollTo(0, scrolled[name] ?? 0);
}

/** Follows the address. */
function follow() {
  const query = new URLSearchParams(location.search);
  query.delete("embed");
  const named = query.get("tab");
  const name = Object.hasOwn(modules, named) ? named : "simulation";
  if (name === named) query.delete("tab"); // another is said to be unknown
  show(name);
  if (!started.has(name))
    modules[name].start(tables, keep(name), {simulate: simulatePoint, measure: measureRun});
  started.add(name);
  return modules[name].open(query);
}

function go(name, query) {
  history.pushState(null, "", address(name, query));
  return follow();
}

const together = 800; // ms within which edits are one for Back
let edited = -Infinity;
let writing = 0;

/**
 * A tab has another query. edit: Back leads to the one before, unless that is just as new; soon:
 * more are to come.
 */
const keep =
  (name) =>
  ({edit = false, soon = false} = {}) => {
    if (current !== name) return;
    clearTimeout(writing);
    const write = (way) => history[way](null, "", address(name, queryOf(name)));
    const now = performance.now();
    const apart = edit && now - edited > together;
    if (edit) edited = now;
    if (apart) write("pushState");
    else if (soon)
      writing = setTimeout(write, 200, "replaceState"); // browsers count them
    else write("replaceState");
  };

/** The run of one of a sweep's points, from its first impacts on. */
function simulatePoint(fields) {
  scrolled.simulation = 0;
  return go("simulation", new URLSearchParams(Object.entries(fields)));
}

/** A run as a record to be identified. answer: of /v1/simulate, with its impacts. */
async function measureRun(answer) {
  await go("measurement", queryOf("measurement"));
  return measurement.measure(answer);
}

async function start() {
  const [fields, {presets}] = await Promise.all([get("v1/parameters"), get("v1/presets")]);
  tables = {...fields, presets};
  tabs.listen((name) => {
    if (name !== current) go(name, queryOf(name));
  });
  addEventListener("popstate", follow);
  onColours(() => {
    for (const name of started) modules[name].redraw();
  });
  await follow();
  const {version} = await get("version");
  $("version").textContent = `vines ${version}`;
}

start().catch((error) => {
  $("message").textContent = `the page could not start: ${error.message}`;
  $("message").classList.add("fault");
});

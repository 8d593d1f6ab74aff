// The page: tabs and the address. The address names the tab and holds its request, so links and the
// Back button restore what was shown.

import * as measurement from "./measurement/measurement.js";
import {get} from "./shared/api.js";
import {onColours} from "./shared/colours.js";
import {$, attributes, on} from "./shared/dom.js";
import * as simulation from "./simulation/simulation.js";
import * as sweep from "./sweep/sweep.js";

// A tab is a module with start(tables, changed, others), open(query), query() and redraw(), started
// when it is first shown. others: {simulate(fields), measure(answer)} open another tab.
const modules = {simulation, sweep, measurement};
const started = new Set();
const queryOf = (name) => (started.has(name) ? modules[name].query() : "");
const scrolled = {};
let tables;
let current = null;

// Embedded in another page's <iframe>: plots only.
const embedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embedded", embedded);

const tabs = [...document.querySelectorAll("[role=tab]")];
const nameOf = (tab) => tab.id.replace("tab-", "");

function selectTab(chosen) {
  for (const tab of tabs) {
    const is = nameOf(tab) === chosen;
    attributes(tab, {"aria-selected": is, tabindex: is ? 0 : -1});
    $(tab.getAttribute("aria-controls")).hidden = !is;
  }
}

const moves = {ArrowRight: (i) => i + 1, ArrowLeft: (i) => i - 1, Home: () => 0, End: () => -1};

/** Tabs are chosen by click and by arrow keys. */
function listenToTabs(choose) {
  for (const tab of tabs)
    on(tab, {
      click: () => choose(nameOf(tab)),
      keydown(event) {
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        const next = tabs.at(move(tabs.indexOf(tab)) % tabs.length);
        next.focus();
        next.click();
      },
    });
}

function address(name, query) {
  const parts = [embedded ? "embed=1" : "", name === "simulation" ? "" : `tab=${name}`, query];
  return `?${parts.filter(Boolean).join("&")}`;
}

function show(name) {
  if (current === name) return;
  if (current) scrolled[current] = scrollY;
  current = name;
  selectTab(name);
  scrollTo(0, scrolled[name] ?? 0);
}

/** Shows the tab and request of the address. */
function follow() {
  const query = new URLSearchParams(location.search);
  query.delete("embed");
  const named = query.get("tab");
  const name = Object.hasOwn(modules, named) ? named : "simulation";
  if (name === named) query.delete("tab"); // other values are reported as unknown
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

const together = 800; // ms within which edits share a history entry
let edited = -Infinity;
let writing = 0;

/**
 * Writes a tab's query to the address. edit: adds a history entry, unless the last is recent; soon:
 * more changes follow.
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

/** Opens the simulation of a sweep's point. */
function simulatePoint(fields) {
  scrolled.simulation = 0;
  return go("simulation", new URLSearchParams(Object.entries(fields)));
}

/** Opens the record of a run, an answer of /v1/simulate with impacts, in Measurement. */
async function measureRun(answer) {
  await go("measurement", queryOf("measurement"));
  return measurement.measure(answer);
}

async function start() {
  const [fields, {presets}] = await Promise.all([get("v1/parameters"), get("v1/presets")]);
  tables = {...fields, presets};
  listenToTabs((name) => {
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

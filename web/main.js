// The page: tabs and the address. The address names the tab and holds its request, so links and the
// Back button restore what was shown.

import * as measurement from "./measurement/measurement.js";
import {get} from "./shared/api.js";
import {onColours} from "./shared/colours.js";
import {$, attributes, on} from "./shared/dom.js";
import * as simulation from "./simulation/simulation.js";
import * as sweep from "./sweep/sweep.js";

// A tab is a module with start(tables, changed, others), open(query), query() and redraw(), started
// when it is first shown. tables: fields and presets of the service; changed({edit, soon}): called
// when the tab's query has changed, see addressUpdater; others: {simulate(fields), measure(answer)}
// open another tab.
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

/** Tabs are chosen by click, by arrow keys, and by Home and End. */
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

function showTab(name) {
  if (current === name) return;
  if (current) scrolled[current] = scrollY;
  current = name;
  selectTab(name);
  scrollTo(0, scrolled[name] ?? 0);
}

/** Shows the tab and request of the address. */
function openAddress() {
  const query = new URLSearchParams(location.search);
  query.delete("embed");
  const named = query.get("tab");
  const name = Object.hasOwn(modules, named) ? named : "simulation";
  if (name === named) query.delete("tab"); // any other value stays, and open() reports it
  showTab(name);
  if (!started.has(name))
    modules[name].start(tables, addressUpdater(name), {
      simulate: simulatePoint,
      measure: measureRun,
    });
  started.add(name);
  return modules[name].open(query);
}

function navigate(name, query) {
  history.pushState(null, "", address(name, query));
  return openAddress();
}

const editWindow = 800; // ms
let lastEdit = -Infinity;
let writeTimer = 0;

/**
 * Returns a function that writes a tab's query to the address. edit: adds a history entry if the
 * previous edit is more than `editWindow` ago, otherwise replaces the current one. soon: more
 * changes follow; the replacement is delayed by 200 ms.
 */
const addressUpdater =
  (name) =>
  ({edit = false, soon = false} = {}) => {
    if (current !== name) return;
    clearTimeout(writeTimer);
    const write = (method) => history[method](null, "", address(name, queryOf(name)));
    const now = performance.now();
    const isNewEntry = edit && now - lastEdit > editWindow;
    if (edit) lastEdit = now;
    if (isNewEntry) write("pushState");
    else if (soon)
      writeTimer = setTimeout(write, 200, "replaceState"); // browsers limit the rate of calls
    else write("replaceState");
  };

/** Opens the simulation of a sweep's point. */
function simulatePoint(fields) {
  scrolled.simulation = 0; // the new simulation is shown from the top
  return navigate("simulation", new URLSearchParams(Object.entries(fields)));
}

/** Opens the record of a run, an answer of /v1/simulate with impacts, in Measurement. */
async function measureRun(answer) {
  await navigate("measurement", queryOf("measurement"));
  return measurement.measure(answer);
}

async function start() {
  const [fields, {presets}] = await Promise.all([get("v1/parameters"), get("v1/presets")]);
  tables = {...fields, presets};
  listenToTabs((name) => {
    if (name !== current) navigate(name, queryOf(name));
  });
  addEventListener("popstate", openAddress);
  onColours(() => {
    for (const name of started) modules[name].redraw();
  });
  await openAddress();
  const {version} = await get("version");
  $("version").textContent = `vines ${version}`;
}

start().catch((error) => {
  $("message").textContent = `the page could not start: ${error.message}`;
  $("message").classList.add("fault");
});

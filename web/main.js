// The page: its tabs, and the address, which names the tab and holds its request. So a link shows
// the same, and Back leads back.
import {get} from "./api.js";
import {$} from "./dom.js";
import * as measurement from "./measurement.js";
import {showModel} from "./model.js";
import * as simulation from "./simulation.js";
import * as sweep from "./sweep.js";
import * as tabs from "./tabs.js";

const panes = {simulation, sweep, measurement};
const scrolled = {};
let current = null;

function address(name, query) {
  if (name === "simulation") return `?${query}`;
  return query ? `?tab=${name}&${query}` : `?tab=${name}`;
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
  const name = Object.hasOwn(panes, query.get("tab")) ? query.get("tab") : "simulation";
  query.delete("tab");
  show(name);
  return panes[name].open(query);
}

function go(name, query) {
  history.pushState(null, "", address(name, query));
  return follow();
}

const keep = (name) => () => {
  if (current === name) history.replaceState(null, "", address(name, panes[name].query()));
};

/** The run of one of a sweep's points, from its first impacts on. */
function simulatePoint(fields) {
  scrolled.simulation = 0;
  return go("simulation", new URLSearchParams(Object.entries(fields)));
}

async function start() {
  const [fields, {presets}, version] = await Promise.all([
    get("v1/parameters"),
    get("v1/presets"),
    get("version"),
  ]);
  $("version").textContent = `vines ${version.version}`;
  simulation.start(fields.fields, presets, keep("simulation"));
  sweep.start(fields, keep("sweep"), simulatePoint);
  measurement.start(fields.identify_fields, presets, keep("measurement"));
  showModel().catch(() => {}); // the equations are there without the sketch
  tabs.listen((name) => {
    if (name !== current) go(name, panes[name].query() ?? "");
  });
  addEventListener("popstate", follow);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    for (const pane of Object.values(panes)) pane.redraw();
  });
  await follow();
}

start().catch((error) => {
  $("message").textContent = `the page could not start: ${error.message}`;
  $("message").classList.add("fault");
});

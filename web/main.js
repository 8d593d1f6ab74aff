// The page: its tabs, and the address, which names the tab and holds its request.
import {get} from "./shared/api.js";
import {$, sayIn, setTexts} from "./shared/dom.js";
import {onColours} from "./shared/ink.js";
import {joined} from "./shared/numbers.js";
import "./shared/terms.js";
import {toQuery} from "./simulation/request.js";
import {SimulationTab} from "./simulation/simulation.js";

// The class of each tab, a RequestTab, made as (tables, changed, others) when it is first shown.
// tables: the answer of /v1/parameters, and presets; changed(): see addressChanged.
const loaders = {
  simulation: async () => SimulationTab,
  sweep: async () => (await import("./sweep/sweep.js")).SweepTab,
  motions: async () => (await import("./motions/motions.js")).MotionsTab,
  design: async () => (await import("./design/design.js")).DesignTab,
  measurement: async () => (await import("./measurement/measurement.js")).MeasurementTab,
};
const names = Object.keys(loaders);
const tabs = {};
const queryOf = (name) => tabs[name]?.query() ?? "";
const scrolled = {};
let tables;
let current = null;

// Embedded in another page's <iframe>: the results only.
const embedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embedded", embedded);

/** Shows the panel of a tab, scrolled as it was left. */
function showPanel(name) {
  if (current === name) return;
  if (current) scrolled[current] = scrollY;
  current = name;
  for (const each of names) {
    $(`tab-${each}`).ariaCurrent = each === name ? "page" : null;
    $(`panel-${each}`).hidden = each !== name;
  }
  scrollTo(0, scrolled[name] ?? 0);
}

/** A tab shows its latest request; with a key its link opens another tab of the browser. */
function listenToLinks() {
  for (const name of names)
    $(`tab-${name}`).onclick = (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return;
      event.preventDefault();
      if (name !== current) navigate(name, queryOf(name));
    };
}

const address = (name, query) =>
  `?${joined([embedded && "embed=1", name !== "simulation" && `tab=${name}`, query], "&")}`;

const writeAddress = (method) => history[method](null, "", address(current, queryOf(current)));

let pending = 0; // timer of a delayed replacement; 0 without one

function cancelPending() {
  clearTimeout(pending);
  pending = 0;
}

function writePending() {
  if (pending) writeAddress("replaceState");
  cancelPending();
}

const editWindow = 800; // ms
let lastEdit = -Infinity;

/** Writes a query to the address. edit: can add a history entry; soon: more changes follow. */
function addressChanged(name, {edit = false, soon = false} = {}) {
  if (current !== name) return;
  cancelPending();
  const now = performance.now();
  const isOther = address(name, queryOf(name)) !== location.search; // not after Back
  const isNewEntry = edit && isOther && now - lastEdit > editWindow;
  if (edit) lastEdit = now;
  if (isNewEntry) writeAddress("pushState");
  else if (soon)
    pending = setTimeout(writePending, 200); // browsers limit the rate of calls
  else writeAddress("replaceState");
}

/** Shows the tab and request of the address. */
async function openAddress() {
  cancelPending();
  const query = new URLSearchParams(location.search);
  for (const key of ["embed", current && "story"]) query.delete(key);
  const named = query.get("tab");
  const name = names.includes(named) ? named : "simulation";
  if (name === named) query.delete("tab"); // any other value stays, and open() reports it
  showPanel(name);
  if (tabs[name] && String(query) === queryOf(name)) return; // keeps what is not sent yet
  try {
    const Tab = await loaders[name]();
    const changed = (how) => addressChanged(name, how);
    tabs[name] ??= new Tab(tables, changed, others);
  } catch (error) {
    return fail(`the tab could not be loaded: ${error.message}`);
  }
  if (current === name) tabs[name].open(query);
}

/** Starts a guided story. Returns false for an unknown one. */
async function tell(name) {
  const {start} = await import("./stories.js");
  return start(name, (query) => navigate("simulation", query)); // a step names its tab
}

function navigate(name, query) {
  writePending();
  history.pushState(null, "", address(name, query));
  return openAddress();
}

const others = {
  /** Opens the simulation of a sweep's point. */
  simulate(fields) {
    scrolled.simulation = 0; // the new simulation is shown from the top
    const pinned = new URLSearchParams(queryOf("simulation")).get("pinned");
    navigate("simulation", toQuery({...fields, ...(pinned !== null && {pinned})}));
  },
  /** Opens the record of a run, an answer of /v1/simulate with impacts. */
  async measure(answer) {
    await navigate("measurement", queryOf("measurement"));
    tabs.measurement?.measure(answer); // missing if it could not be loaded
  },
};

/** Shows a fault in the panel that is visible. */
function fail(text) {
  const {id} = $(`panel-${current ?? "simulation"}`).querySelector(".message");
  sayIn(id)(text, true);
}

async function start() {
  // Keys and bars have the colour that they name.
  for (const {style, dataset} of document.querySelectorAll("[data-colour]"))
    style.setProperty("--key", `var(--${dataset.colour})`);
  const [fields, {presets}] = await Promise.all([get("v1/parameters"), get("v1/presets")]);
  tables = {...fields, presets};
  listenToLinks();
  $("story").onchange = ({target}) => {
    tell(target.value);
    target.value = "";
  };
  addEventListener("popstate", openAddress);
  onColours(() => {
    for (const tab of Object.values(tabs)) tab.redraw();
  });
  const story = new URLSearchParams(location.search).get("story");
  if (!story || !(await tell(story))) await openAddress();
  // The page is usable without its version.
  const {version} = await get("version").catch(() => ({}));
  if (version) setTexts({version: `vines ${version}`});
}

start().catch((error) => fail(`the page could not start: ${error.message}`));

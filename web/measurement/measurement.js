// The measurement tab: a file and the form are sent as one request, and the identified system is
// shown. The list of impacts can be edited and sent again.

import {
  identify,
  identifyJson,
  Problem,
  sendFileAsCurl,
  simulate,
  wholeMessage,
} from "../shared/api.js";
import {$, countUp, element, sayIn, scrollToResults} from "../shared/dom.js";
import {copy, save} from "../shared/export.js";
import {Form} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {ImpactList} from "./impact_list.js";
import {showFit, summariseMeasurement} from "./measurement_summary.js";
import {
  draw,
  drawRecord,
  mark,
  nameFigures,
  redraw,
  start as startViews,
} from "./measurement_views.js";
import * as picker from "./picker.js";
import {asJson, parse, recordOf, spikeNear} from "./record.js";
import {oscillatorOf, recordOfRun} from "./sample.js";

const groups = {
  system: ["System", true],
  SI: ["Oscillator", true],
  record: ["Columns and units", false],
};
/** Experiments of Table 4: label of the button for a simulated record. */
const samples = {fig15: "b = 9 mm, periodic", fig20: "b = 15 mm, chaotic"};
const longestQuery = 6000; // characters; servers and proxies accept addresses of about 8 kB
const sampleCycles = 330; // about 40 s
const presets = {}; // of the experiments, by name

let form;
let list;
let file = null;
let parsed = null; // content of the file
let record = null; // parsed columns as selected by the form
let answer = null;
let sent = null; // fields that the answer belongs to
let newest = 0; // counts the records requested; only the newest is shown
let ticking = 0;
let shown = null;
let remembered = () => {};

const results = $("measure-results");

const say = sayIn("measure-message");

/**
 * Changes to the service's fields: column names are typed or taken from the file's header; the
 * amplitude of the forcing is fitted and has no field.
 */
const changes = {
  threshold: {group: "system", unit: "sd of the noise"},
  R: {default_note: "estimated"},
  m1: {default_note: "required"},
  k1: {default_note: "required"},
  f: {default_note: "its own"},
};
const isColumn = (name) => name.endsWith("_column");
const fieldsOf = (fields) =>
  fields
    .filter((f) => !["impact_times_s", "F"].includes(f.name))
    .map((f) => ({...f, ...(isColumn(f.name) && {type: "text"}), ...changes[f.name]}));

const preset = () => $("measure-preset").value;

/** Fields of the chosen oscillator, without those that are estimated. */
function base() {
  const {R, F, cycles, ...oscillator} = presets[preset()]?.parameters ?? {};
  return oscillator;
}

/** Fields as a query; commas stay readable. */
const asQuery = (fields) => String(new URLSearchParams(fields)).replaceAll("%2C", ",");

export const query = () => shown;

const pick = (fields, isWanted) => Object.fromEntries(Object.entries(fields).filter(isWanted));

/** Updates the address with the form. The file itself is not part of a link. */
function remember() {
  const given = base();
  const differing = pick(form.values(), ([name, value]) => value !== given[name]);
  shown = asQuery({...(preset() && {preset: preset()}), ...differing});
  remembered();
  compare();
}

/** Selects an oscillator; more: further fields. */
function choosePreset(name, more) {
  $("measure-preset").value = Object.hasOwn(presets, name) ? name : "";
  form.set({...base(), ...more});
}
/** Column fields of the form, which are kept when the oscillator changes. */
function ofColumns() {
  const names = form.fields.filter((f) => f.group === "record").map((f) => f.name);
  return pick(form.values(), ([name]) => names.includes(name));
}

export async function open(given) {
  const fields = Object.fromEntries(given);
  if (asQuery(fields) === shown) return;
  const {preset: name = given.size ? "" : "fig20", ...rest} = fields;
  choosePreset(name, rest);
  remember();
}

export {redraw};

/** Draws the columns selected by the fields, with the impacts known. */
function drawFile(fields) {
  record = parsed && recordOf(parsed, fields);
  for (const id of ["measure-parts", "measure-list", "measure-add-at"]) $(id).hidden = !record;
  if (parsed) picker.show(parsed, fields);
  if (!record) return;
  drawRecord(record, addAt);
  // Without an answer the list starts empty, so that impacts can be added by hand.
  list.set(answer?.impacts ?? {time_s: []}, [record.t[0], record.t.at(-1)]);
}

function edited() {
  for (const id of ["measure-again", "measure-reset"]) $(id).disabled = !list.edited;
  mark(record, list.rows, answer);
}

/** Adds the impact at a clicked spike of the acceleration, while adding is switched on. */
function addAt(t, reach) {
  if (!$("plot-measured-a").matches(".adding")) return;
  const at = spikeNear(record, t, reach);
  if (at !== null && list.add(record.t[at])) say(`added an impact at ${record.t[at].toFixed(4)} s`);
}

/** Sets the answer of the record; null: not identified yet. */
function setAnswer(next, fields) {
  answer = next;
  sent = fields;
  results.classList.toggle("known", answer !== null);
  compare();
}

/** Clears chosen columns that a new file does not have. */
function forgetColumns(names) {
  for (const [name, value] of Object.entries(ofColumns()))
    if (isColumn(name) && names.length && !names.includes(value)) form.replace(name, "");
}

/** Quotes the lines around one with an error. */
function quoteLine(detail = "") {
  const line = Number(/^line (\d+)/.exec(detail)?.[1]);
  const first = Math.max(line - 1, 1);
  const around = parsed?.text.split("\n", line + 1).slice(first - 1) ?? [];
  const lines = around.map((text, k) => {
    const n = first + k;
    const textContent = `${String(n).padStart(7)}  ${text.slice(0, 120).trimEnd()}\n`;
    return element("span", {className: n === line ? "at-fault" : "", textContent});
  });
  $("measure-lines").replaceChildren(...lines);
  $("measure-lines").hidden = !lines.length;
}

/** Reads a chosen file, draws it and, if its columns are known, identifies it. */
async function readFile(chosen) {
  if (!chosen) return;
  ++newest;
  job.cancel();
  const input = $("measure-file");
  if (input.files[0] !== chosen) input.value = ""; // allows choosing the same file again
  file = chosen;
  parsed = null;
  setAnswer(null, null);
  const megabytes = (chosen.size / 1e6).toFixed(chosen.size < 1e5 ? 3 : 1);
  $("measure-about").textContent = `${chosen.name}, ${megabytes} MB`;
  quoteLine();
  say("reading …");
  try {
    const read = await parse(chosen, (share) => {
      if (file === chosen) say(`reading … ${(100 * share).toFixed(0)} %`);
    });
    if (file !== chosen) return;
    parsed = read;
    const {names, columns} = parsed;
    $("measure-columns").replaceChildren(...names.map((value) => element("option", {value})));
    $("measure-about").textContent += `, ${columns[0]?.length ?? 0} samples`;
    forgetColumns(names);
    drawFile(form.values());
    if (record || !names.length) run();
    else say("choose which column is the time, and which the displacement or acceleration", true);
  } catch (error) {
    if (file !== chosen) return;
    file = null;
    drawFile();
    say(`${chosen.name} cannot be read: ${error.message}`, true);
  }
}

/** Sends the file unchanged or, if the address would be too long, everything as JSON. */
function request(fields, signal) {
  const text = asQuery(fields);
  return text.length <= longestQuery
    ? identify(text, file, signal)
    : identifyJson(asJson(parsed, fields), signal);
}

const job = new Job({
  ask: ({fields}, signal) => request(fields, signal),
  show(got, {fields}, milliseconds) {
    setAnswer(got, fields);
    summariseMeasurement(answer, milliseconds);
    nameFigures(preset());
    showFit(answer);
    remember();
    say("");
    drawFile(fields);
    if (record) draw(answer);
    countUp(results);
  },
  fail(error) {
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say(wholeMessage(error, left), true);
    quoteLine(error.message);
  },
  busy(is, cancelled) {
    $("measure-cancel").hidden = !is;
    compare(is);
    results.setAttribute("aria-busy", is);
    clearInterval(ticking);
    let seconds = 0;
    if (is) ticking = setInterval(() => tick(++seconds), 1000);
    if (cancelled) say("cancelled");
  },
  later: (text) => say(text, true),
});

function tick(seconds) {
  if ($("measure-message").matches(".fault")) return;
  const of = record ? ` ${record.t.length} samples` : "";
  say(`identifying${of} … ${seconds} s`);
}

function run(more = {}) {
  if (!file) {
    say("choose a file first", true);
    $("measure-file").focus();
    return;
  }
  if (!parsed) return; // identified after reading
  form.showErrors([]);
  quoteLine();
  say("identifying …");
  const {name, size, lastModified} = file;
  job.start({fields: {...form.values(), ...more}, file: [name, size, lastModified]});
}

const readRun = (run, name) => readFile(new File([recordOfRun(run)], name, {type: "text/csv"}));

/** Identifies the record of a simulated run {parameters, impacts, sticking, status}. */
export async function measure(run) {
  const {parameters} = run;
  choosePreset("", oscillatorOf(parameters));
  remember();
  await readRun(run, `run-b${parameters.b * 1000}mm.csv`);
}

/** Identifies a simulated record of one of the experiments. */
async function readSample(name) {
  const mine = ++newest;
  job.cancel();
  choosePreset(name, ofColumns());
  remember();
  say("simulating …");
  const {parameters} = presets[name];
  const fields = {...parameters, cycles: sampleCycles, include: ["impacts", "regime"]};
  try {
    const run = await simulate(fields);
    if (newest === mine) await readRun(run, `sample-${name}.csv`);
  } catch (error) {
    if (newest === mine) say(error.message, true);
  }
}

function download() {
  const text = JSON.stringify(answer, null, 1);
  const name = file.name.replace(/\.[^.]*$/, "");
  save(new Blob([text], {type: "application/json"}), `${name}-identified.json`);
}

function command() {
  const path = `v1/identify?${asQuery(sent ?? form.values())}`;
  return sendFileAsCurl(path, "text/csv", file?.name ?? "record.csv");
}

/** Files are chosen or dropped on the tab. */
function listenToFiles() {
  const input = $("measure-file");
  input.onchange = () => readFile(input.files[0]);
  const drag = (event) => {
    event.preventDefault();
    $("measure-drop").classList.toggle("over", event.type === "dragover");
    if (event.type === "drop") readFile(event.dataTransfer.files[0]);
  };
  for (const type of ["ondragover", "ondragleave", "ondrop"]) $("panel-measurement")[type] = drag;
}

/** identify_fields: of /v1/parameters; presets; changed(): called when the query changes. */
export function start({identify_fields: fields, presets: all}, changed) {
  remembered = changed;
  startViews(() => ({name: file?.name ?? "", answer}));
  form = new Form($("measure-fields"), fieldsOf(fields), {prefix: "measure-", grouped: groups});
  for (const [name, input] of form.inputs)
    if (isColumn(name)) input.setAttribute("list", "measure-columns");
  list = new ImpactList(edited);
  $("measure-preset").append(new Option("user-defined oscillator", ""));
  for (const {name, title, ...preset} of all) {
    if (!(name in samples)) continue;
    presets[name] = preset;
    $("measure-preset").append(new Option(`Table 4, ${title.replace("experiment, ", "")}`, name));
    const button = element("button", {
      type: "button",
      className: "small",
      textContent: samples[name],
      onclick: () => readSample(name),
    });
    $("measure-samples").append(" ", button);
  }
  listen();
  listenToFiles();
}

/**
 * Marks the results as stale if they do not belong to the form's fields, or are about to be
 * replaced.
 */
function compare(isBusy = false) {
  const {impact_times_s: _, ...fields} = sent ?? {};
  const isOld = sent !== null && asQuery(form.values()) !== asQuery(fields);
  results.classList.toggle("stale", isBusy || isOld);
}

function listen() {
  $("measure-preset").onchange = () => {
    choosePreset(preset(), ofColumns());
    remember();
  };
  $("measure-fields").onchange = () => {
    remember();
    if (parsed && !answer) drawFile(form.values());
  };
  picker.start((field, name) => {
    form.replace(field, name);
    remember();
    if (!parsed) return;
    setAnswer(null, null);
    drawFile(form.values());
    if (record) run();
  });
  $("measure-form").onsubmit = (event) => {
    event.preventDefault();
    run();
    if (file) scrollToResults("measure");
  };
  $("measure-cancel").onclick = () => job.cancel();
  $("measure-again").onclick = () => run({impact_times_s: list.times()});
  $("measure-reset").onclick = () => list.reset();
  $("measure-add-at").onclick = ({currentTarget: button}) =>
    button.setAttribute("aria-pressed", $("plot-measured-a").classList.toggle("adding"));
  $("measure-download").onclick = download;
  $("measure-copy").onclick = () => copy(command(), say);
}

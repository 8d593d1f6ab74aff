// The tab of a measurement: a file and its fields in, one request, what was identified out; the
// list of impacts can be edited and sent again.
import {
  identify,
  identifyJson,
  Problem,
  sendFileAsCurl,
  simulate,
  wholeMessage,
} from "../shared/api.js";
import {$, countUp, element, sayIn} from "../shared/dom.js";
import {Form} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {copy, save} from "../shared/take_away.js";
import {showFit} from "./fit.js";
import {ImpactList} from "./impact_list.js";
import {summariseMeasurement} from "./measurement_summary.js";
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
/** The experiments of Table 4, and a simulated record of each by its name. */
const samples = {fig15: "b = 9 mm, periodic", fig20: "b = 15 mm, chaotic"};
const longestQuery = 6000; // servers and proxies take 8 kB of address
const sampleCycles = 330; // some 40 s
const presets = {}; // of the experiments, by name

let form;
let list;
let file = null;
let parsed = null; // what was read of it
let record = null; // what the fields make of that
let answer = null;
let sent = null; // the fields that it answers
let turn = 0; // counts the records that were asked for: the newest one counts
let ticking = 0;
let shown = null;
let remembered = () => {};

const results = $("measure-results");

const say = sayIn("measure-message");

/**
 * The service's fields as this form shows them: names of columns are typed in or taken from the
 * file's header; the forcing's amplitude is fitted.
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

/** The oscillator that is chosen; what is estimated is left: the presets have it of a simulation. */
function base() {
  const {R, F, cycles, ...oscillator} = presets[preset()]?.parameters ?? {};
  return oscillator;
}

/** Fields as a query, a list as its values with commas, which stay readable. */
const asQuery = (fields) => String(new URLSearchParams(fields)).replaceAll("%2C", ",");

export const query = () => shown;

const pick = (fields, isWanted) => Object.fromEntries(Object.entries(fields).filter(isWanted));

/** The form as a query for a link; the file stays with who has it. */
function remember() {
  const given = base();
  const differing = pick(form.values(), ([name, value]) => value !== given[name]);
  shown = asQuery({...(preset() && {preset: preset()}), ...differing});
  remembered();
  compare();
}

/** Another oscillator; more: other fields. */
function choosePreset(name, more) {
  $("measure-preset").value = Object.hasOwn(presets, name) ? name : "";
  form.set({...base(), ...more});
}
/** What the form says of the columns, which stays with another oscillator. */
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

// What is drawn.

/** What the fields make of the file's columns, and what is known of it. */
function drawFile(fields) {
  record = parsed && recordOf(parsed, fields);
  for (const id of ["measure-parts", "measure-list", "measure-add-at"]) $(id).hidden = !record;
  if (parsed) picker.show(parsed, fields);
  if (!record) return;
  drawRecord(record, addAt);
  // A record whose impacts cannot be found has them given by hand.
  list.set(answer?.impacts ?? {time_s: []}, [record.t[0], record.t.at(-1)]);
}

function edited() {
  for (const id of ["measure-again", "measure-reset"]) $(id).disabled = !list.edited;
  mark(record, list.rows, answer);
}

/**
 * A click on the acceleration adds the impact whose spike is there, if that is what it is for now.
 */
function addAt(t, reach) {
  if (!$("plot-measured-a").matches(".adding")) return;
  const at = spikeNear(record, t, reach);
  if (at !== null && list.add(record.t[at])) say(`added an impact at ${record.t[at].toFixed(4)} s`);
}

/** What is known of the record; null: nothing yet. */
function setAnswer(next, fields) {
  answer = next;
  sent = fields;
  results.classList.toggle("known", answer !== null);
  compare();
}

/** A column that was chosen is that of another file, where this one has no such. */
function forgetColumns(names) {
  for (const [name, value] of Object.entries(ofColumns()))
    if (isColumn(name) && names.length && !names.includes(value)) form.replace(name, "");
}

/** The lines around one that is at fault. */
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

// What is done.

/** A file is there: it is drawn, and, if it can be, identified. */
async function take(chosen) {
  if (!chosen) return;
  ++turn;
  job.cancel();
  const input = $("measure-file");
  if (input.files[0] !== chosen) input.value = ""; // so that the same file can be chosen again
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

/** What is sent: the file as it is, or, where the address would be too long, all as JSON. */
function request(fields, signal) {
  const asked = asQuery(fields);
  return asked.length <= longestQuery
    ? identify(asked, file, signal)
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

/** How long it takes already. */
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
  if (!parsed) return; // what is being read is identified then
  form.showErrors([]);
  quoteLine();
  say("identifying …");
  const {name, size, lastModified} = file;
  job.start({fields: {...form.values(), ...more}, file: [name, size, lastModified]});
}

const takeRun = (run, name) => take(new File([recordOfRun(run)], name, {type: "text/csv"}));

/** A record of a run that was simulated: {parameters, impacts, sticking, status}. */
export async function measure(run) {
  const {parameters} = run;
  choosePreset("", oscillatorOf(parameters));
  remember();
  await takeRun(run, `run-b${parameters.b * 1000}mm.csv`);
}

/** The same of one of the experiments. */
async function takeSample(name) {
  const mine = ++turn;
  job.cancel();
  choosePreset(name, ofColumns());
  remember();
  say("simulating …");
  const {parameters} = presets[name];
  const fields = {...parameters, cycles: sampleCycles, include: ["impacts", "regime"]};
  try {
    const run = await simulate(fields);
    if (turn === mine) await takeRun(run, `sample-${name}.csv`);
  } catch (error) {
    if (turn === mine) say(error.message, true);
  }
}

/** Where the plots lie below the form, one who asks for them is led there. */
function lead() {
  const panel = $("measure-form");
  if (file && results.offsetLeft < panel.offsetLeft + panel.offsetWidth) results.scrollIntoView();
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

/** A file is chosen, or dropped anywhere. */
function listenToFiles() {
  const input = $("measure-file");
  input.onchange = () => take(input.files[0]);
  const drag = (event) => {
    event.preventDefault();
    $("measure-drop").classList.toggle("over", event.type === "dragover");
    if (event.type === "drop") take(event.dataTransfer.files[0]);
  };
  for (const type of ["ondragover", "ondragleave", "ondrop"]) $("panel-measurement")[type] = drag;
}

/** tables: of /v1/parameters, and presets; changed: called when there is another query. */
export function start({identify_fields: fields, presets: all}, changed) {
  remembered = changed;
  startViews(() => ({name: file?.name ?? "", answer}));
  form = new Form($("measure-fields"), fieldsOf(fields), {prefix: "measure-", grouped: groups});
  for (const [name, input] of form.inputs)
    if (isColumn(name)) input.setAttribute("list", "measure-columns");
  list = new ImpactList(edited);
  $("measure-preset").append(new Option("own oscillator", ""));
  for (const {name, title, ...preset} of all) {
    if (!(name in samples)) continue;
    presets[name] = preset;
    $("measure-preset").append(new Option(`Table 4, ${title.replace("experiment, ", "")}`, name));
    const button = element("button", {
      type: "button",
      className: "small",
      textContent: samples[name],
      onclick: () => takeSample(name),
    });
    $("measure-samples").append(" ", button);
  }
  listen();
  listenToFiles();
}

/** Whether what is shown is of other fields than the form's, or will be soon. */
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
    lead();
  };
  $("measure-cancel").onclick = () => job.cancel();
  $("measure-again").onclick = () => run({impact_times_s: list.times()});
  $("measure-reset").onclick = () => list.reset();
  $("measure-add-at").onclick = ({currentTarget: button}) =>
    button.setAttribute("aria-pressed", $("plot-measured-a").classList.toggle("adding"));
  $("measure-download").onclick = download;
  $("measure-copy").onclick = () => copy(command(), say);
}

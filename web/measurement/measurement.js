// The tab of a measurement: a file and its fields in, one request, what was identified out; the
// list of impacts can be edited and sent again.
import {
  identify,
  identifyJson,
  Problem,
  recordAsCurl,
  simulate,
  wholeMessage,
} from "../shared/api.js";
import {$, countUp, element} from "../shared/dom.js";
import {Form} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {Motion} from "../shared/motion.js";
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
import {parse, recordOf, spikeNear, textOf} from "./record.js";
import {oscillatorOf, recordOfRun} from "./sample.js";

const groups = {
  system: ["System", true],
  SI: ["Oscillator", true],
  record: ["Columns and units", false],
};
const experiments = ["fig15", "fig20"]; // those of Table 4
const sampleNames = {fig15: "b = 9 mm, periodic", fig20: "b = 15 mm, chaotic"};
const estimated = new Set(["R", "F", "cycles"]); // the presets' values are of the simulation
const longestQuery = 6000; // servers and proxies take 8 kB of address
const sampleCycles = 330; // some 40 s

let form;
let list;
let presets = [];
let file = null;
let text = "";
let reading = Promise.resolve(null);
let record = null;
let answer = null;
let sent = null;
let began = 0;
let turn = 0; // counts the records that were asked for: the newest one counts
let ticking = 0;
let shown = null;
let remembered = () => {};

function say(message, fault = false) {
  $("measure-message").textContent = message;
  $("measure-message").classList.toggle("fault", fault);
}

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
const isColumn = (f) => f.type === "choice" && !f.choices && f.name !== "preset";
const fieldsOf = (fields) =>
  fields
    .filter((f) => !["impact_times_s", "F"].includes(f.name))
    .map((f) => ({...f, ...(isColumn(f) ? {type: "text"} : {}), ...changes[f.name]}));

const preset = () => presets.find((p) => p.name === $("measure-preset").value);
function base() {
  const parameters = Object.entries(preset()?.parameters ?? {});
  return Object.fromEntries(parameters.filter(([name]) => !estimated.has(name)));
}

/** Fields as a query, a list as its values with commas, which stay readable. */
const asQuery = (fields) => String(new URLSearchParams(fields)).replaceAll("%2C", ",");

export const query = () => shown;

/** The form as a query for a link; the file stays with who has it. */
function remember() {
  const given = base();
  const values = form.values();
  const start = preset() ? {preset: preset().name} : {};
  const differing = Object.entries(values).filter(([name, value]) => value !== given[name]);
  shown = asQuery({...start, ...Object.fromEntries(differing)});
  remembered();
}

/** Another oscillator; which column of the record is which stays. */
function choosePreset(name) {
  $("measure-preset").value = experiments.includes(name) ? name : "";
  const ofRecord = new Set(form.fields.filter((f) => f.group === "record").map((f) => f.name));
  const kept = Object.entries(form.values()).filter(([field]) => ofRecord.has(field));
  form.set({...base(), ...Object.fromEntries(kept)});
}

export async function open(given) {
  if (String(given) === shown || asQuery(Object.fromEntries(given)) === shown) return;
  const {preset: name = given.size ? "" : "fig20", ...rest} = Object.fromEntries(given);
  choosePreset(name);
  form.set({...base(), ...rest});
  remember();
}

export {redraw};

// What is drawn.

function drawFile() {
  for (const id of ["measure-parts", "measure-list", "measure-add-at"]) $(id).hidden = !record;
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
  if ($("measure-add-at").getAttribute("aria-pressed") !== "true") return;
  const at = spikeNear(record, t, reach);
  if (at !== null && list.add(record.t[at])) say(`added an impact at ${record.t[at].toFixed(4)} s`);
}

function present(milliseconds) {
  for (const node of document.querySelectorAll(".identified")) node.hidden = false;
  summariseMeasurement(answer, milliseconds);
  nameFigures(preset()?.name);
  showFit(answer);
  if (!record) return;
  drawFile();
  draw(record, answer);
}

/** The lines around one that is at fault. */
function quoteLine(detail) {
  const line = Number(/^line (\d+)/.exec(detail)?.[1]);
  const lines = [];
  for (let n = 1, from = 0; n <= line + 1 && from <= text.length; ++n) {
    const at = text.indexOf("\n", from);
    const to = at < 0 ? text.length : at;
    if (n >= line - 1) {
      const beginning = text.slice(from, Math.min(to, from + 120)).trimEnd();
      const textContent = `${String(n).padStart(7)}  ${beginning}\n`;
      lines.push(element("span", {className: n === line ? "at-fault" : "", textContent}));
    }
    from = to + 1;
  }
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
  text = "";
  answer = record = sent = null;
  for (const node of document.querySelectorAll(".identified")) node.hidden = true;
  const megabytes = (chosen.size / 1e6).toFixed(chosen.size < 1e5 ? 3 : 1);
  $("measure-about").textContent = `${chosen.name}, ${megabytes} MB`;
  quoteLine("");
  say("reading …");
  reading = read(chosen);
  try {
    const parsed = await reading;
    if (file !== chosen) return;
    $("measure-columns").replaceChildren(
      ...parsed.names.map((value) => element("option", {value})),
    );
    $("measure-about").textContent += `, ${parsed.columns[0]?.length ?? 0} samples`;
    showColumns(parsed);
    if (record || !parsed.names.length) run();
    else say("choose which column is the time, and which the displacement or acceleration", true);
  } catch (error) {
    if (file !== chosen) return;
    file = null;
    drawFile();
    say(`${chosen.name} cannot be read: ${error.message}`, true);
  }
}

async function read(chosen) {
  const all = await textOf(chosen);
  if (file === chosen) text = all;
  return parse(all, (share) => {
    if (file === chosen) say(`reading … ${(100 * share).toFixed(0)} %`);
  });
}

/** What the fields make of the file's columns, before anything is known of it. */
function showColumns(parsed) {
  picker.show(parsed, form.values());
  record = recordOf(parsed, form.values());
  drawFile();
}

/** What is sent: the file as it is, or, where the address would be too long, all as JSON. */
async function request(fields, signal) {
  const asked = asQuery(fields);
  if (asked.length <= longestQuery) return identify(asked, file, signal);
  const {sent, units} = recordOf(await reading, fields);
  const lists = Object.fromEntries(
    Object.entries(sent).map(([name, column]) => [name, [...column]]),
  );
  return identifyJson({...fields, ...units, record: lists}, signal);
}

const job = new Job({
  ask: async ({fields}, signal) => {
    const got = await request(fields, signal);
    return {got, parsed: await reading};
  },
  show({got, parsed}, {fields}, milliseconds) {
    [answer, sent, record] = [got, fields, recordOf(parsed, fields)];
    picker.show(parsed, fields);
    remember();
    say("");
    present(milliseconds);
    countUp($("measure-results"));
  },
  fail(error) {
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say(wholeMessage(error, left), true);
    quoteLine(error.message);
  },
  busy(is, cancelled) {
    $("measure-cancel").hidden = !is;
    if (is) $("measure-results").classList.add("stale");
    else compare();
    $("measure-results").setAttribute("aria-busy", String(is));
    clearInterval(ticking);
    if (is) ticking = setInterval(tick, 1000);
    if (cancelled) say("cancelled");
  },
  later: (text) => say(text, true),
});

/** How long it takes already. */
function tick() {
  if ($("measure-message").classList.contains("fault")) return;
  const samples = record?.t.length;
  const of = samples ? ` ${samples} samples` : "";
  say(`identifying${of} … ${((performance.now() - began) / 1000).toFixed(0)} s`);
}

function run(more = {}) {
  if (!file) {
    say("choose a file first", true);
    $("measure-file").focus();
    return;
  }
  form.showErrors([]);
  quoteLine("");
  say("identifying …");
  began = performance.now();
  const {name, size, lastModified} = file;
  job.start({fields: {...form.values(), ...more}, file: [name, size, lastModified]});
}

/** A record of a run that was simulated: {parameters, impacts, sticking, status}. */
export async function measure(run) {
  const {parameters} = run;
  $("measure-preset").value = "";
  form.set(oscillatorOf(parameters));
  remember();
  const text = recordOfRun(run, new Motion(run));
  await take(new File([text], `run-b${parameters.b * 1000}mm.csv`, {type: "text/csv"}));
}

/** The same of one of the experiments. */
async function takeSample(name) {
  const mine = ++turn;
  job.cancel();
  choosePreset(name);
  remember();
  say("simulating …");
  const parameters = presets.find((p) => p.name === name).parameters;
  const fields = {...parameters, cycles: sampleCycles, include: ["impacts", "regime"]};
  try {
    const run = await simulate(fields);
    if (turn !== mine) return;
    const text = recordOfRun(run, new Motion(run));
    await take(new File([text], `sample-${name}.csv`, {type: "text/csv"}));
  } catch (error) {
    if (turn === mine) say(error.message, true);
  }
}

/** Where the plots lie below the form, one who asks for them is led there. */
function lead() {
  const panel = $("measure-form");
  const results = $("measure-results");
  if (file && results.offsetLeft < panel.offsetLeft + panel.offsetWidth) results.scrollIntoView();
}

function download() {
  const text = JSON.stringify(answer, null, 1);
  const name = file.name.replace(/\.[^.]*$/, "");
  save(new Blob([text], {type: "application/json"}), `${name}-identified.json`);
}

const command = () => recordAsCurl(asQuery(sent ?? form.values()), file?.name ?? "record.csv");

function listenToFiles() {
  const panel = $("panel-measurement");
  const over = (is) => $("measure-drop").classList.toggle("over", is);
  $("measure-file").addEventListener("change", () => take($("measure-file").files[0]));
  panel.addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  panel.addEventListener("dragleave", (event) => {
    if (!panel.contains(event.relatedTarget)) over(false);
  });
  panel.addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    take(event.dataTransfer.files[0]);
  });
}

/** tables: of /v1/parameters, and presets; changed: called when there is another query. */
export function start({identify_fields: fields, presets: all}, changed) {
  remembered = changed;
  startViews(() => ({name: file?.name ?? "", answer}));
  presets = all.filter((p) => experiments.includes(p.name));
  form = new Form($("measure-fields"), fieldsOf(fields), {prefix: "measure-", grouped: groups});
  for (const name of fields.map((f) => f.name).filter((n) => n.endsWith("_column")))
    form.inputs.get(name).setAttribute("list", "measure-columns");
  list = new ImpactList(
    {
      body: $("measure-impacts"),
      note: $("measure-list-note"),
      adding: $("measure-add"),
      doubtful: $("measure-doubtful"),
    },
    edited,
  );
  $("measure-preset").append(
    new Option("own oscillator", ""),
    ...presets.map((p) => new Option(`Table 4, ${p.title.replace("experiment, ", "")}`, p.name)),
  );
  listen();
  listenToFiles();
}

/** What is shown is of other fields than the form's. */
function compare() {
  const {impact_times_s: _, ...fields} = sent ?? {};
  const isOld = sent !== null && asQuery(form.values()) !== asQuery(fields);
  $("measure-results").classList.toggle("stale", isOld);
}

function listen() {
  $("measure-preset").addEventListener("change", () => {
    choosePreset($("measure-preset").value);
    remember();
    compare();
  });
  $("measure-fields").addEventListener("change", async () => {
    remember();
    compare();
    const parsed = await reading.catch(() => null);
    if (parsed && !answer) showColumns(parsed);
  });
  picker.start(async (field, name) => {
    form.replace(field, name);
    remember();
    const parsed = await reading.catch(() => null);
    if (!parsed) return;
    answer = sent = null;
    showColumns(parsed);
    if (record) run();
  });
  for (const preset of presets) {
    const button = element("button", {type: "button", className: "small"});
    button.textContent = sampleNames[preset.name];
    button.addEventListener("click", () => takeSample(preset.name));
    $("measure-samples").append(" ", button);
  }
  $("measure-form").addEventListener("submit", (event) => {
    event.preventDefault();
    run();
    lead();
  });
  $("measure-cancel").addEventListener("click", () => job.cancel());
  $("measure-again").addEventListener("click", () => {
    run({impact_times_s: list.times().map((t) => Number(t.toFixed(7)))});
  });
  $("measure-reset").addEventListener("click", () => list.reset());
  $("measure-add-at").addEventListener("click", ({currentTarget: button}) => {
    const on = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(on));
    $("plot-measured-a").classList.toggle("adding", on);
  });
  $("measure-download").addEventListener("click", download);
  $("measure-copy").addEventListener("click", () => copy(command(), say));
}

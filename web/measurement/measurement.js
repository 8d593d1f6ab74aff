// The measurement tab: identifies a file; the list of its impacts can be edited and sent again.
import {asCurl, identify, identifyJson, simulate} from "../shared/api.js";
import * as dom from "../shared/dom.js";
import {$} from "../shared/dom.js";
import {Form} from "../shared/form.js";
import {RequestTab} from "../shared/job.js";
import {joined, shortTo} from "../shared/numbers.js";
import {ImpactList} from "./impact_list.js";
import {summariseMeasurement} from "./measurement_summary.js";
import * as views from "./measurement_views.js";
import * as records from "./record.js";

const groups = {
  system: ["System", true],
  SI: ["Oscillator", true],
  record: ["Columns and units", false],
};
const longestQuery = 6000; // characters; servers and proxies accept addresses of about 8 kB
const sampleCycles = 330; // about 40 s
const firstSample = "fig20"; // read when the tab is opened without a record

/** Changes to the service's fields. The fitted amplitude of the forcing has no field. */
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

/** Fields as a query; commas stay readable. */
const asQuery = (fields) => String(new URLSearchParams(fields)).replaceAll("%2C", ",");

const pick = (fields, isWanted) => Object.fromEntries(Object.entries(fields).filter(isWanted));

/** The record of a simulated run as a file. */
const fileOf = (run, name) => new File([records.recordOfRun(run)], name, {type: "text/csv"});

const presetMenu = $("measure-preset");

export class MeasurementTab extends RequestTab {
  records = 0; // counts the records requested; only the newest is shown
  file = null;
  parsed = null; // content of the file
  record = null; // parsed columns as selected by the form
  answer = null;
  sent = null; // fields that the answer belongs to

  constructor({identify_fields: fields, presets}, changed) {
    super("measure-", changed);
    views.start(() => ({name: this.file?.name ?? "", answer: this.answer}));
    const own = {prefix: "measure-", grouped: groups};
    this.form = new Form($("measure-fields"), fieldsOf(fields), own);
    for (const {name, input} of this.form.fields)
      if (isColumn(name)) input.setAttribute("list", "measure-columns");
    this.list = new ImpactList(() => {
      for (const id of ["measure-again", "measure-reset"]) $(id).disabled = !this.list.edited;
      views.drawRecord(this.record, this.list.rows, this.answer, (...at) => this.addAt(...at));
    });
    this.presets = Object.fromEntries(presets.map(({name, ...preset}) => [name, preset]));
    this.listen();
  }

  listen() {
    dom.onFile($("panel-measurement"), $("measure-drop"), (file) => file && this.read(() => file));
    presetMenu.onchange = () => this.choosePreset(presetMenu.value, this.ofColumns());
    $("measure-fields").onchange = ({target}) => {
      this.remember();
      if (this.parsed && target.list) this.useColumns();
      else if (this.parsed && !this.answer && $("measure-group-record").contains(target))
        this.drawFile(this.form.values());
    };
    $("measure-samples").onclick = ({target: {value}}) =>
      value && this.read(() => this.sample(value));
    $("measure-again").onclick = () => this.run({impact_times_s: this.list.times()});
    $("measure-reset").onclick = () => this.list.reset();
    $("measure-add-at").onclick = ({currentTarget}) => {
      currentTarget.ariaPressed = $("plot-measured-a").classList.toggle("adding");
    };
    $("measure-download").onclick = () => {
      const text = JSON.stringify(this.answer, null, 1);
      const name = this.file.name.replace(/\.[^.]*$/, "");
      dom.save(new Blob([text], {type: "application/json"}), `${name}-identified.json`);
    };
    $("measure-copy").onclick = () => {
      const path = `v1/identify?${asQuery(this.sent ?? this.form.values())}`;
      dom.copy(asCurl({path, type: "text/csv", file: this.file?.name ?? "record.csv"}), this.say);
    };
  }

  open(given) {
    const fields = Object.fromEntries(given);
    if (asQuery(fields) === this.asked) return;
    const isFirst = this.asked === null;
    const {preset = given.size ? "" : firstSample, ...rest} = fields;
    this.choosePreset(preset, rest);
    if (isFirst) this.read(() => this.first(given.size === 0));
  }

  /** The record of before a reload or, if wanted, a sample. */
  async first(sample) {
    return (await records.afterReload()) ?? (sample ? this.sample(firstSample) : null);
  }

  /** Selects an oscillator; more: further fields. */
  choosePreset(name, more) {
    dom.choose(presetMenu, name);
    this.form.set({...this.base(), ...more});
    this.remember();
  }

  /** Fields of the chosen oscillator, without those that are estimated. */
  base() {
    const {R, F, cycles, ...oscillator} = this.presets[presetMenu.value]?.parameters ?? {};
    return oscillator;
  }

  /** Column fields of the form, which are kept when the oscillator changes. */
  ofColumns() {
    return pick(this.form.values(), ([name]) => this.form.named.get(name).group === "record");
  }

  /** Updates the address with the form. The file itself is not part of a link. */
  remember() {
    const given = this.base();
    const differing = pick(this.form.values(), ([name, value]) => value !== given[name]);
    const {value: preset} = presetMenu;
    this.asked = asQuery({...(preset && {preset}), ...differing});
    this.changed();
    this.markStale();
  }

  isStale(busy) {
    const {impact_times_s: _, ...fields} = this.sent ?? {};
    return busy || (this.sent !== null && asQuery(this.form.values()) !== asQuery(fields));
  }

  submit() {
    this.run();
    if (this.file) this.scrollToResults();
  }

  run(more = {}) {
    if (!this.file) {
      $("measure-file").focus();
      return this.say("choose a file first", true);
    }
    if (!this.parsed) return; // identified after reading
    this.form.showErrors([]);
    this.say("identifying …");
    const {name, size, lastModified} = this.file;
    this.start({fields: {...this.form.values(), ...more}, file: [name, size, lastModified]});
  }

  /** Sends the file unchanged or, if the address would be too long, everything as JSON. */
  ask({fields}, signal) {
    const text = asQuery(fields);
    return text.length <= longestQuery
      ? identify(text, this.file, signal)
      : identifyJson(records.asJson(this.parsed, fields), signal);
  }

  show(answer, {fields}, milliseconds) {
    this.setAnswer(answer, fields);
    summariseMeasurement(answer, milliseconds);
    views.nameFigures(presetMenu.value);
    this.remember();
    this.say("");
    this.drawFile(fields);
    if (this.record) views.draw(answer);
    dom.countUp(this.results);
  }

  busy(is, cancelled) {
    super.busy(is, cancelled);
    clearInterval(this.ticking);
    let seconds = 0;
    const tick = () => {
      ++seconds;
      const count = this.record ? ` ${this.record.t.length} samples` : "";
      if (!$("measure-message").matches(".fault")) this.say(`identifying${count} … ${seconds} s`);
    };
    if (is) this.ticking = setInterval(tick, 1000);
  }

  /** Sets the answer of the record; null: not identified yet. */
  setAnswer(answer, fields) {
    Object.assign(this, {answer, sent: fields});
    this.results.classList.toggle("known", answer !== null);
    this.markStale();
  }

  /** Shows the columns selected by the fields, with the impacts known; the list draws them. */
  drawFile(fields) {
    const {parsed} = this;
    this.record = parsed && records.recordOf(parsed, fields);
    const known = this.record !== null;
    dom.reveal({"measure-parts": known, "measure-list": known, "measure-add-at": known});
    if (!known) return;
    const {t} = this.record;
    // Without an answer the list starts empty, so that impacts can be added by hand.
    this.list.set(this.answer?.impacts ?? {time_s: []}, [t[0], t.at(-1)]);
  }

  /** Adds the impact at a clicked spike of the acceleration, while adding is switched on. */
  addAt(time, reach) {
    if (!$("plot-measured-a").matches(".adding")) return;
    const {t} = this.record;
    const i = records.spikeNear(this.record, time, reach);
    if (i !== null && this.list.add(t[i])) this.say(`added an impact at ${t[i].toFixed(4)} s`);
  }

  /** Gives up the previous record for the file to which source() resolves, if any. */
  async read(source) {
    this.cancel();
    if (!this.parsed) this.file = null;
    const mine = ++this.records;
    const isNewest = () => this.records === mine;
    try {
      const file = await source();
      if (file && isNewest()) await this.readFile(file, isNewest);
    } catch ({message}) {
      if (!isNewest()) return;
      const unread = !this.parsed && this.file;
      this.say(joined([unread && `${unread.name} cannot be read`, message], ": "), true);
      if (!unread) return;
      this.file = null;
      this.drawFile();
    }
  }

  /** Reads a file, draws it and, if its columns are known, identifies it. */
  async readFile(file, isNewest) {
    const input = $("measure-file");
    if (input.files[0] !== file) input.value = ""; // allows choosing the same file again
    Object.assign(this, {file, parsed: null});
    this.setAnswer(null, null);
    const about = `${file.name}, ${(file.size / 1e6).toFixed(file.size < 1e5 ? 3 : 1)} MB`;
    dom.setTexts({"measure-about": about});
    this.say("reading …");
    const parsed = await records.parse(file, (share) => {
      if (isNewest()) this.say(`reading … ${(100 * share).toFixed(0)} %`);
    });
    if (!isNewest()) return;
    this.parsed = parsed;
    records.keep(file);
    const {names, columns} = parsed;
    $("measure-columns").replaceChildren(...names.map((value) => dom.element("option", {value})));
    dom.setTexts({"measure-about": `${about}, ${columns[0]?.length ?? 0} samples`});
    // Clears chosen columns that the file does not have.
    for (const [name, value] of Object.entries(this.ofColumns()))
      if (isColumn(name) && names.length && !names.includes(value)) this.form.replace(name, "");
    this.useColumns();
  }

  /** Draws the record and, if its columns are known, identifies it. */
  useColumns() {
    this.setAnswer(null, null);
    this.drawFile(this.form.values());
    if (this.record || !this.parsed.names.length) return this.run();
    this.form.parts.get("record").open = true;
    this.say("choose which column is the time, and which the displacement or acceleration", true);
  }

  /** Identifies the record of a simulated run {parameters, impacts, sticking, status}. */
  measure(run) {
    const {parameters} = run;
    this.choosePreset("", records.oscillatorOf(parameters));
    return this.read(() => fileOf(run, `run-b${shortTo(5, parameters.b * 1000)}mm.csv`));
  }

  /** A simulated record of one of the experiments, whose oscillator it selects. */
  async sample(name) {
    this.choosePreset(name, this.ofColumns());
    this.say("simulating …");
    const {parameters} = this.presets[name];
    const fields = {...parameters, cycles: sampleCycles, include: ["impacts", "regime"]};
    return fileOf(await simulate(fields), `sample-${name}.csv`);
  }

  redraw = views.redraw;
}

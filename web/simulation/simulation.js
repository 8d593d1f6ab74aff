// The simulation tab: each change is sent at once. The address holds request and visible range.
import {simulate} from "../shared/api.js";
import * as dom from "../shared/dom.js";
import {$} from "../shared/dom.js";
import {Form, unknownText} from "../shared/form.js";
import {Job, RequestTab} from "../shared/job.js";
import {isSampled, motionOf} from "../shared/motion.js";
import {joined, roundedRange} from "../shared/numbers.js";
import {unitsOf} from "../shared/units.js";
import * as details from "./details.js";
import * as machine from "./machine.js";
import * as mainPlots from "./main_plots.js";
import * as pin from "./pin.js";
import * as player from "./player.js";
import * as presetMenu from "./request.js";
import {formsOf, Request, toQuery} from "./request.js";
import {run, setRun, viewport} from "./run.js";
import * as sliders from "./sliders.js";
import {Strip} from "./strip.js";
import {describe, showSentence} from "./words.js";

// Parts requested for every slider movement, and parts requested once it rests.
const firstParts = {include: ["impacts", "exponents", "regime", "energy"], exponents: ["qr"]};
const sampledParts = {...firstParts, include: [...firstParts.include, "series"]};
const deferredParts = {
  include: ["exponents", "eigenvalues", "manifold"],
  exponents: ["raw_product"],
};

const mostSamples = 60000; // of a run that is drawn from samples
const idle = 100; // ms without an edit before the deferred parts are requested

/** The range first in view: the last cycles of a periodic motion, or else the window. */
function homeOf({parameters, status, regime}) {
  const end = status.tau;
  if (regime.periodic && regime.contacts) {
    const cycles = Math.max(6, 2 * regime.period_cycles);
    return [Math.max(end - (2 * Math.PI * cycles) / parameters.Omega, 0), end];
  }
  const to = parameters.window?.[1];
  return to && to < 0.9 * end ? [0, to] : [0, end];
}

/** Shows the remarks: the reason for an undecided verdict, and warnings. */
function remark({exponents: {verdict, verdict_reason: why}, regime, warnings}, more = {}) {
  const open = verdict === "not_decided" && !regime.periodic;
  const all = [open && `not decided: ${why}`, ...warnings, ...(more.warnings ?? [])];
  dom.showRemarks("remarks", [...new Set(all.filter(Boolean))]);
}

// Parts of the same run with a ball too light to matter: without the absorber.
const lightParts = {m2: undefined, mass_ratio: 1e-7, include: ["impacts", "series"]};

export class SimulationTab extends RequestTab {
  mistyped = false; // true while a slider's number differs from the request
  wantedView = null; // of the next run, from the address
  lastMoved = "b"; // name of the slider moved last

  deferred = new Job({
    ask: ({fields, parts}, signal) =>
      Promise.all([
        simulate({...fields, ...parts}, signal),
        run.motion.exact === false &&
          simulate({max_points: mostSamples, ...fields, ...lightParts}, signal),
      ]),
    show: ([answer, without], {fields}) => {
      if (fields !== run.fields) return;
      run.deferred = answer;
      if (without) run.motion.without = motionOf(without, run.load);
      machine.redraw();
      remark(run.answer, answer);
      mainPlots.showDeferred();
      details.show();
      dom.countUp(this.results);
    },
    busy: details.busy,
    fail: ({message}) =>
      this.say(`T, the raw product and the manifold are missing: ${message}`, true),
  });

  constructor({fields, presets}, changed, {measure}) {
    super("", changed);
    this.form = new Form($("fields"), fields);
    this.request = new Request(this.form, fields, presets);
    mainPlots.start();
    sliders.start(this);
    details.start(this.request.fieldOf, () => this.requestMore(run.fields));
    const choose = (name) => {
      this.request.choose(name);
      this.send({fresh: true});
    };
    const read = (query) => {
      this.request.read(query);
      this.send();
    };
    presetMenu.start(presets, choose, read);
    pin.start(changed, read);
    this.listen(measure);
    machine.start((fields, dragging) => this.set(fields, dragging));
    this.strip = new Strip();
    startPlots();
  }

  listen(measure) {
    $("fields").oninput = () => this.note();
    $("fields").onchange = () => this.send();
    viewport.onZoom(() => {
      dom.reveal({whole: viewport.zoomed});
      this.changed({soon: true});
    });
    $("whole").onclick = () => viewport.reset();
    $("more").ontoggle = () => {
      if (run) this.showOrigins();
      if ($("more").open) $("more").scrollIntoView({block: "nearest"});
    };
    $("sheet").onclick = () => {
      const ariaExpanded = $("form").classList.toggle("open");
      Object.assign($("sheet"), {ariaExpanded, textContent: `All ${ariaExpanded ? "▾" : "▴"}`});
    };
    dom.onFile($("panel-simulation"), $("load"), (file) => this.readLoad(file));
    $("measure-this").onclick = () => run && measure(run.answer);
    const texts = formsOf("v1/simulate", () => this.request.fields());
    $("copies").onchange = ({target}) => {
      dom.copy(texts[target.value](), this.say);
      target.value = "";
    };
  }

  ask(fields, signal) {
    const parts = isSampled(this.request.merged(fields)) ? sampledParts : firstParts;
    return simulate({max_points: mostSamples, ...fields, ...parts}, signal);
  }

  isStale(busy) {
    return busy || this.mistyped || !run || toQuery(run.fields) !== this.asked;
  }

  mark(mistyped) {
    this.mistyped = mistyped;
    this.markStale();
  }

  markStale(busy) {
    super.markStale(busy);
    dom.reveal({again: !busy && this.isStale(false)});
  }

  busy(is, cancelled) {
    super.busy(is, cancelled);
    if (is && !$("message").classList.contains("fault")) this.say("computing …");
    else if (cancelled && run) this.say("cancelled: the previous run is shown");
  }

  /** Errors are shown at sliders, or else at fields, without moving the focus. */
  fail({message, errors = []}, fields) {
    if (fields.linked && errors.length) {
      const faults = [...fields.unknown, ...errors.map(({detail}) => detail)].join("; ");
      return this.open(new URLSearchParams(), `the address has faults, Fig. 3 is shown: ${faults}`);
    }
    if (!run) dom.setTexts({sentence: "No results yet."});
    const left = this.form.showErrors(errors, false);
    const ofSliders = sliders.showErrors(errors);
    if (left.length + ofSliders.length < errors.length) $("more").open = true;
    this.sayFault(ofSliders.length ? ofSliders : [message, ...left.map(({detail}) => detail)]);
  }

  showOrigins() {
    if ($("more").open) this.form.showOrigins(run.answer.parameters);
  }

  show(answer, fields) {
    const fresh = run === null || fields.fresh;
    const {forcing} = this.request.merged(fields);
    const load = [answer.parameters.forcing, forcing].find((given) => given?.time_s);
    const units = unitsOf(answer.parameters);
    setRun({fields, answer, motion: motionOf(answer, load), units, load});
    this.say(fields.note || unknownText(fields.unknown));
    this.mark(false);
    this.form.showErrors([]);
    this.showOrigins();
    // The identification assumes straight flights and one R.
    $("measure-this").disabled = Boolean(answer.series || answer.parameters.restitution_plus);
    remark(answer);
    viewport.span(0, answer.status.tau, homeOf(answer), fresh);
    if (this.wantedView) viewport.range = this.wantedView;
    this.wantedView = null;
    dom.reveal({whole: viewport.zoomed});
    this.drawRun(fresh);
    dom.countUp(this.results, "shown");
    clearTimeout(this.deferring);
    this.deferring = setTimeout(() => this.requestMore(fields), idle);
  }

  /** Requests the deferred parts of the run, or all for the open details. */
  requestMore(fields) {
    this.deferred.start({fields, parts: details.wanted() ?? deferredParts});
  }

  drawRun(fresh) {
    const {request} = this;
    const {answer, fields, units} = run;
    const {parameters} = answer;
    const slider = sliders.sliderOf(this.lastMoved, parameters);
    sliders.show(parameters, {fresh, dragged: fields.dragged}, slider);
    showSentence(answer, slider, units);
    machine.showReduction(answer.energy);
    pin.compare();
    mainPlots.draw();
    player.show();
    describe(answer, request.describe(fields, parameters));
    presetMenu.markPlots(request.edited ? null : request.preset);
    dom.reveal({regimes: !parameters.forcing}); // which need a period
    if (!parameters.forcing) this.strip.show(request.systemOf(fields), parameters, slider);
  }

  submit() {
    if (!$("form").querySelector(".slider [aria-invalid=true]")) this.send();
  }

  /** Sends the form. fresh: not by a slider; linked: as in the address; note: to be shown. */
  send({dragging = false, fresh = false, unknown = [], linked = false, note = ""} = {}) {
    const fields = this.request.fields();
    const about = {fresh, unknown, dragged: dragging, linked, note};
    for (const [what, value] of Object.entries(about)) Object.defineProperty(fields, what, {value});
    if (fresh) this.lastMoved = "b";
    this.note();
    const {name, edited} = this.request;
    presetMenu.markChip(name, edited, !name && "m1" in fields);
    const query = toQuery(fields);
    const isNew = query !== this.asked;
    const edit = isNew && this.asked !== null; // Back undoes it
    this.asked = query;
    if (isNew || !dragging) this.changed({edit, soon: dragging});
    this.start(fields, {dragging});
  }

  /** Called when the text in a slider's number is not a number. */
  sliderRefused({label, number}) {
    this.mark(true);
    this.say(`${label}: “${number.value}” is not a number`, true);
  }

  /** Called when a slider or the strip's marker moves. fields: to set, null to clear one. */
  sliderMoved(fields, slider, dragging) {
    this.lastMoved = slider.name;
    this.set(fields, dragging);
  }

  /** Sets fields, null to clear one; dragging: more changes follow. */
  set(fields, dragging) {
    for (const [name, value] of Object.entries(fields)) this.form.replace(name, value);
    this.send({dragging});
  }

  /** Takes a recorded load in place of the harmonic forcing. */
  async readLoad(file) {
    if (!file) return;
    try {
      const {loadOf, parse} = await import("../measurement/record.js");
      const forcing = loadOf(await parse(file));
      dom.setTexts({"load-note": `${file.name}, ${forcing.time_s.length} samples`});
      this.set({forcing, F: null, f: null, acceleration: null}, false);
    } catch ({message}) {
      this.say(`${file.name} cannot be read: ${message}`, true);
    }
  }

  /** Shows the preset's note, or that the preset was changed. */
  note() {
    const {preset, edited} = this.request;
    const changed = preset && edited ? `${preset.source}, changed` : (preset?.note ?? "");
    dom.setTexts({"preset-note": changed});
  }

  /** The query of the requested run with its visible range; null before the first. */
  query() {
    if (this.asked === null) return null;
    const view = this.wantedView ?? (viewport.changed ? viewport.range : null);
    const pinned = pin.query();
    const more = [
      view && `view=${roundedRange(view)}`,
      pinned !== null && `pinned=${encodeURIComponent(pinned)}`,
    ];
    return joined([this.asked, ...more], "&");
  }

  /** Shows the run of a query, with a note; by default the paper's Fig. 3. */
  open(given, note = "") {
    const rest = new URLSearchParams(given);
    const view = rest.get("view")?.split(",").map(Number);
    const pinned = rest.get("pinned");
    for (const name of ["view", "pinned"]) rest.delete(name);
    pin.restore(pinned, (texts) => this.ask(this.form.parse(texts)));
    if (String(rest) === this.asked) return;
    const isView = view?.length === 2 && view[0] < view[1];
    this.wantedView = isView ? view : null;
    const unknown = this.request.read(rest);
    if (view && !isView) unknown.push(`view=${given.get("view")}`);
    this.asked = toQuery(this.request.fields());
    this.send({fresh: true, unknown, linked: !note, note});
    this.changed(); // in canonical form
  }

  redraw() {
    for (const part of [mainPlots, details, machine]) part.redraw();
    this.strip.refresh();
  }
}

/** One plot is large, by a click on it, Enter or its chip; on small screens the others are hidden. */
function startPlots() {
  const figures = [...document.querySelectorAll("#plots figure")];
  const buttons = figures.map((figure) =>
    dom.button(figure.dataset.short, () => enlarge(figure), {className: "chip"}),
  );
  const enlarge = (chosen) => {
    dom.press(buttons, (one) => figures[buttons.indexOf(one)] === chosen);
    for (const figure of figures) figure.classList.toggle("chosen", figure === chosen);
  };
  $("switch").append(...buttons);
  enlarge(figures[0]);
  const act = ({target, key = "Enter"}) => {
    const figure = target.closest("figure");
    if (figure && key === "Enter" && !target.closest("button")) enlarge(figure);
  };
  dom.on($("plots"), {click: act, keydown: act});
}

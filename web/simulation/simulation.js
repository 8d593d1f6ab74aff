// The simulation tab: every change is sent as one request and its answer shown immediately. The
// address holds the request and the visible range.

import {Problem, simulate, wholeMessage} from "../shared/api.js";
import {
  $,
  attributes,
  button,
  countUp,
  nextTask,
  press,
  reveal,
  sayIn,
  setTexts,
} from "../shared/dom.js";
import {copy, formsOf} from "../shared/export.js";
import {Form, unknownText} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {Motion} from "../shared/motion.js";
import {showRemarks} from "../shared/tables.js";
import {onUnits, unitsOf, unitsSwitch} from "../shared/units.js";
import {describe} from "./captions.js";
import * as details from "./details.js";
import * as machine from "./machine.js";
import * as mainPlots from "./main_plots.js";
import * as pin from "./pin.js";
import * as player from "./player.js";
import * as presetMenu from "./preset_menu.js";
import {Request, toQuery} from "./request.js";
import {run, setRun, viewport} from "./run.js";
import {showSentence} from "./sentence.js";
import * as sliders from "./sliders.js";
import * as strip from "./strip.js";

// Parts requested for every slider movement, and parts requested once it rests.
const firstParts = {include: ["impacts", "exponents", "regime", "energy"], exponents: ["qr"]};
const deferredParts = {
  include: ["exponents", "eigenvalues", "manifold"],
  exponents: ["raw_product"],
};

const large = 20000; // impacts above which a run is drawn in several tasks
const idle = 100; // ms without an edit before the deferred parts are requested

let request;
let lastMoved = "b";
let shown = null;
let wantedView = null;
let remembered = () => {};
let deferring = 0;

const say = sayIn("message");

/** Marks the results as those of another request. */
const setStale = (is) => $("results").classList.toggle("stale", is);

const job = new Job({
  ask: (fields, signal) => simulate({...fields, ...firstParts}, signal),
  show: present,
  fail: showError,
  busy(is, cancelled) {
    if (is || cancelled) setStale(true);
    attributes($("results"), {"aria-busy": is});
    reveal({cancel: is});
    if (is && !$("message").classList.contains("fault")) say("computing …");
    else if (cancelled) say("cancelled: the previous run is shown");
  },
  later: (text) => say(text, true),
});

const deferredJob = new Job({
  ask: (fields, signal) => simulate({...fields, ...deferredParts}, signal),
  show(answer, fields) {
    if (fields !== run.fields) return;
    run.deferred = answer;
    remark(run.answer, answer);
    mainPlots.showDeferred();
    details.follow();
    countUp($("results"));
  },
  fail: (error) => say(`T, the raw product and the manifold are missing: ${error.message}`, true),
});

function showError(error) {
  setStale(true);
  if (!run) setTexts({sentence: "No results yet."});
  if (!(error instanceof Problem)) return say(wholeMessage(error, []), true);
  const left = request.form.showErrors(error.errors, false);
  const turned = sliders.showErrors(error.errors);
  if (left.length + turned.length < error.errors.length) $("more").open = true;
  say(turned.length ? turned.join("; ") : wholeMessage(error, left), true);
}

/** The range first in view: the window, if it ends well before the run. */
function homeOf({parameters, status}) {
  const to = parameters.window?.[1];
  return to && to < 0.9 * status.tau ? [0, to] : [0, status.tau];
}

/** Shows the remarks: the reason for an undecided verdict, and warnings. */
function remark({exponents: {verdict, verdict_reason: why}, regime, warnings}, more = {}) {
  const open = verdict === "not_decided" && !regime.periodic;
  const all = [...warnings, ...(more.warnings ?? [])];
  showRemarks("remarks", [...new Set([...(open ? [`not decided: ${why}`] : []), ...all])]);
}

function showOrigins() {
  request.showDamping(run.answer.parameters);
  if ($("more").open) request.form.showOrigins(run.answer.parameters);
}

/** Draws a run; a large one in several tasks, between which the browser handles events. */
async function present(answer, fields) {
  const pause = answer.impacts.tau.length > large ? nextTask : null;
  if (pause) await pause();
  const fresh = run === null || fields.fresh;
  setRun({fields, answer, motion: new Motion(answer), units: unitsOf(answer.parameters)});
  say(unknownText(fields.unknown));
  setStale(false);
  request.form.showErrors([]);
  showOrigins();
  remark(answer);
  reveal({units: answer.parameters.si});
  viewport.span(0, answer.status.tau, homeOf(answer), fresh);
  if (wantedView) viewport.range = wantedView;
  wantedView = null;
  reveal({whole: viewport.changed});
  for (const step of drawing(fresh)) {
    if (pause) await pause();
    if (run.answer !== answer) return;
    step();
  }
  countUp($("results"), "shown");
  clearTimeout(deferring);
  deferring = setTimeout(() => deferredJob.start(fields), idle);
}

/** The steps that draw the run in the chosen units. */
function drawing(fresh = false) {
  const {answer, fields, units} = run;
  const slider = sliders.sliderOf(lastMoved, answer.parameters);
  const tell = () => {
    sliders.show(answer.parameters, {fresh, dragged: fields.dragged}, slider);
    showSentence(answer, slider, units);
  };
  const end = () => {
    player.show();
    describe(answer, request.textOf(fields, answer.parameters));
    presetMenu.markPlots(request.edited ? null : request.preset);
    strip.show(request.systemOf(fields), answer.parameters, slider);
  };
  return [tell, ...mainPlots.drawing(), end];
}

/**
 * Sends the form. dragging: while a slider is dragged; fresh: not changed by a slider; unknown: names
 * in the address.
 */
function send({dragging = false, fresh = false, unknown = []} = {}) {
  const fields = request.fields();
  const about = {fresh, unknown, dragged: dragging};
  for (const [name, value] of Object.entries(about)) Object.defineProperty(fields, name, {value});
  presetMenu.markChip(request.name, request.edited);
  if (dragging) player.hold();
  remember(toQuery(fields), dragging);
  job.start(fields, {dragging});
}

/** Updates the address; Back undoes an edit. */
function remember(query, soon) {
  if (query === shown) {
    if (!soon) remembered(); // the edit is complete
    return;
  }
  const edit = shown !== null;
  shown = query;
  remembered({edit, soon});
}

/** Called when a slider or the strip's marker moves. */
function sliderMoved(fields, slider, dragging) {
  lastMoved = slider.name;
  const {form} = request;
  if (slider.name === "zeta") request.dampingChosen = true;
  const entries = Object.entries(fields);
  for (const [name, value] of entries) form.replace(name, value ?? "");
  note("");
  send({dragging});
}

/** Shows the preset's note, or that the preset was changed. */
function note(text) {
  const {preset, edited} = request;
  const changed = preset && edited ? `${preset.source}, changed` : (preset?.note ?? "");
  setTexts({"preset-note": text || changed});
}

function choosePreset(name) {
  lastMoved = "b";
  request.choose(name);
  note("");
  send({fresh: true});
}

/** The query of the requested run with its visible range; null before the first. */
export function query() {
  if (shown === null) return null;
  const view = wantedView ?? (viewport.changed ? viewport.range : null);
  const pinned = pin.query();
  const more = [
    view && `view=${viewText(view)}`,
    pinned !== null && `pinned=${encodeURIComponent(pinned)}`,
  ];
  return [shown, ...more].filter(Boolean).join("&");
}

/** Digits for a ten-thousandth of the range. */
function viewText([from, to]) {
  const places = Math.max(0, 4 - Math.floor(Math.log10(to - from)));
  return [from, to].map((t) => Number(t.toFixed(Math.min(places, 15)))).join(",");
}

/** Shows the run of a query; by default the paper's Fig. 3. */
export function open(given) {
  const rest = new URLSearchParams(given);
  const view = rest.get("view")?.split(",").map(Number);
  const pinned = rest.get("pinned");
  for (const name of ["view", "pinned"]) rest.delete(name);
  pin.restore(pinned, firstParts);
  if (String(rest) === shown) return;
  const isView = view?.length === 2 && view[0] < view[1];
  wantedView = isView ? view : null;
  const unknown = request.read(rest);
  if (view && !isView) unknown.push(`view=${new URLSearchParams(given).get("view")}`);
  lastMoved = "b";
  note("");
  shown = toQuery(request.fields());
  send({fresh: true, unknown});
  remembered(); // in canonical form
}

export function redraw() {
  mainPlots.redraw();
  details.redraw();
  strip.redraw();
  machine.redraw();
}

/**
 * fields: of /v1/parameters; presets; changed({edit}): called when the query changes;
 * measure(answer): opens the run in Measurement.
 */
export function start({fields, presets: list}, changed, {measure}) {
  remembered = changed;
  const form = new Form($("fields"), fields);
  request = new Request(form, fields, list);
  mainPlots.start();
  player.start();
  const refused = (text, {label}) => {
    setStale(true);
    say(`${label}: “${text}” is not a number`, true);
  };
  const old = () => run && toQuery(run.fields) !== shown;
  sliders.start(sliderMoved, refused, (differs) => setStale(differs || old()));
  details.start(request.fieldOf);
  presetMenu.start(list, choosePreset);
  pin.start(changed, (other) => {
    request.read(other);
    send();
  });
  startSmallScreen();
  listen(form, measure);
}

function listen(form, measure) {
  for (const [name, input] of form.inputs) {
    input.oninput = () => note(request.fieldEdited(name));
    input.onchange = () => {
      if (name === "damping") request.dampingChosen = true;
      send();
    };
  }
  viewport.onZoom(() => {
    reveal({whole: viewport.changed});
    remembered({soon: true});
  });
  $("whole").onclick = () => viewport.reset();
  $("more").ontoggle = () => {
    if (run) showOrigins();
    if ($("more").open) $("more").scrollIntoView({block: "nearest"});
  };
  unitsSwitch($("units"));
  onUnits(() => {
    if (!run) return;
    run.units = unitsOf(run.answer.parameters);
    for (const step of drawing()) step();
    details.follow();
  });
  $("form").onsubmit = (event) => {
    event.preventDefault();
    if (!$("form").querySelector(".slider [aria-invalid=true]")) send();
  };
  $("cancel").onclick = () => job.cancel();
  $("measure-this").onclick = () => run && measure(run.answer);
  const forms = formsOf("v1/simulate", () => request.fields());
  for (const [name, text] of Object.entries(forms)) {
    const title = `copy this run as ${name}`;
    $("copies").append(button(name, () => copy(text(), say), {className: "small", title}));
  }
}

/** On small screens: one plot at a time, and the parameters in a sheet. */
function startSmallScreen() {
  const buttons = document.querySelectorAll("#switch button");
  for (const one of buttons)
    one.onclick = () => {
      $("instrument").dataset.plot = one.dataset.plot;
      press(buttons, (b) => b === one);
    };
  buttons[0].click();
  $("sheet").onclick = () => {
    const open = $("form").classList.toggle("open");
    attributes($("sheet"), {"aria-expanded": open});
    setTexts({sheet: `All ${open ? "▾" : "▴"}`});
  };
}

// The tab of one simulation: what one turns goes to the service as one request, and what it answers
// is shown at once. The address is the request, and what is in view.
import {Problem, simulate, wholeMessage} from "../shared/api.js";
import {showRemarks} from "../shared/cards.js";
import {formsOf} from "../shared/copies.js";
import {$, attributes, button, countUp, nextTask, reveal, sayIn, write} from "../shared/dom.js";
import {Form, unknownText} from "../shared/form.js";
import {Job} from "../shared/job.js";
import {Motion} from "../shared/motion.js";
import {copy} from "../shared/take_away.js";
import {onUnits, unitsOf, unitsSwitch} from "../shared/units.js";
import {describe} from "./captions.js";
import * as chips from "./chips.js";
import * as details from "./details.js";
import * as instrument from "./instrument.js";
import * as machine from "./machine.js";
import {mark} from "./matches.js";
import * as phone from "./phone.js";
import * as pin from "./pin.js";
import * as player from "./player.js";
import {Request, toQuery} from "./request.js";
import {axis, run, setRun} from "./run.js";
import {showSentence} from "./sentence.js";
import * as sliders from "./sliders.js";
import * as strip from "./strip.js";

// What every turn of a slider asks for, and what follows once it rests.
const first = {include: ["impacts", "exponents", "regime", "energy"], exponents: ["qr"]};
const second = {include: ["exponents", "eigenvalues", "manifold"], exponents: ["raw_product"]};

const large = 20000; // impacts
const rest = 100; // ms without an edit before what follows is asked for

let request;
let touched = "b";
let shown = null;
let wantedView = null;
let remembered = () => {};
let resting = 0;

const say = sayIn("message");

/** Whether what is shown is of another request. */
const setStale = (is) => $("results").classList.toggle("stale", is);

// What is computed.

const job = new Job({
  ask: (asked, signal) => simulate({...asked, ...first}, signal),
  show: present,
  fail: refuse,
  busy(is, cancelled) {
    if (is || cancelled) setStale(true);
    attributes($("results"), {"aria-busy": is});
    reveal({cancel: is});
    if (is && !$("message").classList.contains("fault")) say("computing …");
    else if (cancelled) say("cancelled: what is shown is the run before");
  },
  later: (text) => say(text, true),
});

const more = new Job({
  ask: (asked, signal) => simulate({...asked, ...second}, signal),
  show(answer, asked) {
    if (asked !== run.asked) return;
    run.more = answer;
    remark(run.answer, answer);
    instrument.showMore();
    details.follow();
    countUp($("results"));
  },
  fail: (error) => say(`T, the raw product and the manifold are missing: ${error.message}`, true),
});

function refuse(error) {
  setStale(true);
  if (!run) write({sentence: "Nothing is computed yet."});
  if (!(error instanceof Problem)) return say(wholeMessage(error, []), true);
  const left = request.form.showErrors(error.errors, false);
  const turned = sliders.showErrors(error.errors);
  if (left.length + turned.length < error.errors.length) $("more").open = true;
  say(turned.length ? turned.join("; ") : wholeMessage(error, left), true);
}

/** What is first in view: the window, where there is one that ends before the run. */
function homeOf({parameters, status}) {
  const to = parameters.window?.[1];
  return to && to < 0.9 * status.tau ? [0, to] : [0, status.tau];
}

/** What there is to know of a run beside its sentence: why it is not decided, and the service's warnings. */
function remark({exponents: {verdict, verdict_reason: why}, regime, warnings}, more = {}) {
  const open = verdict === "not_decided" && !regime.periodic;
  const all = [...warnings, ...(more.warnings ?? [])];
  showRemarks("remarks", [...new Set([...(open ? [`not decided: ${why}`] : []), ...all])]);
}

function showOrigins() {
  if ($("more").open) request.form.showOrigins(run.answer.parameters);
}

/** A run with many impacts is drawn in several tasks, between which the page hears of other things. */
async function present(answer, asked) {
  const pause = answer.impacts.tau.length > large ? nextTask : null;
  if (pause) await pause();
  const fresh = run === null || asked.fresh;
  setRun({asked, answer, motion: new Motion(answer), units: unitsOf(answer.parameters)});
  say(unknownText(asked.unknown));
  setStale(false);
  request.form.showErrors([]);
  showOrigins();
  remark(answer);
  reveal({units: answer.parameters.si});
  axis.span(0, answer.status.tau, homeOf(answer), fresh);
  if (wantedView) axis.view = wantedView;
  wantedView = null;
  reveal({whole: axis.away});
  for (const step of drawing(fresh)) {
    if (pause) await pause();
    if (run.answer !== answer) return;
    step();
  }
  countUp($("results"), "shown");
  clearTimeout(resting);
  resting = setTimeout(() => more.start(asked), rest);
}

/** What shows the run, in the units that are chosen, step by step. */
function drawing(fresh = false) {
  const {answer, asked, units} = run;
  const slider = sliders.sliderOf(touched, answer.parameters);
  const tell = () => {
    sliders.show(answer.parameters, {fresh, dragged: asked.dragged}, slider);
    showSentence(answer, slider, units);
  };
  const end = () => {
    player.show();
    describe(answer, request.textOf(asked, answer.parameters));
    mark(request.edited ? null : request.preset);
    strip.show(request.systemOf(asked), answer.parameters, slider);
  };
  return [tell, ...instrument.drawing(), end];
}

// What is asked.

/** How the newest request is sent. hasty: while a slider is dragged; fresh: not by turning one. */
function send({hasty = false, fresh = false, unknown = []} = {}) {
  const asked = request.asked();
  const about = {fresh, unknown, dragged: hasty};
  for (const [name, value] of Object.entries(about)) Object.defineProperty(asked, name, {value});
  chips.mark(request.name, request.edited);
  if (hasty) player.hold();
  remember(toQuery(asked), hasty);
  job.start(asked, {hasty});
}

/** Back undoes an edit. */
function remember(query, soon) {
  if (query === shown) {
    if (!soon) remembered(); // an edit has come to its end
    return;
  }
  const edit = shown !== null;
  shown = query;
  remembered({edit, soon});
}

/** A slider or the strip's marker was turned. */
function turn(fields, slider, hasty) {
  touched = slider.name;
  const {form} = request;
  if (slider.name === "zeta") request.dampingChosen = true;
  const entries = Object.entries(fields);
  for (const [name, value] of entries) form.replace(name, value ?? "");
  request.greyOut();
  note("");
  send({hasty});
}

/** What a preset says of itself holds as long as it is not changed. */
function note(text) {
  const {preset, edited} = request;
  const changed = preset && edited ? `${preset.source}, changed` : (preset?.note ?? "");
  write({"preset-note": text || changed});
}

function choosePreset(name) {
  touched = "b";
  request.choose(name);
  note("");
  send({fresh: true});
}

/** The query of the run that is asked for, and what of it is in view; null before the first. */
export function query() {
  if (shown === null) return null;
  const view = wantedView ?? (axis.away ? axis.view : null);
  const pinned = pin.query();
  const more = [
    view && `view=${viewText(view)}`,
    pinned !== null && `pinned=${encodeURIComponent(pinned)}`,
  ];
  return [shown, ...more].filter(Boolean).join("&");
}

/** As many digits as a ten-thousandth of what is in view. */
function viewText([from, to]) {
  const places = Math.max(0, 4 - Math.floor(Math.log10(to - from)));
  return [from, to].map((t) => Number(t.toFixed(Math.min(places, 15)))).join(",");
}

/** Shows what a query asks for; without one the paper's Fig. 3. */
export function open(given) {
  const rest = new URLSearchParams(given);
  const view = rest.get("view")?.split(",").map(Number);
  const pinned = rest.get("pinned");
  for (const name of ["view", "pinned"]) rest.delete(name);
  pin.restore(pinned, first);
  if (String(rest) === shown) return;
  const isView = view?.length === 2 && view[0] < view[1];
  wantedView = isView ? view : null;
  const unknown = request.read(rest);
  if (view && !isView) unknown.push(`view=${new URLSearchParams(given).get("view")}`);
  touched = "b";
  note("");
  shown = toQuery(request.asked());
  send({fresh: true, unknown});
  remembered(); // as the page itself writes it
}

export function redraw() {
  instrument.redraw();
  details.redraw();
  strip.redraw();
  machine.redraw();
}

/**
 * tables: of /v1/parameters, and presets; changed({edit}): there is another query; measure(answer):
 * identifies the run.
 */
export function start({fields, presets: list}, changed, {measure}) {
  remembered = changed;
  const form = new Form($("fields"), fields);
  request = new Request(form, fields, list);
  instrument.start();
  player.start();
  const refused = (text, {label}) => {
    setStale(true);
    say(`${label}: “${text}” is no number`, true);
  };
  const old = () => run && toQuery(run.asked) !== shown;
  sliders.start(turn, refused, (differs) => setStale(differs || old()));
  details.start(request.fieldOf);
  chips.start(list, choosePreset);
  pin.start(changed, (other) => {
    request.read(other);
    send();
  });
  phone.start();
  listen(form, measure);
}

function listen(form, measure) {
  for (const [name, input] of form.inputs) {
    input.oninput = () => note(request.typedOver(name));
    input.onchange = () => {
      if (name === "damping") request.dampingChosen = true;
      send();
    };
  }
  axis.onView(() => {
    reveal({whole: axis.away});
    remembered({soon: true});
  });
  $("whole").onclick = () => axis.reset();
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
  const forms = formsOf("v1/simulate", () => request.asked());
  for (const [name, text] of Object.entries(forms)) {
    const title = `copy this run as ${name}`;
    $("copies").append(button(name, () => copy(text(), say), {className: "small", title}));
  }
}

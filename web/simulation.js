// The tab of one simulation: preset and form in, one request, plots out. Its query is the request,
// so a link shows the same run.
import {mark, show} from "./about.js";
import {asCurl, Problem, simulate, wholeMessage} from "./api.js";
import {$, showBusy} from "./dom.js";
import {Form, textOf} from "./form.js";
import {listParameters} from "./parameters.js";
import {holding, isOfSystem, queryText} from "./presets.js";
import {accountEnergy, summarise, tabulate} from "./summary.js";
import {copy} from "./take_away.js";
import {onUnits, unitsOf, unitsSwitch} from "./units.js";
import {draw, redraw} from "./views.js";

// What the page draws.
const include = [
  "series",
  "impacts",
  "exponents",
  "eigenvalues",
  "section",
  "energy",
  "regime",
  "manifold",
];

let form;
let fieldOf;
let presets;
let running = null;
let shown = null;
let last = null;
let dampingChosen = false;
let remembered = () => {};

function say(text, fault = false) {
  $("message").textContent = text;
  $("message").classList.toggle("fault", fault);
}

const preset = () => presets.find((p) => p.name === $("preset").value);

function present(answer, milliseconds) {
  last = {answer, milliseconds};
  const units = unitsOf(answer.parameters);
  $("units").hidden = !answer.parameters.si;
  summarise(answer, milliseconds, units);
  listParameters(answer.parameters, fieldOf);
  tabulate(answer.windows, units);
  accountEnergy(answer.energy, units);
  draw(answer, units);
  return mark(preset());
}

/** One request and its answer; lead: go to the plots that the preset is about. */
async function run(lead = false) {
  running?.abort();
  const mine = new AbortController();
  running = mine;
  const request = form.values();
  form.showErrors([]);
  showBusy("", true);
  say("computing …");
  const started = performance.now();
  try {
    const answer = await simulate({...asked(request), include}, mine.signal);
    if (running !== mine) return;
    answer.request = request;
    if (emptied(request)) leavePreset("");
    remember(request);
    form.showOrigins(answer.parameters);
    const figures = present(answer, performance.now() - started);
    say(""); // what ended the run early is among the warnings
    if (lead) show(figures);
    $("results").dataset.done = String(Number($("results").dataset.done ?? 0) + 1);
  } catch (error) {
    if (error.name === "AbortError") {
      if (running === mine) say("cancelled");
      return;
    }
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say(wholeMessage(error, left), true);
  } finally {
    if (running === mine) {
      running = null;
      showBusy("", false);
    }
  }
}

/** What a text of a query stands for: a list of lists, a list, or a text. */
function queryValue(text) {
  if (text.includes(";")) {
    const parts = text.split(";").filter((part) => part.trim());
    return parts.map(queryValue);
  }
  return text.includes(",") ? text.split(",") : text;
}

/** What of the preset holds beside a request's fields. */
const held = (request) => holding(preset()?.parameters ?? {}, request, fieldOf);

/**
 * A preset's name stands for its fields, so it does not fit a request that has emptied one of them.
 * A default is not in the request.
 */
const emptied = (request) =>
  Object.entries(held(request)).some(
    ([name, value]) => !(name in request) && value !== fieldOf[name].default,
  );

function leavePreset(why) {
  $("preset").value = "";
  $("preset-note").textContent = why;
  greyOut();
}

/**
 * Over a preset in SI a reduced field can be changed; a system of one's own is one or the other.
 */
const greyOut = () => form.disable(preset() ? [] : form.unmixable());

/** The fields that are not the preset's. */
function differing(request) {
  const base = held(request);
  const differs = ([name, value]) => !(name in base) || queryText(value) !== queryText(base[name]);
  return Object.fromEntries(Object.entries(request).filter(differs));
}

/**
 * What to send: the preset's name in place of those values that are its own, so that one that
 * differs changes alone.
 */
const asked = (request) =>
  !preset() || emptied(request) ? request : {preset: preset().name, ...differing(request)};

/** The request as a query, as the GET route takes it. */
function remember(request) {
  const fields = {...(preset() ? {preset: preset().name} : {}), ...differing(request)};
  const texts = Object.entries(fields).map(([name, value]) => [name, queryText(value)]);
  shown = String(new URLSearchParams(texts));
  remembered();
}

/**
 * The damping of the paper's numbers and its windows go with its system: they make way for a system
 * of one's own, unless they were chosen.
 */
function makeWay(base) {
  const gone = [];
  const input = (name) => form.inputs.get(name);
  const standard = fieldOf.damping.default;
  if (!dampingChosen && input("damping").value !== standard) {
    form.replace("damping", standard);
    gone.push(`damping is ${standard}`);
  }
  for (const name of ["window", "windows"]) {
    const ofPreset = name in base && input(name).value === textOf(base[name]);
    if (!ofPreset) continue;
    form.replace(name, "");
    gone.push(`${name} is empty`);
  }
  return gone;
}

/**
 * Something was typed over a preset. Reduced fields over one in SI change it where it is: both
 * cannot be mixed.
 */
function typedOver(name) {
  const chosen = preset();
  const base = chosen?.parameters;
  if (!base) return greyOut();
  if (name in base && !form.filled(name)) return leavePreset("");
  if (!isOfSystem(name) || !form.filled(name)) return;
  const gone = makeWay(base);
  if ("m1" in base && fieldOf[name].group === "reduced") return;
  leavePreset([`A system of your own, in place of ${chosen.source}`, ...gone].join("; "));
}

function choosePreset(name) {
  $("preset").value = presets.some((p) => p.name === name) ? name : "";
  $("preset-note").textContent = preset()?.note ?? "";
  dampingChosen = false;
  if (preset()) form.set(preset().parameters);
  greyOut();
}

/** The query of the run that is shown, or null before the first. */
export const query = () => shown;

/** Shows what a query asks for; without one the paper's Fig. 3. */
export async function open(given) {
  if (String(given) === shown) return;
  const rest = new URLSearchParams(given);
  choosePreset(rest.get("preset") ?? (rest.size ? "" : "fig3"));
  rest.delete("preset");
  const fields = Object.fromEntries([...rest].map(([key, text]) => [key, queryValue(text)]));
  dampingChosen = "damping" in fields;
  form.set({...held(fields), ...fields});
  greyOut();
  await run();
}

export {redraw};

const command = () => asCurl("v1/simulate", {...asked(form.values()), include});

/** changed: called when there is another query. */
export function start(fields, list, changed) {
  presets = list;
  remembered = changed;
  form = new Form($("fields"), fields);
  fieldOf = Object.fromEntries(fields.map((f) => [f.name, f]));
  for (const [name, input] of form.inputs) input.addEventListener("input", () => typedOver(name));
  form.inputs.get("damping").addEventListener("change", () => {
    dampingChosen = true;
  });
  unitsSwitch($("units"));
  onUnits(() => {
    if (last) present(last.answer, last.milliseconds);
  });
  $("preset").append(
    new Option("own parameters", ""),
    ...presets.map((p) => new Option(`${p.source}: ${p.title}`, p.name)),
  );
  $("preset").addEventListener("change", () => {
    choosePreset($("preset").value);
    if ($("preset").value) run(true);
  });
  $("form").addEventListener("submit", (event) => {
    event.preventDefault();
    run();
  });
  $("cancel").addEventListener("click", () => running?.abort());
  $("copy").addEventListener("click", () => copy(command(), say));
}

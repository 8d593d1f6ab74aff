// The tab of one simulation: preset and form in, one request, plots out. Its query is the request, so a link shows the same run.
import {mark, show} from "./about.js";
import {asCurl, simulate, Problem} from "./api.js";
import {$} from "./dom.js";
import {Form} from "./form.js";
import {accountEnergy, summarise, tabulate} from "./summary.js";
import {draw, redraw} from "./views.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime", "manifold"];  // what the page draws

let form, fieldOf, presets, running = null, shown = null, remembered = () => {};

function say(text, fault = false) {
  $("message").textContent = text;
  $("message").classList.toggle("fault", fault);
}

const preset = () => presets.find((p) => p.name === $("preset").value);

function present(answer, milliseconds) {
  summarise(answer, milliseconds);
  tabulate(answer.windows);
  accountEnergy(answer.energy);
  draw(answer);
  return mark(preset());
}

/** One request and its answer; lead: go to the plots that the preset is about. */
async function run(lead = false) {
  running?.abort();
  const mine = running = new AbortController();
  const request = form.values();
  form.showErrors([]);
  $("run").disabled = true;
  $("cancel").hidden = false;
  $("results").classList.add("stale");
  say("computing …");
  const started = performance.now();
  try {
    const answer = await simulate({...asked(request), include}, mine.signal);
    if (running !== mine) return;
    answer.request = request;
    leavePreset(request);
    remember(request);
    const figures = present(answer, performance.now() - started);
    say("");  // what ended the run early is among the warnings
    if (lead) show(figures);
    $("results").dataset.done = String(Number($("results").dataset.done ?? 0) + 1);
  } catch (error) {
    if (error.name === "AbortError") { if (running === mine) say("cancelled"); return; }
    const left = error instanceof Problem ? form.showErrors(error.errors) : [];
    say([error.message, ...left.map((e) => e.detail).filter((d) => d !== error.message)].join("; "), true);
  } finally {
    if (running === mine) {
      running = null;
      $("run").disabled = false;
      $("cancel").hidden = true;
      $("results").classList.remove("stale");
    }
  }
}

/** A value as a query has it; intervals: a,b;c,d. */
const queryText = (value) => Array.isArray(value?.[0]) ? value.join(";") : String(value);
const queryValue = (text) => text.includes(";") ? text.split(";").filter((part) => part.trim()).map(queryValue) : text.includes(",") ? text.split(",") : text;

/** A preset's name stands for its fields, so it does not fit a request that has emptied one of them. A default is not in the request. */
const emptied = (request) => Object.entries(preset()?.parameters ?? {}).some(([name, value]) => !(name in request) && value !== fieldOf[name].default);

function leavePreset(request) {
  if (emptied(request)) $("preset").value = $("preset-note").textContent = "";
}

/** What to send: the preset's name in place of those values of the system that are its own, so that one that differs changes alone. */
function asked(request) {
  const base = preset()?.parameters ?? {};
  if (!preset() || emptied(request)) return request;
  const own = ([name, value]) => ["system", "reduced", "SI"].includes(fieldOf[name].group) && queryText(value) === queryText(base[name]);
  return {preset: preset().name, ...Object.fromEntries(Object.entries(request).filter((field) => !own(field)))};
}

/** The request as a query, as the GET route takes it. */
function remember(request) {
  const base = preset()?.parameters ?? {}, query = new URLSearchParams(preset() ? {preset: preset().name} : {});
  for (const [name, value] of Object.entries(request)) if (!(name in base) || queryText(value) !== queryText(base[name])) query.set(name, queryText(value));
  shown = String(query);
  remembered();
}

function choosePreset(name) {
  $("preset").value = presets.some((p) => p.name === name) ? name : "";
  $("preset-note").textContent = preset()?.note ?? "";
  if (preset()) form.set(preset().parameters);
}

/** The query of the run that is shown, or null before the first. */
export const query = () => shown;

/** Shows what a query asks for; without one the paper's Fig. 3. */
export async function open(given) {
  if (String(given) === shown) return;
  const rest = new URLSearchParams(given);
  choosePreset(rest.get("preset") ?? (rest.size ? "" : "fig3"));
  rest.delete("preset");
  form.set({...preset()?.parameters, ...Object.fromEntries([...rest].map(([key, text]) => [key, queryValue(text)]))});
  await run();
}

export {redraw};

/** changed: called when there is another query. */
export function start(fields, list, changed) {
  presets = list;
  remembered = changed;
  form = new Form($("fields"), fields);
  fieldOf = Object.fromEntries(fields.map((f) => [f.name, f]));
  $("preset").append(new Option("own parameters", ""), ...presets.map((p) => new Option(`${p.source}: ${p.title}`, p.name)));
  $("preset").addEventListener("change", () => { choosePreset($("preset").value); if ($("preset").value) run(true); });
  $("form").addEventListener("submit", (event) => { event.preventDefault(); run(); });
  $("cancel").addEventListener("click", () => { running?.abort(); });
  $("copy").addEventListener("click", async () => {
    const command = asCurl("v1/simulate", {...asked(form.values()), include});
    try { await navigator.clipboard.writeText(command); say("copied"); } catch { say(command); }
  });
}

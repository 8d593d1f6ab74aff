// The page: preset and form in, one request, plots out. The address holds the request, so a link shows the same run.
import {mark, show} from "./about.js";
import {get, simulate, Problem} from "./api.js";
import {$} from "./dom.js";
import {Form} from "./form.js";
import {accountEnergy, summarise, tabulate} from "./summary.js";
import {draw, redraw} from "./views.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime", "manifold"];  // what the page draws

let form, presets, running = null;

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
    const answer = await simulate({...request, include}, mine.signal);
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

/** A preset's name stands for its fields, so it does not fit a request that has emptied one of them. */
function leavePreset(request) {
  if (Object.keys(preset()?.parameters ?? {}).some((name) => !(name in request))) $("preset").value = $("preset-note").textContent = "";
}

/** The request in the address, as the GET route takes it. */
function remember(request) {
  const base = preset()?.parameters ?? {}, query = new URLSearchParams(preset() ? {preset: preset().name} : {});
  for (const [name, value] of Object.entries(request)) if (!(name in base) || queryText(value) !== queryText(base[name])) query.set(name, queryText(value));
  history.replaceState(null, "", `?${query}`);
}

function choosePreset(name) {
  $("preset").value = presets.some((p) => p.name === name) ? name : "";
  $("preset-note").textContent = preset()?.note ?? "";
  if (preset()) form.set(preset().parameters);
}

/** What the address asks for, or the paper's Fig. 3. */
function fromAddress() {
  const query = new URLSearchParams(location.search);
  const name = query.get("preset") ?? (query.size ? "" : "fig3");
  choosePreset(name);
  query.delete("preset");
  form.set({...preset()?.parameters, ...Object.fromEntries([...query].map(([key, text]) => [key, queryValue(text)]))});
}

async function start() {
  const [fields, list, version] = await Promise.all([get("v1/parameters"), get("v1/presets"), get("version")]);
  presets = list.presets;
  $("version").textContent = `vines ${version.version}`;
  form = new Form($("fields"), fields.fields);
  $("preset").append(new Option("own parameters", ""), ...presets.map((p) => new Option(`${p.source}: ${p.title}`, p.name)));
  fromAddress();
  $("preset").addEventListener("change", () => { choosePreset($("preset").value); if ($("preset").value) run(true); });
  $("form").addEventListener("submit", (event) => { event.preventDefault(); run(); });
  $("cancel").addEventListener("click", () => { running?.abort(); });
  $("copy").addEventListener("click", async () => {
    const command = `curl -s ${new URL("v1/simulate", location.href.split("?")[0])} -d '${JSON.stringify({...form.values(), include})}'`;
    try { await navigator.clipboard.writeText(command); say("copied"); } catch { say(command); }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  await run();
}

start().catch((error) => say(`the page could not start: ${error.message}`, true));

// The request: a preset (`name`, "" if none) and the given fields, which the service merges.
import {absoluteUrl, asCurl} from "../shared/api.js";
import {$, element, press, setTexts} from "../shared/dom.js";
import {isObject, isOfMotion, queryOf, resolved, textOf} from "../shared/form.js";
import {run} from "./run.js";
import {differenceText, parameterLine} from "./sliders.js";

export class Request {
  constructor(form, fields, presets) {
    Object.assign(this, {form, presets, name: ""});
    this.fieldOf = Object.fromEntries(fields.map((f) => [f.name, f]));
  }

  presetOf(name) {
    return this.presets.find((preset) => preset.name === name);
  }

  get preset() {
    return this.presetOf(this.name);
  }

  /** Selects a preset, or none, and sets fields. With neither, the values shown become given ones. */
  choose(name, fields) {
    const chosen = this.presetOf(name);
    this.form.set(fields ?? (chosen ? {} : this.givenValues()));
    this.form.unfold({...chosen?.parameters});
    this.name = chosen?.name ?? "";
  }

  /** The given fields, and those that the run shown has from its preset. */
  givenValues() {
    const {values, origins} = resolved(run?.answer.parameters ?? {});
    const isPresets = ([name]) => origins[name] === `preset ${this.name}`;
    const own = Object.entries(values).filter(isPresets);
    // An answer describes objects, such as a load, in other words.
    const objects = Object.entries(this.preset?.parameters ?? {}).filter(([, v]) => isObject(v));
    return {...Object.fromEntries([...own, ...objects]), ...this.form.values()};
  }

  /** The fields of a request and those of its preset. */
  merged({preset: name, ...fields}) {
    return {...this.presetOf(name)?.parameters, ...fields};
  }

  /** True when the motion, or the part of it that is analysed, is no longer that of the preset. */
  get edited() {
    const affectsResult = (name) => /^window|^max_imp/.test(name) || isOfMotion(this.fieldOf[name]);
    return Object.keys(this.givenFields()).some(affectsResult);
  }

  /** A request as text: its preset and the given fields of the motion. */
  describe({preset: name, ...given}, parameters) {
    const preset = this.presetOf(name);
    const names = Object.keys(given).filter((field) => isOfMotion(this.fieldOf[field]));
    if (!preset) return parameterLine(parameters);
    const source = preset.source.split(",")[0];
    return names.length ? `${source} with ${differenceText(names, parameters)}` : source;
  }

  /** The given fields; none if all of them have the preset's values. */
  givenFields() {
    const given = this.form.values();
    const own = this.preset?.parameters ?? {};
    const differs = ([name, value]) => !(name in own) || textOf(value) !== textOf(own[name]);
    return Object.entries(given).some(differs) ? given : {};
  }

  /** The fields to send: the preset's name and the given fields. */
  fields() {
    return {...(this.name && {preset: this.name}), ...this.givenFields()};
  }

  /** The preset and the given fields of the system and its initial state, without the run's. */
  systemOf(request) {
    const is = ([name]) => isOfMotion(this.fieldOf[name]) && this.fieldOf[name].group !== "run";
    return Object.fromEntries(Object.entries(request).filter(is));
  }

  /** Fills the form from a query; an empty one selects fig3. Returns the unknown names. */
  read(query) {
    const {preset: given, ...fields} = Object.fromEntries(new URLSearchParams(query));
    const named = given ?? (Object.keys(fields).length ? "" : "fig3");
    this.choose(named, this.form.parse(fields));
    const unknown = this.form.unknown(fields);
    return named && !this.name ? [`preset=${named}`, ...unknown] : unknown;
  }
}

/** A request as a query. Without fields it is `preset=`, because an empty query selects fig3. */
export const toQuery = (fields) => queryOf(fields) || "preset=";

// Presets: in a menu and as chips; and the plots that correspond to them.
const chips = document.querySelectorAll("#chips button");

/** choose(name) gets a preset's name, or "" for none; read(query) the query of a chip without one. */
export function start(presets, choose, read) {
  const menu = $("preset");
  for (const {name, source, title} of presets) menu.append(new Option(`${source}: ${title}`, name));
  menu.onchange = () => choose(menu.value);
  for (const chip of chips) {
    const {preset, query} = chip.dataset;
    if (preset) chip.title = menu.querySelector(`[value="${preset}"]`).text;
    chip.onclick = () => (preset ? choose(preset) : read(query));
  }
}

/** Selects the preset, and its chip unless the parameters were changed; own: a user's machine. */
export function markChip(name, changed, own) {
  $("preset").value = name;
  press(chips, ({dataset: {preset}}) => (preset ? preset === name && !changed : own));
}

/** Tags the plots of a preset, and links to one in the details if all of them are there. */
export function markPlots(preset) {
  const name = preset?.name.split("_")[0]; // rows of a table share their plots
  const source = preset?.source.split(",")[0];
  for (const figure of document.querySelectorAll("[data-of]")) {
    const isOf = figure.dataset.of.split(" ").includes(name);
    figure.classList.toggle("about", isOf);
    figure.querySelector(".tag")?.remove();
    if (isOf)
      figure.querySelector("figcaption").append(element("span", {className: "tag"}, source));
  }
  const own = [...document.querySelectorAll("figure.about")];
  const alone = own.length && own.every((figure) => figure.closest("#details"));
  $("to-details").href = alone ? `#${own[0].id}` : "#summary-title"; // a target inside opens them
  setTexts({"to-details": alone ? `${source} is below ▾` : "details ▾"});
}

/** A Python program for the request that needs only the standard library. */
const asPython = (path, fields) => `import json, urllib.request

request = json.loads(${JSON.stringify(JSON.stringify(fields))})
url = ${JSON.stringify(absoluteUrl(path))}
body = json.dumps(request).encode()
head = {"Content-Type": "application/json"}
with urllib.request.urlopen(urllib.request.Request(url, body, head)) as answer:
    result = json.load(answer)
print(result["exponents"].get("qr", {}).get("final"), result["regime"]["type"])
`;

/** A frame for another page, of a site that the service allows to embed it. */
function asFrame() {
  const address = new URL(location.href);
  address.searchParams.set("embed", "1");
  address.hash = "";
  return `<iframe src="${address}" width="800" height="600" allow="autoplay"></iframe>`;
}

/** Functions that return the text, by form. request() returns the fields of the request. */
export const formsOf = (path, request) => ({
  link: () => location.href,
  curl: () => asCurl({path, body: request()}),
  Python: () => asPython(path, {...request(), include: ["impacts", "exponents", "regime"]}),
  JSON: () => JSON.stringify(request(), null, 2),
  embed: asFrame,
});

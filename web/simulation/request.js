// The request of the form: which preset it stands on, what of it differs, and how an address says
// it.
import {textOf} from "../shared/form.js";
import {holding, isOfMotion, isOfSystem, queryText} from "../shared/presets.js";
import {differenceText, parameterLine} from "./sliders.js";

/** What a text of a query stands for: a list of lists, a list, or a text. */
function queryValue(text) {
  if (text.includes(";")) {
    const parts = text.split(";").filter((part) => part.trim());
    return parts.map(queryValue);
  }
  return text.includes(",") ? text.split(",") : text;
}

/** The entries of an object for which it holds. */
const only = (object, is) => Object.fromEntries(Object.entries(object).filter(is));

export class Request {
  /** form: the Form; fields: of /v1/parameters; presets: of /v1/presets. */
  constructor(form, fields, presets) {
    Object.assign(this, {form, presets, name: "", dampingChosen: false});
    this.fieldOf = Object.fromEntries(fields.map((f) => [f.name, f]));
  }

  get preset() {
    return this.presets.find((p) => p.name === this.name);
  }

  /**
   * The preset of a name, or none, and the fields given beside it; without both the form keeps what
   * it shows.
   */
  choose(name, fields) {
    this.name = this.presets.some((p) => p.name === name) ? name : "";
    this.dampingChosen = "damping" in {...fields};
    if (this.preset || fields) this.form.set({...this.held({...fields}), ...fields});
    this.greyOut();
  }

  leave() {
    this.name = "";
    this.greyOut();
  }

  /** Over a preset in SI a reduced field can be changed; a system of one's own is one or the other. */
  greyOut() {
    this.form.disable(this.preset ? [] : this.form.unmixable());
  }

  /** What of the preset holds beside a request's fields. */
  held(request) {
    return holding(this.preset?.parameters ?? {}, request, this.fieldOf);
  }

  /** The fields that are not the preset's. */
  differing(request) {
    const base = this.held(request);
    const differs = ([name, value]) =>
      !(name in base) || queryText(value) !== queryText(base[name]);
    return only(request, differs);
  }

  /** Whether the motion, or what is shown of it, is no more the preset's. */
  get edited() {
    const changed = this.differing(this.form.values());
    const isShown = (name) => /^window|^max_imp/.test(name) || isOfMotion(this.fieldOf[name]);
    return Object.keys(changed).some(isShown);
  }

  /** What a request that was asked stands on, and what of the motion differs from that, in words. */
  textOf({preset: name, ...differing}, parameters) {
    const preset = this.presets.find((p) => p.name === name);
    const names = Object.keys(differing).filter((field) => isOfMotion(this.fieldOf[field]));
    if (!preset) return parameterLine(parameters);
    const source = preset.source.split(",")[0];
    return names.length ? `${source} with ${differenceText(names, parameters)}` : source;
  }

  /**
   * A preset's name stands for its fields, so it does not fit a request that has emptied one of
   * them. A default is not in the request.
   */
  emptied(request) {
    return Object.entries(this.held(request)).some(
      ([name, value]) => !(name in request) && value !== this.fieldOf[name].default,
    );
  }

  /**
   * What to send: the preset's name in place of those values that are its own, so that one that
   * differs changes alone.
   */
  asked() {
    const request = this.form.values();
    if (this.preset && this.emptied(request)) this.leave();
    return this.preset ? {preset: this.name, ...this.differing(request)} : request;
  }

  /** Of a request what is the system's and its start; not how long it runs, or what is told. */
  systemOf(request) {
    const is = (field) => isOfMotion(field) && field.group !== "run";
    return only(request, ([name]) => is(this.fieldOf[name]));
  }

  /** Fills the form with a query; returns the names that are no fields. */
  read(query) {
    const rest = new URLSearchParams(query);
    const named = rest.get("preset") ?? (rest.size ? "" : "fig3");
    rest.delete("preset");
    const isKnown = ([name]) => this.form.inputs.has(name);
    const known = [...rest].filter(isKnown).map(([name, text]) => [name, queryValue(text)]);
    const unknown = [...rest].filter((entry) => !isKnown(entry)).map(([name]) => name);
    this.choose(named, Object.fromEntries(known));
    return named && !this.name ? [`preset=${named}`, ...unknown] : unknown;
  }

  /**
   * The damping of the paper's numbers and its windows go with its system: they make way for a
   * system of one's own, unless they were chosen. Returns what went, in words.
   */
  makeWay(base) {
    const {form} = this;
    const gone = [];
    const input = (name) => form.inputs.get(name);
    const standard = this.fieldOf.damping.default;
    if (!this.dampingChosen && input("damping").value !== standard) {
      form.replace("damping", standard);
      gone.push(`damping is ${standard}`);
    }
    for (const name of ["window", "windows"]) {
      if (!(name in base) || input(name).value !== textOf(base[name])) continue;
      form.replace(name, "");
      gone.push(`${name} is empty`);
    }
    return gone;
  }

  /**
   * Something was typed over a preset. Reduced fields over one in SI change it where it is: both
   * cannot be mixed. Returns what became of it, in words.
   */
  typedOver(name) {
    const {preset, form} = this;
    const base = preset?.parameters ?? {};
    const filled = form.filled(name);
    const own = preset && filled && isOfSystem(name);
    const gone = own ? this.makeWay(base) : [];
    const replaced = own && !("m1" in base && this.fieldOf[name].group === "reduced");
    if (replaced || (name in base && !filled)) this.name = "";
    this.greyOut();
    return replaced
      ? [`A system of your own, in place of ${preset.source}`, ...gone].join("; ")
      : "";
  }
}

/** A request as the address has it; that of defaults alone names no preset, and says so. */
export function toQuery(asked) {
  const entries = Object.entries(asked).map(([name, v]) => [name, queryText(v)]);
  return String(new URLSearchParams(entries.length ? entries : {preset: ""}));
}

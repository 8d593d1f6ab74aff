// The request of the form: its preset, the fields that differ from it, and its conversion to and
// from a query.
import {textOf} from "../shared/form.js";
import {isOfMotion, isOfSystem, queryText, validFields} from "../shared/presets.js";
import {differenceText, parameterLine} from "./sliders.js";

/** Parses a query text: a list of lists, a list, or a text. */
function queryValue(text) {
  if (text.includes(";")) {
    const parts = text.split(";").filter((part) => part.trim());
    return parts.map(queryValue);
  }
  return text.includes(",") ? text.split(",") : text;
}

/** The entries of an object that pass a test. */
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

  /** Selects a preset, or none, with further fields; without either, the form keeps its values. */
  choose(name, fields) {
    this.name = this.presets.some((p) => p.name === name) ? name : "";
    this.dampingChosen = "damping" in {...fields};
    if (this.preset || fields) this.form.set({...this.held({...fields}), ...fields});
    this.updateDisabled();
  }

  leave() {
    this.name = "";
    this.updateDisabled();
  }

  /** A preset in SI can be combined with reduced fields; a user-defined system cannot. */
  updateDisabled() {
    this.form.disable(this.preset ? [] : this.form.unmixable());
  }

  /** Fields of the preset that stay valid next to those of a request. */
  held(request) {
    return validFields(this.preset?.parameters ?? {}, request, this.fieldOf);
  }

  /** Fields that differ from the preset. */
  differing(request) {
    const base = this.held(request);
    const differs = ([name, value]) =>
      !(name in base) || queryText(value) !== queryText(base[name]);
    return only(request, differs);
  }

  /** True when the motion, or the part of it that is analysed, is no longer that of the preset. */
  get edited() {
    const changed = this.differing(this.form.values());
    const isShown = (name) => /^window|^max_imp/.test(name) || isOfMotion(this.fieldOf[name]);
    return Object.keys(changed).some(isShown);
  }

  /** A request as text: its preset and the differing fields of the motion. */
  textOf({preset: name, ...differing}, parameters) {
    const preset = this.presets.find((p) => p.name === name);
    const names = Object.keys(differing).filter((field) => isOfMotion(this.fieldOf[field]));
    if (!preset) return parameterLine(parameters);
    const source = preset.source.split(",")[0];
    return names.length ? `${source} with ${differenceText(names, parameters)}` : source;
  }

  /**
   * True when a field of the preset was emptied, so that its name no longer describes the request.
   * Defaults are not part of a request.
   */
  emptied(request) {
    return Object.entries(this.held(request)).some(
      ([name, value]) => !(name in request) && value !== this.fieldOf[name].default,
    );
  }

  /** The fields to send: the preset's name with the differing fields, or all fields. */
  fields() {
    const request = this.form.values();
    if (this.preset && this.emptied(request)) this.leave();
    return this.preset ? {preset: this.name, ...this.differing(request)} : request;
  }

  /** The fields of the system and its initial state, without the length and output of the run. */
  systemOf(request) {
    const is = (field) => isOfMotion(field) && field.group !== "run";
    return only(request, ([name]) => is(this.fieldOf[name]));
  }

  /** Fills the form from a query; returns the unknown names. */
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
   * The closed-form damping and the windows belong to the paper's system. They are reset for a
   * user-defined system, unless the user chose them. Returns the changes as text.
   */
  resetPaperFields(base) {
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
   * Handles a field edited over a preset. A field of the system replaces the preset, except a
   * reduced field over a preset in SI, which changes the preset's system. Returns the changes as
   * text.
   */
  fieldEdited(name) {
    const {preset, form} = this;
    const base = preset?.parameters ?? {};
    const filled = form.filled(name);
    const own = preset && filled && isOfSystem(name);
    const gone = own ? this.resetPaperFields(base) : [];
    const replaced = own && !("m1" in base && this.fieldOf[name].group === "reduced");
    if (replaced || (name in base && !filled)) this.name = "";
    this.updateDisabled();
    return replaced ? [`User-defined system in place of ${preset.source}`, ...gone].join("; ") : "";
  }
}

/** A request as a query; one of defaults only has an empty preset. */
export function toQuery(fields) {
  const entries = Object.entries(fields).map(([name, v]) => [name, queryText(v)]);
  return String(new URLSearchParams(entries.length ? entries : {preset: ""}));
}

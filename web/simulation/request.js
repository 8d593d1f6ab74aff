// The request of the form: its preset, the fields that differ from it, and its conversion to and
// from a query.
//
// `name` is the selected preset, "" if none. While a preset is selected, the request holds its name
// and the fields that differ from it. It is deselected when one of its fields is emptied, or when a
// field of the system is filled: the system is then user-defined. A reduced (dimensionless) field
// over a preset in SI is an exception: it only changes the preset's system.
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

  /** Selects a preset, or none, and sets further fields. Without either, the form is unchanged. */
  choose(name, fields) {
    this.name = this.presets.some((p) => p.name === name) ? name : "";
    this.dampingChosen = "damping" in {...fields};
    if (this.preset || fields) this.form.set({...this.presetFields({...fields}), ...fields});
    this.updateDisabled();
  }

  deselect() {
    this.name = "";
    this.updateDisabled();
  }

  /**
   * Disables fields that exclude each other (SI and reduced), unless a preset is selected: a preset
   * in SI can be combined with reduced fields.
   */
  updateDisabled() {
    this.form.disable(this.preset ? [] : this.form.unmixable());
  }

  /** Fields of the preset that stay valid next to those of a request. */
  presetFields(request) {
    return validFields(this.preset?.parameters ?? {}, request, this.fieldOf);
  }

  /** Fields that differ from the preset. */
  changedFields(request) {
    const base = this.presetFields(request);
    const differs = ([name, value]) =>
      !(name in base) || queryText(value) !== queryText(base[name]);
    return only(request, differs);
  }

  /** True when the motion, or the part of it that is analysed, is no longer that of the preset. */
  get edited() {
    const changed = this.changedFields(this.form.values());
    const affectsResult = (name) => /^window|^max_imp/.test(name) || isOfMotion(this.fieldOf[name]);
    return Object.keys(changed).some(affectsResult);
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
   * True when a field that the preset sets is empty, so that the preset's name no longer describes
   * the request. Fields with the default value do not count: a request leaves them out.
   */
  hasEmptiedField(request) {
    return Object.entries(this.presetFields(request)).some(
      ([name, value]) => !(name in request) && value !== this.fieldOf[name].default,
    );
  }

  /**
   * The fields to send: the preset's name with the differing fields, or all fields. Deselects a
   * preset of which a field is empty.
   */
  fields() {
    const request = this.form.values();
    if (this.preset && this.hasEmptiedField(request)) this.deselect();
    return this.preset ? {preset: this.name, ...this.changedFields(request)} : request;
  }

  /** The fields of the system and its initial state, without the length and output of the run. */
  systemOf(request) {
    const is = (field) => isOfMotion(field) && field.group !== "run";
    return only(request, ([name]) => is(this.fieldOf[name]));
  }

  /**
   * Fills the form from a query; an empty query selects fig3. Returns the unknown names, after
   * "preset=NAME" if that preset is unknown.
   */
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
   * user-defined system, unless the user chose them. Returns the changes as a list of texts.
   */
  resetPaperFields(base) {
    const {form} = this;
    const changes = [];
    const input = (name) => form.inputs.get(name);
    const standard = this.fieldOf.damping.default;
    if (!this.dampingChosen && input("damping").value !== standard) {
      form.replace("damping", standard);
      changes.push(`damping is ${standard}`);
    }
    for (const name of ["window", "windows"]) {
      if (!(name in base) || input(name).value !== textOf(base[name])) continue;
      form.replace(name, "");
      changes.push(`${name} is empty`);
    }
    return changes;
  }

  /**
   * Handles a field edited over a preset. A field of the system replaces the preset, except a
   * reduced field over a preset in SI, which changes the preset's system. Returns the changes as
   * text if the preset is replaced, otherwise "".
   */
  fieldEdited(name) {
    const {preset, form} = this;
    const base = preset?.parameters ?? {};
    const filled = form.filled(name);
    const definesSystem = preset && filled && isOfSystem(name);
    const changes = definesSystem ? this.resetPaperFields(base) : [];
    const isSI = "m1" in base;
    const replaced = definesSystem && !(isSI && this.fieldOf[name].group === "reduced");
    if (replaced || (name in base && !filled)) this.name = "";
    this.updateDisabled();
    if (!replaced) return "";
    return [`User-defined system in place of ${preset.source}`, ...changes].join("; ");
  }
}

/** A request as a query. Without fields it is `preset=`, because an empty query selects fig3. */
export function toQuery(fields) {
  const entries = Object.entries(fields).map(([name, v]) => [name, queryText(v)]);
  return String(new URLSearchParams(entries.length ? entries : {preset: ""}));
}

// The form, built from the field table of /v1/parameters. An empty input stands for the default
// that its placeholder shows.
import {element} from "./dom.js";
import {toNumber} from "./numbers.js";
import {originText, resolved, standing} from "./origins.js";
import {symbolOf} from "./quantities.js";
import {unitShown} from "./units.js";

// The groups of /v1/simulate: title, whether they are open at first, and what to know of them.
export const groups = {
  system: ["System", true],
  reduced: ["Reduced parameters", false],
  SI: [
    "SI parameters",
    false,
    "A system of your own: m1, F and f, and one of each pair between them.",
  ],
  start: ["Initial state", false],
  run: ["Run", true],
  output: ["Output", false],
};
// The preset has its own menu; the page needs every part that it draws, and shows no perturbed run.
const hidden = new Set(["preset", "include", "perturbation"]);

const isObject = (value) => typeof value === "object" && value !== null;

/** A value as a text that its input takes. */
export function textOf(value) {
  if (Array.isArray(value)) return value.map(textOf).join(isObject(value[0]) ? "; " : ", ");
  if (!isObject(value)) return String(value);
  return Object.entries(value)
    .map((pair) => pair.join("="))
    .join(", ");
}

/** What is said of names in the address that no field has. */
export const unknownText = (names) =>
  names.length
    ? `the address names what this page does not know: ${names.map((n) => `"${n}"`).join(", ")}`
    : "";

/** A text as JSON wants it; what cannot be a number is sent as text, for the service to refuse. */
const number = (text) => toNumber(text) ?? text.trim();
const interval = (text) => text.split(text.includes(";") ? ";" : ",").map(number);
function assignment(text) {
  const [name, value = ""] = text.split("=");
  return [name.trim(), number(value)];
}
const state = (text) =>
  text.includes("=") ? Object.fromEntries(text.split(",").map(assignment)) : text.trim();
const listOf = (read) => (text) =>
  text
    .split(";")
    .filter((part) => part.trim())
    .map(read);
export const defaultSet = "default set"; // of starts, in place of a list

// What fields of a type but a number have of their own. Those that are no texts: how their input is
// made, what it holds, undefined for the default, and how a value is set. Texts: how they are read,
// and what stands in an empty one.
const types = {
  choice: {
    wide: true,
    make: ({choices}) => element("select", {}, ...choices.map((c) => new Option(c))),
    get: ({value}, standard) => (value === standard ? undefined : value),
    set(input, value) {
      input.value = value;
    },
  },
  choices: {
    wide: true,
    make({choices}) {
      const boxOf = (value) => element("input", {type: "checkbox", value});
      const labels = choices.map((c) => element("label", {}, boxOf(c), c));
      return element("div", {className: "checks"}, ...labels);
    },
    get(input, standard) {
      const chosen = [...input.querySelectorAll("input:checked")].map((box) => box.value);
      return chosen.length === standard.length ? undefined : chosen;
    },
    set(input, chosen) {
      for (const box of input.querySelectorAll("input")) box.checked = chosen.includes(box.value);
    },
  },
  interval: {read: interval},
  intervals: {wide: true, read: listOf(interval), hint: "none; as a,b; c,d"},
  states: {
    wide: true,
    read: (text) => (text.trim() === defaultSet ? defaultSet : listOf(state)(text)),
    hint: "one; as x0=0.01; x0=0, y0=0.002",
  },
  text: {wide: true, read: (text) => text.trim()},
};
const typeOf = ({type}) => types[type] ?? {};

const textInput = (field) =>
  element("input", {type: "text", inputMode: typeOf(field).read ? "text" : "decimal"});

// Two ways to say the same: where one is filled the other follows from it.
const alternatives = Object.entries({...standing, cycles: "tau_end"});
const others = Object.fromEntries(
  alternatives.flatMap(([a, b]) => [
    [a, b],
    [b, a],
  ]),
);

function rounded(value) {
  if (Array.isArray(value)) return value.map(rounded);
  return typeof value === "number" ? Number(value.toPrecision(6)) : value;
}

const factorOf = ({unit, type}) => (type === "number" ? unitShown(unit).factor : 1);

/** A number times a factor, without the digits of rounding; what is no number stays as it is. */
const times = (value, factor) =>
  factor === 1 || value === "" || !Number.isFinite(Number(value))
    ? value
    : Number((value * factor).toPrecision(15));

/** On a small screen the groups are closed at first: what is looked at lies below them. */
const folded = matchMedia("(max-width: 700px)").matches;

export class Form {
  inputs = new Map();
  errors = new Map();
  rows = new Map();
  parts = new Map();
  exact = new Map(); // of numbers that are shown in other units: {text, value}
  replaced = [];

  /**
   * prefix: of the ids, where a page has several forms; grouped: the groups to show, as in
   * `groups`.
   */
  constructor(container, fields, {prefix = "", grouped = groups} = {}) {
    this.prefix = prefix;
    this.fields = fields.filter((f) => !hidden.has(f.name) && f.group in grouped);
    this.factors = new Map(fields.map((field) => [field.name, factorOf(field)]));
    for (const [group, [title, open, note = ""]] of Object.entries(grouped)) {
      const rows = this.fields.filter((f) => f.group === group).map((f) => this.row(f));
      const details = element(
        "details",
        {open: open && !folded, id: `${prefix}group-${group}`},
        element("summary", {}, title),
        element("p", {className: "note"}, note),
        element("div", {className: "grid"}, ...rows),
      );
      this.parts.set(group, details);
      container.append(details);
    }
    container.addEventListener("input", () => this.greyOut());
  }

  row(field) {
    const {name, type, minimum, maximum} = field;
    const {make = textInput, set, wide} = typeOf(field);
    const input = make(field);
    if (set) set(input, field.default);
    else input.placeholder = this.standardOf(field);
    const error = element("p", {className: "error", id: `${this.prefix}error-${name}`});
    input.setAttribute("aria-describedby", error.id);
    input.addEventListener("input", () => this.sayOrigin(name));
    const {unit} = unitShown(field.unit);
    const shownUnit = element("span", {className: "unit"}, unit && `, ${unit}`);
    const named = element("span", {}, symbolOf(name).replaceAll("_", " "), shownUnit);
    const ends = [minimum, maximum].map((v) => this.shown(name, v));
    const range = minimum === undefined ? "" : ` [${ends.join(" to ")}]`;
    const label = element(
      type === "choices" ? "div" : "label",
      {title: `${name}: ${field.description}${range}`},
      element("span", {className: "name"}, named, element("span", {className: "origin"})),
      input,
    );
    const width = wide && !field.narrow ? " wide" : "";
    const row = element("div", {className: `field field-${name}${width}`}, label, error);
    this.inputs.set(name, input);
    this.errors.set(name, error);
    this.rows.set(name, row);
    return row;
  }

  /** What an empty input stands for, before an answer tells. */
  standardOf(field) {
    const note = (field.default_note ?? "").split(":")[0];
    return note || textOf(this.shown(field.name, field.default ?? "")) || typeOf(field).hint || "";
  }

  /** A value as it is shown; what is no number stays as it is. */
  shown(name, value) {
    return times(value, this.factors.get(name));
  }

  /** A value is written to an input; the last digits that it does not show are kept. */
  write(name, value) {
    const text = textOf(this.shown(name, value));
    this.inputs.get(name).value = text;
    this.exact.set(name, {text, value});
  }

  /** What an input of text holds, typed for JSON; undefined where it is empty. */
  read(field) {
    const {name} = field;
    const {value: text} = this.inputs.get(name);
    const {read} = typeOf(field);
    if (!text.trim()) return undefined;
    if (read) return read(text);
    const exact = this.exact.get(name);
    if (exact?.text === text) return number(String(exact.value));
    return times(number(text), 1 / this.factors.get(name));
  }

  /** The fields that differ from their defaults, typed for JSON. */
  values() {
    const values = this.fields.map((field) => {
      const input = this.inputs.get(field.name);
      if (input.disabled) return [];
      const {get} = typeOf(field);
      return [field.name, get ? get(input, field.default) : this.read(field)];
    });
    return Object.fromEntries(values.filter(([, value]) => value !== undefined));
  }

  set(values) {
    for (const field of this.fields) {
      const {name} = field;
      const value = values[name];
      const {set} = typeOf(field);
      if (set) set(this.inputs.get(name), value ?? field.default);
      else this.write(name, value ?? "");
      if (value !== undefined && !folded) this.parts.get(field.group).open = true;
      this.sayOrigin(name);
    }
    this.greyOut();
    this.showErrors([]);
  }

  /**
   * Shows where each value comes from, and in what is empty the value itself. parameters: of an
   * answer.
   */
  showOrigins(parameters) {
    const {values, origins} = resolved(parameters);
    for (const field of this.fields) {
      const {name} = field;
      this.sayOrigin(name, origins[name]);
      if (typeOf(field).set) continue;
      const value = values[name];
      this.inputs.get(name).placeholder =
        value == null ? this.standardOf(field) : textOf(rounded(this.shown(name, value)));
    }
  }

  /** Without an origin: what is there now is not of the last answer. */
  sayOrigin(name, title = "") {
    const origin = this.rows.get(name).querySelector(".origin");
    Object.assign(origin, {textContent: originText(title), title});
  }

  /** The fields of these names and only these are set by something else. */
  disable(names) {
    this.replaced = names;
    this.greyOut();
  }

  /** Another value than the last answer's. */
  replace(name, value) {
    this.write(name, value);
    this.sayOrigin(name);
  }

  filled(name) {
    return Boolean(this.inputs.get(name)?.value?.trim());
  }

  /**
   * The empty fields that cannot be mixed with those that are filled, or named: a system is in SI
   * or reduced.
   */
  unmixable(named = []) {
    const of = (group) => this.fields.filter((f) => f.group === group).map((f) => f.name);
    const some = (group) => of(group).some((name) => this.filled(name) || named.includes(name));
    const si = some("SI");
    const reduced = some("reduced");
    return si === reduced ? [] : of(si ? "reduced" : "SI").filter((name) => !this.filled(name));
  }

  /** Greys out what something else sets, or what follows from another field. */
  greyOut() {
    for (const {name} of this.fields) {
      const other = others[name];
      const follows = this.filled(other) && !this.filled(name);
      const off = follows || [name, other].some((each) => this.replaced.includes(each));
      this.inputs.get(name).disabled = off;
      this.rows.get(name).classList.toggle("off", off);
    }
  }

  /**
   * Errors of a problem document at their fields; returns those that belong to none. lead: to the
   * first of them.
   */
  showErrors(errors, lead = true) {
    for (const {name} of this.fields) {
      this.errors.get(name).textContent = "";
      this.inputs.get(name).removeAttribute("aria-invalid");
    }
    const left = [];
    let first = null;
    for (const error of errors) {
      const name = error.pointer.split("/")[1];
      const place = this.errors.get(name);
      if (!place) {
        left.push(error);
        continue;
      }
      place.append(place.textContent && " ", error.detail);
      const input = this.inputs.get(name);
      input.setAttribute("aria-invalid", "true");
      input.closest("details").open = true;
      first ??= input;
    }
    if (lead) first?.focus();
    return left;
  }
}

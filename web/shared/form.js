// The form, built from the field table of /v1/parameters. An empty input stands for the default
// that its placeholder shows.
import {element} from "./dom.js";
import {toNumber} from "./numbers.js";
import {originText, resolved} from "./origins.js";
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
const wide = new Set(["choice", "choices", "intervals", "states", "text"]);
const hints = {intervals: "none; as a,b; c,d", states: "one; as x0=0.01; x0=0, y0=0.002"};

const isObject = (value) => typeof value === "object" && value !== null;
const assignments = (object) => Object.entries(object).map((pair) => pair.join("="));

/** A value as a text that its input takes. */
export function textOf(value) {
  if (Array.isArray(value))
    return isObject(value[0]) ? value.map(textOf).join("; ") : value.join(", ");
  return isObject(value) ? assignments(value).join(", ") : String(value);
}

/** A text as JSON wants it; what cannot be a number is sent as text, for the service to refuse. */
const number = (text) => toNumber(text) ?? text.trim();
const parts = (text) => text.split(";").filter((part) => part.trim());
const interval = (text) => text.split(",").map(number);
const intervals = (text) => parts(text).map(interval);
function assignment(text) {
  const [name, value = ""] = text.split("=");
  return [name.trim(), number(value)];
}
const state = (text) =>
  text.includes("=") ? Object.fromEntries(text.split(",").map(assignment)) : text.trim();
export const defaultSet = "default set"; // of starts, in place of a list
const states = (text) => (text.trim() === defaultSet ? defaultSet : parts(text).map(state));

// Two ways to say the same: where one is filled the other follows from it.
const alternatives = [
  ["k1", "f0"],
  ["c1", "damping_ratio"],
  ["m2", "mass_ratio"],
  ["x_dot0", "x_velocity0"],
  ["y_dot0", "y_velocity0"],
  ["tau_end", "cycles"],
];
const swapped = alternatives.map(([one, other]) => [other, one]);
const others = Object.fromEntries([...alternatives, ...swapped]);

function rounded(value) {
  if (Array.isArray(value)) return value.map(rounded);
  return typeof value === "number" ? Number(value.toPrecision(6)) : value;
}

const readers = {interval, intervals, states, text: (text) => text.trim()};

const factorOf = ({unit, type}) => (type === "number" ? unitShown(unit).factor : 1);

/** A number times a factor, without the digits of rounding. */
const times = (value, factor) => (factor === 1 ? value : Number((value * factor).toPrecision(15)));

/** The unit behind a field's name. */
function unitOf(field) {
  const {unit} = unitShown(field.unit);
  return unit && `, ${unit}`;
}

/** A field's name as one reads it. */
const labelOf = ({name}) => symbolOf(name).replaceAll("_", " ");

function menuInput(field) {
  const options = field.choices.map((c) => element("option", {value: c, textContent: c}));
  const input = element("select", {}, ...options);
  input.value = field.default;
  return input;
}

function checksInput(field) {
  const check = (c) => {
    const box = element("input", {type: "checkbox", value: c, checked: field.default.includes(c)});
    return element("label", {}, box, c);
  };
  return element("div", {className: "checks"}, ...field.choices.map(check));
}

function textInput(field) {
  return element("input", {type: "text", inputMode: readers[field.type] ? "text" : "decimal"});
}

const inputs = {choice: menuInput, choices: checksInput};

/** On a small screen the groups are closed at first: what is looked at lies below them. */
const folded = matchMedia("(max-width: 700px)").matches;

export class Form {
  /**
   * prefix: of the ids, where a page has several forms; grouped: the groups to show, as in
   * `groups`.
   */
  constructor(container, fields, {prefix = "", grouped = groups} = {}) {
    this.prefix = prefix;
    this.fields = fields.filter((f) => !hidden.has(f.name) && f.group in grouped);
    this.inputs = new Map();
    this.errors = new Map();
    this.rows = new Map();
    this.parts = new Map();
    this.origins = new Map();
    this.factors = new Map(fields.map((field) => [field.name, factorOf(field)]));
    this.exact = new Map(); // of numbers that are shown in other units: {text, value}
    this.replaced = [];
    for (const [group, [title, open, note = ""]] of Object.entries(grouped)) {
      const grid = element("div", {className: "grid"});
      for (const field of this.fields.filter((f) => f.group === group))
        grid.append(this.row(field));
      const id = `${prefix}group-${group}`;
      const summary = element("summary", {textContent: title});
      const remark = element("p", {className: "note", textContent: note});
      const details = element("details", {open: open && !folded, id}, summary, remark, grid);
      this.parts.set(group, details);
      container.append(details);
    }
    container.addEventListener("input", () => this.greyOut());
  }

  row(field) {
    const error = element("p", {className: "error", id: `${this.prefix}error-${field.name}`});
    const unit = element("span", {className: "unit", textContent: unitOf(field)});
    const origin = element("span", {className: "origin"});
    const named = element("span", {}, labelOf(field), unit);
    const name = element("span", {className: "name"}, named, origin);
    const input = (inputs[field.type] ?? textInput)(field);
    input.setAttribute("aria-describedby", error.id);
    input.addEventListener("input", () => this.forgetOrigin(field.name));
    const ends = [field.minimum, field.maximum].map((v) => this.shown(field.name, v));
    const range = field.minimum === undefined ? "" : ` [${ends.join(" to ")}]`;
    const title = `${field.name}: ${field.description}${range}`;
    const label = element(field.type === "choices" ? "div" : "label", {title}, name, input);
    const width = wide.has(field.type) && !field.narrow ? " wide" : "";
    if (input.type === "text") input.placeholder = this.standardOf(field);
    const row = element("div", {className: `field field-${field.name}${width}`}, label, error);
    this.inputs.set(field.name, input);
    this.origins.set(field.name, origin);
    this.errors.set(field.name, error);
    this.rows.set(field.name, row);
    return row;
  }

  /** What an empty input stands for, before an answer tells. */
  standardOf(field) {
    const note = (field.default_note ?? "").split(":")[0];
    return note || textOf(this.shown(field.name, field.default ?? "")) || hints[field.type] || "";
  }

  /** A value as it is shown; what is no number stays as it is. */
  shown(name, value) {
    const factor = this.factors.get(name);
    const isNumber = value !== "" && Number.isFinite(Number(value));
    return factor === 1 || !isNumber ? value : times(Number(value), factor);
  }

  /** A value is written to an input; the last digits that it does not show are kept. */
  write(name, value) {
    const text = textOf(this.shown(name, value));
    this.inputs.get(name).value = text;
    this.exact.set(name, {text, value});
  }

  /** What an input of text holds, typed for JSON. */
  read({name, type}) {
    const {value: text} = this.inputs.get(name);
    if (readers[type]) return readers[type](text);
    const factor = this.factors.get(name);
    const exact = this.exact.get(name);
    if (factor !== 1 && exact?.text === text) return number(String(exact.value));
    const value = number(text);
    return typeof value === "number" ? times(value, 1 / factor) : value;
  }

  /** The fields that differ from their defaults, typed for JSON. */
  values() {
    const values = {};
    for (const field of this.fields) {
      const input = this.inputs.get(field.name);
      if (input.disabled) continue;
      if (field.type === "choice") {
        if (input.value !== field.default) values[field.name] = input.value;
      } else if (field.type === "choices") {
        const chosen = [...input.querySelectorAll("input:checked")].map((box) => box.value);
        if (chosen.length !== field.default.length) values[field.name] = chosen;
      } else if (input.value.trim() !== "") {
        values[field.name] = this.read(field);
      }
    }
    return values;
  }

  set(values) {
    for (const field of this.fields) {
      const input = this.inputs.get(field.name);
      const value = values[field.name];
      if (field.type === "choice") {
        input.value = value ?? field.default;
      } else if (field.type === "choices") {
        for (const box of input.querySelectorAll("input"))
          box.checked = (value ?? field.default).includes(box.value);
      } else {
        this.write(field.name, value ?? "");
      }
      if (value !== undefined && !folded) this.parts.get(field.group).open = true;
    }
    for (const {name} of this.fields) this.forgetOrigin(name);
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
      const input = this.inputs.get(field.name);
      const origin = this.origins.get(field.name);
      const value = values[field.name];
      origin.textContent = originText(origins[field.name]);
      origin.title = origins[field.name] ?? "";
      if (input.type === "text")
        input.placeholder =
          value == null ? this.standardOf(field) : textOf(rounded(this.shown(field.name, value)));
    }
  }

  /** The fields of these names and only these are set by something else. */
  disable(names) {
    this.replaced = names;
    this.greyOut();
  }

  /** What is there now is not of the last answer. */
  forgetOrigin(name) {
    Object.assign(this.origins.get(name), {textContent: "", title: ""});
  }

  /** Another value than the last answer's. */
  replace(name, value) {
    this.write(name, value);
    this.forgetOrigin(name);
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
      const off =
        this.replaced.includes(name) ||
        (other && (this.replaced.includes(other) || (this.filled(other) && !this.filled(name))));
      this.inputs.get(name).disabled = Boolean(off);
      this.rows.get(name).classList.toggle("off", Boolean(off));
    }
  }

  /**
   * Errors of a problem document at their fields; returns those that belong to none. lead: to the
   * first of them.
   */
  showErrors(errors, lead = true) {
    for (const field of this.fields) {
      this.errors.get(field.name).textContent = "";
      this.inputs.get(field.name).removeAttribute("aria-invalid");
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
      place.textContent += (place.textContent ? " " : "") + error.detail;
      const input = this.inputs.get(name);
      input.setAttribute("aria-invalid", "true");
      input.closest("details").open = true;
      first ??= input;
    }
    if (lead) first?.focus?.();
    return left;
  }
}

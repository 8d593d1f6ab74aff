// The form, built from the field table of /v1/parameters. An empty input stands for the default that its placeholder shows.
import {element} from "./dom.js";

// The groups of /v1/simulate: title, and whether they are open at first.
export const groups = {
  system: ["System", true], reduced: ["Reduced parameters", false], SI: ["SI parameters", false],
  start: ["Initial state", false], run: ["Run", true], output: ["Output", false],
};
const hidden = new Set(["preset", "include"]);  // the preset has its own menu; the page needs every part that it draws
const wide = new Set(["choice", "choices", "intervals", "states", "text"]);
const hints = {intervals: "none; as a,b; c,d", states: "one; as x0=0.01; x0=0, y0=0.002"};

const isObject = (value) => typeof value === "object" && value !== null;
const show = (value) => !Array.isArray(value) ? isObject(value) ? Object.entries(value).map((pair) => pair.join("=")).join(", ") : String(value)
  : isObject(value[0]) ? value.map(show).join("; ") : value.join(", ");

/** A text as JSON wants it; what cannot be a number is sent as text, for the service to refuse. */
const number = (text) => text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : text.trim();
const interval = (text) => text.split(",").map(number);
const intervals = (text) => text.split(";").filter((part) => part.trim()).map(interval);
const state = (text) => text.includes("=") ? Object.fromEntries(text.split(",").map((part) => part.split("=")).map(([name, value = ""]) => [name.trim(), number(value)])) : text.trim();
const states = (text) => text.split(";").filter((part) => part.trim()).map(state);
const readers = {interval, intervals, states, text: (text) => text.trim()};

export class Form {
  /** prefix: of the ids, where a page has several forms; grouped: the groups to show, as in `groups`. */
  constructor(container, fields, {prefix = "", grouped = groups} = {}) {
    this.prefix = prefix;
    this.fields = fields.filter((f) => !hidden.has(f.name) && f.group in grouped);
    this.inputs = new Map();
    this.errors = new Map();
    this.rows = new Map();
    this.parts = new Map();
    for (const [group, [title, open]] of Object.entries(grouped)) {
      const grid = element("div", {className: "grid"});
      for (const field of this.fields.filter((f) => f.group === group)) grid.append(this.row(field));
      const details = element("details", {open, id: `${prefix}group-${group}`}, element("summary", {textContent: title}), grid);
      this.parts.set(group, details);
      container.append(details);
    }
  }

  row(field) {
    const error = element("p", {className: "error", id: `${this.prefix}error-${field.name}`});
    const unit = field.unit && field.unit !== "dimensionless" ? `, ${field.unit}` : "";
    const name = element("span", {}, field.name, element("span", {className: "unit", textContent: unit}));
    let input;
    if (field.type === "choice") {
      input = element("select", {}, ...field.choices.map((c) => element("option", {value: c, textContent: c})));
      input.value = field.default;
    } else if (field.type === "choices") {
      input = element("div", {className: "checks"}, ...field.choices.map((c) =>
        element("label", {}, element("input", {type: "checkbox", value: c, checked: field.default.includes(c)}), c)));
    } else {
      const placeholder = field.default_note || show(field.default ?? "") || hints[field.type] || "";
      input = element("input", {type: "text", inputMode: readers[field.type] ? "text" : "decimal", placeholder});
    }
    input.setAttribute("aria-describedby", error.id);
    const range = field.minimum === undefined ? "" : ` [${field.minimum} to ${field.maximum}]`;
    this.inputs.set(field.name, input);
    this.errors.set(field.name, error);
    const label = element(field.type === "choices" ? "div" : "label", {title: field.description + range}, name, input);
    const row = element("div", {className: `field${wide.has(field.type) && !field.narrow ? " wide" : ""}`}, label, error);
    this.rows.set(field.name, row);
    return row;
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
        values[field.name] = (readers[field.type] ?? number)(input.value);
      }
    }
    return values;
  }

  set(values) {
    for (const field of this.fields) {
      const input = this.inputs.get(field.name);
      const value = values[field.name];
      if (field.type === "choice") input.value = value ?? field.default;
      else if (field.type === "choices")
        for (const box of input.querySelectorAll("input")) box.checked = (value ?? field.default).includes(box.value);
      else input.value = value === undefined ? "" : show(value);
      if (value !== undefined) this.parts.get(field.group).open = true;
    }
    this.showErrors([]);
  }

  /** Greys out the fields of these names and only these: something else sets them. */
  disable(names) {
    for (const field of this.fields) {
      this.inputs.get(field.name).disabled = names.includes(field.name);
      this.rows.get(field.name).classList.toggle("off", names.includes(field.name));
    }
  }

  /** Errors of a problem document at their fields; returns those that belong to none. */
  showErrors(errors) {
    for (const field of this.fields) {
      this.errors.get(field.name).textContent = "";
      this.inputs.get(field.name).removeAttribute("aria-invalid");
    }
    const left = [];
    let first = null;
    for (const error of errors) {
      const name = error.pointer.split("/")[1];
      const place = this.errors.get(name);
      if (!place) { left.push(error); continue; }
      place.textContent += (place.textContent ? " " : "") + error.detail;
      const input = this.inputs.get(name);
      input.setAttribute("aria-invalid", "true");
      input.closest("details").open = true;
      first ??= input;
    }
    first?.focus?.();
    return left;
  }
}

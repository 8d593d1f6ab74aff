// The form, built from the field table of /v1/parameters. An empty input stands for the default that its placeholder shows.
import {element} from "./dom.js";

const groups = {
  system: ["System", true], reduced: ["Reduced parameters", false], SI: ["SI parameters", false],
  start: ["Initial state", false], run: ["Run", true], output: ["Output", false],
};
const hidden = new Set(["preset", "include"]);  // the preset has its own menu; the page needs every part that it draws
const wide = new Set(["choice", "choices", "intervals"]);

const show = (value) => !Array.isArray(value) ? String(value) : Array.isArray(value[0]) ? value.map(show).join("; ") : value.join(", ");

/** A text as JSON wants it; what cannot be a number is sent as text, for the service to refuse. */
const number = (text) => text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : text.trim();
const interval = (text) => text.split(",").map(number);
const intervals = (text) => text.split(";").filter((part) => part.trim()).map(interval);
const readers = {interval, intervals};

export class Form {
  constructor(container, fields) {
    this.fields = fields.filter((f) => !hidden.has(f.name));
    this.inputs = new Map();
    this.errors = new Map();
    for (const [group, [title, open]] of Object.entries(groups)) {
      const grid = element("div", {className: "grid"});
      for (const field of this.fields.filter((f) => f.group === group)) grid.append(this.row(field));
      const details = element("details", {open, id: `group-${group}`}, element("summary", {textContent: title}), grid);
      container.append(details);
    }
  }

  row(field) {
    const error = element("p", {className: "error", id: `error-${field.name}`});
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
      const placeholder = field.default_note || show(field.default ?? "") || (field.type === "intervals" ? "none; as a,b; c,d" : "");
      input = element("input", {type: "text", inputMode: readers[field.type] ? "text" : "decimal", placeholder});
    }
    input.setAttribute("aria-describedby", error.id);
    const range = field.minimum === undefined ? "" : ` [${field.minimum} to ${field.maximum}]`;
    this.inputs.set(field.name, input);
    this.errors.set(field.name, error);
    const label = element(field.type === "choices" ? "div" : "label", {title: field.description + range}, name, input);
    return element("div", {className: `field${wide.has(field.type) ? " wide" : ""}`}, label, error);
  }

  /** The fields that differ from their defaults, typed for JSON. */
  values() {
    const values = {};
    for (const field of this.fields) {
      const input = this.inputs.get(field.name);
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
      if (value !== undefined) document.getElementById(`group-${field.group}`).open = true;
    }
    this.showErrors([]);
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

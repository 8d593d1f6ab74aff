// The few parameters that one turns: a slider, a number and its unit each. What they set are fields
// of the form.
import {element} from "../shared/dom.js";
import {toNumber} from "../shared/numbers.js";

const mm = {unit: "mm", factor: 1000};
const zetaField = ({lambda, derived}, zeta) => (derived.zeta ? (lambda * zeta) / derived.zeta : 0);

// of(parameters): the value in the field's unit; fields(value, parameters): what it sets, null for
// what makes way; range: of the slider, in its unit, and where it depends on the system
// rangeOf(parameters); about: what it is.
const clearance = {name: "b", label: "Clearance", symbol: "b", ...mm, range: [1, 45]};
clearance.about = "half the free path of the mass";
const restitution = {
  name: "R",
  label: "Restitution",
  symbol: "R",
  range: [0, 1],
  about: "of both walls",
  of: ({R_plus: plus, R_minus: minus}) => (plus + minus) / 2,
  fields: (value) => ({R: value, R_plus: null, R_minus: null}),
};
const reduced = [
  clearance,
  restitution,
  {
    name: "G",
    label: "Forcing",
    symbol: "G",
    ...mm,
    range: [0, 40],
    about: "amplitude of the base over ε",
  },
  {
    name: "Omega",
    label: "Frequency",
    symbol: "Ω",
    range: [0.9, 1.1],
    about: "over the oscillator's own",
  },
  {
    name: "zeta",
    label: "Damping",
    symbol: "ζ",
    range: [0, 0.04],
    about: "ratio of the oscillator's damping",
    of: ({derived}) => derived.zeta,
    fields: (zeta, parameters) => ({lambda: zetaField(parameters, zeta)}),
    sets: "lambda",
  },
];
const si = [
  clearance,
  restitution,
  {
    name: "F",
    label: "Forcing",
    symbol: "F",
    ...mm,
    rangeOf: ({si: {F}}) => [0, 2500 * F || 1],
    about: "amplitude of the base",
    of: (p) => p.si.F,
  },
  {
    name: "f",
    label: "Frequency",
    symbol: "f",
    unit: "Hz",
    rangeOf: ({derived: {f0}}) => [0.9 * f0, 1.1 * f0],
    about: "of the base",
    of: (p) => p.si.f,
  },
  {
    name: "c1",
    label: "Damping",
    symbol: "c₁",
    unit: "N s/m",
    rangeOf: ({si: {c1}}) => [0, 3 * c1 || 1],
    about: "of the oscillator",
    of: (p) => p.si.c1,
    fields: (value) => ({c1: value, damping_ratio: null}),
  },
];
const slidersOf = (parameters) => (parameters.si ? si : reduced);

/** The slider of a name for a system. */
export const sliderOf = (name, parameters) =>
  slidersOf(parameters).find((slider) => slider.name === name) ?? clearance;
/** Its value in a system, in the slider's unit. */
export const valueAt = ({name, of, factor = 1}, parameters) =>
  factor * (of ? of(parameters) : parameters[name]);
/** The fields that it sets for a value in its unit. */
export function fieldsOf({name, fields, factor = 1}, value, parameters) {
  const inField = Number((value / factor).toPrecision(12));
  return fields ? fields(inField, parameters) : {[name]: inField};
}

/** A value in its unit: as its number shows it, or in more digits where that is not all of it. */
export function textAt(slider, parameters, range = rangeOf(slider, parameters)) {
  const value = valueAt(slider, parameters);
  const short = written(value, range);
  const exact = Math.abs(Number(short) - value) <= 1e-6 * Math.abs(value);
  return exact ? short : String(Number(value.toPrecision(4)));
}

/** [least, most] in the slider's unit; it holds the value. */
export function rangeOf(slider, parameters) {
  const value = valueAt(slider, parameters);
  const [least, most] = slider.rangeOf?.(parameters) ?? slider.range;
  if (value >= least && value <= most) return [least, most];
  if (slider.name === "R") return [0, 1];
  const power = 10 ** Math.floor(Math.log10(value || 1));
  return [0, Math.ceil((2 * value) / power) * power];
}

/** A value in the slider's unit as its number shows it: as many digits as its steps have. */
export function written(value, [least, most]) {
  const places = Math.max(0, 3 - Math.floor(Math.log10(most - least || 1)) - 1);
  return value.toFixed(Math.min(places, 8));
}

export class Sliders {
  /**
   * change(fields, slider, {hasty}): fields to set, null to empty one; hasty: more are to come.
   * refuse(text, slider): of what is no number.
   */
  constructor(container, {change, refuse}) {
    Object.assign(this, {container, change, refuse});
    this.kind = null;
    this.rows = new Map();
  }

  /** fresh: another system or run than one that was turned to; last: the slider turned last. */
  show(parameters, fresh, last) {
    this.parameters = parameters;
    const kind = slidersOf(parameters);
    if (this.kind !== kind) this.build(kind);
    for (const [slider, row] of this.rows) {
      this.set(slider, row, fresh);
      row.node.classList.toggle("last", slider === last);
    }
  }

  build(kind) {
    this.kind = kind;
    this.rows.clear();
    this.container.replaceChildren(...kind.map((slider) => this.row(slider)));
  }

  row(slider) {
    const {name, label, symbol, unit = "", about} = slider;
    const id = `slider-${name}`;
    const title = element("label", {htmlFor: id}, `${label} `, element("i", {textContent: symbol}));
    const number = element("input", {type: "text", inputMode: "decimal", id, autocomplete: "off"});
    const range = element("input", {type: "range", ariaLabel: `${label} ${symbol}`});
    const note = element("small", {textContent: about});
    const shownUnit = element("span", {className: "unit", textContent: unit});
    range.addEventListener("input", () => this.turned(slider, Number(range.value), true));
    range.addEventListener("change", () => this.turned(slider, Number(range.value), false));
    number.addEventListener("change", () => this.typed(slider, number));
    const node = element("div", {className: "slider"}, title, number, shownUnit, range, note);
    this.rows.set(slider, {node, number, range, note, span: null});
    return node;
  }

  set(slider, row, fresh) {
    const value = valueAt(slider, this.parameters);
    const inside = row.span && value >= row.span[0] && value <= row.span[1];
    if (fresh || !inside) row.span = rangeOf(slider, this.parameters);
    const [min, max] = row.span;
    Object.assign(row.range, {min, max, step: (max - min) / 1000});
    if (document.activeElement !== row.range || fresh) row.range.value = value;
    row.range.setAttribute("aria-valuetext", `${written(value, row.span)} ${slider.unit ?? ""}`);
    row.number.removeAttribute("aria-invalid");
    if (document.activeElement !== row.number || fresh)
      row.number.value = textAt(slider, this.parameters, row.span);
    if (slider === restitution) {
      const {R_plus: plus, R_minus: minus} = this.parameters;
      row.note.textContent =
        plus === minus ? slider.about : `mean of ${plus} at +b and ${minus} at −b`;
    }
  }

  turned(slider, value, hasty) {
    const row = this.rows.get(slider);
    const rounded = Number(written(value, row.span));
    row.number.value = written(value, row.span);
    this.apply(slider, rounded, hasty);
  }

  typed(slider, input) {
    const value = toNumber(input.value);
    input.toggleAttribute("aria-invalid", false);
    if (value === null) {
      input.setAttribute("aria-invalid", "true");
      return this.refuse(input.value, slider);
    }
    this.apply(slider, value, false);
  }

  /** value: in the slider's unit. */
  apply(slider, value, hasty) {
    this.change(fieldsOf(slider, value, this.parameters), slider, {hasty});
  }
}

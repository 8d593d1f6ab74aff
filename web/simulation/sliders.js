// The main parameters, each with a slider, a number and a unit. They set fields of the form.
import {$, attributes, element} from "../shared/dom.js";
import {inMm, short, shortTo, toNumber} from "../shared/numbers.js";
import {symbolOf} from "../shared/quantities.js";

/**
 * of(parameters): value in the field's unit; fields(value, parameters): fields to set, null to
 * clear one; rangeOf(parameters): in the slider's unit; about: description, or aboutOf(parameters)
 * where it depends on the system; textOf(parameters): the value as text.
 */
const slider = (name, label, about, more) => ({
  name,
  label,
  about,
  symbol: symbolOf(name),
  unit: "",
  factor: 1,
  of: (p) => p[name] ?? p.si[name],
  fields: (value) => ({[name]: value}),
  ...more,
});

const mm = {unit: "mm", factor: 1000};
/** zeta divided by lambda: eq. (3), or the paper's closed form. */
const zetaOver = ({epsilon, damping}) => (damping === "closed_form" ? epsilon : epsilon / 2);

const clearance = slider("b", "Clearance", "half-width of the cavity", {
  ...mm,
  rangeOf: () => [1, 45],
});
const restitution = slider("R", "Restitution", "of both walls", {
  rangeOf: () => [0, 1],
  of: ({R_plus: plus, R_minus: minus}) => (plus + minus) / 2,
  fields: (value) => ({R: value, R_plus: null, R_minus: null}),
  textOf: ({R_plus: plus, R_minus: minus}) =>
    plus !== minus && `R₊ = ${shortTo(4, plus)}, R₋ = ${shortTo(4, minus)}`,
  aboutOf(parameters) {
    const both = this.textOf(parameters);
    return both && `mean of ${both}`;
  },
});
const reduced = [
  clearance,
  restitution,
  slider("G", "Forcing", "amplitude of the base divided by ε", {...mm, rangeOf: () => [0, 40]}),
  slider("Omega", "Frequency", "relative to the natural frequency", {rangeOf: () => [0.9, 1.1]}),
  slider("zeta", "Damping", "damping ratio of the oscillator", {
    rangeOf: () => [0, 0.04],
    of: ({derived}) => derived.zeta,
    fields: (zeta, parameters) => ({lambda: zeta / zetaOver(parameters)}),
  }),
];
const si = [
  clearance,
  restitution,
  slider("F", "Forcing", "amplitude of the base", {
    ...mm,
    rangeOf: ({si: {F}}) => [0, 2500 * F || 1],
  }),
  slider("f", "Frequency", "of the base", {
    unit: "Hz",
    rangeOf: ({derived: {f0}}) => [0.9 * f0, 1.1 * f0],
  }),
  slider("c1", "Damping", "of the oscillator", {
    unit: "N s/m",
    rangeOf: ({si: {c1}}) => [0, 3 * c1 || 1],
    fields: (value) => ({c1: value, damping_ratio: null}),
  }),
];
const slidersOf = (parameters) => (parameters.si ? si : reduced);

/** A slider by name; clearance if the system has none of that name. */
export const sliderOf = (name, parameters) =>
  slidersOf(parameters).find((s) => s.name === name) ?? clearance;
/** The value in the slider's unit. */
export const valueAt = ({of, factor}, parameters) => factor * of(parameters);
/** Fields to set for a value in the slider's unit. */
export const fieldsOf = ({fields, factor}, value, parameters) =>
  fields(Number((value / factor).toPrecision(12)), parameters);

const holds = ([least, most], value) => value >= least && value <= most;

/** [least, most] in the slider's unit; extended if it does not contain the value. */
function rangeOf({rangeOf: usual, ...rest}, parameters) {
  const value = valueAt(rest, parameters);
  const range = usual(parameters);
  if (holds(range, value)) return range;
  const power = 10 ** Math.floor(Math.log10(value || 1));
  return [0, Math.ceil((2 * value) / power) * power];
}

/** A value in the slider's unit, with the digits of its steps. */
export function written(value, [least, most]) {
  const places = 2 - Math.floor(Math.log10(most - least || 1));
  return value.toFixed(Math.min(Math.max(places, 0), 8));
}

/** A value in its unit, with further digits if it lies between steps. */
function textAt(one, parameters, range = rangeOf(one, parameters)) {
  const value = valueAt(one, parameters);
  const short = written(value, range);
  const exact = Math.abs(Number(short) - value) <= 1e-6 * Math.abs(value);
  if (exact) return short;
  const fine = 1e-4 * (range[1] - range[0]); // a tenth of a step
  const four = Number(value.toPrecision(4));
  return String(Math.abs(four - value) <= fine ? four : Number(value.toPrecision(6)));
}

/** A value as text, for example b = 22.0 mm; both values of differing walls. */
export const valueText = (one, parameters) =>
  one.textOf?.(parameters) || `${one.symbol} = ${textAt(one, parameters)} ${one.unit}`.trim();

/** Changed fields as text; sliders with their values. */
export function differenceText(names, parameters) {
  const setBy = (name) => slidersOf(parameters).find((s) => name in s.fields(0, parameters));
  const text = (name) =>
    setBy(name) ? valueText(setBy(name), parameters) : `changed ${symbolOf(name)}`;
  return [...new Set(names.map(text))].join(", ");
}

/** The main parameters as text, and the initial state if it was given. */
export function parameterLine(parameters) {
  const values = slidersOf(parameters).map((one) => valueText(one, parameters));
  const isOwn = (name) => parameters.origin[name] !== "default";
  const start = ["x0", "x_dot0", "y0", "y_dot0"].filter(isOwn);
  return [...values, ...start.map((name) => `${symbolOf(name)} = ${inMm(parameters[name])}`)].join(
    ", ",
  );
}

const rows = new Map(); // {node, number, range, note, span} of each slider
let shown; // parameters
let handlers; // of start()

/** The current range of a slider. */
export const spanOf = (one) => rows.get(one).span;

/**
 * changed(fields, slider, dragging): fields to set, null to clear one; dragging: it is being
 * dragged. refused(text, slider): the text is no number; typed(differs): while typing, whether the
 * number differs from the one shown.
 */
export function start(changed, refused, typed) {
  handlers = {changed, refused, typed};
}

/**
 * fresh: the run was not reached with a slider; dragged: ranges stay unchanged; last: the slider
 * moved last.
 */
export function show(parameters, {fresh, dragged}, last) {
  shown = parameters;
  const kind = slidersOf(parameters);
  if (!kind.every((one) => rows.has(one))) {
    rows.clear();
    $("sliders").replaceChildren(...kind.map(rowOf));
  }
  for (const [one, row] of rows) {
    set(one, row, fresh, dragged);
    row.node.classList.toggle("last", one === last);
  }
}

function rowOf(one) {
  const {label, symbol} = one;
  const id = `slider-${one.name}`;
  const title = element("label", {htmlFor: id}, `${label} `, element("i", {textContent: symbol}));
  const number = element("input", {
    type: "text",
    inputMode: "decimal",
    id,
    autocomplete: "off",
    onchange: () => typed(one, number),
    oninput: () => handlers.typed(number.value !== number.defaultValue),
    onblur: () => handlers.typed(number.matches("[aria-invalid=true]")),
  });
  const range = element("input", {
    type: "range",
    ariaLabel: `${label} ${symbol}`,
    oninput: () => moveSlider(one, Number(range.value), true),
    onchange: () => moveSlider(one, Number(range.value), false),
  });
  const note = element("small");
  title.title = one.about;
  const unit = element("span", {className: "unit", textContent: one.unit});
  const node = element("div", {className: "slider"}, title, number, unit, range, note);
  rows.set(one, {node, number, range, note, span: null});
  return node;
}

function set(one, row, fresh, dragged) {
  const {number, range} = row;
  const value = valueAt(one, shown);
  if (!dragged || !row.span || !holds(row.span, value)) row.span = rangeOf(one, shown);
  const [min, max] = row.span;
  const put = (input, text) => {
    if (fresh || document.activeElement !== input) input.value = text;
  };
  Object.assign(range, {min, max, step: (max - min) / 1000});
  put(range, value);
  attributes(range, {"aria-valuetext": `${written(value, row.span)} ${one.unit}`});
  attributes(number, {"aria-invalid": false});
  number.defaultValue = textAt(one, shown, row.span);
  put(number, number.defaultValue);
  row.note.textContent = one.aboutOf?.(shown) || one.about;
}

/** Marks sliders with invalid values; returns messages in their units. */
export function showErrors(errors) {
  const of = ({pointer}) => [...rows].find(([one]) => one.name === pointer.slice(1));
  return errors.filter(of).map((error) => {
    const [{label, name, unit, factor}, {number}] = of(error);
    attributes(number, {"aria-invalid": true});
    const ends = error.range?.map((v) => short(v * factor)).join(" to ");
    const range = ends ? `${name} must lie in ${ends} ${unit}`.trim() : error.detail;
    return `${label} “${number.value}”: ${range}`;
  });
}

/** Sets a slider to a value, rounded as its number shows it. */
export function moveSlider(one, value, dragging) {
  const {number, span} = rows.get(one);
  number.value = written(value, span);
  apply(one, Number(number.value), dragging);
}

function typed(one, input) {
  const value = toNumber(input.value);
  attributes(input, {"aria-invalid": value === null});
  if (value === null) handlers.refused(input.value, one);
  else apply(one, value, false);
}

function apply(one, value, dragging) {
  handlers.changed(fieldsOf(one, value, shown), one, dragging);
}

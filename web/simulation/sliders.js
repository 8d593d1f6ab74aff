// The main parameters, each with a slider, a number and a unit. They set fields of the form.
import {$, attributes} from "../shared/dom.js";
import {lawsInSi} from "../shared/form.js";
import {inMm, short, shortTo, toNumber} from "../shared/numbers.js";
import {symbolOf} from "../shared/quantities.js";

const factors = {mm: 1000, "°": 180 / Math.PI};

/**
 * A slider, whose row is in the page. It has of(parameters): value in the field's unit;
 * fields(value, parameters): fields to set, null to clear one; usualRange(parameters): in the
 * slider's unit; textOf(parameters): the values as text, if the walls differ; isShown(parameters):
 * false where the system does without. span: the range shown.
 */
function slider(name, more) {
  const number = $(`slider-${name}`);
  const node = number.parentNode;
  const [heading, , {textContent: unit}, range] = node.children;
  const [label] = heading.textContent.split(" ");
  return {
    ...{name, unit, node, number, range, label},
    symbol: symbolOf(name),
    factor: factors[unit] ?? 1,
    of: (p) => p[name] ?? p.si[name],
    fields: (value) => ({[name]: value}),
    ...more,
  };
}

const clearance = slider("b", {usualRange: () => [1, 45]});
const restitution = slider("R", {
  usualRange: () => [0, 1],
  of: ({R_plus: plus, R_minus: minus}) => (plus + minus) / 2,
  fields: (value) => ({R: value, R_plus: null, R_minus: null}),
  textOf: ({R_plus: plus, R_minus: minus}) =>
    plus !== minus && `R₊ = ${shortTo(4, plus)}, R₋ = ${shortTo(4, minus)}`,
});
const isGiven = (name) => (p) => p[name] !== 0 || p.origin[name] === "given";
const reduced = [
  clearance,
  restitution,
  slider("G", {usualRange: () => [0, 40]}),
  slider("Omega", {usualRange: () => [0.9, 1.1]}),
  slider("zeta", {
    usualRange: () => [0, 0.04],
    of: ({derived}) => derived.zeta,
    // The law, eq. (3) or closed form, is given too: a changed lambda would leave the preset's.
    fields: (zeta, {epsilon, damping}) => ({
      lambda: zeta / (damping === "closed_form" ? epsilon : epsilon / 2),
      damping,
    }),
  }),
  slider("gravity", {
    isShown: isGiven("gravity"),
    usualRange: ({gravity}) => [-1, 1].map((sign) => sign * (2000 * Math.abs(gravity) || 10)),
  }),
  slider("friction", {
    isShown: isGiven("friction"),
    usualRange: ({friction}) => [0, 2000 * friction || 10],
  }),
];
const isHarmonic = ({forcing}) => !forcing;
const si = [
  clearance,
  restitution,
  slider("F", {
    isShown: isHarmonic,
    usualRange: ({si: {F}}) => [0, 2500 * F || 1],
  }),
  slider("f", {
    isShown: isHarmonic,
    usualRange: ({derived: {f0}}) => [0.9 * f0, 1.1 * f0],
  }),
  slider("c1", {
    usualRange: ({si: {c1}}) => [0, 3 * c1 || 1],
    fields: (value) => ({c1: value, damping_ratio: null}),
  }),
  slider("inclination", {
    isShown: isGiven("gravity"),
    usualRange: () => [-90, 90],
    of: (p) => lawsInSi(p).inclination ?? 0,
    fields: (value) => ({inclination: value, gravity: null}),
  }),
  slider("mu", {
    isShown: isGiven("friction"),
    usualRange: (p) => [0, Math.max(1, 2 * lawsInSi(p).mu)],
    of: (p) => lawsInSi(p).mu ?? 0,
    fields: (value) => ({mu: value, friction: null}),
  }),
];
const all = new Set([...reduced, ...si]);
const slidersOf = (parameters) =>
  (parameters.si ? si : reduced).filter(({isShown}) => isShown?.(parameters) ?? true);

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
function rangeOf(one, parameters) {
  const value = valueAt(one, parameters);
  const range = one.usualRange(parameters);
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
  const text = (name) => `${symbolOf(name)} = ${inMm(parameters[name])}`;
  const start = ["x0", "x_dot0", "y0", "y_dot0"].filter(isOwn).map(text);
  return [...values, ...start].join(", ");
}

let shown = null; // parameters
let tab; // of start()

/** its: the tab, which has sliderMoved(), sliderRefused() and mark(). */
export function start(its) {
  tab = its;
  for (const one of all) {
    const {number, range} = one;
    Object.assign(number, {
      onchange() {
        const value = toNumber(number.value);
        attributes(number, {"aria-invalid": value === null});
        if (value === null) tab.sliderRefused(one);
        else apply(one, value, false);
      },
      oninput: () => tab.mark(number.value !== number.defaultValue),
      onblur: () => tab.mark(number.matches("[aria-invalid=true]")),
    });
    range.oninput = () => moveSlider(one, Number(range.value), true);
    range.onchange = () => moveSlider(one, Number(range.value), false);
  }
}

/** fresh: not reached with a slider; dragged: ranges stay; last: the slider moved last. */
export function show(parameters, {fresh, dragged}, last) {
  shown = parameters;
  $("sliders").inert = false;
  const kind = slidersOf(parameters);
  for (const one of all) {
    one.node.hidden = !kind.includes(one);
    one.node.classList.toggle("last", one === last);
  }
  for (const one of kind) set(one, fresh, dragged);
}

function set(one, fresh, dragged) {
  const {number, range} = one;
  const value = valueAt(one, shown);
  if (!dragged || !one.span || !holds(one.span, value)) one.span = rangeOf(one, shown);
  const [min, max] = one.span;
  const put = (input, text) => {
    if (fresh || document.activeElement !== input) input.value = text;
  };
  Object.assign(range, {min, max, step: (max - min) / 1000});
  put(range, value);
  attributes(range, {"aria-valuetext": `${written(value, one.span)} ${one.unit}`});
  attributes(number, {"aria-invalid": false});
  number.defaultValue = textAt(one, shown, one.span);
  put(number, number.defaultValue);
}

/** Marks sliders with invalid values; returns messages in their units. */
export function showErrors(errors) {
  const sliders = shown ? slidersOf(shown) : [];
  const of = ({pointer}) => sliders.find(({name}) => name === pointer.slice(1));
  return errors.filter(of).map((error) => {
    const {label, name, unit, factor, number} = of(error);
    attributes(number, {"aria-invalid": true});
    const ends = error.range?.map((v) => short(v * factor)).join(" to ");
    const range = ends ? `${name} must lie in ${ends} ${unit}`.trim() : error.detail;
    return `${label} “${number.value}”: ${range}`;
  });
}

/** Sets a slider to a value, rounded as its number shows it. */
export function moveSlider(one, value, dragging) {
  one.number.value = written(value, one.span);
  apply(one, Number(one.number.value), dragging);
}

function apply(one, value, dragging) {
  tab.sliderMoved(fieldsOf(one, value, shown), one, dragging);
}

// Texts for the axes of a sweep and for values on them. Lengths are in mm.
import {textOf} from "../shared/form.js";
import {symbolOf} from "../shared/quantities.js";
import {unitShown} from "../shared/units.js";

/** unitOf(parameter) returns the service's unit. */
export class AxisLabels {
  constructor(unitOf) {
    this.of = (parameter) => ({symbol: symbolOf(parameter), ...unitShown(unitOf(parameter))});
  }

  /** Name with unit, for example "b (mm)". */
  label(parameter) {
    const {symbol, unit} = this.of(parameter);
    return unit ? `${symbol} (${unit})` : symbol;
  }

  /** A value of a parameter in the unit shown. */
  number(parameter, value) {
    return Number((value * this.of(parameter).factor).toPrecision(12));
  }

  /** The value as text, six digits. */
  text(parameter, value) {
    return String(Number(this.number(parameter, value).toPrecision(6)));
  }

  /** The value with its unit; anything but a number is returned as text. */
  value(parameter, value) {
    if (typeof value !== "number") return textOf(value);
    const {unit} = this.of(parameter);
    return `${this.text(parameter, value)}${unit && ` ${unit}`}`;
  }

  /** [name, value] of a place on an axis. */
  place({parameter}, value) {
    return [symbolOf(parameter), this.value(parameter, value)];
  }

  /** Fields as text, for example "b = 15 mm, R = 0.6". */
  fields(values) {
    return Object.entries(values)
      .map(([parameter, value]) => `${symbolOf(parameter)} = ${this.value(parameter, value)}`)
      .join(", ");
  }

  /** A function that names values of the axis removed by a reduction; null without one. */
  where({reduced}) {
    return reduced && ((value) => this.fields({[reduced]: value}));
  }

  /** The x or y of a Frame for an axis, of which `view` is visible. */
  frameAxis({parameter, log, from}, view) {
    const {factor} = this.of(parameter);
    return {range: view.map(from), log, label: this.label(parameter), factor};
  }
}

/** Note that a simulation does not start from the neighbour's final state as the sweep did. */
export const startNote = ({carried}) => (carried ? ", not from its neighbour's final state" : "");

/** True when a visible range of one axis is meaningful on the other. */
export const sameAxis = (one, other) => one.parameter === other?.parameter && one.log === other.log;

const turns = ["0", "π/2", "π", "3π/2", "2π"];
/** Labels of a phase axis at quarter turns. */
export const phaseLabels = (min, max) =>
  turns
    .map((text, i) => ({at: (i * Math.PI) / 2, text}))
    .filter(({at}) => at >= min - 1e-9 && at <= max + 1e-9);

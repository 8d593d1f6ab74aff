// How the axes of a sweep, and the places on them, are named. Lengths are in mm.
import {textOf} from "../shared/form.js";
import {symbolOf} from "../shared/quantities.js";
import {unitShown} from "../shared/units.js";

/** unitOf(parameter): the service's unit of it. */
export class Naming {
  constructor(unitOf) {
    this.of = (parameter) => ({symbol: symbolOf(parameter), ...unitShown(unitOf(parameter))});
  }

  /** As in "b (mm)". */
  label(parameter) {
    const {symbol, unit} = this.of(parameter);
    return unit ? `${symbol} (${unit})` : symbol;
  }

  /** A value of a parameter in the unit that is shown. */
  number(parameter, value) {
    return Number((value * this.of(parameter).factor).toPrecision(12));
  }

  /** The same as a text, with six digits. */
  text(parameter, value) {
    return String(Number(this.number(parameter, value).toPrecision(6)));
  }

  /** With its unit; what is no number as it is. */
  value(parameter, value) {
    if (typeof value !== "number") return textOf(value);
    const {unit} = this.of(parameter);
    return `${this.text(parameter, value)}${unit && ` ${unit}`}`;
  }

  /** A place on an axis in words: [term, value]. */
  place({parameter}, value) {
    return [symbolOf(parameter), this.value(parameter, value)];
  }

  /** Fields in words, as in "b = 15 mm, R = 0.6". */
  fields(values) {
    return Object.entries(values)
      .map(([parameter, value]) => `${symbolOf(parameter)} = ${this.value(parameter, value)}`)
      .join(", ");
  }

  /** What names a value of the axis that is folded; null where none is. */
  where({reduced}) {
    return reduced && ((value) => this.fields({[reduced]: value}));
  }

  /** The x or y of a Frame over an axis, of which `view` is to be seen. */
  frameAxis({parameter, log, from}, view) {
    const {factor} = this.of(parameter);
    return {range: view.map(from), log, label: this.label(parameter), factor};
  }
}

/** How a point that is simulated alone differs from that of the sweep. */
export const afresh = ({carried}) =>
  carried ? ", afresh: not from its neighbour's last state" : "";

/** Whether what is in view of one axis means the same on the other. */
export const sameAxis = (one, other) => one.parameter === other?.parameter && one.log === other.log;

const turns = ["0", "π/2", "π", "3π/2", "2π"];
/** Labels of a phase. */
export const quarters = (min, max) =>
  turns
    .map((text, i) => ({at: (i * Math.PI) / 2, text}))
    .filter(({at}) => at >= min - 1e-9 && at <= max + 1e-9);

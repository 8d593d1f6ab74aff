// Texts for the axes of a sweep and for values on them. Lengths are in mm.
import {textOf} from "../shared/form.js";
import {symbolOf} from "../shared/quantities.js";
import {unitShown} from "../shared/units.js";

let units = new Map(); // of the service, by parameter

/** Takes the units from the service's fields. */
export function useFields(fields) {
  units = new Map(fields.map(({name, unit}) => [name, unit]));
}

/** {symbol, unit, factor} of a parameter. */
export const of = (parameter) => ({
  symbol: symbolOf(parameter),
  ...unitShown(units.get(parameter)),
});

/** Name with unit, for example "b (mm)". */
export function label(parameter) {
  const {symbol, unit} = of(parameter);
  return unit ? `${symbol} (${unit})` : symbol;
}

/** A value of a parameter in the unit shown. */
export const number = (parameter, value) => Number((value * of(parameter).factor).toPrecision(12));

/** The value as text, six digits. */
export const text = (parameter, value) => String(Number(number(parameter, value).toPrecision(6)));

/** The value with its unit; anything but a number is returned as text. */
export function valueText(parameter, value) {
  if (typeof value !== "number") return textOf(value);
  const {unit} = of(parameter);
  return `${text(parameter, value)}${unit && ` ${unit}`}`;
}

/** [name, value] of a place on an axis. */
export const place = ({parameter}, value) => [symbolOf(parameter), valueText(parameter, value)];

/** Fields as text, for example "b = 15 mm, R = 0.6". */
export const fields = (values) =>
  Object.entries(values)
    .map(([parameter, value]) => `${symbolOf(parameter)} = ${valueText(parameter, value)}`)
    .join(", ");

/** A function that names values of the axis removed by a reduction; null without one. */
export const where = ({reduced}) => reduced && ((value) => fields({[reduced]: value}));

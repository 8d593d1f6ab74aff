// Conversions between numbers and texts.
import {bisectRight} from "d3-array";

/** Limits a value to [least, most]. */
export const clamp = (value, least, most) => Math.min(Math.max(value, least), most);

/** A range with digits for about a ten-thousandth of its width. */
export function roundedRange([from, to]) {
  const places = clamp(4 - Math.floor(Math.log10(to - from)), 0, 15);
  return [from, to].map((v) => Number(v.toFixed(places)));
}

export const minus = (text) => text.replace("-", "−");

/** Wraps a formatter: a missing value becomes a dash. */
export const orDash =
  (text) =>
  (value, ...more) =>
    value == null ? "–" : minus(text(value, ...more));

const isSmall = (value) => value !== 0 && Math.abs(value) < 1e-3;

/** At most five digits. */
export const short = orDash((value) =>
  isSmall(value) || Math.abs(value) >= 1e5
    ? value.toExponential(2).replace(/\.?0+e\+?/, "e")
    : String(Number(value.toPrecision(5))),
);

/** At most n digits. */
export const shortTo = (n, value) => short(value == null ? value : Number(value.toPrecision(n)));

/** Lengths in m as mm. */
export const mm = (metres) => metres.map((v) => v && v * 1000);

/** A length in m as text in mm, with n digits. */
export const inMm = (metres, n = 4) =>
  metres == null ? short(metres) : `${shortTo(n, metres * 1000)} mm`;

/** n decimals, or three significant digits where those would show zeros only. */
export const digits = orDash((v, n = 4) => (isSmall(v) ? v.toExponential(2) : v.toFixed(n)));

/** A value with its error, to two digits of the error. */
export const withError = orDash((value, error, n) => {
  if (!error) return digits(value, n);
  const places = clamp(1 - Math.floor(Math.log10(error)), 0, 12);
  return `${value.toFixed(places).replace(/^-(0\.?0*)$/, "$1")} ± ${error.toFixed(places)}`;
});

export const percent = orDash(
  (value) => `${(value * 100).toFixed(value < 0.1 && value >= 0.0005 ? 1 : 0)} %`,
);

/** The parts of a text that are not empty, joined. */
export const joined = (parts, separator = ", ") => parts.filter(Boolean).join(separator);

/** A count with its noun: 1 impact, 2 impacts. */
export const count = (n, noun) => `${n} ${noun}${Number(n) === 1 ? "" : "s"}`;

/** Parses a number with a decimal point or comma; null if it is none. */
export function toNumber(text) {
  const written = text.trim().replace(/^([-+]?\d*),(\d+(?:e[-+]?\d+)?)$/i, "$1.$2");
  const value = Number(written.replace("−", "-"));
  return written !== "" && Number.isFinite(value) ? value : null;
}

/** The last index of ascending values whose value is at most `value`; -1 if there is none. */
export const lastUpTo = (values, value) => bisectRight(values, value) - 1;

// Numbers as texts, and texts as numbers.

/** A value, or the end of a range that it is beyond. */
export const clamp = (value, least, most) => Math.min(Math.max(value, least), most);

export const minus = (text) => text.replace("-", "−");

function plain(value) {
  const far = Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3);
  if (far) return value.toExponential(2).replace(/\.?0+e\+?/, "e");
  return Number(value.toPrecision(5)).toString();
}
/** Five digits at most. */
export const short = (value) => (value == null ? "–" : minus(plain(value)));

/** The same with n digits at most. */
export const shortTo = (n, value) => short(value == null ? value : Number(value.toPrecision(n)));

/** A length in m as one reads it, with n digits. */
export const inMm = (metres, n = 4) =>
  metres == null ? short(metres) : `${shortTo(n, metres * 1000)} mm`;

/** n digits behind the point, or three in all where that would show none. */
export function digits(value, n = 4) {
  if (value == null) return "–";
  const small = Math.abs(value) < 1e-3 && value !== 0;
  return minus(small ? value.toExponential(2) : value.toFixed(n));
}

/** Of a value and its error, to two digits of the error. */
export function withError(value, error, n) {
  if (value == null) return "–";
  if (!error) return digits(value, n);
  const places = Math.min(Math.max(1 - Math.floor(Math.log10(error)), 0), 8);
  return `${minus(value.toFixed(places))} ± ${error.toFixed(places)}`;
}

export function percent(value) {
  if (value == null) return "–";
  return `${(value * 100).toFixed(value < 0.1 && value >= 0.0005 ? 1 : 0)} %`;
}

/** A number of things: 1 impact, 2 impacts. */
export const count = (n, noun) => `${n} ${noun}${Number(n) === 1 ? "" : "s"}`;

/** A text as a number, with a point or a comma; null where it is none. */
export function toNumber(text) {
  const written = text.trim().replace(/^([-+]?\d*),(\d+(?:e[-+]?\d+)?)$/i, "$1.$2");
  const value = Number(written.replace("−", "-"));
  return written !== "" && Number.isFinite(value) ? value : null;
}

// Reads a record for drawing, by the same rules as the service, which reports the errors.
import {nextTask} from "../shared/dom.js";
import {firstFrom} from "../shared/search.js";

const atOnce = 50000; // lines between two progress reports

/** Control characters that do not occur in text files. */
// biome-ignore lint/suspicious/noControlCharactersInRegex: it searches for control characters
const binary = /[\0-\x08\x0e-\x1a]/;

/**
 * The text of a file in any of the usual encodings, with LF line ends. Throws for a binary file.
 */
async function textOf(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const begins = (first, second) => bytes[0] === first && bytes[1] === second;
  // UTF-16 without a byte order mark: every other byte of ASCII text is zero.
  const hasZeros = (from) => bytes[from] === 0 && bytes[from + 2] === 0;
  let encoding = "utf-8";
  if (begins(0xff, 0xfe) || hasZeros(1)) encoding = "utf-16le";
  else if (begins(0xfe, 0xff) || hasZeros(0)) encoding = "utf-16be";
  let text;
  try {
    text = new TextDecoder(encoding, {fatal: true}).decode(bytes);
  } catch {
    text = new TextDecoder("windows-1252").decode(bytes);
  }
  if (binary.test(text.slice(0, 100000)))
    throw new Error(
      "it is not a text file; scripts/to-csv converts .wav, .mat, .tdms and .uff files to CSV",
    );
  return text.replace(/\r\n?/g, "\n");
}

/** The cells of a line with quotation marks; a quoted decimal comma becomes a point. */
function quotedCellsOf(line, separator) {
  const end = separator.replace(/\W/, "\\$&");
  const other = `[^${end}]*`;
  const cell = new RegExp(`([ \\t]*"[^"]*"${other}|${other})(?:${end}|$)`, "g");
  const cells = [...line.matchAll(cell)].map(([, text]) => text.trim());
  return cells.map((text) => text.replace(/^"([^"]*)"$/, (_, inside) => asPoint(inside)));
}
const asPoint = (cell) =>
  /^[\s+-]*\d*,\d*(e[+-]?\d+)?\s*$/i.test(cell) ? cell.replace(",", ".") : cell;

/** The cells of a line without trailing empty ones. */
function cellsOf(line, separator) {
  let cells;
  if (separator === " ") cells = line.trim().split(/[ \t]+/);
  else if (line.includes('"')) cells = quotedCellsOf(line, separator);
  else cells = line.split(separator);
  while (cells.length && !cells.at(-1).trim()) cells.pop();
  return cells;
}

const isCode = /^\s*[+-]?0[xob]/i; // JavaScript would accept these as numbers

/** A cell as a number, NaN if it is none. A decimal comma requires another separator. */
function numberOf(cell, separator) {
  if (!cell.trim() || isCode.test(cell)) return NaN;
  return Number(separator === "," ? cell : cell.replaceAll(",", "."));
}

const comment = /^\s*(#|%|\/\/)/;

/**
 * The separator that splits the line into two or more numbers; undefined if there is none.
 * declared: the separator of a line sep=, the only one tried.
 */
function separatorOfNumbers(line, declared) {
  return (declared ? [declared] : [";", "\t", ",", " "]).find((separator) => {
    const cells = cellsOf(line, separator);
    return cells.length > 1 && cells.every((cell) => !Number.isNaN(numberOf(cell, separator)));
  });
}

/**
 * [names, units] from the lines above the first row of `count` numbers; units can be missing.
 * Returns undefined if there are no names. above: the last two lines and the last comment.
 *
 * Candidates in order of preference: names and units in the last two lines; names in the comment
 * and units in the last line, unless the comment holds units; units above the names, in a line or
 * the comment; names alone.
 */
function headingOf(above, count, separator) {
  const cells = (line) => cellsOf(line, separator).map((cell) => cell.trim());
  const [last, before, commented] = [above.last, above.before, above.comment].map(cells);
  const areNames = (row) =>
    row.length === count && row.every((cell) => Number.isNaN(numberOf(cell, separator)));
  const areUnits = (row) => row.length && row.length <= count && row.every(isUnit);
  const candidates = [
    [before, last],
    [areUnits(commented) ? [] : commented, last],
    [last, before],
    [last, commented],
    [last],
    [commented],
  ];
  return candidates.find(([names, units]) => areNames(names) && (!units || areUnits(units)));
}

/**
 * Parses a CSV file into {text, names, units, columns}; columns hold numbers, and names is empty if
 * no heading is found. Lines that the service would reject are skipped. onProgress(fraction)
 * reports progress.
 */
export async function parse(file, onProgress) {
  const text = await textOf(file);
  const above = {last: "", before: "", comment: ""};
  let declared;
  let separator;
  let heading;
  let columns = [];
  let lines = 0;
  for (const {0: line, index} of text.matchAll(/[^\n]+/g)) {
    if (++lines % atOnce === 0) {
      onProgress(index / text.length);
      await nextTask();
    }
    if (!line.trim()) continue;
    if (comment.test(line)) {
      above.comment = line.replace(comment, "");
      continue;
    }
    if (!heading) {
      declared ??= /^\s*sep=(.)\s*$/i.exec(line)?.[1];
      separator = separatorOfNumbers(line, declared);
      if (!separator) {
        above.before = above.last;
        above.last = line;
        continue;
      }
      const count = cellsOf(line, separator).length;
      heading = headingOf(above, count, separator);
      if (!heading) break;
      columns = heading[0].map(() => []);
    }
    const values = cellsOf(line, separator).map((cell) => numberOf(cell, separator));
    if (values.length !== columns.length || !values.every(Number.isFinite)) continue;
    for (const [k, column] of columns.entries()) column.push(values[k]);
  }
  const [names = [], units = []] = heading ?? [];
  return {text, names, units, columns: columns.map((column) => Float64Array.from(column))};
}

/**
 * Usual column names by quantity: the first must match exactly, the others must be followed by a
 * space, an underscore, a bracket or the end.
 */
const quantities = {
  time: ["time_s", "time", "t"],
  displacement: ["displacement_m", "displacement", "x"],
  acceleration: ["acceleration_m_s2", "acceleration", "a"],
  base_acceleration: ["base_acceleration_m_s2", "base_acceleration"],
  force: ["force_n", "force"],
};

/** Index of the column named by a field or else by a usual name; -1 if missing. */
function find(names, wanted, [exact, ...prefixes]) {
  if (wanted) return names.findIndex((name) => name.toLowerCase() === wanted.toLowerCase());
  return [`${exact}$`, ...prefixes.map((text) => `${text}([_ ([]|$)`)]
    .map((text) => names.findIndex((name) => new RegExp(`^${text}`, "i").test(name)))
    .reduce((found, at) => (found < 0 ? at : found));
}

/** Index of the column of each quantity, or -1. */
export const columnsOf = (names, fields) =>
  Object.fromEntries(
    Object.entries(quantities).map(([quantity, usual]) => [
      quantity,
      find(names, fields[`${quantity}_column`], usual),
    ]),
  );

/** Factors from the service's units to those of the plots: s, mm, m/s^2. */
const scales = new Map([
  ["s", 1],
  ["ms", 1e-3],
  ["m", 1e3],
  ["mm", 1],
  ["um", 1e-3],
  ["m/s2", 1],
  ["g", 9.80665],
]);
/** A unit in the service's spelling; any other text in lower case, without some characters. */
const spelling = (text) =>
  (text.length > 32 ? "?" : text) // longer than any unit
    .toLowerCase()
    .replace(/[\u00b5\u03bc]/g, "u")
    .replace(/\u00b2/g, "2")
    .replace(/\u207b/g, "-")
    .replace(/[ ^*()[\]\u00b7]/g, "")
    .replace(/^(m?s)ec$/, "$1")
    .replace(/^m(_s2|s-2|\/s\/s)$/, "m/s2");
const otherUnits = new Set(
  "- 1 n a deg degc \u00b0c k pa bar % rad kn nm cm dm km mil in inch ft us ns min h hz v mv mg gal cm/s2 mm/s2 ft/s2 m/s mm/s".split(
    " ",
  ),
);
const isUnit = (cell) => {
  const written = spelling(cell);
  return !written || scales.has(written) || otherUnits.has(written);
};

const unitAmong = (...texts) => texts.map(spelling).find((unit) => scales.has(unit));

/** The unit in a column's name: in brackets, after a space or underscore, or the whole name. */
function unitIn(name) {
  const brackets = /[([]([^)\]]*)/.exec(name);
  const suffixes = [...name.matchAll(/[_ ]/g)].map(({index}) => name.slice(index + 1));
  return unitAmong(name, ...(brackets ? [brackets[1]] : suffixes));
}

/**
 * Column of each quantity found: {name, values, unit}. The unit is that of the column's name, else
 * of the row of units, else of the field, which can be undefined.
 */
function partsOf({names, units, columns}, fields) {
  const found = Object.entries(columnsOf(names, fields)).filter(([, k]) => k >= 0);
  const part = (quantity, k) => ({
    name: names[k],
    values: columns[k],
    unit: unitIn(names[k]) ?? unitAmong(units[k] ?? "") ?? fields[`${quantity}_unit`],
  });
  return Object.fromEntries(found.map(([quantity, k]) => [quantity, part(quantity, k)]));
}

/**
 * The record selected by the fields: {t (s), x (mm), a (m/s^2)}, null for a missing quantity.
 * Samples whose time is not later than all before are dropped, since the plots need ascending
 * times.
 */
export function recordOf(parsed, fields) {
  const {time, displacement, acceleration} = partsOf(parsed, fields);
  if (!time?.values.length || !(displacement ?? acceleration)) return null;
  let last = -Infinity;
  const isLater = time.values.map((t) => {
    const later = t > last;
    if (later) last = t;
    return later;
  });
  const of = (part, usual) => {
    const scale = scales.get(part?.unit ?? usual);
    return part ? part.values.filter((_, i) => isLater[i]).map((v) => v * scale) : null;
  };
  return {t: of(time, "s"), x: of(displacement, "m"), a: of(acceleration, "m/s2")};
}

/** Fields of /v1/identify with the record in its own units. */
export function asJson(parsed, fields) {
  const parts = Object.entries(partsOf(parsed, fields));
  const units = parts.map(([quantity, {unit}]) => [`${quantity}_unit`, unit]);
  const record = parts.map(([, {name, values}]) => [name, [...values]]);
  return {...fields, ...Object.fromEntries(units), record: Object.fromEntries(record)};
}

const medianReach = 8; // samples before and after the interval, for the local median

/**
 * Index of the sample within `reach` of a time whose acceleration deviates most from the local
 * median: the visible spike. null without an acceleration.
 */
export function spikeNear({t, a}, time, reach) {
  const from = firstFrom(t, time - reach);
  const to = Math.max(firstFrom(t, time + reach), from + 1);
  if (!a || from >= t.length) return null;
  const around = a.slice(Math.max(0, from - medianReach), to + medianReach).sort();
  const centre = around[around.length >> 1];
  let best = from;
  for (let i = from; i < Math.min(to, t.length); ++i)
    if (Math.abs(a[i] - centre) > Math.abs(a[best] - centre)) best = i;
  return best;
}

// A record, read as the service reads it, to be drawn. What is at fault in it the service says.
import {nextTask} from "../shared/dom.js";
import {firstFrom} from "../shared/search.js";

const atOnce = 50000; // lines between two looks at the clock of the page

/** What no text holds. */
// biome-ignore lint/suspicious/noControlCharactersInRegex: it is these that are looked for
const binary = /[\0-\x08\x0e-\x1a]/;

/** The text of a file, whatever its encoding; its lines end by LF. Throws if it is none. */
async function textOf(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const begins = (first, second) => bytes[0] === first && bytes[1] === second;
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
    throw new Error("it is no text; scripts/to-csv makes CSV of .wav, .mat, .tdms and .uff files");
  return text.replace(/\r\n?/g, "\n");
}

/** The cells of a line with quotation marks, where a decimal comma becomes a point. */
function quotedCellsOf(line, separator) {
  const cells = [];
  for (let from = 0; from <= line.length; ) {
    const [opening] = /^[ \t]*"/.exec(line.slice(from)) ?? [];
    const quote = opening ? line.indexOf('"', from + opening.length) : -1;
    const at = line.indexOf(separator, quote < 0 ? from : quote);
    const end = at < 0 ? line.length : at;
    const cell = line.slice(from, end).trim();
    cells.push(quote < 0 ? cell : cell.replace(/^"([^"]*)"$/, (_, inside) => asPoint(inside)));
    from = end + 1;
  }
  return cells;
}
const asPoint = (cell) =>
  /^[\s+-]*\d*,\d*(e[+-]?\d+)?\s*$/i.test(cell) ? cell.replace(",", ".") : cell;

/** The cells of a line without empty ones behind the last. */
function cellsOf(line, separator) {
  let cells;
  if (separator === " ") cells = line.trim().split(/[ \t]+/);
  else if (line.includes('"')) cells = quotedCellsOf(line, separator);
  else cells = line.split(separator);
  while (cells.length && !cells.at(-1).trim()) cells.pop();
  return cells;
}

const isCode = /^\s*[+-]?0[xob]/i; // which JavaScript takes for a number

/** A cell as a number, NaN for what is none. A decimal comma needs another separator. */
function numberOf(cell, separator) {
  if (!cell.trim() || isCode.test(cell)) return NaN;
  return Number(separator === "," ? cell : cell.replaceAll(",", "."));
}

const comment = /^\s*(#|%|\/\/)/;

/** That by which the line is numbers, two or more; undefined: none. */
function separatorOfNumbers(line, said) {
  return (said ? [said] : [";", "\t", ",", " "]).find((separator) => {
    const cells = cellsOf(line, separator);
    return cells.length > 1 && cells.every((cell) => !Number.isNaN(numberOf(cell, separator)));
  });
}

/**
 * Names and, if they are there, units above `count` columns of numbers, from the lines there;
 * undefined: there are none.
 */
function headingOf(above, count, separator) {
  const cells = (line) => cellsOf(line, separator).map((cell) => cell.trim());
  const [last, before, aside] = [above.last, above.before, above.comment].map(cells);
  const areNames = (row) =>
    row.length === count && row.every((cell) => Number.isNaN(numberOf(cell, separator)));
  const areUnits = (row) => row.length && row.length <= count && row.every(isUnit);
  const ways = [
    [before, last],
    [areUnits(aside) ? [] : aside, last],
    [last, before],
    [last, aside],
    [last],
    [aside],
  ];
  return ways.find(([names, units]) => areNames(names) && (!units || areUnits(units)));
}

/**
 * A file of CSV: its text and {names, units, columns}, columns of numbers; lines that the service
 * would refuse are left out. heard(share): how much of it is read.
 */
export async function parse(file, heard) {
  const text = await textOf(file);
  const above = {last: "", before: "", comment: ""};
  let said;
  let separator;
  let heading;
  let columns = [];
  let rows = 0;
  let lines = 0;
  for (const {0: line, index} of text.matchAll(/[^\n]+/g)) {
    if (++lines % atOnce === 0) {
      heard(index / text.length);
      await nextTask();
    }
    if (!line.trim()) continue;
    if (comment.test(line)) {
      above.comment = line.replace(comment, "");
      continue;
    }
    if (!heading) {
      said ??= /^\s*sep=(.)\s*$/i.exec(line)?.[1];
      separator = separatorOfNumbers(line, said);
      if (!separator) {
        above.before = above.last;
        above.last = line;
        continue;
      }
      const count = cellsOf(line, separator).length;
      heading = headingOf(above, count, separator);
      if (!heading) break;
      // A number takes two characters at least.
      const most = Math.ceil((text.length - index) / (2 * count)) + 1;
      columns = heading[0].map(() => new Float64Array(most));
    }
    const values = cellsOf(line, separator).map((cell) => numberOf(cell, separator));
    if (values.length !== columns.length) continue;
    for (const [k, column] of columns.entries()) column[rows] = values[k];
    if (values.every(Number.isFinite)) ++rows;
  }
  const [names = [], units = []] = heading ?? [];
  return {text, names, units, columns: columns.map((column) => column.slice(0, rows))};
}

/** What is measured: the names of its column, the first of them whole, others as they begin. */
const quantities = {
  time: ["time_s", "time", "t"],
  displacement: ["displacement_m", "displacement", "x"],
  acceleration: ["acceleration_m_s2", "acceleration", "a"],
  base_acceleration: ["base_acceleration_m_s2", "base_acceleration"],
  force: ["force_n", "force"],
};

/** The column that a field asks for, else that of one of the usual names; -1: none. */
function find(names, asked, [whole, ...beginnings]) {
  if (asked) return names.findIndex((name) => name.toLowerCase() === asked.toLowerCase());
  return [`${whole}$`, ...beginnings.map((text) => `${text}([_ ([]|$)`)]
    .map((text) => names.findIndex((name) => new RegExp(`^${text}`, "i").test(name)))
    .reduce((found, at) => (found < 0 ? at : found));
}

/** The columns that the fields and the names mean, by what is measured: their positions, or -1. */
export const columnsOf = (names, fields) =>
  Object.fromEntries(
    Object.entries(quantities).map(([quantity, usual]) => [
      quantity,
      find(names, fields[`${quantity}_column`], usual),
    ]),
  );

const scales = new Map([
  ["s", 1],
  ["ms", 1e-3],
  ["m", 1e3],
  ["mm", 1],
  ["um", 1e-3],
  ["m/s2", 1],
  ["g", 9.80665],
]);
/** A unit as the service names it, if it is one. */
const spelling = (text) =>
  (text.length > 32 ? "?" : text) // no unit is longer
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
/** Whether a cell is what stands in a row of units below the names. */
const isUnit = (cell) => {
  const written = spelling(cell);
  return !written || scales.has(written) || otherUnits.has(written);
};

const unitAmong = (...texts) => texts.map(spelling).find((unit) => scales.has(unit));

/** The unit that a column's name says, in brackets or behind a blank or underscore, or is. */
function unitIn(name) {
  const brackets = /[([]([^)\]]*)/.exec(name);
  const behind = [...name.matchAll(/[_ ]/g)].map(({index}) => name.slice(index + 1));
  return unitAmong(name, ...(brackets ? [brackets[1]] : behind));
}

/** Of each quantity that is there its column: {name, values, unit}, by what is measured. */
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
 * What the fields make of what was read: {t (s), x (mm), a (m/s^2)}, null for one that is not there.
 * Samples are left out whose time does not lie behind all before it: the plots need it so.
 */
export function recordOf(parsed, fields) {
  const {time, displacement, acceleration} = partsOf(parsed, fields);
  if (!time?.values.length || !(displacement ?? acceleration)) return null;
  let last = -Infinity;
  const isLater = time.values.map((t) => {
    const is = t > last;
    if (is) last = t;
    return is;
  });
  const of = (part, usual) => {
    const scale = scales.get(part?.unit ?? usual);
    return part ? part.values.filter((_, i) => isLater[i]).map((v) => v * scale) : null;
  };
  return {t: of(time, "s"), x: of(displacement, "m"), a: of(acceleration, "m/s2")};
}

/** The same as fields of /v1/identify, with the record in them, in its units. */
export function asJson(parsed, fields) {
  const parts = Object.entries(partsOf(parsed, fields));
  const units = parts.map(([quantity, {unit}]) => [`${quantity}_unit`, unit]);
  const record = parts.map(([, {name, values}]) => [name, [...values]]);
  return {...fields, ...Object.fromEntries(units), record: Object.fromEntries(record)};
}

/**
 * The sample within reach of a moment where the acceleration lies farthest from what is around it:
 * where the eye sees the spike.
 */
export function spikeNear({t, a}, moment, reach) {
  const from = firstFrom(t, moment - reach);
  const to = Math.max(firstFrom(t, moment + reach), from + 1);
  if (!a || from >= t.length) return null;
  const around = a.slice(Math.max(0, from - 8), to + 8).sort();
  const centre = around[around.length >> 1];
  let best = from;
  for (let i = from; i < Math.min(to, t.length); ++i)
    if (Math.abs(a[i] - centre) > Math.abs(a[best] - centre)) best = i;
  return best;
}

// A record, read as the service reads it, to be drawn. What is at fault in it the service says.
import {nextTask} from "../shared/dom.js";
import {firstFrom} from "../shared/search.js";

const atOnce = 50000; // lines between two looks at the clock of the page

const trimmed = (cell) => cell.trim();

/** Whether a text is none: it holds characters that no text has. */
function isBinary(text) {
  for (let i = 0; i < Math.min(text.length, 100000); ++i) {
    const code = text.charCodeAt(i);
    if (code < 9 || (code > 13 && code < 27)) return true;
  }
  return false;
}

/** The text of a file, whatever its encoding; its lines end by LF. Throws if it is none. */
export async function textOf(file) {
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
  if (isBinary(text))
    throw new Error("it is no text; scripts/to-csv makes CSV of .wav, .mat, .tdms and .uff files");
  return text.includes("\r") ? text.replace(/\r\n?/g, "\n") : text;
}

/** The same of a line with quotation marks, where a decimal comma becomes a point. */
function quotedCellsOf(line, separator) {
  const cells = [];
  for (let from = 0; from <= line.length; ) {
    const blanks = /^[ \t]*/.exec(line.slice(from, from + 100))[0].length;
    const quote = line[from + blanks] === '"' ? line.indexOf('"', from + blanks + 1) : -1;
    const at = line.indexOf(separator, quote < 0 ? from : quote);
    const end = at < 0 ? line.length : at;
    const cell = line.slice(from, end).trim();
    const inside = quote < 0 ? null : cell.slice(1, -1);
    cells.push(inside === null || inside.includes('"') ? cell : asPoint(inside));
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
function numberOf(text, separator) {
  const value = Number(text);
  if (Number.isFinite(value) && value !== 0 && !isCode.test(text)) return value;
  const cell = trimmed(text); // a zero may be an empty cell
  if (cell === "" || isCode.test(cell)) return NaN;
  return Number(separator === "," ? cell : cell.replaceAll(",", "."));
}

const isComment = (line) => /^\s*(#|%|\/\/)/.test(line);

/** That by which the line is numbers, two or more; undefined: none. */
function separatorOfNumbers(line, said) {
  return (said ? [said] : [";", "\t", ",", " "]).find((separator) => {
    const cells = cellsOf(line, separator);
    return cells.length > 1 && cells.every((cell) => !Number.isNaN(numberOf(cell, separator)));
  });
}

/** Names and units above `count` columns of numbers, from the lines there; null: there are none. */
function headingOf({last, before, comment}, count, separator) {
  const cells = (line) => cellsOf(line, separator).map(trimmed);
  const fits = (row) =>
    row.length === count && row.every((cell) => Number.isNaN(numberOf(cell, separator)));
  const [low, high, aside] = [last, before, comment].map(cells);
  if (fits(high) && low.length && low.length <= count && low.every(isUnit))
    return {names: high, units: low};
  const areUnits = (row) => row.length && row.length <= count && row.every(isUnit);
  if (fits(aside) && !areUnits(aside) && areUnits(low)) return {names: aside, units: low};
  if (fits(low)) return {names: low, units: [high, aside].find(areUnits) ?? []};
  return fits(aside) ? {names: aside, units: []} : null;
}

/**
 * The columns of a CSV text: {names, units, columns}, columns of numbers; lines that the service
 * would refuse are left out. heard(share): how much of it is read.
 */
export async function parse(text, heard = () => {}) {
  const above = {last: "", before: "", comment: ""};
  let said;
  let separator;
  let heading = null;
  let columns = [];
  let rows = 0;
  let from = 0;
  for (let line = 1; from < text.length; ++line) {
    const at = text.indexOf("\n", from);
    const to = at < 0 ? text.length : at;
    const cells = text.slice(from, to);
    from = to + 1;
    if (line % atOnce === 0) {
      heard(from / text.length);
      await nextTask();
    }
    if (!cells.trim()) continue;
    if (isComment(cells)) {
      if (!heading) above.comment = cells.replace(/^\s*(#|%|\/\/)/, "");
      continue;
    }
    if (!heading) {
      said ??= /^\s*sep=(.)\s*$/i.exec(cells)?.[1];
      separator = separatorOfNumbers(cells, said);
      if (separator) {
        const count = cellsOf(cells, separator).length;
        heading = headingOf(above, count, separator);
        if (!heading) break;
        // A number takes two characters at least.
        const most = Math.ceil((text.length - to + cells.length) / (2 * count)) + 1;
        columns = heading.names.map(() => new Float64Array(most));
      } else {
        above.before = above.last;
        above.last = cells;
        continue;
      }
    }
    const parts = cellsOf(cells, separator);
    if (parts.length !== columns.length) continue;
    let good = true;
    for (let k = 0; k < parts.length; ++k) {
      const value = numberOf(parts[k], separator);
      columns[k][rows] = value;
      good &&= Number.isFinite(value);
    }
    if (good) ++rows;
  }
  const {names, units} = heading ?? {names: [], units: []};
  return {names, units, columns: columns.map((column) => column.slice(0, rows))};
}

function find(names, asked, name, beginnings) {
  const lower = names.map((n) => n.toLowerCase());
  if (asked) return lower.indexOf(asked.toLowerCase());
  const exact = lower.indexOf(name);
  if (exact >= 0) return exact;
  for (const b of beginnings) {
    const starts = (n) => ["_", " ", "(", "["].some((end) => n.startsWith(b + end));
    const at = lower.findIndex((n) => n === b || starts(n));
    if (at >= 0) return at;
  }
  return -1;
}

const units = {s: 1, ms: 1e-3, m: 1e3, mm: 1, um: 1e-3, "m/s2": 1, g: 9.80665};
const spellings = {
  s: "s",
  sec: "s",
  ms: "ms",
  msec: "ms",
  m: "m",
  mm: "mm",
  um: "um",
  "m/s2": "m/s2",
  m_s2: "m/s2",
  "ms-2": "m/s2",
  "m/s/s": "m/s2",
  g: "g",
};
const spelling = (text) =>
  (text.length > 32 ? "?" : text) // no unit is longer
    .toLowerCase()
    .replace(/[\u00b5\u03bc]/g, "u")
    .replace(/\u00b2/g, "2")
    .replace(/\u207b/g, "-")
    .replace(/[ ^*()[\]\u00b7]/g, "");
const otherUnits = new Set(
  "- 1 n a deg degc \u00b0c k pa bar % rad kn nm cm dm km mil in inch ft us ns min h hz v mv mg gal cm/s2 mm/s2 ft/s2 m/s mm/s".split(
    " ",
  ),
);
/** Whether a cell is what stands in a row of units below the names. */
const isUnit = (cell) => {
  const written = spelling(cell);
  return !written || Object.hasOwn(spellings, written) || otherUnits.has(written);
};

/**
 * The unit that a column's name says, in brackets or behind a blank or underscore; undefined where
 * it says none.
 */
function unitIn(name) {
  if (Object.hasOwn(spellings, spelling(name))) return spellings[spelling(name)];
  const brackets = /[([]([^)\]]*)/.exec(name);
  if (brackets) return spellings[spelling(brackets[1])];
  for (const {index} of name.matchAll(/[_ ]/g)) {
    const unit = spellings[spelling(name.slice(index + 1))];
    if (unit) return unit;
  }
}

/** What leaves those samples of a column out whose time does not lie behind all before it. */
function whereAscending(t) {
  let keep = null;
  let last = t[0];
  for (let i = 1; i < t.length; ++i) {
    if (t[i] > last) {
      last = t[i];
    } else {
      keep ??= new Uint8Array(t.length).fill(1);
      keep[i] = 0;
    }
  }
  return (column) => (keep ? column.filter((_, i) => keep[i]) : column);
}

const scaled = (column, unit) => (units[unit] === 1 ? column : column.map((v) => v * units[unit]));

/** The columns that the fields and the names mean, by what is measured: their positions, or -1. */
export function columnsOf(names, fields) {
  const of = (field, name, ...beginnings) => find(names, fields[field], name, beginnings);
  return {
    time: of("time_column", "time_s", "time", "t"),
    displacement: of("displacement_column", "displacement_m", "displacement", "x"),
    acceleration: of("acceleration_column", "acceleration_m_s2", "acceleration", "a"),
    base_acceleration: of(
      "base_acceleration_column",
      "base_acceleration_m_s2",
      "base_acceleration",
    ),
    force: of("force_column", "force_n", "force"),
  };
}

/**
 * What the fields make of the columns: {t (s), x (mm), a (m/s^2)}, null for one that is not there;
 * sent: those columns by name, in the record's units; units: these as fields.
 */
export function recordOf({names, units: row = [], columns}, fields) {
  const columnOf = columnsOf(names, fields);
  const {time, displacement: x, acceleration: a, base_acceleration: base, force} = columnOf;
  if (time < 0 || !columns[time].length || (x < 0 && a < 0)) return null;
  const said = (k, asked) => unitIn(names[k]) ?? spellings[spelling(row[k] ?? "")] ?? asked;
  const unit = (k, asked, usual) => said(k, asked) ?? usual;
  const t = scaled(columns[time], unit(time, fields.time_unit, "s"));
  const kept = whereAscending(t); // as the plots need it
  const present = [time, x, a, base, force].filter((k) => k >= 0);
  const sent = Object.fromEntries(present.map((k) => [names[k], columns[k]]));
  return {
    units: {
      time_unit: said(time, fields.time_unit),
      displacement_unit: x < 0 ? undefined : said(x, fields.displacement_unit),
      acceleration_unit: a < 0 ? undefined : said(a, fields.acceleration_unit),
      base_acceleration_unit: base < 0 ? undefined : said(base, fields.base_acceleration_unit),
      force_unit: force < 0 ? undefined : said(force, fields.force_unit),
    },
    t: kept(t),
    x: x < 0 ? null : kept(scaled(columns[x], unit(x, fields.displacement_unit, "m"))),
    a: a < 0 ? null : kept(scaled(columns[a], unit(a, fields.acceleration_unit, "m/s2"))),
    sent,
  };
}

/**
 * The sample within reach of a moment where the acceleration lies farthest from what is around it:
 * where the eye sees the spike.
 */
export function spikeNear({t, a}, moment, reach) {
  const from = firstFrom(t, moment - reach);
  const to = Math.max(firstFrom(t, moment + reach), from + 1);
  if (!a || from >= t.length) return null;
  const around = a.slice(Math.max(0, from - 8), Math.min(t.length, to + 8)).sort();
  const centre = around[around.length >> 1];
  let best = from;
  for (let i = from; i < Math.min(to, t.length); ++i)
    if (Math.abs(a[i] - centre) > Math.abs(a[best] - centre)) best = i;
  return best;
}

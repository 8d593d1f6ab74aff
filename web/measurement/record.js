// Records: read from a file by the rules of the service, simulated from a run, kept by the browser.
import {bisectLeft, maxIndex, median} from "d3-array";
import {randomLcg, randomUniform} from "d3-random";
import {get, set} from "idb-keyval";
import {nextTask} from "../shared/dom.js";
import {Motion} from "../shared/motion.js";
import {lastUpTo} from "../shared/numbers.js";

const atOnce = 50000; // lines between two progress reports
const encodings = ["utf-8", "utf-16le", "utf-16be", "windows-1252"];

/** Control characters that do not occur in text files. */
// biome-ignore lint/suspicious/noControlCharactersInRegex: it searches for control characters
const binary = /[\0-\x08\x0e-\x1a]/;

/** The text of a file in the first encoding that gives lines of text. Throws for a binary file. */
async function textOf(file) {
  const bytes = await file.arrayBuffer();
  for (const encoding of encodings)
    try {
      const text = new TextDecoder(encoding, {fatal: true}).decode(bytes);
      const lines = text.replace(/\r\n?/g, "\n");
      if (lines.includes("\n") && !binary.test(lines.slice(0, 100000))) return lines;
    } catch {
      // another encoding
    }
  throw new Error(
    "it is not a text file; scripts/to-csv converts .wav, .mat, .tdms and .uff files to CSV",
  );
}

const withComma = /^[\s+-]*\d*,\d*(e[+-]?\d+)?\s*$/i;

/** A quoted text without separators; a decimal comma becomes a point. */
const unquoted = (text, separator) =>
  withComma.test(text) ? text.replace(",", ".") : text.replaceAll(separator, " ");

/** The cells of a line without trailing empty ones. */
function cellsOf(line, separator) {
  const plain = line.replace(/"([^"]*)"/g, (_, inside) => unquoted(inside, separator));
  const cells = separator === " " ? plain.trim().split(/[ \t]+/) : plain.split(separator);
  while (cells.length && !cells.at(-1).trim()) cells.pop();
  return cells;
}

const numeric = /^\s*[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?\s*$/i;

/** A cell as a number, NaN if it is none. A decimal comma requires another separator. */
function numberOf(cell, separator) {
  const text = separator === "," ? cell : cell.replace(",", ".");
  return numeric.test(text) ? Number(text) : NaN;
}

const comment = /^\s*(#|%|\/\/)/;

/** The separator that splits a line into numbers, if any; declared: by a line sep=. */
const separatorOfNumbers = (line, declared) =>
  (declared ? [declared] : [";", "\t", ",", " "]).find((separator) => {
    const cells = cellsOf(line, separator);
    return cells.length > 1 && cells.every((cell) => !Number.isNaN(numberOf(cell, separator)));
  });

/** {names, units} of `count` columns from the lines above them: the first of `pairs` with names. */
function headingOf(above, count, separator) {
  const cellsIn = (line) => cellsOf(line, separator).map((cell) => cell.trim());
  const comments = above.filter((line) => comment.test(line));
  const plain = above.filter((line) => !comment.test(line));
  const [last = [], before = []] = plain.slice(-2).toReversed().map(cellsIn);
  const commented = cellsIn(comments.at(-1)?.replace(comment, "") ?? "");
  const areNames = (row) =>
    row.length === count && row.every((cell) => Number.isNaN(numberOf(cell, separator)));
  const areUnits = (row) => row.length && row.length <= count && row.every(isUnit);
  const named = areUnits(commented) ? [] : commented;
  const pairs = [
    [before, last],
    [named, last],
    [last, before],
    [last, commented],
    [last, []],
    [commented, []],
  ];
  const isHeading = ([names, units]) => areNames(names) && (!units.length || areUnits(units));
  const [names, units] = pairs.find(isHeading) ?? [[], []];
  return {names, units};
}

/**
 * Parses a CSV file into {names, units, columns}; all are empty without a heading. Skips lines that
 * the service would reject. onProgress(fraction) reports progress.
 */
export async function parse(file, onProgress = () => {}) {
  const lines = (await textOf(file)).split("\n").filter((line) => line.trim());
  const declared = /^\s*sep=(.)\s*$/i.exec(lines[0])?.[1];
  const isRow = (line) => !comment.test(line) && separatorOfNumbers(line, declared);
  const first = lines.findIndex(isRow);
  if (first < 0) return {names: [], units: [], columns: []};
  const separator = separatorOfNumbers(lines[first], declared);
  const count = cellsOf(lines[first], separator).length;
  const heading = headingOf(lines.slice(0, first), count, separator);
  const columns = heading.names.map(() => []);
  for (let n = first; n < lines.length && columns.length; ++n) {
    if (n % atOnce === 0) {
      onProgress(n / lines.length);
      await nextTask();
    }
    const values = cellsOf(lines[n], separator).map((cell) => numberOf(cell, separator));
    if (values.length !== count || !values.every(Number.isFinite)) continue;
    for (const [k, column] of columns.entries()) column.push(values[k]);
  }
  return {...heading, columns: columns.map((column) => Float64Array.from(column))};
}

/** Usual column names: the first as a whole, the others before a space, underscore or bracket. */
const quantities = {
  time: ["time_s", "time", "t"],
  displacement: ["displacement_m", "displacement", "x"],
  acceleration: ["acceleration_m_s2", "acceleration", "a"],
  base_acceleration: ["base_acceleration_m_s2", "base_acceleration"],
  base_displacement: ["base_displacement_m", "base_displacement"],
  force: ["force_n", "force"],
};

/** Index of the column named by a field or else by a usual name; -1 if missing. */
function find(names, wanted, [exact, ...prefixes]) {
  if (wanted) return names.findIndex((name) => name.toLowerCase() === wanted.toLowerCase());
  const patterns = [`${exact}$`, ...prefixes.map((text) => `${text}([_ ([]|$)`)];
  const indexOf = (text) => names.findIndex((name) => RegExp(`^${text}`, "i").test(name));
  const places = patterns.map(indexOf);
  return places.find((at) => at >= 0) ?? -1;
}

/** Factors from the service's units to those of the plots: s, mm, m/s^2; N. */
const scales = new Map([
  ["s", 1],
  ["ms", 1e-3],
  ["m", 1e3],
  ["mm", 1],
  ["um", 1e-3],
  ["m/s2", 1],
  ["mm/s2", 1e-3],
  ["g", 9.80665],
  ["n", 1],
  ["kn", 1e3],
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
    .replace(/^(mm?)(_s2|s-2|\/s\/s)$/, "$1/s2");
const others =
  "- 1 a deg degc \u00b0c k pa bar % rad nm cm dm km mil in inch ft us ns min h hz v mv mg gal cm/s2 ft/s2 m/s mm/s";
const otherUnits = new Set(others.split(" "));
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

/** Columns found: {name, values, unit: by the column's name, the row of units or the field}. */
function partsOf({names, units, columns}, fields) {
  const found = Object.entries(quantities).flatMap(([quantity, usual]) => {
    const k = find(names, fields[`${quantity}_column`], usual);
    if (k < 0) return [];
    const unit = unitIn(names[k]) ?? unitAmong(units[k] ?? "") ?? fields[`${quantity}_unit`];
    return [[quantity, {name: names[k], values: columns[k], unit}]];
  });
  return Object.fromEntries(found);
}

/** The record of the fields: {t (s), x (mm), a (m/s^2)}, at ascending times; null if missing. */
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

/** A recorded load in SI, as the field `forcing`. Throws without a time or a load. */
export function loadOf(parsed) {
  const {time, force, ...parts} = partsOf(parsed, {});
  const acceleration = parts.base_acceleration ?? parts.acceleration;
  const displacement = parts.base_displacement ?? parts.displacement;
  if (!time || !(acceleration ?? displacement ?? force))
    throw new Error("it needs a column time and one of acceleration, displacement, force");
  const inSi = ({values, unit}, usual, factor = 1) =>
    Array.from(values, (v) => v * scales.get(unit ?? usual) * factor);
  const time_s = inSi(time, "s");
  if (acceleration) return {time_s, acceleration_m_s2: inSi(acceleration, "m/s2")};
  if (displacement) return {time_s, displacement_m: inSi(displacement, "m", 1e-3)};
  return {time_s, force_N: inSi(force, "n")};
}

/** Fields of /v1/identify with the record in its own units. */
export function asJson(parsed, fields) {
  const parts = Object.entries(partsOf(parsed, fields));
  const units = parts.map(([quantity, {unit}]) => [`${quantity}_unit`, unit]);
  const record = parts.map(([, {name, values}]) => [name, [...values]]);
  return {...fields, ...Object.fromEntries(units), record: Object.fromEntries(record)};
}

const medianReach = 8; // samples before and after the interval, for the local median

/** Index of the sample of the visible spike within `reach` of a time; null without acceleration. */
export function spikeNear({t, a}, time, reach) {
  const from = bisectLeft(t, time - reach);
  const to = Math.max(bisectLeft(t, time + reach), from + 1);
  if (!a || from >= t.length) return null;
  const centre = median(a.slice(Math.max(0, from - medianReach), to + medianReach));
  return from + maxIndex(a.slice(from, to), (v) => Math.abs(v - centre));
}

const keptName = "vines-record";

/** Keeps a file in place of the previous one, if the browser permits it. */
export const keep = (file) =>
  nextTask()
    .then(() => set(keptName, file))
    .catch(() => {});

/** The kept file if the page was reloaded, else undefined. */
export async function afterReload() {
  const [navigation] = performance.getEntriesByType("navigation");
  if (navigation?.type !== "reload") return undefined;
  return nextTask()
    .then(() => get(keptName))
    .catch(() => undefined);
}

const samplesPerCycle = 245; // about 2 kHz at 8.35 Hz, the forcing of Li et al. (2018)
const maxSamples = 200000;
const settling = 20; // cycles skipped: a recorder is started later than the motion
const pulse = 1 / 150; // duration in cycles

/** The oscillator of a run as fields of /v1/identify; m1 = 1 kg, k1 = 1 N/m if dimensionless. */
export function oscillatorOf({si, b, epsilon, Omega, derived}) {
  const system = si ?? {m1: 1, k1: 1, m2: epsilon, f: Omega / (2 * Math.PI)};
  const {m1, k1, m2, f} = system;
  const c1 = 2 * derived.zeta * Math.sqrt(k1 * m1); // damping of the simulated motion
  return {m1, k1, c1, m2, f, b};
}

/** Samples of a run as CSV; a long run is recorded after `settling` cycles. */
export function recordOfRun(answer) {
  const {parameters, impacts} = answer;
  const omega0 = parameters.derived.omega0 ?? 1; // rad/s
  const motion = new Motion(answer);
  const {cycle} = motion;
  const from = motion.end > 3 * settling * cycle ? settling * cycle : 0;
  const count = Math.min(Math.floor(((motion.end - from) / cycle) * samplesPerCycle), maxSamples);
  const width = pulse * cycle;
  const noise = randomUniform.source(randomLcg(1))(-1, 1); // the same in each record
  // Amplitudes of uniform noise, in m and m/s^2.
  const [noiseX, noiseA] = [1.3e-4 * parameters.b, 1.2e-3 * parameters.b * omega0 ** 2];
  const lines = ["time_s,displacement_m,acceleration_m_s2"];
  for (let n = 0; n < count; ++n) {
    const tau = from + (n * cycle) / samplesPerCycle;
    const {x, x_ddot: smooth} = motion.at(tau);
    let a = smooth; // without pulses
    for (let i = lastUpTo(impacts.tau, tau + width / 2); i >= 0; --i) {
      const position = (tau - impacts.tau[i]) / width + 0.5; // in the pulse, from 0 to 1
      if (position >= 1) break;
      const jump = impacts.x_dot_after[i] - impacts.x_dot_before[i];
      a += ((jump * Math.PI) / 2 / width) * Math.sin(Math.PI * position);
    }
    const seconds = ((tau - from) / omega0).toFixed(7);
    const measured = (x + noiseX * noise()).toExponential(7);
    lines.push(`${seconds},${measured},${(a * omega0 ** 2 + noiseA * noise()).toExponential(4)}`);
  }
  return `${lines.join("\n")}\n`;
}

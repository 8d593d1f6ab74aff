// The answer keys of the OpenAPI document, by part of an answer, and their tables in docs/api.md.
import {anchorOf, codes} from "./markdown.mjs";

/**
 * By part: the schemas that tell it, or their key `at`; what in them is told elsewhere, all but
 * their keys at the `top` or `opaque` ones; of lines that have values by the names of what is swept,
 * those of the names that are keys all the same.
 */
const listsOfFields = [
  "fields",
  "manifold_fields",
  "sweep_fields",
  "axis_fields",
  "basins_fields",
  "continue_fields",
  "design_fields",
  "identify_fields",
  "form_fields",
];
const parts = {
  simulate: {of: ["Simulation"], top: true},
  parameters: {of: ["SimulationParameters", "System"]},
  "simulate.status": {of: ["RunStatus"]},
  "simulate.series": {of: ["Series"]},
  "simulate.impacts": {of: ["Impacts"]},
  "simulate.sticking": {of: ["Sticking"]},
  "simulate.touches": {of: ["Touches"]},
  "simulate.exponents": {of: ["Exponents"]},
  "simulate.windows": {of: ["WindowExponents"]},
  "simulate.eigenvalues": {of: ["Eigenvalues"]},
  "simulate.matrices": {of: ["Matrices"]},
  "simulate.section": {of: ["Section"]},
  "simulate.energy": {of: ["Energy"]},
  "simulate.regime": {of: ["Regime"]},
  "simulate.perturbation": {of: ["Perturbation"]},
  manifold: {of: ["RunManifold", "SlowManifold"]},
  "manifold-answer": {of: ["Manifold"], top: true},
  "sweep.start": {of: ["SweepStart", "BasinsStart"], opaque: ["parameters", "request"]},
  "sweep.point": {
    of: ["SweepResult", "SweepFault"],
    opaque: ["section", "second_start", "worst", "best", "starts"],
    swept: ["lambda"],
  },
  "sweep.section": {of: ["SweepResult"], at: "section"},
  "sweep.motion": {of: ["SweepMotion"]},
  "sweep.reduced": {of: ["SweepReduction"], swept: []},
  "sweep.progress": {of: ["SweepProgress"]},
  "sweep.end": {of: ["SweepWarning", "SweepDone", "SweepError"]},
  "basins.point": {of: ["BasinsPoint"], swept: []},
  "basins.end": {of: ["BasinsDone"], opaque: ["attractors", "basins"]},
  "basins.attractors": {of: ["BasinsAttractor"], swept: []},
  "basins.basins": {of: ["BasinsStatistics"], swept: []},
  "continue.start": {of: ["ContinueStart"], opaque: ["parameters", "request"]},
  "continue.branch": {of: ["ContinueBranch"]},
  "continue.point": {of: ["ContinuePoint", "ContinueSpecial"], swept: []},
  "continue.end": {of: ["ContinueProgress", "ContinueDone"]},
  "design.start": {of: ["DesignStart"], opaque: ["request"]},
  "design.point": {of: ["DesignPoint"]},
  "design.sample": {of: ["DesignSample"]},
  "design.progress": {of: ["DesignProgress"]},
  "design.done": {of: ["DesignDone"]},
  provenance: {of: ["Provenance"], opaque: ["request"]},
  identify: {of: ["Identification"], top: true},
  "identify.signal": {of: ["Signal"]},
  "identify.fitted": {of: ["Fitted"]},
  "identify.laws": {of: ["BallLaws"]},
  "identify.impacts": {of: ["IdentifiedImpacts"]},
  "identify.sticking": {of: ["Sticking"]},
  "identify.restitution": {of: ["Restitution"]},
  "identify.b_fitted": {of: ["Identification"], at: "b_fitted"},
  "identify.exponents": {of: ["MeasuredExponents"]},
  "identify.slope": {of: ["Identification"], at: "slope"},
  "identify.motion": {of: ["FittedMotion"]},
  "identify.direct": {of: ["DirectEstimate"], opaque: ["exponents"]},
  "identify.forward": {of: ["ForwardRun"]},
  "presets-answer": {of: ["Presets"], opaque: ["presets[].parameters"]},
  "health-answer": {of: ["Version", "Status"]},
  "parameters-answer": {
    of: ["Parameters", "Field"],
    opaque: ["model.symbols", ...listsOfFields],
  },
  problem: {of: ["Problem"]},
};

/** Placeholder for the names of a sweep's parameters. */
const isSwept = (path, fields) => fields.has(path.split(".").at(-1)) && !/sta(te|rt)\./.test(path);

class Walk {
  constructor(openapi) {
    this.schemas = openapi.components.schemas;
  }

  schema({$ref}) {
    return this.schemas[$ref.split("/").at(-1)];
  }

  /** The keys below a schema, and the objects among them that have a meaning of their own. */
  keys(schema, {opaque = [], top = false}, path = "", meaning = "") {
    const constant = schema.const === undefined ? meaning : `always ${schema.const}`;
    const own = {path, si: "", meaning: schema.description || constant};
    if (path && (top || opaque.includes(path))) return [own];
    if (schema.$ref) return this.keys(this.schema(schema), {opaque, top}, path, own.meaning);
    const several = (schema.anyOf ?? schema.oneOf)?.filter((one) => one.type !== "null");
    if (several) return several.flatMap((one) => this.keys(one, {opaque, top}, path, own.meaning));
    const entries = schema.items ? this.keys(schema.items, {opaque, top}, `${path}[]`) : [];
    const object = path && own.meaning ? [{...own, isObject: true}] : [];
    if (entries.some((entry) => entry.path.startsWith(`${path}[].`)))
      return [...object, ...entries];
    if (!schema.properties) return path ? [own] : [];
    const before = path && `${path}.`;
    const keys = object;
    for (const [name, value] of Object.entries(schema.properties)) {
      const counterpart = keys.find(
        (key) => key.path === before + value.description?.match(inSi)?.[1],
      );
      if (counterpart) counterpart.si = before + name;
      else keys.push(...this.keys(value, {opaque, top}, before + name));
    }
    return keys;
  }
}

/** The first of the keys with each path. */
function distinct(keys) {
  const first = new Map();
  for (const key of keys) if (!first.has(key.path)) first.set(key.path, key);
  return [...first.values()];
}

const inSi = /^(\w+) in (?:s|1\/s|m\/s|m\/s\^2|N s|J), for a system in SI$/;

/** By part: {path, si, meaning} of each key; si: the path of its SI counterpart, or "". */
export function describedKeys(openapi) {
  const walk = new Walk(openapi);
  const swept = new Set(Object.keys(walk.schemas.SweepBase.properties));
  const keys = new Map();
  for (const [part, {of, at, swept: kept, ...how}] of Object.entries(parts)) {
    const schemas = of.map((name) => walk.schemas[name]);
    const own = at ? schemas.map((schema) => schema.properties[at]) : schemas;
    const isKey = ({path}) => !kept || kept.includes(path) || !isSwept(path, swept);
    keys.set(part, distinct(own.flatMap((schema) => walk.keys(schema, how))).filter(isKey));
  }
  return keys;
}

/** Parts whose table leaves out the keys that it shares with another part's. */
const like = {"simulate.windows": "simulate.exponents", "identify.exponents": "simulate.exponents"};

/** Many keys are abbreviated to their last names: `*.value`. */
const listOf = (paths) =>
  [...new Set(paths.length > 6 ? paths.map((path) => path.replace(/.*\./, "`*.")) : paths)].join(
    ", ",
  );

/** The table of a part, in Markdown: keys with the same meaning share a row, and top-level keys link
 * to the heading that names them. */
function tableOf(keys, linkOf) {
  const rows = new Map();
  for (const {path, si, meaning} of keys) {
    const row = rows.get(meaning) ?? {paths: [], si: []};
    row.paths.push(linkOf(path));
    if (si) row.si.push(`\`${si}\``);
    rows.set(meaning, row);
  }
  const lines = [...rows].map(([meaning, {paths, si}]) => {
    const text = meaning.replaceAll("|", "\\|");
    return `| ${listOf(paths)} | ${listOf(si)} | ${text} |`;
  });
  return ["| key | in SI | meaning |", "| --- | --- | --- |", ...lines].join("\n");
}

/** A Markdown text in which each table marked with <!-- keys: PART --> is generated. */
export const withKeyTables = (markdown, keys) =>
  markdown.replace(/^(<!-- keys: (\S+) -->\n)(?:\|.*\n)*/gm, (_, marker, part) => {
    const known = new Set((keys.get(like[part]) ?? []).map(({path}) => path));
    const own = keys.get(part).filter(({path}) => !known.has(path));
    const linkOf = (path) => {
      const heading = parts[part].top && headingOf(markdown, path);
      return heading ? `[\`${path}\`](#${heading})` : `\`${path}\``;
    };
    return `${marker}${tableOf(own, linkOf)}\n`;
  });

/** The anchor of the heading below a response that consists of keys and names this one. */
function headingOf(markdown, key) {
  const isOfKeys = (title) => /^`[^`]+`(?:(?:, | and )`[^`]+`)*$/.test(title);
  const titles = [...markdown.matchAll(/^### (.*)$/gm)].map(([, title]) => title);
  const title = titles.find((one) => isOfKeys(one) && codes(one).includes(key));
  return title && anchorOf(title);
}

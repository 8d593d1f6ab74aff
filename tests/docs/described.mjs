// Collects all answer keys of the OpenAPI document, by section of the documents.

/**
 * By part: the schemas that tell it, or their key `at`; what in them is told elsewhere, all but
 * their keys at the `top` or `opaque` ones; of lines that have values by the names of what is swept,
 * those of the names that are keys all the same.
 */
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
  "sweep.start": {of: ["SweepStart"], opaque: ["parameters", "request"]},
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
  provenance: {of: ["Provenance"], opaque: ["request"]},
  identify: {of: ["Identification"], top: true},
  "identify.signal": {of: ["Signal"]},
  "identify.fitted": {of: ["Fitted"]},
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
  problem: {of: ["Problem"]},
};

/** Placeholder for the names of a sweep's parameters. */
const isSwept = (path, fields) => fields.has(path.split(".").at(-1)) && !path.includes("state.");

class Walk {
  constructor(openapi) {
    this.schemas = openapi.components.schemas;
  }

  schema({$ref}) {
    return this.schemas[$ref.split("/").at(-1)];
  }

  /** The paths of the leaves below a schema. */
  paths(schema, {opaque = [], top = false}, path = "") {
    if (schema.$ref) return this.paths(this.schema(schema), {opaque, top}, path);
    if (path && (top || opaque.includes(path))) return [path];
    const several = schema.anyOf ?? schema.oneOf;
    if (several) return several.flatMap((one) => this.paths(one, {opaque, top}, path));
    if (schema.properties)
      return Object.entries(schema.properties).flatMap(([name, inner]) =>
        this.paths(inner, {opaque, top}, path ? `${path}.${name}` : name),
      );
    const entries = schema.items && this.paths(schema.items, {opaque, top}, `${path}[]`);
    return entries?.[0]?.startsWith(`${path}[].`) ? entries : [path];
  }
}

/** A Map of Sets of paths, like answeredKeys(). */
export function describedKeys(openapi) {
  const walk = new Walk(openapi);
  const fields = new Set(Object.keys(walk.schemas.SweepBase.properties));
  const keys = new Map();
  for (const [part, {of, at, swept, ...how}] of Object.entries(parts)) {
    const schemas = of.map((name) => walk.schemas[name]);
    const own = at ? schemas.map((schema) => schema.properties[at]) : schemas;
    const paths = own.flatMap((schema) => walk.paths(schema, how));
    const isKey = (path) => !swept || swept.includes(path) || !isSwept(path, fields);
    keys.set(part, new Set(paths.filter(isKey)));
  }
  const {Parameters, Field} = walk.schemas;
  const opaque = ["model.symbols", ...Object.keys(Parameters.properties).slice(1)];
  const own = Object.keys(Field.properties);
  keys.set("parameters-answer", new Set([...walk.paths(Parameters, {opaque}), ...own]));
  return keys;
}

// The form of a sweep: its axes, how each point is run, and what all points share; and the same as a query.
import {$, element} from "./dom.js";
import {Form, groups} from "./form.js";

const none = "none";
const axisNames = ["axis1", "axis2"];

// Sweeps to begin with. The first is shown when nothing is asked for.
export const examples = [
  ["Regimes over b, the range of Table 3", "axis1=b,0.003,0.04,400&cycles=1000&section=impact&damping=closed_form"],
  ["Map over b and R", "axis1=b,0.003,0.04,120&axis2=R,0.3,0.9,80&cycles=200&transient_cycles=100&damping=closed_form"],
  ["Map over Ω and G", "axis1=Omega,0.94,1.06,120&axis2=G,0.005,0.04,80&cycles=200&transient_cycles=100&b=0.015&damping=closed_form"],
  ["Resonance, from two initial states", "axis1=Omega,0.92,1.08,240&cycles=300&section=stroboscopic&starts=x0=0; y_dot0=0.03&b=0.015&damping=closed_form"],
  ["Resonance, followed upwards", "axis1=Omega,0.92,1.08,320&cycles=300&section=impact&carry_state=up&b=0.015&damping=closed_form"],
];

/** The fields of an axis: the server's, with the parameters to choose from; one that may be absent has none of them at first. */
function axisFields(fields, parameters, optional) {
  const choices = [...(optional ? [none] : []), ...parameters];
  return fields.filter((f) => f.name !== "values")
    .map((f) => f.name === "parameter" ? {...f, choices, default: optional ? none : undefined} : {...f, default_note: f.name === "count" ? "" : " ", narrow: true});
}

const runFields = (fields, base) => [
  ...fields.filter((f) => ["integer", "choice"].includes(f.type)).map((f) => ({...f, narrow: true})),
  ...base.filter((f) => f.name === "max_impacts").map((f) => ({...f, group: "sweep"})),
  ...fields.filter((f) => f.name === "starts").map((f) => ({...f, type: "states"})),
];

export class SweepForm {
  /** tables: the answer of /v1/parameters; changed: called after each change. */
  constructor(container, tables, changed) {
    const {start, system, reduced, SI} = groups;
    this.shared = tables.fields.filter((f) => f.group in {system, reduced, SI, start});
    this.parameters = new Map(this.shared.filter((f) => f.type === "number").map((f) => [f.name, f]));
    this.axes = ["First axis", "Second axis"].map((title, i) =>
      new Form(container, axisFields(tables.axis_fields, [...this.parameters.keys()], i === 1), {prefix: `sweep-${axisNames[i]}-`, grouped: {axis: [title, true]}}));
    this.run = new Form(container, runFields(tables.sweep_fields, tables.fields), {prefix: "sweep-", grouped: {sweep: ["Each point", true]}});
    this.base = new Form(container, this.shared, {prefix: "sweep-base-", grouped: {system, reduced, SI, start}});
    this.notes = this.axes.map((axis) => axis.parts.get("axis").appendChild(element("p", {className: "note"})));
    this.axes.forEach((axis, i) => axis.inputs.get("parameter").addEventListener("change", () => this.chooseParameter(i)));
    container.addEventListener("input", () => { this.adapt(); changed(); });
  }

  parameter(i) { return this.axes[i].inputs.get("parameter").value; }

  /** The limits that were there are of another parameter. A map has no place for a section, which would be most of the answer. */
  chooseParameter(i) {
    for (const name of ["from", "to"]) this.axes[i].inputs.get(name).value = "";
    if (i === 1 && this.parameter(1) !== none) this.run.inputs.get("section").value = none;
    this.adapt();
  }

  /** What depends on the parameters chosen: their ranges, and the fields that they take the place of. */
  adapt() {
    this.axes.forEach((axis, i) => {
      const field = this.parameters.get(this.parameter(i));
      for (const name of ["from", "to", "count", "scale"]) axis.rows.get(name).hidden = !field;
      this.notes[i].textContent = field ? `${field.description}${field.unit && field.unit !== "dimensionless" ? `, in ${field.unit}` : ""}` : "";
      axis.inputs.get("from").placeholder = field ? `from ${field.minimum}` : "";
      axis.inputs.get("to").placeholder = field ? `to ${field.maximum}` : "";
    });
    this.base.disable([this.parameter(0), this.parameter(1)]);
  }

  request() {
    const {max_impacts, ...run} = this.run.values();
    const axes = this.axes.map((axis) => axis.values()).filter((axis) => axis.parameter);
    return {base: {...this.base.values(), ...(max_impacts === undefined ? {} : {max_impacts})}, axes, ...run};
  }

  set({base = {}, axes = [], ...run}) {
    this.base.set(base);
    this.run.set({...run, max_impacts: base.max_impacts});
    this.axes.forEach((axis, i) => axis.set(axes[i] ?? (i ? {} : {parameter: "b"})));
    this.adapt();
  }

  /** A request as the address has it: an axis is parameter,from,to,count and its scale unless it is linear; all else as in a form. */
  static toQuery({base, axes, starts, ...run}) {
    const query = new URLSearchParams();
    axes.forEach(({parameter, from = "", to = "", count = "", scale}, i) => query.set(axisNames[i], [parameter, from, to, count, ...(scale ? [scale] : [])].join(",")));
    for (const [name, value] of Object.entries({...run, ...base})) query.set(name, value);
    if (starts) query.set("starts", starts.map((s) => typeof s === "string" ? s : Object.entries(s).map((pair) => pair.join("=")).join(",")).join(";"));
    return query;
  }

  /** Sets what a query asks for. */
  setQuery(query) {
    const {starts, ...rest} = Object.fromEntries(query);
    const axes = axisNames.filter((name) => rest[name]).map((name) => rest[name].split(",")).map(([parameter, from, to, count, scale]) => ({parameter, from, to, count, scale}));
    this.set({base: rest, axes, ...rest, ...(starts ? {starts: [starts]} : {})});
  }

  /** Errors of a problem document at their fields; returns those that belong to none. */
  showErrors(errors) {
    const within = (prefix, other) => errors.filter((e) => e.pointer.startsWith(prefix)).map((e) => ({...e, pointer: e.pointer.slice(prefix.length) || other(e.value)}));
    // An end of the axis that is no such parameter is at fault as a whole axis; its value tells which.
    const end = (i) => (value) => { const {from, to} = this.axes[i].values(); return value === from ? "/from" : value === to ? "/to" : "/parameter"; };
    const ofRun = errors.filter((e) => !/^\/(base|axes)\b/.test(e.pointer) || e.pointer === "/base/max_impacts").map((e) => ({...e, pointer: e.pointer.replace("/base", "")}));
    return [
      ...this.base.showErrors(within("/base", () => "/").filter((e) => e.pointer !== "/max_impacts")),
      ...this.run.showErrors(ofRun),
      ...this.axes[1].showErrors(within("/axes/1", end(1))),
      ...this.axes[0].showErrors([...within("/axes/0", end(0)), ...errors.filter((e) => e.pointer === "/axes").map((e) => ({...e, pointer: "/count"}))]),
    ];
  }

  /** How many points there will be, as far as the fields tell. */
  size() {
    const {axes, starts, cycles, transient_cycles} = this.request();
    const standard = (name) => this.run.fields.find((f) => f.name === name).default;
    const counts = axes.map((axis) => axis.count ?? NaN), points = counts.reduce((a, n) => a * n, starts?.length || 1);
    return {counts, starts: starts?.length || 1, points, cycles: points * ((cycles ?? standard("cycles")) + (transient_cycles ?? standard("transient_cycles")))};
  }

  /** Half a forcing period, pi/Omega, of a point's fields. */
  halfPeriod = (fields) => {
    const of = (name) => fields[name] ?? this.parameters.get(name).default;
    return Math.PI / (fields.Omega ?? (fields.f ? 2 * Math.PI * fields.f / Math.sqrt(of("k1") / of("m1")) : 1));
  };
}

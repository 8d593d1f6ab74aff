// The form of a sweep: its axes, how each point is run, and what all points share; and the same as
// a query.
import {$, element} from "../shared/dom.js";
import {defaultSet, Form, groups} from "../shared/form.js";
import {isOfSystem} from "../shared/presets.js";
import {unitShown} from "../shared/units.js";

const none = "none";
const axisNames = ["axis1", "axis2", "axis3"];

// Sweeps to begin with: title, form, and what a menu beside the plots shows. The first is shown
// when nothing is asked for.
export const examples = [
  [
    "Regimes over b, the range of Table 3",
    "axis1=b,0.003,0.04,400&cycles=1000&section=impact&damping=closed_form",
  ],
  [
    "Frequency response, with and without the absorber",
    "axis1=Omega,0.94,1.06,241&cycles=300&b=0.015&damping=closed_form",
    {beside: "x_max"},
  ],
  [
    "Map over b and R",
    "axis1=b,0.003,0.04,120&axis2=R,0.3,0.9,80&cycles=200&transient_cycles=100&damping=closed_form",
  ],
  [
    "Map over Ω and G",
    "axis1=Omega,0.94,1.06,120&axis2=G,0.005,0.04,80&cycles=200&transient_cycles=100" +
      "&b=0.015&damping=closed_form",
  ],
  [
    "Resonance, from two initial states",
    "axis1=Omega,0.92,1.08,240&cycles=300&section=stroboscopic&starts=x0=0; y_dot0=0.03" +
      "&b=0.015&damping=closed_form",
  ],
  [
    "Resonance, followed upwards",
    "axis1=Omega,0.92,1.08,320&cycles=300&section=impact&carry_state=up" +
      "&b=0.015&damping=closed_form",
  ],
  [
    "A platform's resonance, worst of several starts",
    "axis1=f,13,15,81&starts=default set" +
      "&m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&F=0.0004&R=0.4&b=0.03",
    {beside: "x_max"},
  ],
];

/**
 * The fields of an axis: the server's, with the parameters to choose from; one that may be absent
 * has none of them at first.
 */
function axisFields(fields, parameters, optional) {
  const choices = [...(optional ? [none] : []), ...parameters];
  const menu = {choices, default: optional ? none : undefined};
  const text = (f) => ({default_note: f.name === "count" ? "" : " ", narrow: true});
  return fields
    .filter((f) => f.name !== "values")
    .map((f) => ({...f, ...(f.name === "parameter" ? menu : text(f))}));
}

/** The fields of how a point is run. What there is to reduce depends on the axes. */
function runFields(fields, base) {
  const own = fields.filter((f) => ["integer", "choice"].includes(f.type));
  const reduce = {choices: [none], default: none};
  return [
    ...own.map((f) => ({...f, ...(f.name === "reduce" ? reduce : {}), narrow: true})),
    ...base.filter((f) => f.name === "max_impacts").map((f) => ({...f, group: "sweep"})),
    ...fields.filter((f) => f.name === "starts").map((f) => ({...f, type: "states"})),
  ];
}

function noteOf({description, unit: own}) {
  const {unit} = unitShown(own);
  return unit ? `${description}, in ${unit}` : description;
}

const textOfState = (state) =>
  Object.entries(state)
    .map((pair) => pair.join("="))
    .join(",");

/** Half a forcing period, pi/Omega, of a point's fields. */
export function halfPeriod({Omega, f, f0, k1, m1}) {
  const natural = f0 ?? Math.sqrt(k1 / m1) / (2 * Math.PI); // in Hz
  return Math.PI / (Omega ?? (f ? f / natural : 1));
}

/** The starts as the address has them: the default set's name, or a list of texts or of states. */
function textOfStarts(starts) {
  if (typeof starts === "string") return starts;
  return starts.map((s) => (typeof s === "string" ? s : textOfState(s))).join(";");
}

export class SweepForm {
  /** tables: the answer of /v1/parameters; changed: called after each change. */
  constructor(container, tables, changed) {
    const {start, system, reduced, SI} = groups;
    const grouped = {system, reduced, SI, start};
    this.shared = tables.fields.filter((f) => f.group in grouped);
    const swept = this.shared.filter((f) => f.type === "number");
    this.parameters = new Map(swept.map((f) => [f.name, f]));
    this.axes = ["First axis", "Second axis", "Third axis"].map((title, i) => {
      const fields = axisFields(tables.axis_fields, [...this.parameters.keys()], i > 0);
      const prefix = `sweep-${axisNames[i]}-`;
      return new Form(container, fields, {prefix, grouped: {axis: [title, i < 2]}});
    });
    this.run = new Form(container, runFields(tables.sweep_fields, tables.fields), {
      prefix: "sweep-",
      grouped: {sweep: ["Each point", true]},
    });
    this.base = new Form(container, this.shared, {prefix: "sweep-base-", grouped});
    this.notes = this.axes.map((axis) =>
      axis.parts.get("axis").appendChild(element("p", {className: "note"})),
    );
    this.defaultSet = this.offerDefaultSet();
    this.listen();
    container.addEventListener("input", () => {
      this.adapt();
      changed();
    });
  }

  listen() {
    for (const [i, axis] of this.axes.entries())
      axis.inputs.get("parameter").addEventListener("change", () => this.chooseParameter(i));
    for (const [name, input] of this.base.inputs)
      input.addEventListener("input", () => {
        if (isOfSystem(name) && this.base.filled(name)) this.makeWay();
      });
    this.base.inputs.get("damping").addEventListener("change", () => {
      this.dampingChosen = true;
    });
  }

  /** A box that fills in the default set of starts. */
  offerDefaultSet() {
    const input = this.run.inputs.get("starts");
    const box = element("input", {type: "checkbox", id: "sweep-default-set"});
    const title =
      "at rest in the middle, at a wall, moving, and on from both neighbours: " +
      "the worst and the best of them are told";
    const text = `${defaultSet}: worst and best of several`;
    const label = element("label", {className: "check", title}, box, text);
    this.run.rows.get("starts").insertBefore(label, this.run.errors.get("starts"));
    // Before adapt() hears of it.
    box.addEventListener("input", () => {
      input.value = box.checked ? defaultSet : "";
    });
    return box;
  }

  /**
   * The damping of the paper's numbers goes with its system: it makes way for another one, unless
   * it was chosen.
   */
  makeWay() {
    const input = this.base.inputs.get("damping");
    const standard = this.base.fields.find((f) => f.name === "damping").default;
    if (this.dampingChosen || input.value === standard) return;
    this.base.replace("damping", standard);
    $("sweep-note").textContent = `A system of your own: damping is ${standard}`;
  }

  parameter(i) {
    return this.axes[i].inputs.get("parameter").value;
  }

  /**
   * The limits that were there are of another parameter. A map has no place for a section, which
   * would be most of the answer.
   */
  chooseParameter(i) {
    for (const name of ["from", "to"]) this.axes[i].replace(name, "");
    if (i > 0 && this.parameter(i) !== none) this.run.inputs.get("section").value = none;
    if (isOfSystem(this.parameter(i))) this.makeWay();
    this.adapt();
  }

  /**
   * What depends on the parameters chosen: their ranges, and the fields that they take the place
   * of.
   */
  adapt() {
    for (const [i, axis] of this.axes.entries()) {
      const field = this.parameters.get(this.parameter(i));
      for (const name of ["from", "to", "count", "scale"]) axis.rows.get(name).hidden = !field;
      this.notes[i].textContent = field ? noteOf(field) : "";
      this.scale(i, this.parameter(i));
      for (const [name, end] of [
        ["from", field?.minimum],
        ["to", field?.maximum],
      ])
        axis.inputs.get(name).placeholder = field ? `${name} ${axis.shown(name, end)}` : "";
    }
    const swept = this.axes.map((_, i) => this.parameter(i));
    this.base.disable([...swept, ...this.base.unmixable(swept)]);
    this.adaptRun();
  }

  /**
   * What can be reduced, and what the default set and a reduction leave no place for: they tell of
   * several motions.
   */
  adaptRun() {
    const {inputs} = this.run;
    const reduce = inputs.get("reduce");
    const chosen = reduce.value;
    const swept = this.axes.map((_, i) => this.parameter(i)).filter((name) => name !== none);
    const choices = [none, ...swept.flatMap((name) => [`max over ${name}`, `min over ${name}`])];
    reduce.replaceChildren(...choices.map((c) => new Option(c)));
    reduce.value = choices.includes(chosen) ? chosen : none;
    const several = inputs.get("starts").value.trim() === defaultSet;
    this.defaultSet.checked = several;
    const off = [
      ...(several ? ["carry_state"] : []),
      ...(several || reduce.value !== none ? ["section"] : []),
    ];
    for (const name of off) inputs.get(name).value = none;
    this.run.disable(off);
  }

  /** The ends of an axis are typed in the unit of its parameter. */
  scale(i, parameter) {
    const {factor} = unitShown(this.parameters.get(parameter)?.unit);
    for (const name of ["from", "to"]) this.axes[i].factors.set(name, factor);
  }

  request() {
    const {max_impacts, ...run} = this.run.values();
    const limit = max_impacts === undefined ? {} : {max_impacts};
    const axes = this.axes.map((axis) => axis.values()).filter((axis) => axis.parameter);
    return {base: {...this.base.values(), ...limit}, axes, ...run};
  }

  set({base = {}, axes = [], ...run}) {
    this.base.set(base);
    const given = [axes[0] ?? {parameter: "b"}, axes[1] ?? {}, axes[2] ?? {}];
    for (const [i, axis] of given.entries()) {
      this.scale(i, axis.parameter);
      this.axes[i].set(axis);
    }
    this.adapt();
    this.run.set({...run, max_impacts: base.max_impacts});
    this.adapt();
  }

  /**
   * A request as the address has it: an axis is parameter,from,to,count and its scale unless it is
   * linear; all else as in a form.
   */
  static toQuery({base, axes, starts, ...run}) {
    const query = new URLSearchParams();
    for (const [i, {parameter, from = "", to = "", count = "", scale}] of axes.entries()) {
      const parts = [parameter, from, to, count, ...(scale ? [scale] : [])];
      query.set(axisNames[i], parts.join(","));
    }
    for (const [name, value] of Object.entries({...run, ...base})) query.set(name, value);
    if (starts) query.set("starts", textOfStarts(starts));
    return query;
  }

  /** Sets what a query asks for. example: it is one of the examples, whose damping nobody chose. */
  setQuery(query, example) {
    this.dampingChosen = !example && query.has("damping");
    $("sweep-note").textContent = "";
    const {starts, ...rest} = Object.fromEntries(query);
    const axes = axisNames
      .filter((name) => rest[name])
      .map((name) => rest[name].split(","))
      .map(([parameter, from, to, count, scale]) => ({parameter, from, to, count, scale}));
    this.set({base: rest, axes, ...rest, ...(starts ? {starts: [starts]} : {})});
  }

  /** Errors of a problem document at their fields; returns those that belong to none. */
  showErrors(errors) {
    const within = (prefix, other) =>
      errors
        .filter((e) => e.pointer.startsWith(prefix))
        .map((e) => ({...e, pointer: e.pointer.slice(prefix.length) || other(e.value)}));
    const ofBase = within("/base", () => "/").filter((e) => e.pointer !== "/max_impacts");
    const ofRun = errors
      .filter((e) => !/^\/(base|axes)\b/.test(e.pointer) || e.pointer === "/base/max_impacts")
      .map((e) => ({...e, pointer: e.pointer.replace("/base", "")}));
    const ofAxis = (i) => within(`/axes/${i}`, (value) => this.faultOf(i, value));
    const ofAllAxes = errors
      .filter((e) => e.pointer === "/axes")
      .map((e) => ({...e, pointer: "/count"}));
    return [
      ...this.base.showErrors(ofBase),
      ...this.run.showErrors(ofRun),
      ...[2, 1].flatMap((i) => this.axes[i].showErrors(ofAxis(i))),
      ...this.axes[0].showErrors([...ofAxis(0), ...ofAllAxes]),
    ];
  }

  /** Where an axis is at fault as a whole: an end that is no such parameter has this value. */
  faultOf(i, value) {
    const {from, to} = this.axes[i].values();
    if (value === from) return "/from";
    return value === to ? "/to" : "/parameter";
  }

  /** How many points there will be, as far as the fields tell. */
  size() {
    const {axes, starts: asked, cycles, transient_cycles} = this.request();
    const several = asked === defaultSet;
    const starts = several ? 1 : asked?.length || 1;
    const standard = (name) => this.run.fields.find((f) => f.name === name).default;
    const counts = axes.map((axis) => axis.count ?? NaN);
    const points = counts.reduce((a, n) => a * n, starts);
    const transient = transient_cycles ?? standard("transient_cycles");
    const cyclesOfRun = transient + (cycles ?? standard("cycles"));
    return {counts, starts, points, cycles: points * (several ? 5 : 1) * cyclesOfRun};
  }
}

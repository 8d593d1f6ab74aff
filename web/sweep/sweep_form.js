// The form of a sweep: its axes, how each point is run, and what all points share; and the same as
// a query.
import {element, write} from "../shared/dom.js";
import {defaultSet, Form, groups, textOf, unknownText} from "../shared/form.js";
import {isOfSystem} from "../shared/presets.js";
import {unitShown} from "../shared/units.js";
import {fillMenu} from "./menu.js";

const none = "none";
const axisNames = ["axis1", "axis2", "axis3"];
const ends = ["from", "to"];

// Sweeps to begin with: title and query. The first is shown when nothing is asked for.
export const examples = [
  [
    "Regimes over b, the range of Table 3",
    "axis1=b,0.003,0.04,400&cycles=1000&section=impact&damping=closed_form",
  ],
  [
    "Frequency response, with and without the absorber",
    "axis1=Omega,0.94,1.06,241&cycles=300&b=0.015&damping=closed_form&beside=x_max",
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
      "&m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&F=0.0004&R=0.4&b=0.03&beside=x_max",
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

const standardOf = (form, name) => form.fields.find((f) => f.name === name).default;

/** Where an axis is at fault as a whole: an end that is no such parameter has this value. */
function faultOf(axis, value) {
  const values = axis.values();
  return ends.find((name) => values[name] === value) ?? "parameter";
}

export class SweepForm {
  /** tables: the answer of /v1/parameters; changed: called after each change. */
  constructor(container, tables, changed) {
    const {start, system, reduced, SI} = groups;
    const grouped = {system, reduced, SI, start};
    const shared = tables.fields.filter((f) => f.group in grouped);
    const swept = shared.filter((f) => f.type === "number");
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
    this.base = new Form(container, shared, {prefix: "sweep-base-", grouped});
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

  /** All of it before the container hears of it, which adapts the rest. */
  listen() {
    for (const [i, axis] of this.axes.entries())
      axis.inputs.get("parameter").oninput = () => this.chooseParameter(i);
    for (const [name, input] of this.base.inputs)
      input.oninput = () => {
        if (name === "damping") this.dampingChosen = true;
        else if (isOfSystem(name) && this.base.filled(name)) this.makeWay();
      };
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
    this.run.errors.get("starts").before(label);
    box.oninput = () => {
      input.value = box.checked ? defaultSet : "";
    };
    return box;
  }

  /**
   * The damping of the paper's numbers goes with its system: it makes way for another one, unless
   * it was chosen.
   */
  makeWay() {
    const standard = standardOf(this.base, "damping");
    if (this.dampingChosen || this.base.inputs.get("damping").value === standard) return;
    this.base.replace("damping", standard);
    write({"sweep-note": `A system of your own: damping is ${standard}`});
  }

  /** The parameters of the axes, none for one that is absent. */
  swept() {
    return this.axes.map((axis) => axis.inputs.get("parameter").value);
  }

  /**
   * The limits that were there are of another parameter. A map has no place for a section, which
   * would be most of the answer.
   */
  chooseParameter(i) {
    const parameter = this.swept()[i];
    for (const name of ends) this.axes[i].replace(name, "");
    if (i > 0 && parameter !== none) this.run.inputs.get("section").value = none;
    if (isOfSystem(parameter)) this.makeWay();
  }

  /**
   * What depends on the parameters chosen: their ranges, and the fields that they take the place
   * of; reduce: the reduction to choose, if it is another.
   */
  adapt(reduce) {
    const swept = this.swept();
    for (const [i, axis] of this.axes.entries()) {
      const field = this.parameters.get(swept[i]);
      for (const [name, row] of axis.rows) row.hidden = !field && name !== "parameter";
      this.notes[i].textContent = field ? noteOf(field) : "";
      this.scale(i, swept[i]);
      const range = {from: field?.minimum, to: field?.maximum};
      for (const name of ends)
        axis.inputs.get(name).placeholder = `${name} ${axis.shown(name, range[name])}`;
    }
    this.base.disable([...swept, ...this.base.unmixable(swept)]);
    this.adaptRun(swept, reduce);
  }

  /**
   * What can be reduced, and what the default set and a reduction leave no place for: they tell of
   * several motions.
   */
  adaptRun(swept, reduce) {
    const {inputs} = this.run;
    const axes = swept.filter((name) => name !== none);
    const reductions = axes.flatMap((name) => [[`max over ${name}`], [`min over ${name}`]]);
    fillMenu(inputs.get("reduce"), [[none], ...reductions], reduce);
    const several = inputs.get("starts").value.trim() === defaultSet;
    this.defaultSet.checked = several;
    const off = [];
    if (several) off.push("carry_state");
    if (several || inputs.get("reduce").value !== none) off.push("section");
    for (const name of off) inputs.get(name).value = none;
    this.run.disable(off);
  }

  /** The ends of an axis are typed in the unit of its parameter. */
  scale(i, parameter) {
    const {factor} = unitShown(this.parameters.get(parameter)?.unit);
    for (const name of ends) this.axes[i].factors.set(name, factor);
  }

  request() {
    const {max_impacts, ...run} = this.run.values();
    const limit = max_impacts === undefined ? {} : {max_impacts};
    const axes = this.axes.map((axis) => axis.values()).filter((axis) => axis.parameter);
    return {base: {...this.base.values(), ...limit}, axes, ...run};
  }

  /**
   * A request as the address has it: an axis is parameter,from,to,count and its scale unless it is
   * linear; all else as in a form.
   */
  static toQuery({base, axes, ...run}) {
    const query = new URLSearchParams();
    for (const [i, {parameter, from, to, count, scale}] of axes.entries()) {
      const parts = [parameter, from, to, count, ...(scale ? [scale] : [])];
      query.set(axisNames[i], parts.join(","));
    }
    for (const [name, value] of Object.entries({...run, ...base})) query.set(name, textOf(value));
    return query;
  }

  /** Sets what a query asks for. example: it is one of the examples, whose damping nobody chose. */
  setQuery(query, example) {
    this.dampingChosen = !example && query.has("damping");
    const fields = Object.fromEntries(query);
    const isKnown = (name) =>
      axisNames.includes(name) || [this.base, this.run].some((form) => form.inputs.has(name));
    const unknown = Object.keys(fields).filter((name) => !isKnown(name));
    write({"sweep-note": unknownText(unknown)});
    this.base.set(fields);
    this.run.set(fields);
    const given = axisNames.filter((name) => fields[name]).map((name) => fields[name].split(","));
    for (const [i, axis] of this.axes.entries()) {
      const [parameter = i ? undefined : "b", from, to, count, scale] = given[i] ?? [];
      this.scale(i, parameter);
      axis.set({parameter, from, to, count, scale});
    }
    this.adapt(fields.reduce);
  }

  /** Errors of a problem document at their fields; returns those that belong to none. */
  showErrors(errors) {
    const placed = errors.map((error) => [error, ...this.placeOf(error)]);
    // The last one leads to its first fault.
    return [this.base, this.run, ...this.axes.toReversed()].flatMap((form) =>
      form.showErrors(
        placed
          .filter(([, own]) => own === form)
          .map(([error, , name]) => ({...error, pointer: `/${name}`})),
      ),
    );
  }

  /** The form and the field of an error. */
  placeOf({pointer, value}) {
    const [, part, name, field] = pointer.split("/");
    if (part === "axes") {
      const axis = this.axes[name ?? 0];
      return [axis, field ?? (name ? faultOf(axis, value) : "count")];
    }
    if (part !== "base") return [this.run, part];
    return name === "max_impacts" ? [this.run, name] : [this.base, name];
  }

  /** How many points there will be, as far as the fields tell. */
  size() {
    const {axes, starts: asked, ...run} = this.request();
    const several = asked === defaultSet;
    const starts = several ? 1 : asked?.length || 1;
    const counts = axes.map((axis) => axis.count ?? NaN);
    const points = counts.reduce((a, n) => a * n, starts);
    const cyclesOf = (name) => run[name] ?? standardOf(this.run, name);
    const cycles = cyclesOf("transient_cycles") + cyclesOf("cycles");
    return {counts, starts, points, cycles: points * (several ? 5 : 1) * cycles};
  }
}

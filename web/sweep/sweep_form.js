// The form of a sweep: axes, run of each point, shared fields; and its conversion to and from a
// query.
import {element, fillMenu, setTexts} from "../shared/dom.js";
import {defaultSet, Form, groups, isOfSystem, textOf, unknownText} from "../shared/form.js";
import {unitShown} from "../shared/units.js";

const none = "none";
const axisNames = ["axis1", "axis2", "axis3"];
const ends = ["from", "to"];

// Examples: title and query. The first is shown by default.
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
 * Fields of an axis, from the service's table, with a menu of the parameters. An optional axis
 * starts without a parameter.
 */
function axisFields(fields, parameters, optional) {
  const choices = [...(optional ? [none] : []), ...parameters];
  const menu = {choices, default: optional ? none : undefined};
  const text = (f) => ({default_note: f.name === "count" ? "" : " ", narrow: true});
  return fields
    .filter((f) => f.name !== "values")
    .map((f) => ({...f, ...(f.name === "parameter" ? menu : text(f))}));
}

/** Fields for the run of a point. The choices of `reduce` depend on the axes. */
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

/** A count with its digits in groups of three. */
export const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, " ");

const standardOf = (form, name) => form.fields.find((f) => f.name === name).default;

/**
 * The field to blame for an error of a whole axis: the end with the value at fault, or the
 * parameter.
 */
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

  /** These handlers run before the listener of the container, which calls adapt(). */
  listen() {
    for (const [i, axis] of this.axes.entries())
      axis.inputs.get("parameter").oninput = () => this.chooseParameter(i);
    for (const [name, input] of this.base.inputs)
      input.oninput = () => {
        if (name === "damping") this.dampingChosen = true;
        else if (isOfSystem(name) && this.base.filled(name)) this.resetDamping();
      };
  }

  /** A check box that fills in the default set of starts. */
  offerDefaultSet() {
    const input = this.run.inputs.get("starts");
    const box = element("input", {type: "checkbox", id: "sweep-default-set"});
    const title =
      "from the middle, a wall, moving, and both neighbours' final states; " +
      "the worst and the best motion are shown";
    const text = `${defaultSet}: worst and best of several`;
    const label = element("label", {className: "check", title}, box, text);
    this.run.errors.get("starts").before(label);
    box.oninput = () => {
      input.value = box.checked ? defaultSet : "";
    };
    return box;
  }

  /**
   * The closed-form damping belongs to the paper's system. It is reset for another system, unless
   * the user chose it.
   */
  resetDamping() {
    const standard = standardOf(this.base, "damping");
    if (this.dampingChosen || this.base.inputs.get("damping").value === standard) return;
    this.base.replace("damping", standard);
    setTexts({"sweep-note": `User-defined system: damping is ${standard}`});
  }

  /** Parameters of the axes; "none" for a missing axis. */
  swept() {
    return this.axes.map((axis) => axis.inputs.get("parameter").value);
  }

  /**
   * Clears the ends, which belong to the previous parameter. A map does not show a section, which
   * would be most of the answer, so it is turned off.
   */
  chooseParameter(i) {
    const parameter = this.swept()[i];
    for (const name of ends) this.axes[i].replace(name, "");
    if (i > 0 && parameter !== none) this.run.inputs.get("section").value = none;
    if (isOfSystem(parameter)) this.resetDamping();
  }

  /**
   * Adapts ranges, units, disabled fields and the size to the fields. reduce: the reduction to
   * select, if it changes.
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
    this.base.disable(swept);
    this.adaptRun(swept, reduce);
    this.showSize();
  }

  /**
   * Adapts the reductions, and disables fields that cannot be combined with the default set of
   * starts or with a reduction, both of which report several motions.
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
   * A request as a query: an axis is parameter,from,to,count and, unless linear, its scale; other
   * fields as in a form.
   */
  static toQuery({base, axes, ...run}) {
    const query = new URLSearchParams();
    for (const [i, {parameter, from, to, count, scale}] of axes.entries()) {
      const parts = [parameter, from, to, count, ...(scale ? [scale] : [])];
      query.set(axisNames[i], parts.join(","));
    }
    for (const [name, value] of Object.entries({...run, ...base})) query.set(name, textOf(value));
    return String(query);
  }

  /**
   * Fills the form from a query. example: the query is an example, whose damping was not chosen by
   * the user.
   */
  setQuery(query, example) {
    this.dampingChosen = !example && query.has("damping");
    const fields = Object.fromEntries(query);
    const isKnown = (name) =>
      axisNames.includes(name) || [this.base, this.run].some((form) => form.inputs.has(name));
    const unknown = Object.keys(fields).filter((name) => !isKnown(name));
    setTexts({"sweep-note": unknownText(unknown)});
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

  /** Shows errors of a problem document at their fields; returns those without a field. */
  showErrors(errors) {
    const placed = errors.map((error) => [error, ...this.placeOf(error)]);
    // The last form focuses its first invalid field.
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

  /** Shows the number of points and cycles, if the fields are filled. */
  showSize() {
    const {axes, starts: given, ...run} = this.request();
    const several = given === defaultSet;
    const starts = several ? 1 : given?.length || 1;
    const counts = axes.map(({count}) => count ?? NaN);
    const points = counts.reduce((a, n) => a * n, starts);
    const cyclesOf = (name) => run[name] ?? standardOf(this.run, name);
    const each = (several ? 5 : 1) * (cyclesOf("transient_cycles") + cyclesOf("cycles"));
    const factors = [...counts, ...(starts > 1 ? [`${starts} starts`] : [])];
    const product = factors.length > 1 ? `${factors.join(" × ")} = ` : "";
    const size = `${product}${grouped(points)} points, ${grouped(points * each)} cycles`;
    setTexts({"sweep-size": Number.isFinite(points) ? size : ""});
  }
}

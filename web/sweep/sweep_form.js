// The form of a sweep; its fields of an axis have the axis' name in front: axis1_from.
import {$, element, fillMenu, setTexts} from "../shared/dom.js";
import {BaseForm, defaultSet, queryOf, shown, smallScreen, unknownText} from "../shared/form.js";
import {joined} from "../shared/numbers.js";
import {unitShown} from "../shared/units.js";

const none = "none";
const axisNames = ["axis1", "axis2", "axis3"];
const axisParts = ["parameter", "from", "to", "count", "scale"];

const defaultSetBox = $("sweep-default-set");
const parameterOf = (axis) => `${axis}_parameter`;
const endsOf = (axis) => [`${axis}_from`, `${axis}_to`];

/** Fields of an axis with a menu of the parameters; an optional axis starts without one. */
function axisFields(axis, fields, parameters, optional) {
  const choices = [...(optional ? [none] : []), ...parameters];
  const menu = {choices, default: optional ? none : undefined};
  const text = (name) => ({default_note: name === "count" ? "" : " ", narrow: true});
  return fields
    .filter(({name}) => axisParts.includes(name))
    .map((f) => ({...f, ...(f.name === "parameter" ? menu : text(f.name))}))
    .map((f) => ({...f, name: `${axis}_${f.name}`, label: f.name, group: axis, part: axis}));
}

/** Fields for the run of a point. The choices of `reduce` depend on the axes. */
function runFields(fields, base) {
  const own = fields.filter((f) => ["integer", "choice"].includes(f.type) && f.name !== "format");
  const reduce = {choices: [none], default: none};
  const named = (list, name) => list.find((f) => f.name === name);
  const all = [
    ...own.map((f) => ({...f, ...(f.name === "reduce" && reduce), narrow: true})),
    {...named(base, "max_impacts"), part: "base"},
    {...named(fields, "starts"), type: "states"},
  ];
  return all.map((f) => ({part: "run", ...f, group: "sweep"}));
}

/** A count with its digits in groups of three. */
export const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, " ");

const ownGroups = {
  axis1: ["First axis", true],
  axis2: ["Second axis", true],
  axis3: ["Third axis", false],
  sweep: ["Each point", true],
};

export class SweepForm extends BaseForm {
  /** tables: the answer of /v1/parameters; changed: called after each change. */
  constructor(container, tables, changed) {
    super(container, tables, "sweep-", ownGroups, (names) => [
      ...axisNames.flatMap((axis, i) => axisFields(axis, tables.axis_fields, names, i > 0)),
      ...runFields(tables.sweep_fields, tables.fields),
    ]);
    $("sweep-more").open = !smallScreen; // the results lie below the form
    const addNote = (axis) => this.parts.get(axis).appendChild(element("p", {className: "note"}));
    this.notes = axisNames.map(addNote);
    this.named.get("starts").error.before($("sweep-default"));
    container.addEventListener("input", ({target}) => {
      const field = this.fields.find(({input}) => input === target);
      if (field) this.edited(field.name, target.value);
      if (target === defaultSetBox) this.input("starts").value = target.checked ? defaultSet : "";
      this.adapt();
      changed();
    });
  }

  /** Another parameter clears the ends of its axis. A second axis turns off the section. */
  edited(name, value) {
    const axis = axisNames.find((each) => name === parameterOf(each));
    if (axis) for (const end of endsOf(axis)) this.replace(end, "");
    if (axis && axis !== axisNames[0] && value !== none) this.input("section").value = none;
  }

  /** Adapts ranges, units, disabled fields and size. reduce: the reduction to select, if new. */
  adapt(reduce) {
    const swept = axisNames.map((axis) => this.input(parameterOf(axis)).value);
    for (const [i, axis] of axisNames.entries()) {
      const field = this.parameters.get(swept[i]);
      for (const part of axisParts)
        this.named.get(`${axis}_${part}`).row.hidden = !field && part !== "parameter";
      const {unit} = unitShown(field?.unit);
      this.notes[i].textContent = joined([field?.description, unit && `in ${unit}`]);
      const [from, to] = endsOf(axis);
      this.scale([from, to], swept[i]);
      this.input(from).placeholder = `from ${shown(this.named.get(from), field?.minimum)}`;
      this.input(to).placeholder = `to ${shown(this.named.get(to), field?.maximum)}`;
    }
    this.adaptRun(swept, reduce);
    this.showSize();
  }

  /** Adapts the reductions; disables what is swept or excluded by several motions of a point. */
  adaptRun(swept, reduce) {
    const axes = swept.filter((name) => name !== none);
    const reductions = axes.flatMap((name) => [[`max over ${name}`], [`min over ${name}`]]);
    fillMenu(this.input("reduce"), [[none], ...reductions], reduce);
    const several = this.input("starts").value.trim() === defaultSet;
    defaultSetBox.checked = several;
    const off = [];
    if (several) off.push("carry_state");
    if (several || this.input("reduce").value !== none) off.push("section");
    for (const name of off) this.input(name).value = none;
    this.disable([...off, ...axes]);
  }

  /** Shows the origins of the values, and the ranges of the axes. */
  showOrigins(parameters) {
    super.showOrigins(parameters);
    this.adapt();
  }

  request() {
    const {base, run, ...axes} = this.parted();
    return {base, axes: Object.values(axes).filter(({parameter}) => parameter), ...run};
  }

  /** A request as a query; an axis is parameter,from,to,count and, unless linear, its scale. */
  static toQuery({base, axes, ...run}) {
    const texts = axes.map(({parameter, from, to, count, scale}, i) => {
      const parts = [parameter, from, to, count, ...(scale ? [scale] : [])];
      return [axisNames[i], parts.join(",")];
    });
    return queryOf({...Object.fromEntries(texts), ...run, ...base});
  }

  setQuery(query) {
    const fields = Object.fromEntries(query);
    const unknown = this.unknown(fields).filter((name) => !axisNames.includes(name));
    setTexts({"sweep-note": unknownText(unknown)});
    const given = axisNames.filter((name) => fields[name]).map((name) => fields[name].split(","));
    for (const [i, axis] of axisNames.entries()) {
      const parts = given[i] ?? (i ? [] : ["b"]);
      this.scale(endsOf(axis), parts[0]);
      for (const [k, text] of parts.entries()) fields[`${axis}_${axisParts[k]}`] = text;
    }
    this.set(fields);
    this.adapt(fields.reduce);
  }

  /** The field of an error; for one of a whole axis the end with the value at fault. */
  nameOf({pointer, value}) {
    const [, part, key, field] = pointer.split("/");
    if (part === "base") return key;
    if (part !== "axes") return part;
    const axis = axisNames.filter((a) => this.input(parameterOf(a)).value !== none)[key ?? 0];
    if (field) return `${axis}_${field}`;
    if (!key) return `${axis}_count`;
    return endsOf(axis).find((end) => this.values()[end] === value) ?? parameterOf(axis);
  }

  /** Shows the number of points and cycles, if the fields are filled. */
  showSize() {
    const {axes, starts: given, ...run} = this.request();
    const several = given === defaultSet;
    const starts = several ? 1 : given?.length || 1;
    const counts = axes.map(({count}) => count ?? NaN);
    const points = counts.reduce((a, n) => a * n, starts);
    const cyclesOf = (name) => run[name] ?? this.named.get(name).default;
    // The default set: five motions per point.
    const each = (several ? 5 : 1) * (cyclesOf("transient_cycles") + cyclesOf("cycles"));
    const factors = [...counts, ...(starts > 1 ? [`${starts} starts`] : [])];
    const product = factors.length > 1 ? `${factors.join(" × ")} = ` : "";
    const size = `${product}${grouped(points)} points, ${grouped(points * each)} cycles`;
    setTexts({"sweep-size": Number.isFinite(points) ? size : ""});
  }
}

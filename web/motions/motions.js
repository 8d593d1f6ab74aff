// The motions tab: motions that the system settles on, and continuations of periodic orbits.
import {linesOf} from "../shared/api.js";
import {$, button, element, setTexts, tableOf} from "../shared/dom.js";
import {BaseForm, defaultSet} from "../shared/form.js";
import {makeAccessible} from "../shared/gestures.js";
import {RequestTab} from "../shared/job.js";
import {count, joined, short} from "../shared/numbers.js";
import * as labels from "../sweep/axis_labels.js";
import {Motions} from "./data.js";
import {MotionsPlot, quantities} from "./motions_plot.js";

const ends = ["from", "to"];
const cycles = {cycles: 300, transient_cycles: 200}; // of each start
const mostBranches = 12; // continuations in addition to that of the base
const cyclesOfOrbit = 100; // for the simulation of an orbit
const standardCount = 61; // values of the parameter at which the system settles

/** Names of the kinds of special points. */
const kinds = {
  fold: "fold",
  flip: "flip: period doubling",
  symmetry_breaking: "symmetry breaking",
  torus: "torus: quasi-periodic motion begins",
  grazing: "grazing",
  stick: "sticking begins or ends",
  end: "end",
};

export class MotionsTab extends RequestTab {
  motions = null;

  constructor(tables, changed, {simulate}) {
    super("motions-", changed);
    labels.useFields(tables.fields);
    this.makeForm(tables);
    const open = ({value, state}) => {
      const {base, parameter} = this.motions.request;
      simulate({...base, [parameter]: value, ...state, cycles: cyclesOfOrbit});
    };
    this.plot = new MotionsPlot($("figure-motions"), {open, place: (value) => this.place(value)});
    this.plot.about = () => this.about();
    this.quantity = $("motions-quantity");
    this.quantity.onchange = () => this.draw();
    this.results.addEventListener("click", ({target}) => target.orbit && open(target.orbit));
  }

  makeForm(tables) {
    this.presets = tables.presets;
    const grouped = {motions: ["Parameter", true]};
    const ofCount = tables.axis_fields.find(({name}) => name === "count");
    const own = [
      ...tables.continue_fields.filter((f) => ["parameter", ...ends, "switch"].includes(f.name)),
      {...ofCount, default: standardCount},
    ];
    this.form = new BaseForm($("motions-fields"), tables, "motions-", grouped, (choices) =>
      own.map((f) => ({
        ...f,
        ...(f.name === "parameter" && {choices, default: "b"}),
        ...{group: "motions", part: "own", narrow: true},
      })),
    );
    const menu = this.form.input("parameter");
    menu.onchange = () => {
      this.form.scale(ends, menu.value);
      for (const end of ends) this.form.replace(end, "");
    };
    $("motions-fields").oninput = () => this.markStale();
  }

  request() {
    return {parameter: "b", ...super.request()};
  }

  /** Shows the motions of a query, or of the first example. */
  open(given) {
    const {dataset} = this.examples.options[1];
    const fields = Object.fromEntries(given.size ? given : new URLSearchParams(dataset.query));
    this.form.scale(ends, fields.parameter ?? "b");
    this.fill(fields);
    if (this.formQuery() !== this.asked) this.send();
  }

  /** Sweep and continuation from the base; then continuations of what no branch explains. */
  async ask(request, signal) {
    const preset = this.presets.find(({name}) => name === request.base.preset);
    this.motions = new Motions(request, preset?.parameters);
    this.plot.show(this.motions);
    const {start} = this.motions;
    const base = {...request.base, ...(Number.isFinite(start) && {[request.parameter]: start})};
    await Promise.all([this.settle(signal), this.follow(base, signal)]);
    for (let n = 0; n < mostBranches; ++n) {
      const found = this.motions.unexplained();
      if (!found) break;
      await this.follow({...base, [request.parameter]: found.value, ...found.state}, signal);
    }
  }

  /** Collects the motions that the system settles on. */
  async settle(signal) {
    const {count: given = standardCount, switch: _, base, ...axis} = this.motions.request;
    const {[axis.parameter]: swept, ...others} = base;
    const axes = [{...axis, count: given}];
    const sweep = {base: others, axes, starts: defaultSet, ...cycles};
    await this.receive("v1/sweep", sweep, signal, (line) => this.motions.settled(line));
  }

  /** Follows the orbit on which a base settles. */
  async follow(base, signal) {
    const {count: _, ...request} = this.motions.request;
    const offset = this.motions.branches.length;
    const take = (line) => this.motions.continued(line, offset);
    await this.receive("v1/continue", {...request, base}, signal, take);
  }

  async receive(path, request, signal, take) {
    for await (const {value: line} of linesOf(path, request, signal)) {
      if (take(line) === false || signal.aborted) return;
      this.drawSoon();
    }
  }

  draw() {
    const {branches, attractors, specials} = this.motions;
    this.plot.draw(quantities[this.quantity.value]);
    const runs = `${count(attractors.length, "run")} from several starts`;
    const found = `${branches.length} ${branches.length === 1 ? "branch" : "branches"}`;
    const text = joined([runs, found, count(specials.length, "special point")]);
    setTexts({"motions-count": text});
    const {title} = quantities[this.quantity.value];
    makeAccessible(this.plot, `${title} of all motions: ${text}`);
    this.listSpecials();
    this.place(this.plot.marked);
  }

  listSpecials() {
    const {parameter} = this.motions.request;
    const head = ["special point", labels.label(parameter), "branch", "largest |x| (mm)", "reason"];
    const rows = this.motions.specials.map(({kind, value, branch, x_max, detail}) => [
      kinds[kind] ?? kind,
      labels.text(parameter, value),
      branch === null ? "–" : String(branch + 1),
      x_max == null ? "–" : short(1000 * x_max),
      detail ?? "",
    ]);
    $("motions-special").replaceChildren(...tableOf(head, rows));
  }

  /** Describes the motions at a value of the parameter, each with a button that simulates it. */
  place(value) {
    const {parameter} = this.motions.request;
    if (value == null) return;
    const {label, of} = quantities[this.quantity.value];
    const found = this.motions.distinctAt(value).map((orbit) => {
      const text = `${orbit.stable ? "stable" : "unstable"}, ${label}: ${short(of(orbit))}`;
      return Object.assign(button(text, null, {className: "small"}), {orbit});
    });
    const where = `At ${labels.fields({[parameter]: value})}:`;
    const orbits = found.length ? found : [" no orbit"];
    $("motions-at").replaceChildren(element("b", {}, where), ...orbits);
  }

  about() {
    const {base, parameter} = this.motions.request;
    return {
      title: `Motions over ${labels.label(parameter)}`,
      summary: $("motions-count").textContent,
      caption: labels.fields(base),
      name: "motions",
    };
  }
}

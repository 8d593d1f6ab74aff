// The design tab: the best absorber over a band, beside none and a tuned mass damper of its mass.
import {linesOf} from "../shared/api.js";
import {$, cards, keyOf, setTexts, tableOf} from "../shared/dom.js";
import {Form} from "../shared/form.js";
import {makeAccessible} from "../shared/gestures.js";
import {RequestTab} from "../shared/job.js";
import {dots, line} from "../shared/marks.js";
import {joined, orDash, percent, shortTo} from "../shared/numbers.js";
import {PlotGroup} from "../shared/plot.js";

const inMm = {unit: "mm", factor: 1000};
/** What a design minimises: name, unit, factor from SI. */
const objectives = {
  x_max: {title: "largest |x|", ...inMm},
  x_rms: {title: "rms of x", ...inMm},
  x_relative_max: {title: "largest distance from the base", ...inMm},
  x_acceleration_max: {title: "largest |x″|", unit: "m/s²", factor: 1},
  impact_speed_max: {title: "fastest impact", unit: "m/s", factor: 1},
  decay_time: {title: "time to a tenth of the energy", unit: "s", factor: 1},
};
const round = (value) => shortTo(3, value);
const hostFields = ["m1", "k1", "f0", "c1", "damping_ratio", "damping"];
const groupOf = ({type}) => (type === "integer" ? "search" : "design");
const [cyclesOfWorst, cyclesOfDecay] = [300, 60]; // for the simulation of the worst case
const colours = ["c1", "c2", "c3", "c4", "minus"]; // of the restitution coefficients

export class DesignTab extends RequestTab {
  points = {}; // the last line of each absorber, of the most frequencies
  done = null; // the last line

  constructor(tables, changed, {simulate}) {
    super("design-", changed);
    const own = tables.design_fields.filter(({name}) => name !== "base");
    const host = tables.fields.filter(({name}) => hostFields.includes(name));
    const fields = [
      ...host.map((f) => ({...f, group: "host", part: "base"})),
      ...own.map((f) => ({...f, part: "own", narrow: true, group: groupOf(f)})),
    ];
    const grouped = {
      host: ["Machine", true],
      design: ["Load and absorber", true],
      search: ["Search", false],
    };
    this.form = new Form($("design-fields"), fields, {prefix: "design-", grouped});
    $("design-fields").oninput = () => this.markStale();
    this.plots = new PlotGroup(this.results, undefined, {
      prefix: "figure-design-",
      about: (name) => ({
        summary: this.done?.sentence ?? "",
        caption: this.asked,
        name: `design-${name}`,
      }),
    });
    $("design-simulate").onclick = () => simulate(this.worstCase());
  }

  /** {name: its key, title, unit, factor}. */
  get objective() {
    const {objective, forcing, initial_velocity: velocity} = this.asking ?? {};
    const standard = forcing ? "x_relative_max" : "x_max";
    const name = objective ?? (velocity ? "decay_time" : standard);
    return {name, ...objectives[name]};
  }

  /** Shows the form of a query, or an example; only a query is computed at once. */
  open(given) {
    const standard = new URLSearchParams($("design-form").dataset.query);
    const fields = Object.fromEntries(given.size ? given : standard);
    this.fill(fields);
    if (given.size && this.formQuery() !== this.asked) this.send();
  }

  async ask(request, signal) {
    Object.assign(this, {points: {}, done: null, asking: request});
    for await (const {value: each} of linesOf("v1/design", request, signal)) {
      if (signal.aborted) return;
      if (each.type === "start") this.host = each.host;
      if (each.type === "point") this.points[[each.b, each.R, each.m2]] = each;
      if (each.type === "progress")
        Object.assign($("design-bar"), {max: each.runs_of || 1, value: each.runs});
      if (each.type === "done") this.done = each;
      this.draw();
    }
  }

  busy(is, cancelled) {
    super.busy(is, cancelled);
    $("design-bar").hidden = !is;
  }

  draw() {
    this.drawMap();
    $("design-found").hidden = !this.done;
    if (!this.done) return;
    setTexts({"design-sentence": this.done.sentence});
    this.showCards();
    const banded = this.asking.f !== undefined;
    this.plots.draw("response", banded && this.response());
    this.showTolerances();
  }

  showCards() {
    const {best, without, tuned_mass_damper: damper} = this.done;
    const {name, unit, factor, title} = this.objective;
    const text = orDash((value) => `${round(value * factor)} ${unit}`);
    const change = (value) => value && without[name] && `${percent(value / without[name])} of that`;
    cards($("design-cards"), [
      ["without absorber", text(without[name]), joined([this.asking.over, title], " ")],
      ["vibro-impact absorber", text(best[name]), change(best[name])],
      ["tuned mass damper", text(damper?.[name]), change(damper?.[name])],
    ]);
  }

  /** The objective over f for each alternative. */
  response() {
    const {f, without, tuned_mass_damper: damper, ...response} = this.done.response;
    const {name, factor, unit, title} = this.objective;
    const of = (y, colour, label, dash) =>
      line({x: f, y: y.map((v) => v && v * factor), colour, label, dash, width: 1.6});
    const label = `${title} (${unit})`;
    const {response: plot} = this.plots.all;
    makeAccessible(plot, `${label} over the frequency`);
    plot.viewport.span(f[0], f.at(-1));
    return {
      x: {label: "f (Hz)", factor: 1},
      y: {label},
      unit,
      marks: [
        of(without, "soft", "without", [5, 4]),
        of(response[`${name}_best_start`], "best", "absorber, best start"),
        of(response[`${name}_worst_start`], "c1", "worst start"),
        of(damper, "c4", "tuned mass damper"),
      ],
    };
  }

  /** The objective over b, with a colour for each R; the best is ringed. */
  drawMap() {
    const {name, factor, unit, title} = this.objective;
    const all = [...new Set(Object.values(this.points).map(({R}) => R))].sort((a, b) => a - b);
    const marks = all.map((R, i) => {
      const own = Object.values(this.points).filter((p) => p.R === R && p[name] != null);
      const [x, y] = [own.map(({b}) => 1000 * b), own.map((p) => p[name] * factor)];
      const colour = colours[i % colours.length];
      return dots({x, y, colour, shape: "dot", size: 3, label: `R = ${R}`});
    });
    const keys = marks.map(({colour, label}) => keyOf("●", colour, label));
    $("design-restitutions").replaceChildren(...keys);
    this.plots.draw("map", {
      marks,
      x: {label: "b (mm)"},
      y: {label: `${this.asking?.over ?? "worst"} ${title} (${unit})`},
      empty: "no absorber tried yet",
    });
    const {best} = this.done ?? {};
    if (best) this.plots.all.map.light(1000 * best.b, best[name] * factor);
  }

  /** The best absorber and how far each of its values can be off. */
  showTolerances() {
    const {best} = this.done;
    const values = {
      b: `${round(1000 * best.b)} mm`,
      R: round(best.R),
      f0: "frequency of the machine",
      damping: "damping of the machine",
    };
    const range = ([low, high]) => `× ${round(low)} to ${round(high)}`;
    const rows = Object.entries(best.margins ?? {}).map(([name, margin]) => [
      name,
      values[name] ?? "",
      range(margin.five_percent),
      range(margin.twenty_percent),
    ]);
    const head = ["value", "best", "5 % worse", "20 % worse"];
    $("design-margins").replaceChildren(...tableOf(head, rows));
    const {impact_speed_max: speed, impulse_max: impulse, impacts_per_second: rate} = best;
    const works = [best.works_from, best.works_to].map((v) => (v == null ? "?" : round(v)));
    const {acceleration, F, forcing} = this.asking;
    let unit = forcing ? "of the load" : "m/s of m₁";
    if (acceleration ?? F) unit = `${F ? "m" : "m/s²"} at the base`;
    setTexts({
      "design-walls": `The walls must stand ${round(rate)} impacts per second, of up to ${round(speed)} m/s and ${round(impulse)} N s. At least half of the reduction remains from ${works[0]} to ${works[1]} ${unit}.`,
    });
  }

  /** The simulation of the best absorber where it is worst. */
  worstCase() {
    const {b, R, m2, f, acceleration, F, initial_velocity: velocity} = this.done.best;
    const {base, forcing} = this.asking;
    const absorber = {...base, b, R, m2};
    if (forcing) return {...absorber, forcing};
    if (f !== null) {
      const load = acceleration == null ? {F} : {acceleration};
      return {...absorber, f, ...load, cycles: cyclesOfWorst};
    }
    const {f0} = this.host;
    const start = {x_dot0: velocity / (2 * Math.PI * f0)};
    return {...absorber, F: 0, f: f0, ...start, cycles: cyclesOfDecay};
  }
}

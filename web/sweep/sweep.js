// The sweep tab: a stream of points, drawn while they arrive. The query holds request and menus.
import {asCurl} from "../shared/api.js";
import * as dom from "../shared/dom.js";
import {$} from "../shared/dom.js";
import {RequestTab} from "../shared/job.js";
import {joined, percent, shortTo} from "../shared/numbers.js";
import * as q from "../shared/quantities.js";
import * as labels from "./axis_labels.js";
import {receive, SweepData} from "./data.js";
import {countRegimes, DiagramView, startStyle} from "./diagram.js";
import {MapView} from "./map_view.js";
import {Refiner} from "./refine.js";
import {grouped, SweepForm} from "./sweep_form.js";

const cyclesOfPoint = 272; // for the simulation of a point; tau = 1709 as in the paper

// Menus by their name in the query. The first entry is the default and not mentioned there.
const ofQuery = {
  coordinate: $("sweep-coordinate"),
  beside: $("sweep-quantity"),
  map: $("sweep-mapped"),
};
const menus = {...ofQuery, start: $("sweep-start"), slice: $("sweep-slice")};

const time = (seconds) =>
  seconds < 90 ? `${seconds.toFixed(0)} s` : `${(seconds / 60).toFixed(0)} min`;

/** Failed and truncated points of a complete sweep, as text. */
function remarksOn({points}) {
  const found = Map.groupBy(points, ({error, reason, points_missing: missing}) => {
    if (error || missing) return `failed: ${error ?? "some values of the reduced axis"}`;
    return reason && reason !== "complete" ? "stopped at max_impacts" : "";
  });
  found.delete("");
  return [...found].map(([what, {length}]) => `${grouped(length)} points ${what}`).join("; ");
}

/** Shows the elements whose data-if names something that holds for the sweep. */
function showParts({axes, section, defaultSet, starts, reduced, points}) {
  const several = starts > 1;
  const holds = {
    begun: true,
    diagrams: axes.length === 1,
    map: axes.length > 1,
    third: axes.length > 2,
    section: section !== "none",
    impact: section === "impact",
    stroboscopic: section === "stroboscopic",
    lambda: reduced === null,
    free: menus.beside.value === "x_max",
    several,
    verdicts: !several, // the colours otherwise distinguish the starts
    startMenu: several || defaultSet,
    motions: axes.length === 1 && (defaultSet || (!several && points.some(q.otherMotion))),
    defaultSet,
    second: !defaultSet,
  };
  for (const node of document.querySelectorAll("#sweep-results [data-if]"))
    node.hidden = !holds[node.dataset.if];
}

function showRegimes({points}) {
  for (const [regime, n] of countRegimes(points)) {
    const number = $(`sweep-regime-${regime}`);
    number.textContent = n || "";
    number.parentNode.classList.toggle("absent", !n);
    number.parentNode.hidden = regime === "none" && !n;
  }
}

/** Legend entry with a mark in a colour; `more` follows it. */
const legendEntry = (text, {mark, colour}, ...more) =>
  dom.element("li", {}, dom.keyOf(mark, colour, text), ...more);

/** Shows the legend of a map of attractors, the most frequent first; empty for other plots. */
function showAttractors(map) {
  const names = map.choice.map === "attractor" ? map.values() : [];
  const items = [...Map.groupBy(names, (name) => name)]
    .sort(([, one], [, other]) => other.length - one.length)
    .map(([name, {length}]) => {
      const share = dom.element("small", {}, percent(length / names.length));
      const style = {mark: "■", colour: map.colourOf(name)};
      return legendEntry(name.replace("_", " "), style, " ", share);
    });
  $("sweep-attractors").replaceChildren(...items);
}

const startsAndFree = {...q.startNames, free: "without the absorber"};

/** Motions of all points from each start, and those without the absorber. */
const motionsOf = ({points, axes: [axis], starts}) =>
  points.flatMap((p, i) => {
    if (!p || p.error) return [];
    const start = starts > 1 ? `start ${p.start + 1}` : "this start";
    const free = p.x_free == null ? [] : [{start: "free", x_max: p.x_free}];
    return [...(p.starts ?? [{...p, start}]), ...free].map((m) => ({where: axis?.given[i], ...m}));
  });

/** Shows the largest |x| from each start over a whole axis: reduced, or of the default set. */
function showPeaks(data) {
  const {reduced, axes, defaultSet, request} = data;
  const bare = reduced && !axes.length;
  const shown = bare || (defaultSet && axes.length === 1 && !reduced);
  dom.reveal({"figure-sweep-peaks": shown});
  if (!shown) return;
  const parameter = reduced ?? axes[0].parameter;
  const which = request.reduce?.startsWith("min") ? "Smallest" : "Largest";
  const title = `${which} |x| over ${q.symbolOf(parameter)}, from each start`;
  dom.setTexts({"sweep-peaks-title": title});
  const motions = motionsOf(data).sort((a, b) => (b.x_max ?? -1) - (a.x_max ?? -1));
  const peaks = Map.groupBy(motions, ({start}) => start); // of each start the highest first
  const head = ["start", "largest |x| (mm)", `at ${labels.label(parameter)}`, "regime", "verdict"];
  const rows = [...peaks.values()].map(([m]) => [
    startsAndFree[m.start] ?? m.start,
    m.x_max == null ? "–" : shortTo(3, m.x_max * 1000),
    m.where == null ? "–" : labels.text(parameter, m.where),
    m.regime ? q.regimeText(m.regime) : "–",
    q.verdicts[m.verdict] ?? "–",
  ]);
  $("sweep-peaks").replaceChildren(...dom.tableOf(head, rows));
}

export class SweepTab extends RequestTab {
  data = null; // the sweep shown
  view = null; // its view; null if no axis remains
  wanted = {}; // menu values for the next sweep, by name in the query
  refiner = new Refiner(this);

  constructor(tables, changed, {simulate}) {
    super("sweep-", changed);
    this.form = new SweepForm($("sweep-fields"), tables, () => this.markStale());
    labels.useFields(tables.fields);
    const openPoint = ({data, index, best}) =>
      simulate({...data.fields(index, best), cycles: cyclesOfPoint});
    const diagrams = new DiagramView($("sweep-stack"), openPoint);
    const map = new MapView($("sweep-map"), openPoint);
    this.views = [null, diagrams, map, map]; // by the number of axes
    for (const viewport of [...diagrams.viewports, ...map.viewports])
      viewport.onZoom(() => {
        changed({soon: true});
        this.refiner.schedule();
      });
    this.listen();
  }

  listen() {
    this.results.onchange = () => this.menuChanged();
    $("sweep-resume").onclick = () => this.complete(this.data);
    $("sweep-download").onclick = (event) => {
      event.preventDefault();
      const names = this.data.request.axes.map((a) => a.parameter).join("-");
      dom.save(this.data.file(), `sweep-${names}.ndjson`);
    };
    $("sweep-copy").onclick = () =>
      dom.copy(asCurl({path: "v1/sweep", body: this.form.request()}, "-sN"), this.say);
  }

  formQuery() {
    return SweepForm.toQuery(this.form.request());
  }

  /** In canonical order, without the menus. */
  requestOf(query) {
    const request = new URLSearchParams(query);
    for (const name of [...Object.keys(ofQuery), "view"]) request.delete(name);
    request.sort();
    return String(request);
  }

  query() {
    if (!this.data) return null;
    const menu = Object.entries(ofQuery)
      .filter(([, {selectedIndex}]) => selectedIndex > 0)
      .map(([name, {value}]) => `${name}=${value}`);
    const ends = this.view?.ends().join(",");
    return [this.asked, ...menu, ...(ends ? [`view=${ends}`] : [])].join("&");
  }

  open(given) {
    const numbers = given.get("view")?.split(",").map(Number) ?? [];
    const ends = numbers.every(Number.isFinite) ? numbers : [];
    if (this.data && this.requestOf(given) === this.requestOf(this.asked)) {
      // The same sweep with other menus: Back or Forward.
      for (const [name, menu] of Object.entries(ofQuery)) dom.choose(menu, given.get(name));
      this.view?.zoomTo(ends);
      this.menuChanged();
    } else this.openSweep(given, ends);
  }

  /** Runs the sweep of a query, or the first example if it names none. */
  openSweep(given, ends) {
    const {query} = this.examples.options[1].dataset;
    const request = this.requestOf(given) || this.requestOf(query);
    const standard = {coordinate: "", beside: "", map: ""}; // the first entry
    this.wanted = {...standard, ...Object.fromEntries(given)};
    this.form.setQuery(new URLSearchParams(request));
    this.send(ends);
  }

  /** ends: the range to show, for a sweep from the address. */
  send(ends) {
    this.form.showErrors([]);
    this.markStale();
    this.complete(Object.assign(new SweepData(this.form.request()), {ends}));
  }

  /** Requests the missing points of a sweep. */
  complete(data) {
    this.refiner.stop();
    this.busy(true);
    this.start(data);
  }

  ask(data, signal) {
    return receive(data, signal, (line) => {
      if (line.type === "start") {
        if (data !== this.data) this.present(data);
        this.say("");
        this.showCount();
      } else if (line.type === "progress") this.showCount(line);
      else this.drawSoon();
    });
  }

  show() {
    super.show();
    this.say(remarksOn(this.data));
    this.refiner.schedule();
  }

  busy(is, cancelled) {
    super.busy(is, cancelled);
    const lacking = this.data && !this.data.complete;
    dom.reveal({"sweep-resume": !is && lacking, "sweep-bar": is || lacking});
    if (is || !lacking) return;
    this.showCount();
    this.redraw();
  }

  /** Shows the empty diagrams of a new sweep. */
  present(data) {
    const edit = this.data !== null;
    this.data = data;
    this.asked = SweepForm.toQuery(data.request);
    data.folded = data.reduced && labels.of(data.reduced);
    this.view = this.views[data.axes.length];
    this.form.showOrigins(data.parameters);
    this.fillMenus();
    const keyOf = (state, s) => legendEntry(`${s + 1}: ${labels.fields(state)}`, startStyle(s));
    $("sweep-starts").replaceChildren(...data.states.map(keyOf));
    this.view?.show(data);
    this.refiner.stop();
    this.redraw();
    if (data.ends) this.view?.zoomTo(data.ends);
    this.markStale();
    this.changed({edit});
  }

  /** Fills the menus for a new sweep; unused ones are empty. */
  fillMenus() {
    const {section, defaultSet, axes, states} = this.data;
    const {parameter = "", values = []} = axes[2] ?? {};
    dom.setTexts({"sweep-slice-word": `where ${q.symbolOf(parameter)} =`});
    const titled = ([name, {title}]) => [name, title];
    const entries = {
      coordinate: Object.entries(q.coordinates[section] ?? {}).map(titled),
      [axes.length > 1 ? "map" : "beside"]: q.menuOf(this.data),
      start: defaultSet ? [[0, "worst"], ["best"]] : states.map((_, s) => [s, s + 1]),
      slice: values.map((v, m) => [m, labels.valueText(parameter, v)]),
    };
    for (const [name, menu] of Object.entries(menus))
      dom.fillMenu(menu, entries[name] ?? [], this.wanted[name]);
    this.wanted = {};
  }

  menuChanged() {
    this.redraw();
    this.refiner.schedule();
    this.changed();
  }

  /** Shows the number of points and, of a line of progress, the rate. */
  showCount({per_second: rate, seconds_left: left} = {}) {
    const {total, received, complete} = this.data;
    Object.assign($("sweep-bar"), {max: total || 1, value: received});
    const parts = [
      `${grouped(received)} of ${grouped(total)} points`,
      left != null && `${rate.toFixed(rate < 10 ? 1 : 0)} per second`,
      left != null && !complete && `${time(left)} left`,
    ];
    dom.setTexts({"sweep-rate": joined(parts, " · ")});
  }

  draw() {
    const values = Object.entries(menus).map(([name, {value}]) => [name, value]);
    this.view?.refresh(Object.fromEntries(values));
    showPeaks(this.data);
    showParts(this.data);
    showRegimes(this.data);
    if (this.view) showAttractors(this.view);
  }

  /** Draws a complete or interrupted sweep, or another choice. */
  redraw() {
    if (!this.data) return;
    this.draw();
    this.view?.describe();
    dom.showRemarks("sweep-remarks", [...this.data.warnings]);
  }
}

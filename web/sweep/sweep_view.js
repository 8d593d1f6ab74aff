// Base of the views of a sweep: its plots share viewports, choices and a tooltip.
import {$, button, element} from "../shared/dom.js";
import {listenToKeys, makeAccessible, zoomKeys} from "../shared/gestures.js";
import {clamp, roundedRange} from "../shared/numbers.js";
import {ZoomablePlot} from "../shared/plot.js";
import * as labels from "./axis_labels.js";

const most = 4; // layers kept
const gap = 14; // px between a place and its tooltip

export const missingPoint = [["", "not computed yet"]];

/**
 * A plot of a view. kind(view) returns its content: title and summary; y, by default the second
 * axis; marks; height(place): where y shows a place, or null; columns: {name: of(p)} of the exported
 * table; rows(p): of a point in it, by default one.
 */
export class SweepPlot extends ZoomablePlot {
  /** name: in the id of its figure. */
  constructor(view, name, kind) {
    super($(`figure-sweep-${name}`), ...view.viewports);
    Object.assign(this, {view, kind, name: `sweep-${name}`});
    this.over.addEventListener("pointermove", ({pointerType, buttons}) => {
      if (pointerType !== "mouse" || this.viewport.cursor === null) return;
      if (buttons) view.hideTip();
      else view.showTip({plot: this, at: view.viewports.map(({cursor}) => cursor)});
    });
  }

  content() {
    if (!this.view.choice) return null;
    const [x, y] = this.view.viewports.map(({range}, i) => {
      const {parameter, log, from} = this.view.data.axes[i];
      const {factor} = labels.of(parameter);
      return {range: range.map(from), log, label: labels.label(parameter), factor};
    });
    this.shown = this.kind(this.view);
    return {x, y, ...this.shown};
  }

  about() {
    const {base, axes, ...run} = this.view.data.request; // the caption shows the shared fields
    return {...this.content(), caption: labels.fields({...base, ...run}), name: this.name};
  }

  click(x, _, {y, top, touch}) {
    const at = [x, y];
    if (touch) this.view.showTip({plot: this, at, act: true});
    else this.view.choose({plot: this, at, top});
  }

  /** Moves the tooltip with the place; one with a button stays where it was opened. */
  refresh() {
    super.refresh();
    const {current} = this.view;
    if (current?.plot === this && !current.act) this.view.showTip(current);
  }

  /** {names, rows} of the visible points. */
  numbers() {
    const {data, viewports, several} = this.view;
    const {columns, rows = (p) => [Object.values(columns).map((of) => of(p))]} = this.content();
    const axes = data.axes.slice(0, viewports.length).map(({parameter}) => parameter);
    const starts = several ? ["start"] : [];
    const numbers = this.view.visiblePlaces().flatMap(({p, value, height, start}) => {
      const at = axes.map((parameter, i) => labels.number(parameter, i ? height : value));
      return rows(p).map((row) => [...at, ...starts.map(() => start + 1), ...row]);
    });
    return {names: [...axes.map(labels.label), ...starts, ...Object.keys(columns)], rows: numbers};
  }
}

/**
 * A place is {at: coordinates on the axes, value, height: of the parameters, p: the point, data,
 * index: its sweep and index there}. Subclasses have plots; places() with received points;
 * nearest({plot, at, top: the clicked height, if any}); rowsOf(place): [term, value] of the
 * tooltip; move(step): goes to another place. `current`: the tooltip's {plot, at, act: whether it has
 * a button}.
 */
export class SweepView {
  layers = []; // the sweep shown, and finer ones of ranges that were zoomed into
  current = null;
  tip = element("div", {className: "tip", hidden: true, ariaLive: "polite"});

  /**
   * root: contains the plots, receives the keys; steps: arguments of move() by key;
   * open({data, index, best}): opens a point.
   */
  constructor(root, viewports, steps, open) {
    Object.assign(this, {root, viewports, open});
    root.append(this.tip);
    root.onpointerleave = ({pointerType}) => pointerType === "mouse" && this.hideTip();
    const moves = Object.entries(steps).map(([key, step]) => [key, () => this.move(step)]);
    const Enter = () => this.choose(this.current);
    const Escape = () => this.hideTip();
    listenToKeys(root, {...zoomKeys(viewports), ...Object.fromEntries(moves), Enter, Escape});
    root.addEventListener("focusout", (event) => {
      if (!root.contains(event.relatedTarget)) this.hideTip();
    });
  }

  get data() {
    return this.layers[0];
  }

  /** Adds a finer sweep, if it is new. */
  add(data) {
    if (this.layers.includes(data)) return;
    this.layers.push(data);
    if (this.layers.length > most) this.layers.splice(1, 1);
  }

  /** The layers that show the chosen position of the third axis, the coarsest first. */
  layersShown() {
    return this.layers.filter(({slice}) => (slice ?? this.choice.slice) === this.choice.slice);
  }

  /** Shows another sweep. The zoom is kept if the axes are the same. */
  show(data) {
    const isSame = (one, other) => one.parameter === other?.parameter && one.log === other.log;
    const fresh = this.viewports.some((_, i) => !isSame(data.axes[i], this.data?.axes[i]));
    this.layers = [data];
    this.hideTip();
    for (const [i, viewport] of this.viewports.entries()) {
      const {borders} = data.axes[i];
      viewport.span(borders[0], borders.at(-1), undefined, fresh);
    }
  }

  /** Draws the received points by the texts of the menus; start: an index, or "best". */
  refresh({start, slice, ...choice}) {
    const best = start === "best";
    this.choice = {...choice, best, start: best ? 0 : Number(start), slice: Number(slice)};
    for (const plot of this.plots) plot.refresh();
  }

  visiblePlaces() {
    const {viewports} = this;
    return this.places().filter(({at}) => viewports.every((each, i) => each.holds(at[i])));
  }

  /** Describes the plots for screen readers. */
  describe() {
    for (const plot of this.plots) {
      const {title, summary} = plot.content();
      makeAccessible(plot, `${title}: ${summary}`);
    }
  }

  /** Ends of the visible ranges as rounded values; empty for the full range. */
  ends() {
    if (!this.viewports.some(({zoomed}) => zoomed)) return [];
    return this.viewports.flatMap(({range}, i) => roundedRange(range.map(this.data.axes[i].from)));
  }

  /** Zooms to the ranges returned by ends(); an empty list resets the zoom. */
  zoomTo(ends) {
    for (const [i, viewport] of this.viewports.entries()) {
      if (!ends.length && viewport.changed) viewport.reset();
      const [from, to] = ends.slice(2 * i, 2 * i + 2).map(this.data.axes[i].to);
      if (from < to) viewport.zoom(from, to);
    }
  }

  /** Shows the tooltip of a place and scrolls to it. */
  goTo(...at) {
    for (const [i, viewport] of this.viewports.entries()) viewport.reveal(at[i]);
    for (const [i, viewport] of this.viewports.entries()) viewport.point(at[i]);
    this.showTip({plot: this.plots.find(({size}) => size.width), at, act: true});
  }

  /** Text about the initial state of the simulation of a place, where it differs from the sweep's. */
  startOf({data}) {
    return data.carried ? ", not from its neighbour's final state" : "";
  }

  choose(current) {
    const place = current && this.nearest(current);
    if (place) this.open(place);
  }

  /** Shows the tooltip of the place nearest to `current`, with a button or a note as its last line. */
  showTip(current) {
    const {plot, act} = current;
    const place = this.nearest(current);
    if (!place || !plot.frame) return;
    this.current = current;
    for (const each of this.plots) each.light(place.value, each.shown?.height(place));
    const entry = ([term, value]) => [element("dt", {}, term), element("dd", {}, value)];
    // Pressing the button must not move the focus, which would hide the tooltip before the click.
    const onmousedown = (event) => event.preventDefault();
    const last = act
      ? button("Simulate this point", () => this.open(place), {onmousedown})
      : element("p", {}, `Click to simulate this point${this.startOf(place)}`);
    this.tip.replaceChildren(element("dl", {}, ...this.rowsOf(place).flatMap(entry)), last);
    this.tip.classList.toggle("pinned", Boolean(act));
    this.tip.hidden = false;
    this.moveTip(plot, place);
  }

  /** Moves the tooltip to the right of a place or, without space there, to the left. */
  moveTip({frame, over}, {value, height}) {
    const {style, offsetWidth, offsetHeight} = this.tip;
    const [box, plot] = [this.root, over].map((node) => node.getBoundingClientRect());
    const x = plot.left - box.left + frame.px(value) - frame.box.left;
    const down = height === undefined ? frame.height / 2 : frame.py(height) - frame.box.top;
    const space = Math.max(this.root.clientWidth - offsetWidth, 0);
    const lowest = Math.max(this.root.clientHeight - offsetHeight, 0);
    const left = x + gap <= space ? x + gap : x - gap - offsetWidth;
    style.left = `${clamp(left, 0, space)}px`;
    style.top = `${clamp(plot.top - box.top + down - offsetHeight / 2, 0, lowest)}px`;
  }

  /** Hides tooltip, rings and cursor. */
  hideTip() {
    this.current = null;
    this.tip.hidden = true;
    for (const plot of this.plots ?? []) plot.light();
    for (const viewport of this.viewports) if (viewport.cursor !== null) viewport.point(null);
  }
}

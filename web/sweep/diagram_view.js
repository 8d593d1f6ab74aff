// A sweep over one axis: the bifurcation diagram of its section, lambda1, and another quantity with
// the regimes, stacked. They share the axis and the tooltip.

import {describe, startNames} from "../shared/quantities.js";
import {Viewport} from "../shared/viewport.js";
import * as labels from "./axis_labels.js";
import {LambdaDiagram, QuantityDiagram, SectionDiagram} from "./diagram.js";
import {missingPoint, SweepView} from "./sweep_view.js";

/** Steps of the keys along the axis. */
const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

/** The first place with the smallest distance away(place). */
const closest = (places, away) =>
  places.reduce((best, place) => (away(place) < away(best) ? place : best), places[0]);

export class DiagramView extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Viewport()], ...rest);
    this.plots = [
      new SectionDiagram(this, "section"),
      new LambdaDiagram(this, "lambda"),
      new QuantityDiagram(this, "other"),
    ];
  }

  refresh(choice) {
    this.byStart = this.starts().map((s) => this.layers.places(s));
    super.refresh(choice);
  }

  starts() {
    return Array.from({length: this.data.starts}, (_, s) => s);
  }

  get several() {
    return this.data.starts > 1;
  }

  places() {
    return this.byStart.flat().filter(({p}) => !p.error);
  }

  /** The points of all starts at a place; undefined where one is missing. */
  placesAt({at: [at]}) {
    return this.byStart.map((list) => list.find((place) => place.at[0] === at));
  }

  /**
   * The nearest point of the first start or, given a height in px, of the start drawn nearest to
   * it.
   */
  nearest({plot, at, top}) {
    const place = closest(this.byStart[0], (other) => Math.abs(other.at[0] - at[0]));
    if (!place || top === undefined) return place;
    const away = (other) => {
      const v = other.p.error ? null : plot.drawn(other);
      return v == null ? Infinity : Math.abs(plot.frame.py(v) - plot.frame.box.top - top);
    };
    return closest(this.placesAt(place).filter(Boolean), away);
  }

  /** Tooltip rows of each start; at most five each when there are several. */
  rowsOf(place) {
    const {data, several} = this;
    const rows = this.placesAt(place).map((found, s) => {
      const own = found ? describe(found.p, labels.where(data)) : missingPoint;
      return several ? [[`start ${s + 1}`, ""], ...own.slice(0, 5)] : own;
    });
    return [labels.place(data.axes[0], place.value), ...rows.flat()];
  }

  startOf({p, data}) {
    const {start} = data.defaultSet ? p : {};
    return start ? `, from its start: ${startNames[start]}` : super.startOf({data});
  }

  move(key) {
    if (!(key in steps)) return false;
    const [list] = this.byStart;
    const i = this.current ? list.indexOf(this.nearest(this.current)) : -1;
    const next = Math.max(0, Math.min(list.length - 1, i + steps[key]));
    if (list.length) this.goTo(...list[next].at);
    return true;
  }
}

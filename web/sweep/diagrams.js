// A sweep over one axis: the bifurcation diagram of its section, lambda1, and another quantity with
// the regimes, over each other. They share an axis and what is told of a point.
import {Axis} from "../shared/axis.js";
import {describe, startNames} from "../shared/quantities.js";
import {LambdaDiagram, OtherDiagram, SectionDiagram} from "./diagram.js";
import {SweepView, toCome} from "./view.js";

/** Moves of the keyboard along an axis. */
const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

/** The first of some places that is next to something, as away(place) has it. */
const closest = (places, away) =>
  places.reduce((best, place) => (away(place) < away(best) ? place : best), places[0]);

export class SweepPlots extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Axis()], ...rest);
    this.panels = [
      new SectionDiagram(this, "section"),
      new LambdaDiagram(this, "lambda"),
      new OtherDiagram(this, "other"),
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

  /** The points of all starts at a place; undefined for one that is still to come. */
  there({at: [at]}) {
    return this.byStart.map((list) => list.find((place) => place.at[0] === at));
  }

  /** The point of the first start, or of all starts the one that is drawn next to a height. */
  nearest({panel, at, top}) {
    const place = closest(this.byStart[0], (other) => Math.abs(other.at[0] - at[0]));
    if (!place || top === undefined) return place;
    const away = (other) => {
      const v = other.p.error ? null : panel.drawn(other);
      return v == null ? Infinity : Math.abs(panel.frame.py(v) - panel.frame.box.top - top);
    };
    return closest(this.there(place).filter(Boolean), away);
  }

  /** The rows of each start; of several starts not more than five each. */
  rowsOf(place) {
    const {naming, data, several} = this;
    const rows = this.there(place).map((found, s) => {
      const own = found ? describe(found.p, naming.where(data)) : toCome;
      return several ? [[`start ${s + 1}`, ""], ...own.slice(0, 5)] : own;
    });
    return [naming.place(data.axes[0], place.value), ...rows.flat()];
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

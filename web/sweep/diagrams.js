// A sweep over one axis: the bifurcation diagram of its section, lambda1, and another quantity with
// the regimes, over each other. They share an axis and what is told of a point.
import {Axis} from "../shared/axis.js";
import {coordinates, describe, quantityOf, startNames} from "../shared/quantities.js";
import {firstFrom} from "../shared/search.js";
import {inSeconds} from "../shared/units.js";
import {afresh, sameAxis, span} from "./axes.js";
import {LambdaDiagram, OtherDiagram, SectionDiagram} from "./diagram.js";
import {Telling} from "./telling.js";

/** Moves of the keyboard along an axis. */
const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

export class SweepPlots {
  /**
   * containers: {section, lambda, other}; naming: of axes; open({data, index}): a point was chosen.
   */
  constructor(root, containers, naming, open) {
    Object.assign(this, {naming, open, layers: null, current: null});
    this.axis = new Axis();
    this.axes = [this.axis];
    this.telling = new Telling(root, this);
    this.panels = {
      section: new SectionDiagram(containers.section, this),
      lambda: new LambdaDiagram(containers.lambda, this),
      other: new OtherDiagram(containers.other, this),
    };
    for (const panel of Object.values(this.panels))
      this.telling.follow(panel, () => this.tell({panel, at: this.axis.cursor}));
  }

  /**
   * Another sweep, as Layers; choice: {coordinate: of the section, quantity: of the third plot}. A
   * zoom stays where the axis is that of the one before.
   */
  show(layers, choice) {
    const fresh = !sameAxis(layers.base.axes[0], this.data?.axes[0]);
    Object.assign(this, {layers, choice});
    this.leave();
    span(this.axis, this.data.axes[0], fresh);
    this.refresh();
  }

  /** The same sweep by another choice. */
  showAs(choice) {
    this.choice = choice;
    this.refresh();
  }

  /** More points have come. */
  refresh() {
    if (this.data?.axes?.length !== 1) return;
    this.places = this.starts().map((s) => this.layers.places(s));
    this.at = this.places.map((list) => list.map((place) => place.at));
    for (const panel of Object.values(this.panels)) panel.refresh();
    if (this.current && !this.current.act) this.tell(this.current); // a button stays under the finger
  }

  get data() {
    return this.layers?.base;
  }

  coordinate() {
    return coordinates[this.data.section]?.[this.choice.coordinate];
  }

  quantity() {
    return quantityOf(this.choice.quantity, this.data);
  }

  /** Whether the section's velocities are drawn in mm/s. */
  seconds() {
    return Boolean(this.coordinate()?.seconds && this.data.parameters.si && inSeconds());
  }

  starts() {
    return Array.from({length: this.data.starts}, (_, s) => s);
  }

  get several() {
    return this.data.starts > 1;
  }

  /** f(point, place) of the points of a start that have come and did not fail. */
  each(start, f) {
    for (const place of this.places[start]) if (!place.p.error) f(place.p, place);
  }

  /** All values of all points, for a range; of(point): those of one. */
  *values(of) {
    for (const p of this.layers.points()) {
      if (p.error) continue;
      for (const v of of(p)) if (v !== null && v !== undefined) yield v;
    }
  }

  /** The position of the point of the first start that lies next to a place of the axis. */
  positionAt(at) {
    const [list] = this.places;
    const i = firstFrom(this.at[0], at);
    const before = i > 0 && (i === list.length || at - list[i - 1].at < list[i].at - at);
    return before ? i - 1 : i;
  }

  /** The point of a start at a place of the axis, undefined where it is still to come. */
  pointAt(at, start) {
    const place = this.places[start][firstFrom(this.at[start], at)];
    return place?.at === at ? place : undefined;
  }

  /** Of the points of all starts at a position the one that a panel draws next to a height. */
  nearest(panel, i, top) {
    const place = this.places[0][i];
    const there = this.starts()
      .map((s) => this.pointAt(place.at, s))
      .filter(Boolean);
    const away = ({p}) => {
      const v = p.error ? null : panel.drawn(p);
      return v == null ? Infinity : Math.abs(panel.frame.py(v) - panel.frame.box.top - top);
    };
    return there.reduce((best, other) => (away(other) < away(best) ? other : best));
  }

  click(panel, at, {top, touch}) {
    if (!this.places?.[0].length) return;
    if (touch) this.tell({panel, at, act: true});
    else this.open(this.nearest(panel, this.positionAt(at), top));
  }

  leave() {
    this.current = null;
    this.telling.hide();
    for (const panel of Object.values(this.panels)) panel.light();
  }

  /** The tooltip of the point next to a place; act: with a button that opens it. */
  tell(current) {
    const {panel, at, act = false} = current;
    if (!this.places) return;
    const place = this.places[0][this.positionAt(at)];
    if (!place || !panel.frame) return;
    this.current = current;
    const {value, p, data} = place;
    for (const each of Object.values(this.panels)) each.light(value, each.drawn(p));
    const rows = [this.naming.place(data.axes[0], value)];
    for (const s of this.starts()) {
      if (this.several) rows.push([`start ${s + 1}`, ""]);
      rows.push(...this.describeStart(place, s));
    }
    const {start} = data.defaultSet ? p : {};
    const from = start ? `, from its start: ${startNames[start]}` : afresh(data);
    const open = act ? () => this.open(place) : null;
    this.telling.show(panel, value, null, rows, `simulate it${from}`, open);
  }

  /** The rows of a start; of several starts not more than five each. */
  describeStart({at}, start) {
    const place = this.pointAt(at, start);
    const rows = place ? describe(place.p, this.naming.where(this.data)) : [["", "still to come"]];
    return this.several ? rows.slice(0, 5) : rows;
  }

  choose() {
    if (this.current) this.open(this.places[0][this.positionAt(this.current.at)]);
  }

  move(key) {
    if (!(key in steps)) return false;
    const list = this.places?.[0] ?? [];
    const i = this.current ? this.positionAt(this.current.at) : -1;
    const next = Math.max(0, Math.min(list.length - 1, i + steps[key]));
    if (list.length) this.moveTo(list[next].at);
    return true;
  }

  /** Tells of the point at a place, which is brought into view. */
  moveTo(at) {
    this.axis.reveal(at);
    this.axis.point(at, "key");
    this.tell({panel: Object.values(this.panels).find(({size}) => size.width), at, act: true});
  }
}

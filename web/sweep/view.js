// What the plots of a sweep have in common, over one axis or two: they share their axes, what of
// the sweep is chosen, and a box that tells of a point beside the mouse, a finger or by the keys.
import {$} from "../shared/dom.js";
import {addMenu} from "../shared/figure_menu.js";
import {Frame} from "../shared/frame.js";
import {Panel} from "../shared/panel.js";
import {Tip} from "../shared/tip.js";
import {afresh, sameAxis} from "./axes.js";

const zooms = {"+": 1.5, "=": 1.5, "-": 1 / 1.5};

/** What is told of a point that has not come. */
export const toCome = [["", "still to come"]];

/**
 * A plot of a SweepView; about(): {title, summary}; drawn(place): the height of a place of the view,
 * null where it has many or none; columns(): the numbers of a point, {name: of(p)}.
 */
export class SweepPanel extends Panel {
  /** name: in the ids of its figure and of its container. */
  constructor(view, name) {
    super($(`plot-sweep-${name}`), ...view.axes);
    this.view = view;
    addMenu($(`figure-sweep-${name}`), this, () => ({
      ...this.about(),
      caption: view.caption(),
      name: `sweep-${name}`,
    }));
    this.over.addEventListener("pointermove", (event) => {
      const mouse = event.pointerType === "mouse" && !event.buttons;
      if (mouse && this.axis.cursor !== null)
        view.tell({panel: this, at: view.axes.map(({cursor}) => cursor)});
    });
  }

  /** beside: px at its right. */
  frameOf(width, height, beside) {
    const {naming, data, axes} = this.view;
    const [x, y = this.y()] = axes.map(({view}, i) => naming.frameAxis(data.axes[i], view));
    return new Frame(width, height, x, y, beside);
  }

  click(x, _, {y, top, touch}) {
    const at = [x, y];
    if (touch) this.view.tell({panel: this, at, act: true});
    else this.view.choose({panel: this, at, top});
  }

  /** What is told of it lies where it is drawn; a button stays under the finger. */
  refresh() {
    super.refresh();
    const {current} = this.view;
    if (current?.panel === this && !current.act) this.view.tell(current);
  }

  cursorText() {
    return "";
  }

  /** The numbers of a point, a row or more. */
  rows(p) {
    return [Object.values(this.columns()).map((of) => of(p))];
  }

  /** {names, columns}: the numbers of what is in view. */
  numbers() {
    const {naming, data, axes, several} = this.view;
    const shown = data.axes.slice(0, axes.length).map(({parameter}) => parameter);
    const names = shown.map((parameter) => naming.label(parameter));
    if (several) names.push("start");
    names.push(...Object.keys(this.columns()));
    const rows = this.view.seen().flatMap(({p, value, height, start}) => {
      const at = shown.map((parameter, i) => naming.number(parameter, i ? height : value));
      return this.rows(p).map((row) => [...at, ...(several ? [start + 1] : []), ...row]);
    });
    return {names, columns: names.map((_, i) => rows.map((row) => row[i]))};
  }
}

/**
 * Whoever extends this has panels: [SweepPanel]; places(): those of the points that have come, {at:
 * where on the axes, value and height: the same as values, p, data, index}; nearest({panel, at,
 * top}): the one next to a place, top: the height in px that was clicked on, if it was;
 * rowsOf(place): [term, value] each; and move(key): goes to another place, false if the key is none
 * of its own. A place is told of as current: {panel, at, act: with a button that opens it}.
 */
export class SweepView {
  /**
   * root: what the panels lie in, and what takes the keys; naming: of axes; open({data, index,
   * best}): a point was chosen.
   */
  constructor(root, axes, naming, open) {
    Object.assign(this, {root, axes, naming, open, layers: null, current: null});
    this.tip = new Tip(root);
    root.onpointerleave = (event) => {
      if (event.pointerType === "mouse") this.leave();
    };
    root.onkeydown = (event) => {
      if (event.target === root && this.key(event.key)) event.preventDefault();
    };
    root.addEventListener("focusout", (event) => {
      if (!root.contains(event.relatedTarget)) this.leave();
    });
  }

  get data() {
    return this.layers?.base;
  }

  /** Another sweep, as Layers. A zoom stays where the axes are those of the one before. */
  show(layers) {
    const fresh = this.axes.some((_, i) => !sameAxis(layers.base.axes[i], this.data?.axes[i]));
    this.layers = layers;
    this.leave();
    for (const [i, axis] of this.axes.entries()) {
      const {borders} = this.data.axes[i];
      axis.span(borders[0], borders.at(-1), undefined, fresh);
    }
  }

  /**
   * More points have come, or another choice was made: {coordinate: of the section, quantity: of the
   * plot below, map: the quantity there, start, best: the best motion in place of the worst, slice:
   * along the third axis}.
   */
  refresh(choice) {
    this.choice = choice;
    for (const panel of this.panels) panel.refresh();
  }

  /** The places that are in view. */
  seen() {
    const inside = ({view: [from, to]}, at) => at >= from && at <= to;
    return this.places().filter(({at}) => this.axes.every((axis, i) => inside(axis, at[i])));
  }

  /** The plots in words, for those who do not see them. */
  describe() {
    for (const panel of this.panels) {
      const {title, summary} = panel.about();
      panel.container.setAttribute("role", "img");
      panel.container.setAttribute("aria-label", `${title}: ${summary}`);
    }
  }

  /** What a picture of a plot says below its title: what all points share. */
  caption() {
    const {base, axes, ...run} = this.data.request;
    return this.naming.fields({...base, ...run});
  }

  /** The ends of what is in view, as values in as many digits as that takes; none of the whole. */
  ends() {
    if (!this.axes.some(({zoomed}) => zoomed)) return [];
    return this.axes.flatMap(({view}, i) => {
      const ends = view.map(this.data.axes[i].from);
      const digits = 4 - Math.floor(Math.log10(ends[1] - ends[0]));
      return ends.map((v) => Number(v.toFixed(Math.max(digits, 0))));
    });
  }

  /** Zooms to such ends; without any the whole is shown. */
  zoomTo(ends) {
    for (const [i, axis] of this.axes.entries()) {
      if (!ends.length && axis.away) axis.reset();
      const [from, to] = ends.slice(2 * i, 2 * i + 2).map(this.data.axes[i].to);
      if (from < to) axis.zoom(from, to);
    }
  }

  key(key) {
    if (key in zooms) for (const axis of this.axes) axis.zoomAbout(zooms[key]);
    else if (key === "0") for (const axis of this.axes) axis.reset();
    else if (key === "Enter") this.choose(this.current);
    else if (key === "Escape") this.leave();
    else return this.move(key);
    return true;
  }

  /** Tells of the point at a place, which is brought into view. */
  goTo(...at) {
    for (const [i, axis] of this.axes.entries()) axis.reveal(at[i]);
    for (const [i, axis] of this.axes.entries()) axis.point(at[i], "key");
    this.tell({panel: this.panels.find(({size}) => size.width), at, act: true});
  }

  /** How the point of a place is simulated. */
  startOf({data}) {
    return afresh(data);
  }

  choose(current) {
    const place = current && this.nearest(current);
    if (place) this.open(place);
  }

  tell(current) {
    const {panel, act} = current;
    const place = this.nearest(current);
    if (!place || !panel.frame) return;
    this.current = current;
    for (const each of this.panels) each.light(place.value, each.drawn(place));
    const {frame} = panel;
    const box = this.root.getBoundingClientRect();
    const over = panel.over.getBoundingClientRect();
    const down =
      place.height === undefined ? frame.height / 2 : frame.py(place.height) - frame.box.top;
    this.tip.show(
      over.left - box.left + frame.px(place.value) - frame.box.left,
      over.top - box.top + down,
      this.rowsOf(place),
      `Click: simulate it${this.startOf(place)}`,
      act && {label: "Simulate this point", run: () => this.open(place)},
    );
  }

  /** Nothing is told any longer. */
  leave() {
    this.current = null;
    this.tip.hide();
    for (const panel of this.panels) panel.light();
    for (const axis of this.axes) if (axis.cursor !== null) axis.point(null);
  }
}

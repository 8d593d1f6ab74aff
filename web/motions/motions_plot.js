// The diagram of all motions, with named special points and a marker of the parameter.
import {on} from "../shared/dom.js";
import {Frame, rangeOf} from "../shared/frame.js";
import {Marker} from "../shared/marker.js";
import {curve, dots, texts} from "../shared/marks.js";
import {joined, short} from "../shared/numbers.js";
import {ZoomablePlot} from "../shared/plot.js";
import {verdictColour} from "../shared/quantities.js";
import * as labels from "../sweep/axis_labels.js";

const inMm = (name) => (orbit) => (orbit[name] == null ? null : 1000 * orbit[name]);
export const quantities = {
  x_max: {title: "largest |x|", unit: "mm", label: "largest |x| (mm)", of: inMm("x_max")},
  x_rms: {title: "rms of x", unit: "mm", label: "rms of x (mm)", of: inMm("x_rms")},
  z: {title: "z", unit: "", label: "impacts per cycle z", of: ({z}) => z ?? null},
};

const reach = 24; // px within which a motion is picked
const names = {symmetry_breaking: "symmetry", end: ""};

export class MotionsPlot extends ZoomablePlot {
  marked = null; // the marker's value

  /** open(orbit): simulates a motion; place(value): called when the marker moves. */
  constructor(figure, {open, place}) {
    super(figure);
    Object.assign(this, {open, place});
    const move = (value) => {
      this.marked = value;
      place(value);
    };
    const about = {className: "marker grip", ariaLabel: "Parameter", hidden: true};
    this.marker = new Marker(this.over, move, about);
    on(this.over, {
      pointermove: (event) => this.hover(event),
      pointerleave: () => this.light(),
    });
  }

  /** Shows other motions, which can still grow. */
  show(motions) {
    const {from, to} = motions.request;
    this.motions = motions;
    this.marked = motions.start;
    this.viewport.span(Math.min(from, to), Math.max(from, to));
  }

  get value() {
    return quantities[this.last.quantity].of;
  }

  prepare(width, height) {
    if (!this.last || !(this.viewport.width > 0)) return null;
    const {attractors, branches, specials, request} = this.motions;
    const of = this.value;
    const y = [attractors, ...branches, specials].map((list) => list.map(of));
    const {factor} = labels.of(request.parameter);
    const ofX = {range: this.viewport.range, factor, label: labels.label(request.parameter)};
    const ofY = {range: rangeOf(y) ?? [0, 1], label: quantities[this.last.quantity].label};
    const place = (list) => ({x: list.map(({value}) => value), y: list.map(of)});
    const marked = specials.filter((orbit) => of(orbit) !== null);
    return {
      frame: new Frame(width, height, ofX, ofY, 14),
      marks: [
        dots({...place(attractors), tints: attractors.map(verdictColour), shape: "dot", size: 2}),
        ...branches.flatMap((branch) =>
          stretchesOf(branch).map((part) => curve({...part, ...place(part.list)})),
        ),
        dots({...place(marked), colour: "wall", shape: "diamond", size: 4, above: true}),
        texts({...place(marked), text: marked.map(({kind}) => names[kind] ?? kind)}),
      ],
    };
  }

  point() {
    super.point();
    const {node} = this.marker;
    node.hidden = !this.frame || !this.viewport.holds(this.marked);
    if (node.hidden) return;
    const text = labels.fields({[this.motions.request.parameter]: this.marked});
    this.marker.show(this.frame, this.viewport.range, this.marked, text);
  }

  cursorText(cursor) {
    return labels.text(this.motions.request.parameter, cursor);
  }

  /** The motion drawn nearest to a place of the plot; undefined if none is near. */
  nearest({offsetX, offsetY}) {
    const {attractors, branches, specials} = this.motions;
    const {box, px, py} = this.frame;
    let [best, found] = [reach, undefined];
    for (const orbit of [...specials, ...branches.flat(), ...attractors]) {
      const y = this.value(orbit);
      if (y === null || !orbit.state) continue;
      const [dx, dy] = [px(orbit.value) - box.left - offsetX, py(y) - box.top - offsetY];
      const away = Math.hypot(dx, dy);
      if (away < best) [best, found] = [away, orbit];
    }
    return found;
  }

  hover(event) {
    if (!this.frame || event.target !== this.over) return;
    const found = this.nearest(event);
    this.light(found?.value, found && this.value(found));
    this.over.title = found ? this.describe(found) : "";
  }

  describe({value, stable, verdict, kind, period_cycles: cycles, impacts, multipliers}) {
    const {parameter} = this.motions.request;
    return joined([
      labels.fields({[parameter]: value}),
      kind?.replace("_", " "),
      stable === undefined ? verdict?.replace("_", " ") : `${stable ? "" : "un"}stable`,
      cycles && `period ${cycles}, impacts ${impacts}`,
      multipliers && `|μ| ${short(multipliers.modulus[0])}`,
    ]);
  }

  click(x, _, {top}) {
    const found = this.nearest({offsetX: this.frame.px(x) - this.frame.box.left, offsetY: top});
    if (found) this.open(found);
  }

  /** {names, rows} of all motions in view. */
  numbers() {
    const {attractors, branches, request} = this.motions;
    const stability = ({stable}) => `${stable ? "" : "un"}stable`;
    const all = [
      ...branches.flatMap((list, k) => list.map((m) => [m, `branch ${k + 1}, ${stability(m)}`])),
      ...attractors.map((motion) => [motion, motion.verdict ?? "–"]),
    ];
    const {parameter} = request;
    const shown = Object.values(quantities);
    const row = ([motion, kind]) => [
      labels.number(parameter, motion.value),
      ...shown.map(({of}) => of(motion)),
      kind,
    ];
    return {
      names: [labels.label(parameter), ...shown.map(({label}) => label), "kind"],
      rows: all.filter(([{value}]) => this.viewport.holds(value)).map(row),
    };
  }
}

const solid = {colour: "c2", width: 2.2};
const broken = {colour: "c3", width: 1.6, dash: [6, 4]};

/** Parts of a branch with the same stability, each joined to the next one. */
function stretchesOf(branch) {
  const parts = [];
  for (const orbit of branch) {
    const last = parts.at(-1);
    last?.list.push(orbit);
    if (last?.stable !== orbit.stable)
      parts.push({stable: orbit.stable, list: [orbit], ...(orbit.stable ? solid : broken)});
  }
  return parts;
}

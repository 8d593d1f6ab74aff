// The diagram of all motions, with named special points and a marker of the parameter.
import {on} from "../shared/dom.js";
import {Marker} from "../shared/marker.js";
import {curve, dots, texts} from "../shared/marks.js";
import {joined, short} from "../shared/numbers.js";
import {ZoomablePlot} from "../shared/plot.js";
import * as q from "../shared/quantities.js";
import * as labels from "../sweep/axis_labels.js";

const {x_max, x_rms, z} = q.quantities;
export const quantities = {x_max, x_rms, z};

const names = {symmetry_breaking: "symmetry", end: ""}; // short labels of special points
const stability = ({stable}) => `${stable ? "" : "un"}stable`;

export class MotionsPlot extends ZoomablePlot {
  marked = null; // the marker's value

  /** open(orbit): simulates a motion; place(value): called when the marker moves. */
  constructor(figure, {open, place}) {
    super(figure);
    this.open = open;
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

  /** Draws the motions by a quantity. */
  draw({label, of}) {
    const {attractors, branches, specials, request} = this.motions;
    const place = (list) => ({list, x: list.map(({value}) => value), y: list.map(of)});
    const marked = specials.filter((orbit) => of(orbit) !== null);
    const all = [...specials, ...branches.flat(), ...attractors];
    this.motionsDrawn = place(all.filter((orbit) => orbit.state && of(orbit) !== null));
    super.draw({
      x: {label: labels.label(request.parameter), factor: labels.of(request.parameter).factor},
      y: {label},
      beside: 14,
      empty: "no motion yet",
      marks: [
        dots({...place(attractors), tints: attractors.map(q.verdictColour), shape: "dot", size: 2}),
        ...branches.flatMap((branch) =>
          stretchesOf(branch).map((part) => curve({...part, ...place(part.list)})),
        ),
        dots({...place(marked), colour: "wall", shape: "diamond", size: 4, above: true}),
        texts({...place(marked), text: marked.map(({kind}) => names[kind] ?? kind), above: true}),
      ],
    });
  }

  point() {
    super.point();
    const {node} = this.marker;
    node.hidden = !this.frame || !this.viewport.holds(this.marked);
    if (node.hidden) return;
    const text = labels.fields({[this.motions.request.parameter]: this.marked});
    this.marker.show(this.frame, this.viewport.range, this.marked, text);
  }

  /** {motion, x, y} nearest to a place of the plot, px; undefined values if none is near. */
  nearest(left, top) {
    const {list, x, y} = this.motionsDrawn;
    const {box} = this.frame;
    const i = this.pick({x, y}, box.left + left, box.top + top);
    return {motion: list[i], x: x[i], y: y[i]};
  }

  hover({target, offsetX, offsetY}) {
    if (!this.frame || target !== this.over) return;
    const {motion, x, y} = this.nearest(offsetX, offsetY);
    this.light(x, y);
    this.over.title = motion ? this.describe(motion) : "";
  }

  describe({value, stable, verdict, kind, period_cycles: cycles, impacts, multipliers}) {
    const {parameter} = this.motions.request;
    return joined([
      labels.fields({[parameter]: value}),
      kind?.replace("_", " "),
      stable === undefined ? verdict?.replace("_", " ") : stability({stable}),
      cycles && `period ${cycles}, impacts ${impacts}`,
      multipliers && `|μ| ${short(multipliers.modulus[0])}`,
    ]);
  }

  click(x, _, {top}) {
    const {motion} = this.nearest(this.frame.px(x) - this.frame.box.left, top);
    if (motion) this.open(motion);
  }

  /** {names, rows} of all motions in view. */
  numbers() {
    const {attractors, branches, request} = this.motions;
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

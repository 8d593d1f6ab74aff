// A sweep over two axes, or a slice of one over three: a quantity as colours, with its scale beside
// it.

import uPlot from "../node_modules/uplot/dist/uPlot.esm.js";
import {colour} from "../shared/colours.js";
import {short} from "../shared/numbers.js";
import {bestMotion, describe, quantityOf, regimeColour} from "../shared/quantities.js";
import {Tip} from "../shared/tip.js";
import {
  afresh,
  clipped,
  coordinate,
  nameOf,
  plotAxis,
  point,
  whereOf,
  wholeOrZoomed,
} from "./axes.js";

const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
const stops = (name) => colour(name).split(/\s+/).map(hex);

/** The colour at share t in [0, 1] between stops. */
function between(list, t) {
  const at = Math.min(Math.max(t, 0), 1) * (list.length - 1);
  const i = Math.min(Math.floor(at), list.length - 2);
  const part = at - i;
  return list[i].map((v, k) => Math.round(v + (list[i + 1][k] - v) * part));
}

/**
 * The colours of a quantity's values: share(v) in [0, 1] along `stops`. A diverging one has 0 in
 * its middle, and its sides have scales of their own.
 */
function scaleOf(quantity, values) {
  let min = Infinity;
  let max = -Infinity;
  for (const v of values) {
    if (v < min) min = v;
    if (v > max) max = v;
  }
  if (!(min <= max)) [min, max] = [0, 1];
  if (quantity.diverging) {
    const low = Math.min(min, 0) || -Math.abs(max) || -1;
    const high = Math.max(max, 0) || -low;
    return {
      stops: stops("diverging"),
      marks: [low, low / 2, 0, high / 2, high],
      share: (v) => (v < 0 ? 0.5 - (0.5 * v) / low : 0.5 + (0.5 * v) / high),
    };
  }
  if (min === max) max = min + (Math.abs(min) || 1);
  return {
    stops: stops("sequential"),
    marks: [0, 0.25, 0.5, 0.75, 1].map((t) => min + t * (max - min)),
    share: (v) => (v - min) / (max - min),
  };
}

/** Moves of the keyboard over the cells. */
const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

const room = 74; // px for the scale of the colours beside the map

export class HeatMap {
  /** units(parameter): as in " (m)"; open(index): a cell was chosen. */
  constructor(root, container, units, open) {
    Object.assign(this, {root, container, units, open, plot: null, data: null, current: null});
    this.tip = new Tip(root);
    new ResizeObserver(() => this.resize()).observe(container);
    root.addEventListener("keydown", (event) => this.key(event));
    root.addEventListener("focusout", (event) => {
      if (!root.contains(event.relatedTarget)) this.leave();
    });
  }

  /**
   * choice: {map: the quantity, start, best: the best motion in place of the worst, slice: along
   * the third axis}.
   */
  show(data, choice) {
    this.data = data;
    this.choice = choice;
    this.recreate();
  }

  recreate() {
    this.plot?.destroy();
    this.plot = null;
    this.leave();
    if (this.data?.axes?.length > 1 && this.container.clientWidth) this.create();
  }

  choose(choice) {
    this.choice = choice;
    this.plot?.redraw(false, true); // there may be a scale of the colours now, or none
    this.refresh();
  }

  refresh() {
    if (!this.data?.axes) return;
    if (!this.plot) return this.recreate();
    this.image = null;
    this.plot.redraw(false);
    if (this.current) this.tell(...this.current);
  }

  resize() {
    if (!this.container.clientWidth) return;
    if (!this.plot) return this.recreate();
    this.plot.setSize({width: this.container.clientWidth, height: this.container.clientHeight});
  }

  quantity() {
    return quantityOf(this.choice.map, this.data);
  }

  create() {
    const [first, second] = this.data.axes;
    this.image = null;
    const options = {
      width: this.container.clientWidth,
      height: this.container.clientHeight,
      padding: [8, () => (this.quantity().categories ? 12 : room), 0, 0],
      legend: {show: false},
      scales: {
        x: {time: false, distr: first.log ? 3 : 1, range: wholeOrZoomed(first)},
        y: {distr: second.log ? 3 : 1, range: () => [second.borders[0], second.borders.at(-1)]},
      },
      axes: [
        this.axis(first, {size: 24, gap: 2, labelSize: 16}),
        this.axis(second, {side: 3, size: 52, gap: 3, labelSize: 18}),
      ],
      series: [{}, {paths: () => null, points: {show: false}}],
      cursor: {drag: {x: true, y: true, uni: 20}, points: {show: false}},
      hooks: {draw: [(u) => this.draw(u)]},
    };
    this.plot = new uPlot(options, [first.values, first.values.map(() => null)], this.container);
    point(this.plot.over, {
      move: (left, top) => this.tell(...this.place(left, top)),
      leave: () => this.leave(),
      open: (left, top) => this.open(this.indexAt(...this.place(left, top))),
      touch: (left, top) => this.tell(...this.place(left, top), true),
    });
  }

  axis(axis, options) {
    const label = nameOf(axis, this.units);
    return plotAxis({...options, label, grid: {show: false}}, {log: () => axis.log});
  }

  draw(u) {
    clipped(u, () => this.paint(u));
    if (!this.quantity().categories) this.bar(u);
  }

  place(left, top) {
    const {borders} = this.data.axes[1];
    const v = this.plot.posToVal(top, "y");
    const l = borders.findIndex((border) => border > v) - 1;
    return [this.plot.posToIdx(left), Math.max(0, l === -2 ? borders.length - 2 : l)];
  }

  indexAt(k, l) {
    return this.data.index(k, l, this.choice.start, this.choice.slice);
  }

  pointAt(k, l) {
    return this.data.at(k, l, this.choice.start, this.choice.slice);
  }

  /** {k, l, value} of each cell whose point has come; null where it has no value. */
  *values() {
    const {of} = this.quantity();
    const motion = this.choice.best ? bestMotion : (p) => p;
    const [first, second] = this.data.axes;
    for (let l = 0; l < second.values.length; ++l)
      for (let k = 0; k < first.values.length; ++k) {
        const p = this.pointAt(k, l);
        if (p) yield {k, l, value: p.error ? null : (of(motion(p)) ?? null)};
      }
  }

  /** The colour of a value, as bytes; this.scale: of one that is no category. */
  colours(cells) {
    const quantity = this.quantity();
    const nothing = hex(colour("nothing"));
    if (quantity.categories) {
      this.scale = null;
      const named = quantity.categories.map((name) => [name, hex(colour(regimeColour(name)))]);
      const colours = Object.fromEntries(named);
      return (v) => (v === null ? nothing : colours[v]);
    }
    const values = cells.map(({value}) => value).filter((v) => v !== null);
    const scale = scaleOf(quantity, values);
    this.scale = scale;
    return (v) => (v === null ? nothing : between(scale.stops, scale.share(v)));
  }

  /** A pixel for each cell, from the top down. */
  cells() {
    const [first, second] = this.data.axes;
    const n = first.values.length;
    const m = second.values.length;
    const cells = [...this.values()];
    const colourOf = this.colours(cells);
    const image = new ImageData(n, m);
    for (const {k, l, value} of cells)
      image.data.set([...colourOf(value), 255], 4 * ((m - 1 - l) * n + k));
    const canvas = new OffscreenCanvas(n, m);
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
  }

  paint(u) {
    const [first, second] = this.data.axes;
    const pos = (v, scale) => Math.round(u.valToPos(v, scale, true));
    const left = pos(first.borders[0], "x");
    const right = pos(first.borders.at(-1), "x");
    const top = pos(second.borders.at(-1), "y");
    const bottom = pos(second.borders[0], "y");
    this.image ??= this.cells();
    u.ctx.imageSmoothingEnabled = false;
    u.ctx.drawImage(this.image, left, top, right - left, bottom - top);
  }

  /** The scale of the colours. */
  bar(u) {
    const {ctx, bbox} = u;
    const ratio = devicePixelRatio;
    const left = bbox.left + bbox.width + 12 * ratio;
    const width = 12 * ratio;
    for (let y = 0; y < bbox.height; ++y) {
      ctx.fillStyle = `rgb(${between(this.scale.stops, 1 - y / bbox.height)})`;
      ctx.fillRect(left, bbox.top + y, width, 1);
    }
    ctx.fillStyle = colour("soft");
    ctx.font = `${12 * ratio}px system-ui`;
    Object.assign(ctx, {textAlign: "left", textBaseline: "middle"});
    const top = bbox.top + 6 * ratio;
    const bottom = bbox.top + bbox.height - 6 * ratio;
    for (const mark of this.scale.marks) {
      const y = bbox.top + (1 - this.scale.share(mark)) * bbox.height;
      const within = Math.max(top, Math.min(bottom, y));
      ctx.fillText(short(Number(mark.toPrecision(2))), left + width + 5 * ratio, within);
    }
  }

  leave() {
    this.current = null;
    this.tip.hide();
  }

  tell(k, l, act = false) {
    const {data, plot: u} = this;
    const [first, second] = data.axes;
    const p = this.pointAt(k, l);
    this.current = [k, l, act];
    const rows = [
      coordinate(first, k, this.units),
      coordinate(second, l, this.units),
      ...(p ? describe(p, whereOf(data, this.units)) : [["", "still to come"]]),
    ];
    const box = this.root.getBoundingClientRect();
    const over = u.over.getBoundingClientRect();
    const left = over.left - box.left + u.valToPos(first.values[k], "x");
    const top = over.top - box.top + u.valToPos(second.values[l], "y");
    const open = {label: "Simulate this point", run: () => this.open(this.indexAt(k, l))};
    this.tip.show(left, top, rows, `Click: simulate it${afresh(data)}`, act ? open : null);
  }

  key(event) {
    if (!this.plot || event.target !== this.root) return;
    const [k, l] = this.current ?? [0, 0];
    const move = moves[event.key];
    if (move) this.moveTo(k + move[0], l + move[1]);
    else if (event.key === "Enter" && this.current) this.open(this.indexAt(k, l));
    else if (event.key === "Escape") this.leave();
    else return;
    event.preventDefault();
  }

  /** Tells of the cell that is next to these positions. */
  moveTo(k, l) {
    const [first, second] = this.data.axes;
    const within = (i, axis) => Math.max(0, Math.min(axis.values.length - 1, i));
    const next = [within(k, first), within(l, second)];
    const left = this.plot.valToPos(first.values[next[0]], "x");
    const top = this.plot.valToPos(second.values[next[1]], "y");
    this.plot.setCursor({left, top}, false);
    this.tell(...next, true);
  }
}

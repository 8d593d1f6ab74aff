// A sweep over two axes, or a slice of one over three: a quantity as colours, with their scale beside
// it. Points that are still to come have the colour of a coarser neighbour.
import {Axis} from "../shared/axis.js";
import {rgb} from "../shared/colours.js";
import {Frame} from "../shared/frame.js";
import {short} from "../shared/numbers.js";
import {Panel} from "../shared/panel.js";
import {bestMotion, describe, quantityOf, regimeColour} from "../shared/quantities.js";
import {lastUpTo} from "../shared/search.js";
import {afresh, sameAxis, span} from "./axes.js";
import {barWidth, drawBar, endsOf, scaleOf} from "./colour_scale.js";
import {Telling} from "./telling.js";

/** Moves of the keyboard over the cells. */
const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

const firstPass = 1 / 40; // of the points: by them the colours are chosen, and stay

/** A colour as a pixel. */
const opaque = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

export class SweepMap extends Panel {
  /** naming: of axes; open({data, index}): a cell was chosen. */
  constructor(root, container, naming, open) {
    super(container, new Axis(), new Axis());
    Object.assign(this, {naming, open, layers: null, current: null, ends: new Map()});
    this.axes = [this.axis, this.across];
    this.telling = new Telling(root, this);
    this.telling.follow(this, () => this.tell(this.axis.cursor, this.across.cursor));
  }

  /**
   * Another sweep, as Layers; choice: {map: the quantity, start, best: the best motion in place of
   * the worst, slice: along the third axis}.
   */
  show(layers, choice) {
    const {axes} = layers.base;
    const fresh = axes.slice(0, 2).some((axis, i) => !sameAxis(axis, this.data?.axes[i]));
    Object.assign(this, {layers, choice});
    this.ends.clear();
    this.leave();
    span(this.axis, axes[0], fresh);
    span(this.across, axes[1], fresh);
    this.refresh();
  }

  /** The same sweep by another choice. */
  showAs(choice) {
    this.choice = choice;
    this.refresh();
  }

  /** What is in view, and what is told of it. */
  refresh() {
    super.refresh();
    if (this.current && !this.current[2]) this.tell(...this.current); // a button stays where it is
  }

  get data() {
    return this.layers?.base;
  }

  quantity() {
    return quantityOf(this.choice.map, this.data);
  }

  /** The point at positions of a layer, null before it has come, and its index. */
  pointAt({data, slice}, k, l) {
    const {start, slice: chosen} = this.choice;
    const index = data.index(k, l, start, slice === null ? chosen : 0);
    return {p: data.points[index], data, index, best: this.choice.best};
  }

  /** The motion of a point that is shown: of several starts the worst or the best. */
  motion(p) {
    return this.choice.best ? bestMotion(p) : p;
  }

  /** The value of a point that is drawn; null where it has none. */
  valueOf(p) {
    return p.error ? null : (this.quantity().of(this.motion(p)) ?? null);
  }

  /** All values of the base that are there. */
  values() {
    const layer = {data: this.data, slice: null};
    const [first, second] = this.data.axes;
    const list = [];
    for (let l = 0; l < second.at.length; ++l)
      for (let k = 0; k < first.at.length; ++k) {
        const {p} = this.pointAt(layer, k, l);
        const v = p ? this.valueOf(p) : null;
        if (v !== null) list.push(v);
      }
    return list;
  }

  /**
   * The scale of the colours, null for categories. It is chosen once the whole has been seen
   * coarsely, for each quantity, and holds for all slices and starts.
   */
  scale() {
    const quantity = this.quantity();
    if (quantity.categories) return null;
    const {map} = this.choice;
    const values = this.ends.has(map) ? [] : this.values();
    const ends = this.ends.get(map) ?? endsOf(quantity, values);
    const {received, total, complete} = this.data;
    const seen = complete || received > Math.max(firstPass * total, 50);
    if (seen && values.length) this.ends.set(map, ends);
    return scaleOf(quantity, ends);
  }

  prepare(width, height) {
    if (!(this.data?.axes?.length > 1)) return null;
    const scale = this.scale();
    const [first, second] = this.data.axes;
    const x = this.naming.frameAxis(first, this.axis.view);
    const y = this.naming.frameAxis(second, this.across.view);
    return {scale, frame: new Frame(width, height, x, y, scale ? barWidth : 12)};
  }

  paint(c, {frame, scale}) {
    frame.draw(c);
    const {left, top} = frame.box;
    this.beyond = [false, false];
    c.imageSmoothingEnabled = false;
    c.drawImage(this.image(frame, this.colours(scale)), left, top, frame.width, frame.height);
    if (scale) drawBar(c, frame, scale, this.quantity().label, this.beyond);
  }

  /** The pixel of a point. */
  colours(scale) {
    const nothing = opaque(rgb("nothing"));
    const {categories = []} = this.quantity();
    const named = new Map(categories.map((name) => [name, opaque(rgb(regimeColour(name)))]));
    return (p) => {
      const v = this.valueOf(p);
      if (v === null) return nothing;
      if (!scale) return named.get(v) ?? nothing;
      const share = scale.share(v);
      if (share < 0) this.beyond[0] = true;
      if (share > 1) this.beyond[1] = true;
      return opaque(scale.at(v));
    };
  }

  /** All layers in the pixels of the screen. */
  image(frame, colourOf) {
    const width = Math.round(frame.width * devicePixelRatio);
    const height = Math.round(frame.height * devicePixelRatio);
    const image = new ImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    for (const layer of this.layers.over(this.choice.slice)) {
      const [first, second] = layer.data.axes;
      const columns = positions(first, this.axis.view, width);
      const rows = positions(second, this.across.view, height).reverse();
      const cells = this.cells(layer, colourOf);
      const n = first.at.length;
      for (let j = 0; j < height; ++j) {
        if (rows[j] < 0) continue;
        for (let i = 0; i < width; ++i) {
          const pixel = columns[i] < 0 ? 0 : cells[rows[j] * n + columns[i]];
          if (pixel) pixels[j * width + i] = pixel;
        }
      }
    }
    const canvas = Object.assign(document.createElement("canvas"), {width, height});
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
  }

  /** A pixel for each cell of a layer, 0 where there is nothing. */
  cells(layer, colourOf) {
    const [first, second] = layer.data.axes;
    const [n, m] = [first.at.length, second.at.length];
    const cells = new Uint32Array(n * m);
    for (let l = 0; l < m; ++l)
      for (let k = 0; k < n; ++k) {
        const {p} = this.pointAt(layer, k, l);
        if (p) cells[l * n + k] = colourOf(p);
      }
    // Below a finer layer lies a coarser one.
    if (!layer.data.complete && layer.data === this.data) fill(cells, first.order, second.order);
    return cells;
  }

  cursorText() {
    return "";
  }

  /** The finest point at a place: {p, data, index, k, l}, p null where it is still to come. */
  nearest(at, height) {
    let found = null;
    for (const layer of this.layers.over(this.choice.slice)) {
      const [first, second] = layer.data.axes;
      const [k, l] = [positionAt(first, at), positionAt(second, height)];
      if (k < 0 || l < 0) continue;
      const there = this.pointAt(layer, k, l);
      if (there.p || !found) found = {...there, k, l};
    }
    return found;
  }

  click(at, _, {y, touch}) {
    if (touch) this.tell(at, y, true);
    else this.choosePoint(at, y);
  }

  choosePoint(at, height) {
    const there = this.nearest(at, height);
    if (there) this.open(there);
  }

  leave() {
    this.current = null;
    this.telling.hide();
    this.light();
  }

  tell(at, height, act = false) {
    const there = this.nearest(at, height);
    if (!there || !this.frame) return;
    this.current = [at, height, act];
    const {p, data, k, l} = there;
    const {naming} = this;
    const [x, y] = [data.axes[0].values[k], data.axes[1].values[l]];
    this.light(x, y);
    const rows = [
      naming.place(data.axes[0], x),
      naming.place(data.axes[1], y),
      ...(p ? describe(p, naming.where(data)) : [["", "still to come"]]),
    ];
    const open = act ? () => this.open(there) : null;
    this.telling.show(this, x, y, rows, `simulate it${afresh(data)}`, open);
  }

  choose() {
    if (this.current) this.choosePoint(...this.current);
  }

  move(key) {
    const way = moves[key];
    if (way && this.data?.axes) this.moveBy(way);
    return Boolean(way);
  }

  /** Tells of the cell beside the one that is told of, which is brought into view. */
  moveBy([right, up]) {
    const middle = ({view: [from, to]}) => (from + to) / 2;
    const [at, height] = this.current ?? [middle(this.axis), middle(this.across)];
    const {data, k, l} = this.nearest(at, height);
    const ways = this.current ? [right, up] : [0, 0];
    const [x, y] = [k, l].map((i, d) => beside(data.axes[d], i, ways[d], this.data.axes[d]));
    this.axis.reveal(x);
    this.across.reveal(y);
    this.across.point(y, "key");
    this.axis.point(x, "key");
    this.tell(x, y, true);
  }

  /** {names, columns}: the numbers of what is in view, of the finest layer there. */
  numbers() {
    const {naming, data} = this;
    const [first, second] = data.axes;
    const rows = [];
    for (const layer of this.layers.over(this.choice.slice)) {
      const [x, y] = layer.data.axes;
      for (let l = 0; l < y.at.length; ++l)
        for (let k = 0; k < x.at.length; ++k) {
          const {p} = this.pointAt(layer, k, l);
          if (!p || !within(this.axis, x.at[k]) || !within(this.across, y.at[l])) continue;
          const place = [
            naming.number(x.parameter, x.values[k]),
            naming.number(y.parameter, y.values[l]),
          ];
          rows.push([...place, this.valueOf(p), this.motion(p).regime ?? "–"]);
        }
    }
    const names = [naming.label(first.parameter), naming.label(second.parameter)];
    return {
      names: [...names, this.quantity().label || "regime", "regime"],
      columns: [0, 1, 2, 3].map((i) => rows.map((row) => row[i])),
    };
  }

  /** Which slice and start is shown, where there are several. */
  shown() {
    const {slice, start, best} = this.choice;
    const {axes, defaultSet, starts} = this.data;
    const third = axes[2];
    const of = [
      third && this.naming.place(third, third.values[slice]).join(" = "),
      defaultSet && `of the start that is ${best ? "best" : "worst"}`,
      !defaultSet && starts > 1 && `start ${start + 1}`,
    ].filter(Boolean);
    return of.length ? `, ${of.join(", ")}` : "";
  }

  about() {
    const {title} = this.quantity();
    const scale = this.scale();
    const [first, second] = this.data.axes.map(({parameter}) => this.naming.label(parameter));
    const colours = scale ? `, colours from ${scale.ends.map(short).join(" to ")}` : "";
    const of = this.shown();
    return {
      title: `Map of ${title}${of}`,
      summary: `${title} over ${first} and ${second}${of}${colours}`,
    };
  }
}

/** The place of the cell beside one, of a coarser layer where its own has no more. */
function beside(axis, i, way, whole) {
  const next = axis.at[i + way];
  if (next !== undefined) return next;
  const border = way > 0 ? axis.borders.at(-1) : axis.borders[0];
  const outside = border + way * 1e-9 * (whole.borders.at(-1) - whole.borders[0]);
  const k = positionAt(whole, outside);
  return k < 0 ? axis.at[i] : whole.at[k];
}

const within = ({view: [from, to]}, at) => at >= from && at <= to;

/** The position on an axis whose cell holds a place; -1 beyond them. */
function positionAt({borders}, at) {
  if (at < borders[0] || at > borders.at(-1)) return -1;
  return Math.min(lastUpTo(borders, at), borders.length - 2);
}

/** That of each pixel of a view. */
function positions(axis, [from, to], pixels) {
  const step = (to - from) / pixels;
  return Int32Array.from({length: pixels}, (_, i) => positionAt(axis, from + (i + 0.5) * step));
}

/** The steps of the coarsest grid along an axis of so many values, in which the service begins. */
const coarsest = (n) => 2 ** Math.floor(Math.log2(Math.max(Math.floor(n / 8), 1)));

/**
 * Gives the cells that are still to come the colour of the point before them on a coarser grid; the
 * service computes them in this order. columns, rows: the place of each position in its axis as it
 * was asked for.
 */
function fill(cells, columns, rows) {
  const n = columns.length;
  const [column, row] = [inverse(columns), inverse(rows)];
  const [widest, highest] = [coarsest(n), coarsest(rows.length)];
  const known = cells.slice();
  for (let l = 0; l < rows.length; ++l)
    for (let k = 0; k < n; ++k)
      for (let step = 2; !cells[l * n + k] && step <= Math.max(widest, highest); step *= 2) {
        const [across, up] = [Math.min(step, widest), Math.min(step, highest)];
        const from = row[rows[l] - (rows[l] % up)] * n + column[columns[k] - (columns[k] % across)];
        cells[l * n + k] = known[from];
      }
}

function inverse(order) {
  const list = new Int32Array(order.length);
  order.forEach((given, k) => {
    list[given] = k;
  });
  return list;
}

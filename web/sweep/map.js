// A sweep over two axes, or a slice of one over three: a quantity as colours, with their scale beside
// it. Points that are still to come have the colour of a coarser neighbour.
import {Axis} from "../shared/axis.js";
import {rgb} from "../shared/colours.js";
import {short} from "../shared/numbers.js";
import {bestMotion, describe, quantityOf, regimeColour} from "../shared/quantities.js";
import {lastUpTo} from "../shared/search.js";
import {barWidth, drawBar, endsOf, scaleOf} from "./colour_scale.js";
import {ascending} from "./data.js";
import {SweepPanel, SweepView, toCome} from "./view.js";

/** Moves of the keyboard over the cells. */
const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

const firstPass = 1 / 40; // of the points: by them the colours are chosen, and stay

/** A colour as a pixel. */
const opaque = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

export class SweepMap extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Axis(), new Axis()], ...rest);
    this.panels = [new MapPanel(this, "map")];
  }

  /** What is at positions of a layer; its point is null before it has come. */
  cell(data, k, l) {
    const {start, best, slice} = this.choice;
    const index = data.index(k, l, start, data.slice === null ? slice : 0);
    const [x, y] = data.axes;
    const at = [x.at[k], y.at[l]];
    return {
      p: data.points[index],
      data,
      index,
      best,
      k,
      l,
      at,
      value: x.values[k],
      height: y.values[l],
    };
  }

  /** The cells of a layer whose points have come. */
  *cells(data) {
    const [first, second] = data.axes;
    for (let l = 0; l < second.at.length; ++l)
      for (let k = 0; k < first.at.length; ++k) {
        const cell = this.cell(data, k, l);
        if (cell.p) yield cell;
      }
  }

  /** The layers of what is shown, the coarsest first. */
  over() {
    return this.layers.over(this.choice.slice);
  }

  places() {
    return this.over().flatMap((data) => [...this.cells(data)]);
  }

  /** The finest cell at a place, one whose point has come if there is any. */
  nearest({at}) {
    let found = null;
    for (const data of this.over()) {
      const [k, l] = at.map((place, i) => positionAt(data.axes[i], place));
      if (k < 0 || l < 0) continue;
      const cell = this.cell(data, k, l);
      if (cell.p || !found) found = cell;
    }
    return found;
  }

  rowsOf({p, data, value, height}) {
    const [first, second] = data.axes;
    const places = [this.naming.place(first, value), this.naming.place(second, height)];
    return [...places, ...(p ? describe(p, this.naming.where(data)) : toCome)];
  }

  /** Tells of the cell beside the one that is told of, or of the middle one. */
  move(key) {
    const way = moves[key];
    if (!way) return false;
    const middle = ({view: [from, to]}) => (from + to) / 2;
    const from = this.nearest({at: this.current?.at ?? this.axes.map(middle)});
    const beyond = (at, i) => {
      const {borders} = from.data.axes[i];
      const [first, last] = this.axes[i].whole;
      const border = borders[lastUpTo(borders, at) + (way[i] > 0 ? 1 : 0)];
      return way[i] ? border + way[i] * 1e-9 * (last - first) : at;
    };
    const next = this.current && this.nearest({at: from.at.map(beyond)});
    this.goTo(...(next ?? from).at);
    return true;
  }
}

class MapPanel extends SweepPanel {
  drawn({height}) {
    return height;
  }

  quantity() {
    return quantityOf(this.view.choice.map, this.view.data);
  }

  /** The motion of a point that is shown: of several starts the worst or the best. */
  motion(p) {
    return this.view.choice.best ? bestMotion(p) : p;
  }

  /** The value of a point that is drawn; null where it has none. */
  valueOf(p) {
    return p.error ? null : (this.quantity().of(this.motion(p)) ?? null);
  }

  /** All values of the base that are there. */
  values() {
    return [...this.view.cells(this.view.data)]
      .map(({p}) => this.valueOf(p))
      .filter((v) => v !== null);
  }

  /**
   * The scale of the colours, null for categories. It is chosen once the whole has been seen
   * coarsely, for each quantity, and holds for all slices and starts.
   */
  scale() {
    const quantity = this.quantity();
    if (quantity.categories) return null;
    const {layers, data, choice} = this.view;
    const chosen = layers.ends[choice.map];
    if (chosen) return scaleOf(quantity, chosen);
    const values = this.values();
    const ends = endsOf(quantity, values);
    const seen = data.complete || data.received > Math.max(firstPass * data.total, 50);
    if (seen && values.length) layers.ends[choice.map] = ends;
    return scaleOf(quantity, ends);
  }

  prepare(width, height) {
    if (!this.view.layers) return null;
    const scale = this.scale();
    return {scale, frame: this.frameOf(width, height, scale ? barWidth : 12)};
  }

  paint(c, {frame, scale}) {
    frame.draw(c);
    const {left, top} = frame.box;
    c.imageSmoothingEnabled = false;
    c.drawImage(this.image(frame, this.colours(scale)), left, top, frame.width, frame.height);
    if (scale) drawBar(c, frame, scale, this.quantity().label);
  }

  /** The pixel of a point. */
  colours(scale) {
    const colourOf = (v) => (scale ? scale.at(v) : rgb(regimeColour(v)));
    return (p) => {
      const v = this.valueOf(p);
      return opaque(v === null ? rgb("nothing") : colourOf(v));
    };
  }

  /** All layers in the pixels of the screen. */
  image(frame, colourOf) {
    const width = Math.round(frame.width * devicePixelRatio);
    const height = Math.round(frame.height * devicePixelRatio);
    const image = new ImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    for (const data of this.view.over()) {
      const [first, second] = data.axes;
      const columns = positions(first, this.axis.view, width);
      const rows = positions(second, this.across.view, height).reverse();
      const cells = this.pixels(data, colourOf);
      for (let j = 0; j < height; ++j)
        for (let i = 0; i < width; ++i) {
          const inside = rows[j] >= 0 && columns[i] >= 0;
          const pixel = inside && cells[rows[j] * first.at.length + columns[i]];
          if (pixel) pixels[j * width + i] = pixel;
        }
    }
    const canvas = Object.assign(document.createElement("canvas"), {width, height});
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
  }

  /** A pixel for each cell of a layer, 0 where there is nothing. */
  pixels(data, colourOf) {
    const [first, second] = data.axes;
    const n = first.at.length;
    const pixels = new Uint32Array(n * second.at.length);
    for (const {p, k, l} of this.view.cells(data)) pixels[l * n + k] = colourOf(p);
    // Below a finer layer lies a coarser one.
    if (!data.complete && data === this.view.data) fill(pixels, first.order, second.order);
    return pixels;
  }

  columns() {
    return {
      [this.quantity().label || "regime"]: (p) => this.valueOf(p),
      regime: (p) => this.motion(p).regime ?? "–",
    };
  }

  /** Which slice and start is shown, where there are several. */
  shown() {
    const {slice, start, best} = this.view.choice;
    const {axes, defaultSet, starts} = this.view.data;
    const third = axes[2];
    const of = [
      third && this.view.naming.fields({[third.parameter]: third.values[slice]}),
      defaultSet && `of the start that is ${best ? "best" : "worst"}`,
      starts > 1 && `start ${start + 1}`,
    ];
    return of
      .filter(Boolean)
      .map((text) => `, ${text}`)
      .join("");
  }

  about() {
    const {title} = this.quantity();
    const scale = this.scale();
    const of = this.shown();
    const [first, second] = this.view.data.axes.map((a) => this.view.naming.label(a.parameter));
    const colours = scale ? `, colours from ${scale.ends.map(short).join(" to ")}` : "";
    return {
      title: `Map of ${title}${of}`,
      summary: `${title} over ${first} and ${second}${of}${colours}`,
    };
  }
}

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
  const [column, row] = [ascending(columns), ascending(rows)]; // where each entry is
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

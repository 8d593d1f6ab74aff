// A map: a quantity over two axes, as colours. Missing points look like a coarser neighbour.
import {nice, quantile} from "d3-array";
import {interpolateNumberArray, piecewise} from "d3-interpolate";
import {font, ticks} from "../shared/frame.js";
import {colour, drawText, drawTextUpwards, hex, ink, rgb} from "../shared/ink.js";
import {kind, pixel, raster} from "../shared/marks.js";
import {clamp, joined, lastUpTo, short} from "../shared/numbers.js";
import {bestMotion, describe, quantityOf, regimeColour} from "../shared/quantities.js";
import {Viewport} from "../shared/viewport.js";
import * as labels from "./axis_labels.js";
import {startStyle} from "./diagram.js";
import {missingPoint, SweepPlot, SweepView} from "./sweep_view.js";

const moves = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

const firstPass = 1 / 40; // fraction of the points after which the colour scale is fixed

export class MapView extends SweepView {
  constructor(root, ...rest) {
    super(root, [new Viewport(), new Viewport()], moves, ...rest);
    this.plots = [new SweepPlot(this, "map", map)];
  }

  show(data) {
    this.scaleEnds = {}; // by quantity
    this.attractors = []; // in the order of their colours
    super.show(data);
  }

  /** The cell at positions of a layer; its point is null until it is received. */
  cell(data, k, l) {
    const {start, best, slice} = this.choice;
    const index = data.index(k, l, start, data.slice === null ? slice : 0);
    const [x, y] = data.axes;
    const place = {at: [x.at[k], y.at[l]], value: x.values[k], height: y.values[l], k, l};
    return {...place, p: data.points[index], data, index, best};
  }

  *cells(data) {
    const [first, second] = data.axes;
    for (let l = 0; l < second.at.length; ++l)
      for (let k = 0; k < first.at.length; ++k) {
        const cell = this.cell(data, k, l);
        if (cell.p) yield cell;
      }
  }

  places() {
    return this.layersShown().flatMap((data) => [...this.cells(data)]);
  }

  /** The finest cell at a place, preferably one with a point. */
  nearest({at}) {
    const cells = this.layersShown().flatMap((data) => {
      const [k, l] = at.map((place, i) => positionAt(data.axes[i], place));
      return k < 0 || l < 0 ? [] : [this.cell(data, k, l)];
    });
    return cells.findLast(({p}) => p) ?? cells[0];
  }

  rowsOf({p, data, value, height}) {
    const [first, second] = data.axes;
    const places = [labels.place(first, value), labels.place(second, height)];
    return [...places, ...(p ? describe(p, labels.where(data)) : missingPoint)];
  }

  /** Moves the tooltip to the neighbouring cell; it starts in the middle. */
  move(way) {
    const from = this.nearest({at: this.current?.at ?? this.viewports.map(({middle}) => middle)});
    const halfCell = ({borders, at}) => (borders.at(-1) - borders[0]) / at.length / 2;
    const beyond = (at, i) => at + way[i] * 1.001 * halfCell(from.data.axes[i]);
    const next = this.current && this.nearest({at: from.at.map(beyond)});
    this.goTo(...(next ?? from).at);
  }

  quantity() {
    return quantityOf(this.choice.map, this.data);
  }

  /** The motion shown: of several starts the worst or the best. */
  motion(p) {
    return this.choice.best ? bestMotion(p) : p;
  }

  /** The value drawn for a point; null if it has none. */
  valueOf(p) {
    return p.error ? null : (this.quantity().of(this.motion(p)) ?? null);
  }

  /** The values of the visible slice. */
  values() {
    const values = [...this.cells(this.data)].map(({p}) => this.valueOf(p));
    return values.filter((v) => v !== null);
  }

  /** Colour name of a category; that of an attractor does not change while points arrive. */
  colourOf(name) {
    if (this.choice.map === "regime") return regimeColour(name);
    if (name === "not_decided") return "nothing";
    if (name === "chaotic") return "chaotic";
    const {attractors} = this;
    if (!attractors.includes(name)) attractors.push(name);
    return startStyle(attractors.indexOf(name)).colour;
  }

  /** The colour scale; null for categories. It stays once a coarse picture of the map exists. */
  scale() {
    const quantity = this.quantity();
    if (quantity.categories) return null;
    const {scaleEnds, data, choice} = this;
    const chosen = scaleEnds[choice.map];
    if (chosen) return scaleOf(quantity, chosen);
    const values = this.values();
    const ends = endsOf(quantity, values);
    const seen = data.complete || data.received > Math.max(firstPass * data.total, 50);
    if (seen && values.length) scaleEnds[choice.map] = ends;
    return scaleOf(quantity, ends);
  }

  /** Slice and start shown, where there are several. */
  get about() {
    const {slice, start, best} = this.choice;
    const {axes, defaultSet, starts} = this.data;
    const third = axes[2];
    return joined([
      third && labels.fields({[third.parameter]: third.values[slice]}),
      defaultSet && `${best ? "best" : "worst"} start`,
      starts > 1 && `start ${start + 1}`,
    ]);
  }

  /** Sets the pixels of all layers; those without a regime are hatched. */
  fill(pixels, width, height, scale) {
    const [none, line] = ["regime-none", "panel"].map((name) => pixel(rgb(name)));
    for (const data of this.layersShown()) {
      const [first, second] = data.axes;
      const [across, up] = this.viewports;
      const columns = positions(first, across.range, width);
      const rows = positions(second, up.range, height).reverse();
      const cells = this.pixels(data, scale);
      for (let j = 0; j < height; ++j)
        for (let i = 0; i < width; ++i) {
          const inside = rows[j] >= 0 && columns[i] >= 0;
          const colour = inside && cells[rows[j] * first.at.length + columns[i]];
          const isLine = !scale && colour === none && (i + j) % 8 < 2;
          if (colour) pixels[j * width + i] = isLine ? line : colour;
        }
    }
  }

  /** A pixel for each cell of a layer; 0 without a point. */
  pixels(data, scale) {
    const [first, second] = data.axes;
    const n = first.at.length;
    const pixels = new Uint32Array(n * second.at.length);
    const colourOf = scale ? scale.at : (v) => rgb(this.colourOf(v));
    for (const {p, k, l} of this.cells(data)) {
      const v = this.valueOf(p);
      pixels[l * n + k] = pixel(v === null ? rgb("nothing") : colourOf(v));
    }
    // Only the base layer is filled: below a finer layer the coarser one shows through.
    if (!data.complete && data === this.data) fillGaps(pixels, n);
    return pixels;
  }
}

/** The content of the map: an image and, except for categories, its colour scale. */
function map(view) {
  const {label, title} = view.quantity();
  const scale = view.scale();
  const of = view.about && `, ${view.about}`;
  const [first, second] = view.data.axes.map(({parameter}) => labels.label(parameter));
  const colours = scale ? `, colours from ${scale.ends.map(short).join(" to ")}` : "";
  return {
    title: `Map of ${title}${of}`,
    summary: `${title} over ${first} and ${second}${of}${colours}`,
    beside: scale ? barWidth : 12,
    marks: [
      raster({paint: (...image) => view.fill(...image, scale)}),
      ...(scale ? [bar({scale, title: label, above: true})] : []),
    ],
    height: ({height}) => height,
    columns: {
      [label || title]: (p) => view.valueOf(p),
      regime: (p) => view.motion(p).regime ?? "–",
    },
  };
}

/** Index of the cell at a place; -1 outside the axis. */
function positionAt({borders}, at) {
  if (at < borders[0] || at > borders.at(-1)) return -1;
  return Math.min(lastUpTo(borders, at), borders.length - 2);
}

/** Index of the cell at each pixel of a visible range. */
function positions(axis, [from, to], pixels) {
  const step = (to - from) / pixels;
  return Int32Array.from({length: pixels}, (_, i) => positionAt(axis, from + (i + 0.5) * step));
}

/** Gives missing cells the colour of the cell before them in a row of n or, without one, below. */
function fillGaps(cells, n) {
  for (let i = 1; i < cells.length; ++i) cells[i] ||= (i % n && cells[i - 1]) || cells[i - n];
}

// The colour scale of a map, and the bar that shows it.
const spare = 0.02; // fraction of the values at either end that can lie beyond the scale

/** Round ends of the colour scale, beyond which a few outliers can lie. */
function endsOf({from0 = true}, values) {
  const [least = 0, most = 0] = [spare, 1 - spare].map((share) => quantile(values, share));
  const [low, high] = from0 ? [Math.min(least, 0), Math.max(most, 0)] : [least, most];
  return nice(low, low === high ? low + (Math.abs(low) || 1) : high, 10);
}

/** {at(value): colour as bytes, ends, beyond: whether at() got values below and above the ends}. */
function scaleOf({diverging}, ends) {
  const [low, high] = ends;
  const stops = colour(diverging ? "diverging" : "sequential").split(/\s+/);
  const between = piecewise(interpolateNumberArray, stops.map(hex));
  const most = Math.max(-low, high);
  const [first, last] = diverging ? [-most, most] : ends;
  const beyond = [false, false];
  const at = (v) => {
    beyond[0] ||= v < low;
    beyond[1] ||= v > high;
    return between(clamp((v - first) / (last - first), 0, 1)).map(Math.round);
  };
  return {ends, beyond, at};
}

const barWidth = 86; // px next to the map
const thickness = 12; // px of the bar

/** The bar of a scale at the right of a plot, with its title. */
const bar = kind((c, {box, height}, {scale, title}) => {
  const {at, ends, beyond} = scale;
  const [low, high] = ends;
  const left = box.right + 12;
  const rows = Math.min(Math.round(height), 256);
  const row = height / rows;
  for (let y = 0; y < rows; ++y) {
    c.fillStyle = `rgb(${at(high - ((y + 0.5) / rows) * (high - low))})`;
    c.fillRect(left, box.top + y * row, thickness, row + 0.5);
  }
  c.font = font;
  ink(c, "soft");
  let last = Infinity;
  for (const value of marksOf(ends, height)) {
    const y = box.bottom - ((value - low) / (high - low)) * height;
    if (last - y < 12) continue;
    last = y;
    const sign =
      (value === low && beyond[0] && "≤ ") || (value === high && beyond[1] && "≥ ") || "";
    const text = `${sign}${short(Number(value.toPrecision(6)))}`;
    drawText(c, text, left + thickness + 5, clamp(y, box.top + 5, box.bottom - 5), "left");
  }
  drawTextUpwards(c, title, left + barWidth - 20, (box.top + box.bottom) / 2);
});

/** Values written next to a bar, ascending. */
function marksOf([low, high], height) {
  const inside = low < 0 && high > 0 ? [low, 0, high] : ticks(low, high, Math.max(2, height / 45));
  return [...new Set([low, ...inside, high])].sort((a, b) => a - b);
}

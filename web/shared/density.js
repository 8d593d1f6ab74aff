// Density plots: an image that counts the points at each pixel. A periodic orbit appears as a few
// opaque dots, chaos as a cloud.
import {rgb} from "./colours.js";
import {element} from "./dom.js";
import {clamp} from "./numbers.js";

/** Number of points at each screen pixel of a plot. */
class Counts {
  constructor(frame) {
    this.ratio = devicePixelRatio; // read once: reading it is slower than counting
    [this.width, this.height] = [frame.width, frame.height].map((v) => this.pixels(v));
    this.counts = new Uint16Array(this.width * this.height);
    this.most = 8;
  }

  pixels(v) {
    return Math.round(v * this.ratio);
  }

  /** Counts a rectangle of pixels, clipped to the plot. */
  add(left, top, right, bottom) {
    const [first, last] = [Math.max(left, 0), Math.min(right, this.width)];
    const end = Math.min(bottom, this.height);
    for (let j = Math.max(top, 0); j < end; ++j)
      for (let i = first; i < last; ++i) {
        const n = ++this.counts[j * this.width + i];
        if (n > this.most) this.most = n;
      }
  }
}

/**
 * Counts the values of columns [{from, to, values}], where from and to are px from the left edge of
 * the frame. Values of a broad column are drawn in its middle.
 */
export function count(columns, frame) {
  const found = new Counts(frame);
  const [min, max] = frame.y.range;
  const [broad, thick] = [4, 1.4].map((v) => Math.max(1, found.pixels(v)));
  for (const {from, to, values} of columns) {
    const [begin, end] = [found.pixels(from), found.pixels(to)];
    const across = clamp(end - begin, 1, broad);
    const left = end - begin > broad ? Math.round((begin + end - broad) / 2) : begin;
    for (const v of values) {
      if (!(v >= min && v <= max)) continue;
      const middle = Math.min(found.pixels(frame.py(v) - frame.box.top), found.height - 1);
      const top = middle - (thick >> 1);
      found.add(left, top, left + across, top + thick);
    }
  }
  return found;
}

/** Counts points of the plane of a frame, each 2 px wide. */
export function countPoints(x, y, frame) {
  const found = new Counts(frame);
  const {left, top} = frame.box;
  const size = Math.max(2, found.pixels(2));
  for (let i = 0; i < x.length; ++i) {
    const column = found.pixels(frame.px(x[i]) - left) - (size >> 1);
    const row = found.pixels(frame.py(y[i]) - top) - (size >> 1);
    found.add(column, row, column + size, row + size);
  }
  return found;
}

/** An image of counts in one colour, whose opacity grows with the logarithm of the count. */
export function density({counts, most, width, height}, name) {
  const image = new ImageData(width, height);
  const {data} = image;
  const own = rgb(name);
  const scale = 0.58 / Math.log(most);
  for (let i = 0; i < counts.length; ++i) {
    if (!counts[i]) continue;
    data.set(own, 4 * i);
    data[4 * i + 3] = 255 * (0.42 + scale * Math.log(counts[i]));
  }
  const canvas = element("canvas", {width, height});
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

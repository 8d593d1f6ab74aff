// How often points come to each pixel of a plot, as an image: a periodic orbit is a few full dots,
// chaos a cloud.
import {rgb} from "./colours.js";
import {element} from "./dom.js";

/** The counts of a plot's pixels of the screen. */
class Counts {
  most = 8;

  constructor(frame) {
    this.ratio = devicePixelRatio;
    [this.width, this.height] = [frame.width, frame.height].map((v) => this.pixels(v));
    this.counts = new Uint16Array(this.width * this.height);
  }

  /** Of the screen. */
  pixels(px) {
    return Math.round(px * this.ratio);
  }

  /** Counts a rectangle of pixels, as far as it lies in the plot. */
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

/** Of points in the plane of a frame. */
export function countPoints(x, y, frame) {
  const found = new Counts(frame);
  const {left, top} = frame.box;
  const size = Math.max(2, found.pixels(2));
  const half = size / 2 / found.ratio;
  for (let i = 0; i < x.length; ++i) {
    const column = found.pixels(frame.px(x[i]) - left - half);
    const row = found.pixels(frame.py(y[i]) - top - half);
    found.add(column, row, column + size, row + size);
  }
  return found;
}

/**
 * Of columns, [{from, to, values}], from and to in px from the frame's left edge; a broad one is
 * drawn in its middle.
 */
export function count(columns, frame) {
  const found = new Counts(frame);
  const [min, max] = frame.y.range;
  const thick = Math.max(1, found.pixels(1.4));
  for (const column of columns) {
    const [from, to] = edges(column, found);
    for (const v of column.values) {
      if (!(v >= min && v <= max)) continue;
      const middle = Math.min(found.pixels(frame.py(v) - frame.box.top), found.height - 1);
      const top = middle - (thick >> 1);
      found.add(from, top, to, top + thick);
    }
  }
  return found;
}

/** The pixels of a column: all, or the middle of a broad one. */
function edges({from, to}, found) {
  const [begin, end, broad] = [from, to, 4].map((px) => found.pixels(px));
  if (end - begin <= broad) return [begin, Math.max(end, begin + 1)];
  const first = Math.round((begin + end - broad) / 2);
  return [first, first + broad];
}

/** Counts as an image of one colour, more often as opacity. */
export function density({counts, most, width, height}, name) {
  const image = new ImageData(width, height);
  const own = rgb(name);
  const scale = 0.58 / Math.log(most);
  counts.forEach((n, i) => {
    if (n) image.data.set([...own, 255 * (0.42 + scale * Math.log(n))], 4 * i);
  });
  const canvas = element("canvas", {width, height});
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

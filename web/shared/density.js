// How often points come to each pixel of a plot, as an image: a periodic orbit is a few full dots,
// chaos a cloud.
import {rgb} from "./colours.js";

/** The counts of a plot's pixels of the screen. */
class Counts {
  constructor(frame) {
    this.ratio = devicePixelRatio;
    this.width = Math.round(frame.width * this.ratio);
    this.height = Math.round(frame.height * this.ratio);
    this.counts = new Uint16Array(this.width * this.height);
    this.most = 8;
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
  const {ratio} = found;
  const {left, top} = frame.box;
  const size = Math.max(2, Math.round(2 * ratio));
  for (let i = 0; i < x.length; ++i) {
    const column = Math.round((frame.px(x[i]) - left) * ratio - size / 2);
    const row = Math.round((frame.py(y[i]) - top) * ratio - size / 2);
    found.add(column, row, column + size, row + size);
  }
  return found;
}

/**
 * Of columns, [{from, to, values}], from and to in px from the frame's left edge; a broad one is
 * drawn in its middle.
 */
export function count(columns, frame, log) {
  const found = new Counts(frame);
  const {ratio, height} = found;
  const [min, max] = frame.y.range;
  const at = log ? Math.log : (v) => v;
  const scale = (height - 1) / (at(max) - at(min));
  const thick = Math.max(1, Math.round(1.4 * ratio));
  for (const column of columns) {
    const [from, to] = edges(column, ratio);
    for (const v of column.values) {
      if (!(v >= min && v <= max)) continue;
      const top = Math.round((at(max) - at(v)) * scale) - (thick >> 1);
      found.add(from, top, to, top + thick);
    }
  }
  return found;
}

/** The pixels of a column: all, or the middle of a broad one. */
function edges({from, to}, ratio) {
  const [begin, end] = [Math.round(from * ratio), Math.round(to * ratio)];
  const broad = Math.round(4 * ratio);
  if (end - begin <= broad) return [begin, Math.max(end, begin + 1)];
  const first = Math.round((begin + end - broad) / 2);
  return [first, first + broad];
}

/** Counts as an image of one colour, more often as opacity. */
export function density({counts, most, width, height}, name) {
  const image = new ImageData(width, height);
  const pixels = image.data;
  const [r, g, b] = rgb(name);
  const scale = 0.58 / Math.log(most);
  for (let i = 0; i < counts.length; ++i) {
    if (!counts[i]) continue;
    pixels[4 * i] = r;
    pixels[4 * i + 1] = g;
    pixels[4 * i + 2] = b;
    pixels[4 * i + 3] = 255 * (0.42 + scale * Math.log(counts[i]));
  }
  const canvas = Object.assign(document.createElement("canvas"), {width, height});
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

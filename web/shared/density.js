// How often points come to each pixel of a plot, as an image: a periodic orbit is a few full dots,
// chaos a cloud.
import {rgb} from "./colours.js";
import {element} from "./dom.js";
import {clamp} from "./numbers.js";

/** How often each pixel of the screen in a plot is met. */
class Counts {
  constructor(frame) {
    this.ratio = devicePixelRatio; // asking for it takes longer than counting
    [this.width, this.height] = [frame.width, frame.height].map((v) => this.pixels(v));
    this.counts = new Uint16Array(this.width * this.height);
    this.most = 8;
  }

  pixels(v) {
    return Math.round(v * this.ratio);
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

/**
 * Of columns, [{from, to, values}], from and to in px from the frame's left edge; a broad one is
 * drawn in its middle.
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

/** Of points in the plane of a frame, 2 px wide. */
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

/** Counts as an image of one colour, more often as opacity. */
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

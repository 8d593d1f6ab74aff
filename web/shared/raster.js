// Images of pixels in a plot: maps, and densities, which count the points at each pixel. In a density
// a periodic orbit appears as a few opaque dots, chaos as a cloud.
import {rgb} from "./colours.js";
import {element} from "./dom.js";
import {clamp} from "./numbers.js";

/** A colour [red, green, blue] as a pixel. */
export const pixel = ([r, g, b], alpha = 255) =>
  ((Math.round(alpha) << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** Fills a plot with the pixels that paint(pixels, width, height) sets; 0 is transparent. */
export function drawPixels(c, {box, width, height}, paint) {
  const [w, h] = [width, height].map((v) => Math.round(v * devicePixelRatio));
  const image = new ImageData(w, h);
  paint(new Uint32Array(image.data.buffer), w, h);
  const canvas = element("canvas", {width: w, height: h});
  canvas.getContext("2d").putImageData(image, 0, 0);
  c.imageSmoothingEnabled = false;
  c.drawImage(canvas, box.left, box.top, width, height);
}

/** The number of points at each pixel. */
class Counts {
  constructor(pixels, width, height) {
    Object.assign(this, {pixels, width, height, most: 8});
    this.ratio = devicePixelRatio; // read once: reading it is slower than counting
  }

  /** A length or position in px as device pixels. */
  round(px) {
    return Math.round(px * this.ratio);
  }

  /** Counts a rectangle of pixels, clipped to the plot. */
  add(left, top, right, bottom) {
    const [first, last] = [Math.max(left, 0), Math.min(right, this.width)];
    const end = Math.min(bottom, this.height);
    for (let j = Math.max(top, 0); j < end; ++j)
      for (let i = first; i < last; ++i) {
        const n = ++this.pixels[j * this.width + i];
        if (n > this.most) this.most = n;
      }
  }
}

/** Draws counts in one colour, whose opacity grows with the logarithm of the count. */
const drawDensity = (c, frame, colour, count) =>
  drawPixels(c, frame, (pixels, width, height) => {
    const counts = new Counts(pixels, width, height);
    count(counts);
    const own = rgb(colour);
    const scale = 0.58 / Math.log(counts.most);
    const shades = []; // by count
    for (let i = 0; i < pixels.length; ++i) {
      const n = pixels[i];
      if (n) pixels[i] = shades[n] ??= pixel(own, 255 * (0.42 + scale * Math.log(n)));
    }
  });

/**
 * Density of the values of columns [{from, to, values}], where from and to are in px. Values of a
 * broad column are drawn in its middle.
 */
export function columnDensity(c, frame, {columns, colour}) {
  const [min, max] = frame.y.range;
  const {left, top} = frame.box;
  drawDensity(c, frame, colour, (counts) => {
    const [broad, thick] = [4, 1.4].map((v) => Math.max(1, counts.round(v)));
    for (const {from, to, values} of columns) {
      const [begin, end] = [from, to].map((px) => counts.round(px - left));
      const across = clamp(end - begin, 1, broad);
      const start = end - begin > broad ? Math.round((begin + end - broad) / 2) : begin;
      for (const v of values) {
        if (!(v >= min && v <= max)) continue;
        const middle = Math.min(counts.round(frame.py(v) - top), counts.height - 1);
        const row = middle - (thick >> 1);
        counts.add(start, row, start + across, row + thick);
      }
    }
  });
}

/** Density of points, each 2 px wide. */
export function pointDensity(c, frame, {x, y, colour}) {
  const {left, top} = frame.box;
  drawDensity(c, frame, colour, (counts) => {
    const size = Math.max(2, counts.round(2));
    for (let i = 0; i < x.length; ++i) {
      const column = counts.round(frame.px(x[i]) - left) - (size >> 1);
      const row = counts.round(frame.py(y[i]) - top) - (size >> 1);
      counts.add(column, row, column + size, row + size);
    }
  });
}

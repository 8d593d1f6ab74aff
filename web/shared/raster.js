// Images of pixels in a plot: maps, and densities, which count the points at each pixel. In a density
// a periodic orbit appears as a few opaque dots, chaos as a cloud.

import {element} from "./dom.js";
import {rgb} from "./ink.js";
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

/**
 * Draws the number of rectangles at each pixel in one colour, whose opacity grows with the logarithm
 * of the number. count(add, round, height): add(left, top, right, bottom) counts a rectangle,
 * clipped to the plot; round(px): a length or position in device pixels, as all of these are.
 */
function drawDensity(c, frame, colour, count) {
  const ratio = devicePixelRatio; // read once: reading it is slower than counting
  drawPixels(c, frame, (pixels, width, height) => {
    let most = 8;
    const add = (left, top, right, bottom) => {
      const [first, last] = [Math.max(left, 0), Math.min(right, width)];
      const end = Math.min(bottom, height);
      for (let j = Math.max(top, 0); j < end; ++j)
        for (let i = first; i < last; ++i) {
          const n = ++pixels[j * width + i];
          if (n > most) most = n;
        }
    };
    count(add, (px) => Math.round(px * ratio), height);
    const own = rgb(colour);
    const scale = 0.58 / Math.log(most);
    const shades = []; // by number
    for (let i = 0; i < pixels.length; ++i) {
      const n = pixels[i];
      if (n) pixels[i] = shades[n] ??= pixel(own, 255 * (0.42 + scale * Math.log(n)));
    }
  });
}

/** Density of columns [{from, to, values}] of x; a broad column is drawn in its middle. */
export function columnDensity(c, frame, {columns, colour}) {
  const [min, max] = frame.y.range;
  const {left, top} = frame.box;
  drawDensity(c, frame, colour, (add, round, height) => {
    const [broad, thick] = [4, 1.4].map((v) => Math.max(1, round(v)));
    for (const {from, to, values} of columns) {
      const [begin, end] = [from, to].map((x) => round(frame.px(x) - left));
      const across = clamp(end - begin, 1, broad);
      const start = end - begin > broad ? Math.round((begin + end - broad) / 2) : begin;
      for (const v of values) {
        if (!(v >= min && v <= max)) continue;
        const row = Math.min(round(frame.py(v) - top), height - 1) - (thick >> 1);
        add(start, row, start + across, row + thick);
      }
    }
  });
}

/** Density of points, each 2 px wide. */
export function pointDensity(c, frame, {x, y, colour}) {
  const {left, top} = frame.box;
  drawDensity(c, frame, colour, (add, round) => {
    const size = Math.max(2, round(2));
    for (let i = 0; i < x.length; ++i) {
      const column = round(frame.px(x[i]) - left) - (size >> 1);
      const row = round(frame.py(y[i]) - top) - (size >> 1);
      add(column, row, column + size, row + size);
    }
  });
}

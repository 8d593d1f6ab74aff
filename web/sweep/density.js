// How often a section comes to each pixel of a plot, as an image.
import {rgb} from "./colour_scale.js";

/**
 * {counts, most, width, height} in pixels of the screen. columns: [{from, to, values}], px from the
 * frame's left edge; a broad one is drawn in its middle.
 */
export function count(columns, frame, log) {
  const ratio = devicePixelRatio;
  const width = Math.round(frame.width * ratio);
  const height = Math.round(frame.height * ratio);
  const [min, max] = frame.y.range;
  const at = log ? Math.log : (v) => v;
  const scale = (height - 1) / (at(max) - at(min));
  const thick = Math.max(1, Math.round(1.4 * ratio));
  const counts = new Uint16Array(width * height);
  let most = 8;
  for (const column of columns) {
    const [begin, end] = edges(column, ratio);
    const [from, to] = [Math.max(begin, 0), Math.min(end, width)];
    for (const v of column.values) {
      if (!(v >= min && v <= max)) continue;
      const first = Math.round((at(max) - at(v)) * scale) - (thick >> 1);
      for (let j = Math.max(0, first); j < Math.min(height, first + thick); ++j)
        for (let i = from; i < to; ++i) {
          const n = ++counts[j * width + i];
          if (n > most) most = n;
        }
    }
  }
  return {counts, most, width, height};
}

/** The pixels of a column: all, or the middle of a broad one. */
function edges({from, to}, ratio) {
  const [begin, end] = [Math.round(from * ratio), Math.round(to * ratio)];
  const broad = Math.round(4 * ratio);
  if (end - begin <= broad) return [begin, Math.max(end, begin + 1)];
  const first = Math.round((begin + end - broad) / 2);
  return [first, first + broad];
}

/** Counts as an image of one colour. */
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

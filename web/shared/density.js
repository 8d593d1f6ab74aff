// How often points come to each pixel of a plot, as an image: a periodic orbit is a few full dots,
// chaos a cloud.
import {rgb} from "./colours.js";
import {element} from "./dom.js";
import {clamp} from "./numbers.js";

/**
 * {counts, most, width, height}: how often each pixel of the screen in a plot is met. Of columns,
 * [{from, to, values}], from and to in px from the frame's left edge, whose values are so many px
 * thick; a broad one is drawn in its middle.
 */
export function count(columns, frame, px = 1.4) {
  const pixels = (v) => Math.round(v * devicePixelRatio);
  const [width, height, broad] = [frame.width, frame.height, 4].map(pixels);
  const counts = new Uint16Array(width * height);
  const [min, max] = frame.y.range;
  const thick = Math.max(1, pixels(px));
  let most = 8;
  for (const {from, to, values} of columns) {
    const [begin, end] = [from, to].map(pixels);
    const across = clamp(end - begin, 1, broad);
    const left = end - begin > broad ? Math.round((begin + end - broad) / 2) : begin;
    const right = Math.min(left + across, width);
    for (const v of values) {
      if (!(v >= min && v <= max)) continue;
      const middle = Math.min(pixels(frame.py(v) - frame.box.top), height - 1);
      const top = middle - (thick >> 1);
      const bottom = Math.min(top + thick, height);
      for (let j = Math.max(top, 0); j < bottom; ++j)
        for (let i = Math.max(left, 0); i < right; ++i)
          most = Math.max(most, ++counts[j * width + i]);
    }
  }
  return {counts, most, width, height};
}

/** The same of points in the plane of a frame, 2 px wide. */
export function countPoints(x, y, frame) {
  const column = (v, i) => {
    const middle = frame.px(v) - frame.box.left;
    return {from: middle - 1, to: middle + 1, values: [y[i]]};
  };
  return count(x.map(column), frame, 2);
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

// Marks: what a plot draws over its frame. A mark is its options and draw(c, frame), where c is a
// canvas context or an SvgPen. All have `alpha`, a `label` in legend and table, and `above`: drawn
// last, not clipped.
import {bisectLeft} from "d3-array";
import {element} from "./dom.js";
import {font} from "./frame.js";
import {drawText, ink, rgb, stroke} from "./ink.js";
import {clamp} from "./numbers.js";

/** A kind of mark from draw(c, frame, options). */
export const kind = (draw) => (options) => ({
  ...options,
  draw(c, frame) {
    c.globalAlpha = options.alpha ?? 1;
    draw(c, frame, options);
    c.globalAlpha = 1;
  },
});

/** A line at ascending x; null and NaN interrupt it. dense: it has several points per pixel. */
export const line = kind((c, frame, {x, y, colour, width = 1, dash, dense}) => {
  const [min, max] = frame.x.range;
  // Visible points and one more on either side.
  const from = Math.max(bisectLeft(x, min) - 1, 0);
  const to = Math.min(bisectLeft(x, max) + 1, x.length);
  const ends = []; // of each pixel column: spikes stay
  const widen = (column, py) => {
    const last = ends.at(-1);
    if (last?.column !== column) ends.push({column, low: py, high: py});
    else Object.assign(last, {low: Math.min(last.low, py), high: Math.max(last.high, py)});
  };
  const thinned = dense || to - from > 4 * frame.width;
  let broken = true;
  ink(c, colour, width, dash);
  c.beginPath();
  for (let i = from; i < to; ++i) {
    const [px, py] = [frame.px(x[i]), frame.py(y[i])];
    const there = !Number.isNaN(py);
    if (there && thinned) widen(Math.floor(px), py);
    else if (there) c[broken ? "moveTo" : "lineTo"](px, py);
    broken = !there;
  }
  ends.forEach(({column, low, high}, k) => {
    const last = ends[k - 1] ?? {low, high}; // each column reaches the previous one
    c.moveTo(column + 0.5, Math.min(low, last.high) - 0.5);
    c.lineTo(column + 0.5, Math.max(high, last.low) + 0.5);
  });
  c.stroke();
});

/** A line through points in any order. */
export const curve = kind((c, {px, py}, {x, y, colour, width = 1.6, dash}) => {
  ink(c, colour, width, dash);
  stroke(c, ...x.map((v, i) => [px(v), py(y[i])]));
});

/** Horizontal lines at y, one or several; text: above the right end, where there is space. */
export const levels = kind((c, frame, {y, colour = "line", text = ""}) => {
  ink(c, colour);
  for (const level of [y].flat()) {
    frame.across(c, level);
    if (text && frame.width > 7 * text.length)
      drawText(c, text, frame.box.right - 4, frame.py(level) - 2, "right", "bottom");
  }
});

/** Dashed vertical lines at the values `at`. */
export const uprights = kind((c, frame, {at}) => {
  ink(c, "wall", 1, [6, 4]);
  for (const x of at) frame.upright(c, x);
});

/** A shaded range of y. */
export const layer = kind((c, {box, py, width}, {from, to, colour}) => {
  ink(c, colour);
  c.fillRect(box.left, py(to), width, py(from) - py(to));
});

/** Shaded intervals of x as one path, so that intervals in the same pixel do not darken it. */
export const bands = kind((c, {box: {left, right, top}, px, height}, {intervals, colour}) => {
  ink(c, colour);
  c.beginPath();
  for (const [from, to] of intervals) {
    const a = Math.max(px(from), left);
    const b = Math.min(px(to), right);
    if (b > left && a < right) c.rect(a, top, Math.max(b - a, 1), height);
  }
  c.fill();
});

const hatchStep = 6; // px between the lines of a hatched rectangle

/** Lines across a rectangle, so that it differs from others not only in colour. */
function hatch(c, left, top, width, height) {
  c.save();
  c.beginPath();
  c.rect(left, top, width, height);
  c.clip();
  ink(c, "panel", 1.5);
  for (let x = left - height; x < left + width; x += hatchStep)
    stroke(c, [x, top + height], [x + height, top]);
  c.restore();
}

/**
 * Rectangles over intervals [{from, to, colour, text, hatched}] of x, `height` px high and `down`
 * px below the upper edge. With `texts`, those that fit are written `textDown` px below it.
 */
export const blocks = kind((c, {box, px, ...frame}, options) => {
  const {list, down = 0, height = frame.height, textDown = 0, size = 11, texts} = options;
  const alpha = c.globalAlpha;
  for (const {from, to, colour, text = "", hatched} of list) {
    const ends = [from, to].map((x) => clamp(px(x), box.left, box.right));
    if (!(ends[1] > ends[0])) continue;
    const [left, right] = ends.map(Math.round); // whole pixels: no gaps between neighbours
    ink(c, colour);
    c.fillRect(left, box.top + down, right - left || 1, height);
    if (hatched) hatch(c, left, box.top + down, right - left, height);
    if (!texts || 7 * text.length + 4 >= right - left) continue;
    ink(c, "text");
    c.font = `600 ${font.replace("11", size)}`;
    c.globalAlpha = 1;
    drawText(c, text, (left + right) / 2, box.top + textDown, "center", "top");
    c.globalAlpha = alpha;
  }
});

/** Corners of polygons, and the angle of the first one in right angles. */
const polygons = {box: [4, 0.5], triangle: [3, -1], diamond: [4, 0], pointed: [3, 1]};

/** Adds a circle, a cross or a polygon to a path; a "square" is filled at once, which is fast. */
function symbol(c, shape, x, y, r) {
  if (shape === "square") c.fillRect(x - r, y - r, 2 * r, 2 * r);
  else if (shape === "cross")
    for (const up of [r, -r]) {
      c.moveTo(x - r, y - up);
      c.lineTo(x + r, y + up);
    }
  else if (polygons[shape]) {
    const [n, turn] = polygons[shape];
    for (let i = 0; i < n; ++i) {
      const angle = (turn * Math.PI) / 2 + (2 * Math.PI * i) / n;
      const [right, down] = [1.3 * r * Math.cos(angle), 1.3 * r * Math.sin(angle)];
      c[i ? "lineTo" : "moveTo"](x + right, y + down);
    }
    c.closePath();
  } else {
    c.moveTo(x + r, y);
    c.arc(x, y, r, 0, 2 * Math.PI);
  }
}

const finish = (c, shape) => (shape === "ring" || shape === "cross" ? c.stroke() : c.fill());

const many = 5000; // visible points above which the density is drawn

/**
 * Symbols at points in any order; without y a point is not drawn. size: half the width, px; tints:
 * colour of each point in place of a common one; errors: half lengths of paler bars; fitted: smaller
 * if many are visible, and those beyond the range of y lie at the edge.
 */
export const dots = kind((c, frame, options) => {
  const {x, y, tints, errors = [], shape = "square", size = 1.2, width = 1.2, fitted} = options;
  const {top, bottom} = frame.box;
  const [min, max] = frame.x.range;
  const isShown = (i) => x[i] >= min && x[i] <= max && !Number.isNaN(frame.py(y[i]));
  const visible = [...x.keys()].filter(isShown);
  if (!tints && visible.length > many) {
    const columns = visible.map((i) => ({from: x[i], to: x[i], values: [y[i]]}));
    const {colour, alpha} = options;
    return density({columns, colour, alpha, least: 2, thick: 2}).draw(c, frame);
  }
  const room = fitted ? frame.width / (3 * visible.length) : 1;
  const r = Math.max(size * Math.min(Math.sqrt(room), 1), 0.75);
  const alpha = c.globalAlpha;
  c.globalAlpha = 0.45 * alpha;
  errors.forEach((error, i) => {
    if (!error || y[i] == null) return;
    ink(c, tints[i], Math.max(1, size / 2));
    const end = (sign) => clamp(frame.py(y[i] + sign * error), top, bottom);
    stroke(c, ...[-1, 1].map((sign) => [frame.px(x[i]), end(sign)]));
  });
  c.globalAlpha = alpha;
  for (const [colour, own] of Map.groupBy(visible, (i) => tints?.[i] ?? options.colour)) {
    ink(c, colour, width);
    c.beginPath();
    for (const i of own) {
      const py = frame.py(y[i]);
      symbol(c, shape, frame.px(x[i]), fitted ? clamp(py, top, bottom) : py, r);
    }
    finish(c, shape);
  }
});

/** Symbols of a series over x, such as impacts. */
export const symbols = (options) =>
  dots({fitted: true, above: true, size: 4, width: 1.3, ...options});

/** Dots of a series, cut at the edge of the plot. */
export const beads = (options) => dots({fitted: true, shape: "dot", ...options});

/** Names of series in their colours, for pictures without a legend. */
export const names = kind((c, {box}, {series}) =>
  series.forEach(({label, colour}, k) => {
    ink(c, colour);
    drawText(c, label, box.left + 8 + 90 * k, box.top + 4, "left", "top");
  }),
);

/** Names above points, where they do not lie on another one. */
export const texts = kind((c, frame, {x, y, text}) => {
  ink(c, "text");
  c.font = font;
  const drawn = [];
  text.forEach((one, i) => {
    const [px, py] = [frame.px(x[i]), frame.py(y[i])];
    const crowded = drawn.some(([a, b]) => Math.abs(a - px) < 60 && Math.abs(b - py) < 12);
    if (!one || crowded || !frame.holds(px, py)) return;
    drawn.push([px, py]);
    const middle = clamp(px, frame.box.left + 30, frame.box.right - 30);
    drawText(c, one, middle, py - 8, "center", "bottom");
  });
});

// Images of pixels: maps, and densities, in which chaos appears as a cloud.

/** A colour [red, green, blue] as a pixel. */
export const pixel = ([r, g, b], alpha = 255) =>
  ((Math.round(alpha) << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** Fills a plot with the pixels that paint(pixels, width, height) sets; 0 is transparent. */
function drawPixels(c, {box, width, height}, paint) {
  const [w, h] = [width, height].map((v) => Math.round(v * devicePixelRatio));
  const image = new ImageData(w, h);
  paint(new Uint32Array(image.data.buffer), w, h);
  const canvas = element("canvas", {width: w, height: h});
  canvas.getContext("2d").putImageData(image, 0, 0);
  c.imageSmoothingEnabled = false;
  c.drawImage(canvas, box.left, box.top, width, height);
}

/**
 * Density of columns [{from, to, values}] of x: the number of values at each device pixel. A column
 * is `least` to 4 px wide, a broader one is drawn in its middle; a value is `thick` px high.
 */
export const density = kind((c, frame, {columns, colour, least = 1, thick = 1.4}) => {
  const [min, max] = frame.y.range;
  const {left, top} = frame.box;
  const ratio = devicePixelRatio; // read once: reading it is slower than counting
  const round = (px) => Math.round(px * ratio);
  const [narrow, broad, high] = [least, 4, thick].map((v) => Math.max(1, round(v)));
  drawPixels(c, frame, (pixels, width, height) => {
    let most = 8;
    for (const {from, to, values} of columns) {
      const [begin, end] = [from, to].map((x) => round(frame.px(x) - left));
      const across = clamp(end - begin, narrow, broad);
      const start = Math.round((begin + end - across) / 2);
      const [first, last] = [Math.max(start, 0), Math.min(start + across, width)];
      for (const v of values) {
        if (!(v >= min && v <= max)) continue;
        const row = Math.min(round(frame.py(v) - top), height - 1) - (high >> 1);
        for (let j = Math.max(row, 0); j < Math.min(row + high, height); ++j)
          for (let i = first; i < last; ++i) most = Math.max(most, ++pixels[j * width + i]);
      }
    }
    const own = rgb(colour);
    const scale = 0.58 / Math.log(most);
    const shades = []; // by number
    for (let i = 0; i < pixels.length; ++i) {
      const n = pixels[i];
      if (n) pixels[i] = shades[n] ??= pixel(own, 255 * (0.42 + scale * Math.log(n)));
    }
  });
});

/** Pixels set by paint(pixels, width, height). */
export const raster = kind((c, frame, {paint}) => drawPixels(c, frame, paint));

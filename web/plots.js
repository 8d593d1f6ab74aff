// Line plots over tau (uPlot) and scatter plots (a canvas). Colours come from the style sheet, so
// that they follow the colour scheme. A plot that has no width, as in a closed part of the page in
// some browsers, is drawn when it gets one.
import uPlot from "./uPlot.esm.js";

export const colour = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
function plain(value) {
  const far = Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3);
  if (far) return value.toExponential(2).replace(/\.?0+e\+?/, "e");
  return Number(value.toPrecision(5)).toString();
}
export const short = (value) => (value == null ? "–" : plain(value).replace("-", "−"));

const patience = 250; // ms in which a second click makes a double-click

// Plots over the same time zoom and point together.
const together = {};
let zooming = false;
function zoomAll(source, group) {
  if (zooming) return;
  zooming = true;
  const {min, max} = source.scales.x;
  for (const plot of together[group])
    if (plot !== source && plot.root.isConnected) plot.setScale("x", {min, max});
  zooming = false;
}

/** Adds a symbol to a path: a cross, or else a ring. */
function symbol(c, shape, x, y, r) {
  if (shape === "cross") {
    c.moveTo(x - r, y - r);
    c.lineTo(x + r, y + r);
    c.moveTo(x - r, y + r);
    c.lineTo(x + r, y - r);
  } else {
    c.moveTo(x + r, y);
    c.arc(x, y, r, 0, 2 * Math.PI);
  }
}

/**
 * The labels of a logarithmic axis: powers of ten (not all, if there are many), and 2 and 5 between
 * them if there are few.
 */
export function logTicks(min, max) {
  const from = Math.floor(Math.log10(min));
  const to = Math.ceil(Math.log10(max));
  const step = Math.ceil((to - from) / 8);
  const factors = to - from < 4 ? [1, 2, 5] : [1];
  const list = [];
  for (let k = from; k <= to; k += step) for (const m of factors) list.push(m * 10 ** k);
  return list.filter((v) => v >= min && v <= max);
}

export const axisStyle = () => ({
  stroke: colour("soft"),
  grid: {stroke: colour("grid"), width: 1},
  ticks: {stroke: colour("line"), width: 1, size: 5},
  font: "12px system-ui",
  labelFont: "12px system-ui",
  labelGap: 0,
});

function lineAxes(x, y, log) {
  const axis = {...axisStyle(), values: (_, list) => list.map(short)};
  const logAxis = {
    splits: (u) => logTicks(u.scales.y.min, u.scales.y.max),
    filter: (_, list) => list,
  };
  return [
    {...axis, size: 24, gap: 2, label: x, labelSize: 16},
    {...axis, size: 52, gap: 3, label: y, labelSize: 18, ...(log ? logAxis : {})},
  ];
}

const legendValue = (_, v) => short(v);

/** A series as uPlot has it. One of dots alone has no path. */
const lineStyle = ({label, colour: name, width, dash, dots, paths}) => ({
  label,
  stroke: colour(name),
  width: width ?? 1,
  dash,
  points: {show: false},
  value: legendValue,
  spanGaps: false,
  ...(paths || (dots && !width) ? {paths: paths ?? (() => null)} : {}),
});

export class LinePlot {
  /** synced: the name of the plots that zoom together. */
  constructor(container, {synced} = {}) {
    if (synced) together[synced] ??= new Set();
    this.container = container;
    this.synced = synced;
    this.plot = null;
    new ResizeObserver(() => this.resize()).observe(container);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.container;
    if (!width) return;
    if (this.plot) this.plot.setSize({width, height: height - this.legendHeight()});
    else this.redraw();
  }

  legendHeight() {
    return this.plot?.root.querySelector(".u-legend")?.offsetHeight ?? 0;
  }

  /**
   * series: [{label, colour, dash, width, dots, paths}], dots: their size, and no line unless there
   * is a width; paths: as uPlot has it; range: of y; log: of y; levels: of y, each in the colour
   * levelColour or as {y, colour}; lines: moments of tau; bands: intervals of tau, calm: those of
   * the other shade; marks: [{x, y, colour, shape, size, width}] over the lines; layers: [{from,
   * to, colour}], of y, below them; x: the name of the axis, instead of tau; click(x, reach):
   * called where one clicks, reach: a few pixels in units of x.
   */
  draw(options) {
    this.last = options;
    if (this.plot) {
      together[this.synced]?.delete(this.plot);
      this.plot.destroy();
      this.plot = null;
    }
    if (this.container.clientWidth) this.create(options);
  }

  create({series, data, range, label, log = false, x = "τ", click}) {
    const options = {
      padding: [8, 12, 0, 0],
      width: this.container.clientWidth,
      height: Math.max(this.container.clientHeight - 28, 80),
      scales: {
        x: {time: false},
        y: {...(range ? {range: () => range} : {}), ...(log ? {distr: 3} : {})},
      },
      axes: lineAxes(x, label, log),
      series: [{label: x, value: legendValue}, ...series.map(lineStyle)],
      cursor: {
        sync: this.synced ? {key: this.synced} : undefined,
        drag: {x: true, y: false},
        points: {size: 5},
      },
      legend: {live: true},
      hooks: {
        drawClear: [(u) => this.drawBelow(u)],
        draw: [(u) => this.drawAbove(u)],
        setScale: [(u, key) => this.zoomed(u, key)],
      },
    };
    this.plot = new uPlot(options, data, this.container);
    requestAnimationFrame(() => this.resize()); // when the legend has its final height
    if (this.synced) together[this.synced].add(this.plot);
    if (click) this.listen(this.plot, click);
  }

  zoomed(u, key) {
    if (this.synced && key === "x") zoomAll(u, this.synced);
  }

  drawBelow(u) {
    const {layers = [], calm = [], bands = []} = this.last;
    for (const layer of layers) this.layer(u, layer);
    this.shade(u, calm, "calm");
    this.shade(u, bands, "shade");
  }

  drawAbove(u) {
    const {series, marks = []} = this.last;
    this.rule(u, this.last);
    series.forEach((s, i) => {
      if (s.dots) this.dot(u, s, i + 1);
    });
    for (const group of marks) this.symbols(u, group);
  }

  /** The end of a drag is no click, nor is half of a double-click. */
  listen(u, click) {
    let from = null;
    let waiting = 0;
    u.over.addEventListener("mousedown", (event) => {
      from = event.clientX;
    });
    u.over.addEventListener("click", (event) => {
      clearTimeout(waiting);
      if (event.detail > 1 || (from !== null && Math.abs(event.clientX - from) > 3)) return;
      const at = event.clientX - u.over.getBoundingClientRect().left;
      const t = u.posToVal(at, "x");
      waiting = setTimeout(() => click(t, u.posToVal(at + 6, "x") - t), patience);
    });
  }

  /** Other marks and bands, and the zoom stays. */
  mark(marks, bands = []) {
    if (!this.last) return;
    Object.assign(this.last, {marks, bands});
    this.plot?.redraw(false);
  }

  /** One path, filled once: bands that share a pixel do not darken it. */
  shade(u, bands, name) {
    u.ctx.save();
    u.ctx.fillStyle = colour(name);
    u.ctx.beginPath();
    for (const [from, to] of bands) {
      const left = Math.max(u.valToPos(from, "x", true), u.bbox.left);
      const right = Math.min(u.valToPos(to, "x", true), u.bbox.left + u.bbox.width);
      if (right > u.bbox.left && left < u.bbox.left + u.bbox.width)
        u.ctx.rect(left, u.bbox.top, Math.max(right - left, 1), u.bbox.height);
    }
    u.ctx.fill();
    u.ctx.restore();
  }

  layer(u, {from, to, colour: name}) {
    this.clip(u);
    u.ctx.fillStyle = colour(name);
    const top = u.valToPos(to, "y", true);
    u.ctx.fillRect(u.bbox.left, top, u.bbox.width, u.valToPos(from, "y", true) - top);
    u.ctx.restore();
  }

  clip(u) {
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    u.ctx.clip();
  }

  rule(u, {levels = [], levelColour = "soft", lines = []}) {
    this.clip(u);
    u.ctx.lineWidth = devicePixelRatio;
    u.ctx.setLineDash([]);
    for (const level of levels) {
      const {y, colour: name} = typeof level === "number" ? {y: level, colour: levelColour} : level;
      const at = u.valToPos(y, "y", true);
      u.ctx.strokeStyle = colour(name);
      u.ctx.beginPath();
      u.ctx.moveTo(u.bbox.left, at);
      u.ctx.lineTo(u.bbox.left + u.bbox.width, at);
      u.ctx.stroke();
    }
    u.ctx.strokeStyle = colour("wall");
    u.ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const x of lines) {
      const at = u.valToPos(x, "x", true);
      u.ctx.beginPath();
      u.ctx.moveTo(at, u.bbox.top);
      u.ctx.lineTo(at, u.bbox.top + u.bbox.height);
      u.ctx.stroke();
    }
    u.ctx.restore();
  }

  /**
   * The values as dots, smaller where there are many; those that would fall on the last one drawn
   * are left out.
   */
  dot(u, {colour: name, dots}, index) {
    if (!u.series[index].show) return;
    const tau = u.data[0];
    const values = u.data[index];
    const [from, to] = u.series[0].idxs ?? [0, tau.length - 1];
    const room = Math.sqrt((2 * this.container.clientWidth) / (to - from + 1));
    const size = Math.max(dots * Math.min(1, room), 1.5) * devicePixelRatio;
    this.clip(u);
    u.ctx.fillStyle = colour(name);
    let lastX = NaN;
    let lastY = NaN;
    for (let i = from; i <= to; ++i) {
      if (values[i] == null) continue;
      const x = Math.round(u.valToPos(tau[i], "x", true) - size / 2);
      const y = Math.round(u.valToPos(values[i], "y", true) - size / 2);
      if (x === lastX && y === lastY) continue;
      u.ctx.fillRect(x, y, size, size);
      [lastX, lastY] = [x, y];
    }
    u.ctx.restore();
  }

  /** A mark beyond the range of y lies on its edge. */
  symbols(u, {x, y, colour: name, shape, size = 4, width = 1.3}) {
    const {min, max} = u.scales.x;
    const {left, top, width: w, height: h} = u.bbox;
    const ratio = devicePixelRatio;
    const c = u.ctx;
    const shown = x.reduce((n, v) => n + (v >= min && v <= max), 0);
    const room = Math.sqrt(w / ratio / (4 * shown));
    const r = size * ratio * Math.min(Math.max(room, 0.5), 1); // smaller where there are many
    const flat = shape === "dot" || shown > 2000; // crosses that hide each other take long to draw
    c.save();
    c.beginPath();
    c.rect(left - r, top - r, w + 2 * r, h + 2 * r);
    c.clip();
    c.strokeStyle = c.fillStyle = colour(name);
    c.lineWidth = width * ratio;
    c.setLineDash([]);
    c.beginPath();
    for (let i = 0; i < x.length; ++i) {
      if (!(x[i] >= min && x[i] <= max) || y[i] == null) continue;
      const px = u.valToPos(x[i], "x", true);
      const py = Math.min(Math.max(u.valToPos(y[i], "y", true), top), top + h);
      if (flat) c.rect(px - r, py - r, 2 * r, 2 * r);
      else symbol(c, shape, px, py, r);
    }
    if (flat) c.fill();
    else c.stroke();
    c.restore();
  }

  redraw() {
    if (this.last) this.draw(this.last);
  }
}

/** Round steps for an axis: 1, 2 or 5 times a power of ten, about `count` of them. */
export function ticks(min, max, count) {
  const raw = (max - min) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= raw);
  const list = [];
  for (let k = Math.ceil(min / step); k * step <= max; ++k) list.push(k * step);
  return list;
}

/** The range of the groups' values and a margin. */
function extentOf(groups, key) {
  let min = Infinity;
  let max = -Infinity;
  for (const group of groups)
    for (const v of group[key]) {
      if (v < min) min = v;
      if (v > max) max = v;
    }
  if (!(min <= max)) return null;
  const margin = (max - min) * 0.06 || Math.abs(max) * 0.06 || 1;
  return [min - margin, max + margin];
}

export class ScatterPlot {
  constructor(canvas) {
    this.canvas = canvas;
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  /**
   * groups: [{x, y, colour, size, alpha, shape}], shape: ring, cross or else a dot; curves: [{x, y,
   * colour, dash}]; levels: [{y, colour, label}]; extent: {x, y}, else that of the groups; equal:
   * the same scale on both axes; xLabel, yLabel; empty: what to say if there are no points.
   */
  draw(options) {
    this.last = options;
    const {groups, curves = [], levels = [], equal = false, empty = "no impacts"} = options;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width) return;
    const c = this.blank(width, height);
    const box = {left: 58, top: 8, right: width - 10, bottom: height - 38};
    let ex = options.extent?.x ?? extentOf(groups, "x");
    let ey = options.extent?.y ?? extentOf(groups, "y");
    if (!ex || !ey) {
      c.textAlign = "center";
      c.fillText(empty, width / 2, height / 2);
      return;
    }
    if (equal) [ex, ey] = sameScale(ex, ey, box);
    const px = (v) => box.left + ((v - ex[0]) / (ex[1] - ex[0])) * (box.right - box.left);
    const py = (v) => box.bottom - ((v - ey[0]) / (ey[1] - ey[0])) * (box.bottom - box.top);
    this.axes(c, box, [ex, px, options.xLabel], [ey, py, options.yLabel]);
    c.save();
    c.beginPath();
    c.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    c.clip();
    for (const group of groups) this.dots(c, group, px, py);
    for (const curve of curves) this.curve(c, curve, px, py);
    for (const level of levels) this.level(c, level, box, py);
    c.restore();
  }

  /** The canvas, emptied, in CSS pixels. */
  blank(width, height) {
    const ratio = devicePixelRatio;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const c = this.canvas.getContext("2d");
    c.scale(ratio, ratio);
    c.font = "12px system-ui";
    c.fillStyle = colour("soft");
    return c;
  }

  /** Each axis as [extent, pixel of a value, label]. */
  axes(c, box, [ex, px, xLabel], [ey, py, yLabel]) {
    const line = (x0, y0, x1, y1) => {
      c.beginPath();
      c.moveTo(x0, y0);
      c.lineTo(x1, y1);
      c.stroke();
    };
    c.strokeStyle = colour("grid");
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const t of ticks(...ex, Math.min(6, (box.right - box.left) / 55))) {
      line(px(t), box.top, px(t), box.bottom);
      c.fillText(short(t), px(t), box.bottom + 4);
    }
    c.fillText(xLabel, (box.left + box.right) / 2, box.bottom + 21);
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const t of ticks(...ey, 6)) {
      line(box.left, py(t), box.right, py(t));
      c.fillText(short(t), box.left - 5, py(t));
    }
    c.save();
    c.translate(9, (box.top + box.bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.textAlign = "center";
    c.fillText(yLabel, 0, 0);
    c.restore();
  }

  dots(c, {x, y, colour: name, size: asked = 2.4, alpha = 0.75, shape}, px, py) {
    const size = x.length > 20000 ? 1 : asked;
    c.globalAlpha = alpha;
    c.fillStyle = c.strokeStyle = colour(name);
    if (shape) {
      c.lineWidth = 1.2;
      c.beginPath();
      for (let i = 0; i < x.length; ++i) symbol(c, shape, px(x[i]), py(y[i]), size);
      c.stroke();
    } else {
      for (let i = 0; i < x.length; ++i)
        c.fillRect(px(x[i]) - size / 2, py(y[i]) - size / 2, size, size);
    }
    c.globalAlpha = 1;
  }

  curve(c, {x, y, colour: name, dash = []}, px, py) {
    c.strokeStyle = colour(name);
    c.lineWidth = 1.6;
    c.setLineDash(dash);
    c.beginPath();
    for (let i = 0; i < x.length; ++i) c.lineTo(px(x[i]), py(y[i]));
    c.stroke();
  }

  level(c, {y, colour: name, label = ""}, box, py) {
    c.strokeStyle = c.fillStyle = colour(name);
    c.lineWidth = 1;
    c.setLineDash([]);
    c.beginPath();
    c.moveTo(box.left, py(y));
    c.lineTo(box.right, py(y));
    c.stroke();
    c.textAlign = "right";
    c.textBaseline = "bottom";
    c.fillText(label, box.right - 4, py(y) - 2);
  }

  redraw() {
    if (this.last) this.draw(this.last);
  }
}

/** The ranges widened so that a unit is as long on both axes. */
function sameScale(ex, ey, box) {
  const unit = Math.min(
    (box.right - box.left) / (ex[1] - ex[0]),
    (box.bottom - box.top) / (ey[1] - ey[0]),
  );
  const around = ([min, max], pixels) => [
    (min + max) / 2 - pixels / unit / 2,
    (min + max) / 2 + pixels / unit / 2,
  ];
  return [around(ex, box.right - box.left), around(ey, box.bottom - box.top)];
}

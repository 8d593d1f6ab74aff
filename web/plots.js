// Line plots over tau (uPlot) and scatter plots at impacts (a canvas). Colours come from the style sheet, so that they
// follow the colour scheme.
import uPlot from "./uPlot.esm.js";

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const short = (value) => value == null ? "–" : Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : Number(value.toPrecision(5)).toString();

// Plots over tau zoom and point together.
const together = new Set();
let zooming = false;
function zoomAll(source) {
  if (zooming) return;
  zooming = true;
  const {min, max} = source.scales.x;
  for (const plot of together) if (plot !== source && plot.root.isConnected) plot.setScale("x", {min, max});
  zooming = false;
}

export class LinePlot {
  constructor(container, {synced = false} = {}) {
    this.container = container;
    this.synced = synced;
    this.plot = null;
    new ResizeObserver(() => this.resize()).observe(container);
  }

  resize() {
    if (!this.plot) return;
    const {clientWidth: width, clientHeight: height} = this.container;
    if (width > 0) this.plot.setSize({width, height: height - this.legendHeight()});
  }

  legendHeight() {
    return this.plot?.root.querySelector(".u-legend")?.offsetHeight ?? 0;
  }

  /** series: [{label, colour, dash, width}]; range: of y; walls: levels of y; lines: moments of tau; bands: intervals of tau; zero: a line at y = 0. */
  draw({series, data, range, walls = [], lines = [], bands = [], zero = false}) {
    this.last = {series, data, range, walls, lines, bands, zero};
    if (this.plot) {
      together.delete(this.plot);
      this.plot.destroy();
    }
    const axis = {stroke: colour("soft"), grid: {stroke: colour("grid"), width: 1}, ticks: {stroke: colour("line"), width: 1}, font: "12px system-ui"};
    const options = {
      width: Math.max(this.container.clientWidth, 50), height: Math.max(this.container.clientHeight - 28, 80),
      scales: {x: {time: false}, y: range ? {range: () => range} : {}},
      axes: [{...axis, size: 34}, {...axis, size: 56, values: (_, ticks) => ticks.map(short)}],
      series: [{label: "τ", value: (_, v) => short(v)},
        ...series.map((s) => ({label: s.label, stroke: colour(s.colour), width: s.width ?? 1, dash: s.dash, points: {show: false}, value: (_, v) => short(v), spanGaps: false}))],
      cursor: {sync: this.synced ? {key: "tau"} : undefined, drag: {x: true, y: false}, points: {size: 5}},
      legend: {live: true},
      hooks: {
        drawClear: [(u) => this.shade(u, bands)],
        draw: [(u) => this.rule(u, walls, lines, zero)],
        setScale: [(u, key) => { if (this.synced && key === "x") zoomAll(u); }],
      },
    };
    this.plot = new uPlot(options, data, this.container);
    requestAnimationFrame(() => this.resize());  // when the legend has its final height
    if (this.synced) together.add(this.plot);
  }

  shade(u, bands) {
    u.ctx.save();
    u.ctx.fillStyle = colour("shade");
    for (const [from, to] of bands) {
      const left = Math.max(u.valToPos(from, "x", true), u.bbox.left), right = Math.min(u.valToPos(to, "x", true), u.bbox.left + u.bbox.width);
      if (right > u.bbox.left && left < u.bbox.left + u.bbox.width) u.ctx.fillRect(left, u.bbox.top, Math.max(right - left, 1), u.bbox.height);
    }
    u.ctx.restore();
  }

  rule(u, walls, lines, zero) {
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    u.ctx.clip();
    u.ctx.lineWidth = devicePixelRatio;
    u.ctx.setLineDash([]);
    u.ctx.strokeStyle = colour(zero ? "soft" : "wall");
    for (const y of zero ? [0] : walls) {
      const at = u.valToPos(y, "y", true);
      u.ctx.beginPath(); u.ctx.moveTo(u.bbox.left, at); u.ctx.lineTo(u.bbox.left + u.bbox.width, at); u.ctx.stroke();
    }
    u.ctx.strokeStyle = colour("wall");
    u.ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const x of lines) {
      const at = u.valToPos(x, "x", true);
      u.ctx.beginPath(); u.ctx.moveTo(at, u.bbox.top); u.ctx.lineTo(at, u.bbox.top + u.bbox.height); u.ctx.stroke();
    }
    u.ctx.restore();
  }

  redraw() { if (this.last) this.draw(this.last); }
}

/** Round steps for an axis: 1, 2 or 5 times a power of ten, about `count` of them. */
function ticks(min, max, count) {
  const raw = (max - min) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= raw);
  const list = [];
  for (let k = Math.ceil(min / step); k * step <= max; ++k) list.push(k * step);
  return list;
}

export class ScatterPlot {
  constructor(canvas) {
    this.canvas = canvas;
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  /** groups: [{x, y, colour}] */
  draw(groups, xLabel, yLabel) {
    this.last = [groups, xLabel, yLabel];
    const {canvas} = this, ratio = devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width) return;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const c = canvas.getContext("2d");
    c.scale(ratio, ratio);
    c.font = "12px system-ui";
    c.fillStyle = colour("soft");
    const box = {left: 56, top: 8, right: width - 10, bottom: height - 36};
    const extent = (key) => {
      let min = Infinity, max = -Infinity;
      for (const group of groups) for (const v of group[key]) { if (v < min) min = v; if (v > max) max = v; }
      if (!(min <= max)) return null;
      const margin = (max - min) * 0.06 || Math.abs(max) * 0.06 || 1;
      return [min - margin, max + margin];
    };
    const ex = extent("x"), ey = extent("y");
    if (!ex) {
      c.textAlign = "center";
      c.fillText("no impacts", width / 2, height / 2);
      return;
    }
    const px = (v) => box.left + (v - ex[0]) / (ex[1] - ex[0]) * (box.right - box.left);
    const py = (v) => box.bottom - (v - ey[0]) / (ey[1] - ey[0]) * (box.bottom - box.top);
    c.strokeStyle = colour("grid");
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const t of ticks(...ex, 6)) { c.beginPath(); c.moveTo(px(t), box.top); c.lineTo(px(t), box.bottom); c.stroke(); c.fillText(short(t), px(t), box.bottom + 4); }
    c.fillText(xLabel, (box.left + box.right) / 2, box.bottom + 19);
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const t of ticks(...ey, 6)) { c.beginPath(); c.moveTo(box.left, py(t)); c.lineTo(box.right, py(t)); c.stroke(); c.fillText(short(t), box.left - 5, py(t)); }
    c.save();
    c.translate(10, (box.top + box.bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.textAlign = "center";
    c.fillText(yLabel, 0, 0);
    c.restore();
    c.globalAlpha = 0.75;
    for (const group of groups) {
      const size = group.x.length > 20000 ? 1 : 2.4;
      c.fillStyle = colour(group.colour);
      for (let i = 0; i < group.x.length; ++i) c.fillRect(px(group.x[i]) - size / 2, py(group.y[i]) - size / 2, size, size);
    }
    c.globalAlpha = 1;
  }

  redraw() { if (this.last) this.draw(...this.last); }
}

// Lines over an axis. What is drawn is what is in view. Plots over the same time share a TimeAxis:
// they zoom together and show one cursor. One that has no width, as in a closed part of the page,
// is drawn when it gets one.
import {colour} from "./colours.js";
import {element} from "./dom.js";
import {blank, Frame, rangeOf, Size} from "./frame.js";
import {listen} from "./gestures.js";
import {short} from "./numbers.js";
import {firstFrom, line, shade, symbols} from "./shapes.js";
import {TimeAxis} from "./time_axis.js";

const naming = (x = "τ") => (typeof x === "string" ? {label: x, factor: 1} : x);

export class LinePlot {
  /** axis: that of the plots it shares time with. */
  constructor(container, {axis = new TimeAxis()} = {}) {
    this.container = container;
    this.axis = axis;
    this.frame = null;
    this.legend = element("div", {className: "legend"});
    this.canvas = element("canvas");
    this.over = element("div", {className: "over"});
    this.cursor = element("div", {className: "cursor", hidden: true});
    this.ring = element("div", {className: "lit", hidden: true});
    this.over.append(this.cursor, this.ring);
    container.append(this.legend, this.canvas, this.over);
    axis.onView(() => this.soon());
    axis.onCursor(() => this.point());
    listen(this.over, axis, (t, reach) => this.last?.click?.(t, reach));
    this.size = new Size(container, () => {
      this.legendHeight = this.legend.offsetHeight;
      this.refresh();
    });
    this.legendHeight = 0;
  }

  /**
   * series: [{label, colour, dash, width, dots, text}], dots: their size, and no line unless there
   * is a width; text(value): its legend in words; data: columns, or trace(from, to, columns): {data,
   * dense} of what is in view, dense: the extremes of each pixel, and samples(from, to): the same as
   * numbers to take away; unit: of them; span: [from, to] of the whole axis, if this plot is to say so; range: of y;
   * log: of y; levels: of y, each in the colour levelColour or as {y, colour}; lines: moments;
   * bands: intervals, calm: those of the other shade; marks: [{x, y, colour, shape, size, width}]
   * over the lines, x ascending; layers: [{from, to, colour}], of y, below them; x: {label,
   * factor}, the name of the axis and what its numbers are multiplied by, or the name; label: that
   * of y; bare: no labels of x; click(x, reach): called where one clicks, reach: a few pixels in
   * units of x.
   */
  draw(options) {
    this.last = {...options, x: naming(options.x)};
    if (options.span) this.axis.span(...options.span);
    this.writeLegend();
    this.refresh();
  }

  /** Before the next frame, however often one asks. */
  soon() {
    this.waiting ||= requestAnimationFrame(() => {
      this.waiting = 0;
      this.refresh();
    });
  }

  /** Draws what is in view. */
  refresh() {
    const {width} = this.size;
    if (!width || !this.last) return;
    const height = Math.max(this.size.height - this.legendHeight, 50);
    const {data, dense} = this.dataFor(width);
    this.frame = this.frameOf(width, height, data);
    this.place(width, height);
    this.paint(blank(this.canvas, {width, height}), this.frame, data, dense);
    this.point();
    this.light(...(this.lit ?? []));
  }

  /** The canvas, and what lies over the lines and takes the pointer. */
  place(width, height) {
    const {box} = this.frame;
    const placed = [width, height, box.bottom, this.legendHeight].join();
    if (this.placed === placed) return;
    this.placed = placed;
    this.canvas.style.height = `${height}px`;
    Object.assign(this.over.style, {
      left: `${box.left}px`,
      top: `${box.top + this.legendHeight}px`,
      width: `${this.frame.width}px`,
      height: `${this.frame.height}px`,
    });
  }

  dataFor(width) {
    const {data, trace} = this.last;
    return data ? {data} : trace(...this.axis.view, Math.max(width - 60, 10));
  }

  frameOf(width, height, data, bare = this.last.bare) {
    const {x, label, log, range} = this.last;
    const y = range ?? rangeOf(data.slice(1), {log}) ?? [0, 1];
    return new Frame(width, height, {...x, range: this.axis.view, bare}, {range: y, log, label});
  }

  /** c: a canvas' context, or what draws in its place. */
  paint(c, frame, [x, ...columns], dense = false) {
    const {series, layers = [], calm = [], bands = [], marks = []} = this.last;
    frame.draw(c);
    frame.clip(c);
    for (const {from, to, colour: name} of layers) {
      c.fillStyle = colour(name);
      c.fillRect(frame.box.left, frame.py(to), frame.width, frame.py(from) - frame.py(to));
    }
    shade(c, frame, calm, "calm");
    shade(c, frame, bands, "shade");
    this.rule(c, frame);
    series.forEach((s, k) => {
      if (!s.dots || s.width) line(c, frame, x, columns[k], s, dense);
    });
    c.restore();
    series.forEach(({dots, colour: name}, k) => {
      const group = {x, y: columns[k], colour: name, shape: "dot", size: dots / 2};
      if (dots) symbols(c, frame, group, true);
    });
    for (const group of marks) symbols(c, frame, group);
  }

  /** All of it, with labels and the names of the lines, for a picture of its own. */
  paintAll(c, width, height) {
    const {data, dense} = this.dataFor(width);
    const frame = this.frameOf(width, height, data, false);
    this.paint(c, frame, data, dense);
    const {series} = this.last;
    if (series.length < 2) return;
    c.textAlign = "left";
    c.textBaseline = "top";
    series.forEach(({label, colour: name}, k) => {
      c.fillStyle = colour(name);
      c.fillText(label, frame.box.left + 8 + 90 * k, frame.box.top + 4);
    });
  }

  /** {names, columns}: the numbers of what is in view. */
  numbers() {
    const {series, x, data, samples, unit = ""} = this.last;
    const [from, to] = this.axis.view;
    const [time, ...columns] = data ?? samples(from, to);
    const [first, end] = [firstFrom(time, from), firstFrom(time, to)];
    const last = time[end] === to ? end + 1 : end;
    const part = (column) => Array.from(column.slice(first, last));
    return {
      names: [x.label, ...series.map(({label}) => `${label}${unit && ` (${unit})`}`)],
      columns: [part(time).map((t) => t * x.factor), ...columns.map(part)],
    };
  }

  rule(c, frame) {
    const {levels = [], levelColour = "soft", lines = []} = this.last;
    c.lineWidth = 1;
    c.setLineDash([]);
    for (const level of levels) {
      const {y, colour: name} = typeof level === "number" ? {y: level, colour: levelColour} : level;
      c.strokeStyle = colour(name);
      frame.across(c, y);
    }
    c.strokeStyle = colour("wall");
    c.setLineDash([6, 4]);
    for (const x of lines) frame.upright(c, x);
    c.setLineDash([]);
  }

  /** Other marks and bands, and the zoom stays. */
  mark(marks, bands = []) {
    if (!this.last) return;
    Object.assign(this.last, {marks, bands});
    this.refresh();
  }

  /** The cursor, and the values there. */
  point() {
    const {cursor, view} = this.axis;
    const inView = this.frame && cursor !== null && cursor >= view[0] && cursor <= view[1];
    this.cursor.hidden = !inView;
    if (inView) {
      const left = Math.round(this.frame.px(cursor) - this.frame.box.left);
      this.cursor.style.transform = `translateX(${left}px)`;
      this.cursor.dataset.at = short(cursor * this.last.x.factor);
    }
    if (this.last) this.tell(cursor);
  }

  /** Rings a point; none without one, or out of view. */
  light(x, y) {
    this.lit = [x, y];
    const {frame} = this;
    const [from, to] = this.axis.view;
    const [min, max] = frame?.y.range ?? [];
    const inside = x >= from && x <= to && y >= min && y <= max;
    this.ring.hidden = !inside;
    if (!inside) return;
    const {left, top} = frame.box;
    this.ring.style.transform = `translate(${frame.px(x) - left}px, ${frame.py(y) - top}px)`;
  }

  /** The names of the lines; none for a single one. */
  writeLegend() {
    const {series} = this.last;
    const written = JSON.stringify(series);
    if (this.written === written) return;
    this.written = written;
    this.values = series.map(() => element("b"));
    const keys = series.map(({label, colour: name, dash}, i) => {
      const key = element("span", {className: `key line${dash ? " dashed" : ""}`}, label, " ");
      key.style.setProperty("--key", `var(--${name})`);
      key.append(this.values[i]);
      return key;
    });
    const several = series.length > 1;
    this.legend.replaceChildren(...(several ? keys : []));
    this.legend.hidden = !several;
    this.legendHeight = this.legend.offsetHeight;
  }

  /** The values at a moment, of columns that are there. */
  tell(t) {
    const {series, data} = this.last;
    if (series.length < 2 || !data) return;
    const at = t === null || !data[0].length ? -1 : firstFrom(data[0], t);
    const i = Math.min(at, data[0].length - 1);
    series.forEach((s, k) => {
      const value = i < 0 ? null : data[k + 1][i];
      const shown = value == null ? (s.text?.(null) ?? "") : (s.text ?? short)(value);
      if (this.values[k].textContent !== shown) this.values[k].textContent = shown;
    });
  }

  redraw() {
    this.refresh();
  }
}

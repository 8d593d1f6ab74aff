// Lines over an axis. What is drawn is what is in view.
import {colour} from "./colours.js";
import {element} from "./dom.js";
import {Frame, rangeOf} from "./frame.js";
import {short} from "./numbers.js";
import {Panel} from "./panel.js";
import {firstFrom} from "./search.js";
import {line, shade, symbols} from "./shapes.js";

const columnsOf = (width) => Math.max(width - 60, 10);

const naming = (x = "τ") => (typeof x === "string" ? {label: x, factor: 1} : x);

export class LinePlot extends Panel {
  /** axis: that of the plots it shares time with. */
  constructor(container, axis) {
    super(container, axis);
    this.legend = element("div", {className: "legend"});
    container.prepend(this.legend);
  }

  /**
   * series: [{label, colour, dash, width, dots, text}], dots: their size, and no line unless there
   * is a width; text(value): its legend in words; data: columns, or trace(from, to, columns): {data,
   * dense} of what is in view, dense: the extremes of each pixel, and samples(from, to): the same as
   * numbers to take away; unit: of them; span: [from, to] of the whole axis, if this plot is to say
   * so; range: of y; log: of y; levels: of y, each in the colour levelColour or as {y, colour};
   * lines: moments; bands: intervals, calm: those of the other shade; marks: [{x, y, colour, shape,
   * size, width}] over the lines, x ascending; layers: [{from, to, colour}], of y, below them; x:
   * {label, factor}, the name of the axis and what its numbers are multiplied by, or the name;
   * label: that of y; bare: no labels of x; click(x, reach): called where one clicks, reach: a few
   * pixels in units of x.
   */
  draw(options) {
    this.last = {...options, x: naming(options.x)};
    if (options.span) this.axis.span(...options.span);
    this.writeLegend();
    this.refresh();
  }

  resized() {
    this.head = this.legend.offsetHeight;
    this.refresh();
  }

  click(...where) {
    this.last?.click?.(...where);
  }

  /** What is in view; alone: with the labels of x, whatever is below it. */
  prepare(width, height, alone = false) {
    if (!this.last) return null;
    const {x, label, log, range, bare} = this.last;
    const {data, dense = false} = this.dataFor(width);
    const y = range ?? rangeOf(data.slice(1), {log}) ?? [0, 1];
    const ofX = {...x, range: this.axis.view, bare: bare && !alone};
    return {data, dense, frame: new Frame(width, height, ofX, {range: y, log, label})};
  }

  /** Of a line whose extremes are drawn, pixel by pixel. */
  get columns() {
    return columnsOf(this.size.width);
  }

  dataFor(width) {
    const {data, trace} = this.last;
    return data ? {data} : trace(...this.axis.view, columnsOf(width));
  }

  /** c: a canvas' context, or what draws in its place. */
  paint(c, {frame, data: [x, ...columns], dense}) {
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

  /** With the names of the lines. */
  paintAll(c, width, height) {
    const {frame} = super.paintAll(c, width, height);
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
    super.point();
    if (this.last) this.tell(this.axis.cursor);
  }

  cursorText(cursor) {
    return short(cursor * this.last.x.factor);
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
    this.head = this.legend.offsetHeight;
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
}

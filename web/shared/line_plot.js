// Lines over an axis. What is drawn is what is in view.
import {element} from "./dom.js";
import {Frame, rangeOf} from "./frame.js";
import {ink, write} from "./ink.js";
import {short} from "./numbers.js";
import {Panel} from "./panel.js";
import {firstFrom, lastUpTo} from "./search.js";
import {line, shade, symbols} from "./shapes.js";

const columnsOf = (width) => Math.max(width - 60, 10);

const shortOrNone = (value) => (value === null ? "" : short(value));

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
   * is a width; text(value, whether its line has ended): its legend in words; data: columns, or trace(from, to, columns): {data,
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

  /**
   * What is in view; alone: with the labels of x, whatever is below it, and the names of the lines.
   */
  prepare(width, height, alone = false) {
    if (!this.last) return null;
    const {x, label, log, range, bare, data, trace} = this.last;
    const drawn = data ? {data} : trace(...this.axis.view, columnsOf(width));
    const ofX = {...x, range: this.axis.view, bare: bare && !alone};
    const ofY = {range: range ?? rangeOf(drawn.data.slice(1), log) ?? [0, 1], log, label};
    return {...drawn, alone, frame: new Frame(width, height, ofX, ofY)};
  }

  /** Of a line whose extremes are drawn, pixel by pixel. */
  get columns() {
    return columnsOf(this.size.width);
  }

  paint(c, {frame, data: [x, ...columns], dense, alone}) {
    const {series, layers = [], calm = [], bands = [], marks = [], lines = []} = this.last;
    const {levels = [], levelColour = "soft"} = this.last;
    frame.draw(c);
    frame.clip(c);
    for (const {from, to, colour} of layers) {
      ink(c, colour);
      c.fillRect(frame.box.left, frame.py(to), frame.width, frame.py(from) - frame.py(to));
    }
    shade(c, frame, calm, "calm");
    shade(c, frame, bands, "shade");
    for (const level of levels) {
      ink(c, level.colour ?? levelColour);
      frame.across(c, level.y ?? level);
    }
    ink(c, "wall", 1, [6, 4]);
    for (const moment of lines) frame.upright(c, moment);
    series.forEach((s, k) => {
      if (!s.dots || s.width) line(c, frame, x, columns[k], s, dense);
    });
    c.restore();
    series.forEach(({dots, colour}, k) => {
      const group = {x, y: columns[k], colour, shape: "dot", size: dots / 2};
      if (dots) symbols(c, frame, group, true);
    });
    for (const group of marks) symbols(c, frame, group);
    if (!alone || series.length < 2) return;
    series.forEach(({label, colour}, k) => {
      ink(c, colour);
      write(c, label, frame.box.left + 8 + 90 * k, frame.box.top + 4, "left", "top");
    });
  }

  /** {names, columns}: the numbers of what is in view. */
  numbers() {
    const {series, x, data, samples, unit = ""} = this.last;
    const [from, to] = this.axis.view;
    const [time, ...columns] = data ?? samples(from, to);
    const part = (column) =>
      Array.from(column.slice(firstFrom(time, from), lastUpTo(time, to) + 1));
    return {
      names: [x.label, ...series.map(({label}) => `${label}${unit && ` (${unit})`}`)],
      columns: [part(time).map((t) => t * x.factor), ...columns.map(part)],
    };
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
    const keys = series.map(({label, colour, dash}, i) => {
      const className = `key line${dash ? " dashed" : ""}`;
      const key = element("span", {className}, label, " ", this.values[i]);
      key.style.setProperty("--key", `var(--${colour})`);
      return key;
    });
    this.legend.hidden = keys.length < 2;
    this.legend.replaceChildren(...(this.legend.hidden ? [] : keys));
    this.head = this.legend.offsetHeight;
  }

  /** The values at a moment, of columns that are there. */
  tell(t) {
    const {series, data} = this.last;
    if (!data) return;
    const i = t === null ? -1 : lastUpTo(data[0], t);
    const within = t > data[0][i] ? i + 1 : i; // a line that ends has no value behind its end
    series.forEach(({text = shortOrNone}, k) => {
      const column = data[k + 1];
      const value = column[within] === null ? null : (column[i] ?? null);
      const shown = text(value, column.findLastIndex((v) => v !== null) < within);
      if (this.values[k].textContent !== shown) this.values[k].textContent = shown;
    });
  }
}

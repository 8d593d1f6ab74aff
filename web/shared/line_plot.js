// Line plots over a shared axis. Only the visible part is drawn.
import {element} from "./dom.js";
import {Frame, rangeOf} from "./frame.js";
import {drawText, ink} from "./ink.js";
import {short} from "./numbers.js";
import {firstFrom, lastUpTo} from "./search.js";
import {line, shade, symbols} from "./shapes.js";
import {ZoomablePlot} from "./zoomable_plot.js";

const columnsOf = (width) => Math.max(width - 60, 10);

const shortOrNone = (value) => (value === null ? "" : short(value));

const naming = (x = "τ") => (typeof x === "string" ? {label: x, factor: 1} : x);

export class LinePlot extends ZoomablePlot {
  /** viewport: shared with other plots over the same time. */
  constructor(container, viewport) {
    super(container, viewport);
    this.legend = element("div", {className: "legend"});
    container.prepend(this.legend);
  }

  /**
   * series: [{label, colour, dash, width, dots, text}]; dots: size of dots in place of a line, or
   * in addition to it if `width` is given; text(value, ended): value in the legend. Data: `data`,
   * columns, or trace(from, to, columns), which returns {data, dense} for the visible range (dense:
   * minimum and maximum of each pixel), and samples(from, to), the same as numbers for export.
   * unit: of the values; span: [from, to] of the full axis, if this plot sets it; range, log,
   * label: of y; levels: horizontal lines, numbers in levelColour or {y, colour}; lines: vertical
   * lines; bands, calm: shaded intervals in two shades; marks: [{x, y, colour, shape, size, width}]
   * over the lines, x ascending; layers: [{from, to, colour}], y ranges shaded below the lines; x:
   * name of the axis or {label, factor}; bare: no labels along x; click(x, reach): reach is 6 px in
   * units of x.
   */
  draw(options) {
    this.last = {...options, x: naming(options.x)};
    if (options.span) this.viewport.span(...options.span);
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

  /** alone: for export, with labels along x and the names of the lines. */
  prepare(width, height, alone = false) {
    if (!this.last) return null;
    const {x, label, log, range, bare, data, trace} = this.last;
    const drawn = data ? {data} : trace(...this.viewport.range, columnsOf(width));
    const ofX = {...x, range: this.viewport.range, bare: bare && !alone};
    const ofY = {range: range ?? rangeOf(drawn.data.slice(1), log) ?? [0, 1], log, label};
    return {...drawn, alone, frame: new Frame(width, height, ofX, ofY)};
  }

  /** Number of min-max columns of a dense line. */
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
      drawText(c, label, frame.box.left + 8 + 90 * k, frame.box.top + 4, "left", "top");
    });
  }

  /** {names, columns} of the visible range. */
  numbers() {
    const {series, x, data, samples, unit = ""} = this.last;
    const [from, to] = this.viewport.range;
    const [time, ...columns] = data ?? samples(from, to);
    const part = (column) =>
      Array.from(column.slice(firstFrom(time, from), lastUpTo(time, to) + 1));
    return {
      names: [x.label, ...series.map(({label}) => `${label}${unit && ` (${unit})`}`)],
      columns: [part(time).map((t) => t * x.factor), ...columns.map(part)],
    };
  }

  /** Replaces marks and bands; the zoom is kept. */
  mark(marks, bands = []) {
    if (!this.last) return;
    Object.assign(this.last, {marks, bands});
    this.refresh();
  }

  /** Shows the cursor and the values there. */
  point() {
    super.point();
    if (this.last) this.tell(this.viewport.cursor);
  }

  cursorText(cursor) {
    return short(cursor * this.last.x.factor);
  }

  /** The legend; empty for a single line. */
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

  /** Shows the values at the cursor in the legend; only for plots with fixed columns. */
  tell(t) {
    const {series, data} = this.last;
    if (!data) return;
    const i = t === null ? -1 : lastUpTo(data[0], t);
    const within = t > data[0][i] ? i + 1 : i; // a line has no value after its end
    series.forEach(({text = shortOrNone}, k) => {
      const column = data[k + 1];
      const value = column[within] === null ? null : (column[i] ?? null);
      const shown = text(value, column.findLastIndex((v) => v !== null) < within);
      if (this.values[k].textContent !== shown) this.values[k].textContent = shown;
    });
  }
}

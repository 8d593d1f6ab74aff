// Plots over a shared axis, with a legend that shows the values at the cursor. Only the visible
// part is drawn.
import {element} from "./dom.js";
import {Frame, rangeOf} from "./frame.js";
import {names} from "./marks.js";
import {short} from "./numbers.js";
import {ZoomablePlot} from "./plot.js";
import {firstFrom, lastUpTo} from "./search.js";

const columnsOf = (width) => Math.max(width - 60, 10);

const shortOrNone = (value) => (value === null ? "" : short(value));

/** The marks with a label; they share x. */
const seriesOf = (marks) => marks.filter(({label}) => label);

export class LinePlot extends ZoomablePlot {
  /** viewport: shared with other plots over the same time. */
  constructor(container, viewport) {
    super(container, viewport);
    this.legend = element("div", {className: "legend"});
    container.prepend(this.legend);
  }

  /**
   * x: {label, factor}; y: {range, log, label}, the range by default that of the series; bare: no
   * labels along x; span: [from, to] of the full axis, if this plot sets it; unit: of the series;
   * click(x, reach): reach is 6 px in units of x; points: as in Plot.
   *
   * marks: the labelled ones are series, whose text(value, ended) is their value in the legend; or
   * trace(from, to, columns), which returns the marks of the visible range, and samples(from, to),
   * which returns those for the table. under: further marks, drawn first.
   */
  draw(options) {
    if (options.span) this.viewport.span(...options.span);
    super.draw(options);
  }

  resized() {
    this.head = this.legend.offsetHeight;
    this.refresh();
  }

  click(...where) {
    this.last?.click?.(...where);
  }

  /** Number of min-max columns of a dense line. */
  get columns() {
    return columnsOf(this.size.width);
  }

  refresh() {
    if (this.last) this.writeLegend(seriesOf(this.marks(this.size.width)));
    super.refresh();
  }

  /** The marks of the visible range. */
  marks(width) {
    return this.last.marks ?? this.last.trace(...this.viewport.range, columnsOf(width));
  }

  /** alone: for export, with labels along x and the names of the series. */
  prepare(width, height, alone = false) {
    if (!this.last) return null;
    const {x, y, bare, under = []} = this.last;
    const {range} = this.viewport;
    const marks = this.marks(width);
    const series = seriesOf(marks);
    const columns = series.map((one) => one.y);
    const ofY = {range: rangeOf(columns, y.log) ?? [0, 1], ...y};
    const frame = new Frame(width, height, {...x, range, bare: bare && !alone}, ofY);
    const named = alone && series.length > 1 ? [names({series})] : [];
    return {frame, marks: [...under, ...marks, ...named]};
  }

  /** {names, columns} of the visible range. */
  numbers() {
    const {x, marks, samples, unit} = this.last;
    const [from, to] = this.viewport.range;
    const series = seriesOf(marks ?? samples(from, to));
    const part = ([...column], time) => column.slice(firstFrom(time, from), lastUpTo(time, to) + 1);
    const time = series[0]?.x ?? [];
    return {
      names: [x.label, ...series.map(({label}) => (unit ? `${label} (${unit})` : label))],
      columns: [
        part(time, time).map((t) => t * x.factor),
        ...series.map((one) => part(one.y, time)),
      ],
    };
  }

  /** Shows the cursor, and the values there in the legend. */
  point() {
    super.point();
    const {cursor: t} = this.viewport;
    seriesOf(this.last?.marks ?? []).forEach(({x, y, text = shortOrNone}, k) => {
      const i = t === null ? -1 : lastUpTo(x, t);
      const within = t > x[i] ? i + 1 : i; // a line has no value after its end
      const value = y[within] === null ? null : (y[i] ?? null);
      const shown = text(value, y.findLastIndex((v) => v !== null) < within);
      if (this.values[k].textContent !== shown) this.values[k].textContent = shown;
    });
  }

  cursorText(cursor) {
    return short(cursor * this.last.x.factor);
  }

  /** The legend; empty for a single series. */
  writeLegend(series) {
    const written = JSON.stringify(series.map(({label, colour, dash}) => [label, colour, dash]));
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
}

// All plots: a canvas that is redrawn when its size changes, and a ring around one point.
import {element, keyOf, on} from "./dom.js";
import {addExportButton, captionOf} from "./export.js";
import {blank, Frame, font, rangeOf, sizeOf} from "./frame.js";
import {listen, makeAccessible} from "./gestures.js";
import {drawText, ink} from "./ink.js";
import {names} from "./marks.js";
import {lastUpTo, nearest, short} from "./numbers.js";
import {Viewport} from "./viewport.js";

const small = 130; // px of height below which a plot has few labels

/** Draws a prepared plot: {frame, marks}, or a text in place of both. */
function paint(c, {frame, marks, empty, width, height}) {
  if (!frame) {
    c.font = font;
    ink(c, "soft");
    return drawText(c, empty, width / 2, height / 2);
  }
  frame.draw(c);
  frame.clip(c);
  for (const mark of marks) if (!mark.above) mark.draw(c, frame);
  c.restore();
  for (const mark of marks) if (mark.above) mark.draw(c, frame);
}

const plotId = ({id}) => id.replace("figure-", "plot-");

export class Plot {
  frame = null;
  lit = [];

  /**
   * Adds itself to a container. Subclasses have prepare(width, height, alone): {frame, marks}, {empty:
   * a text} or null; in a figure about(): {title, summary, caption, name} of an export.
   */
  constructor(container, viewport) {
    this.canvas = this.node = element("canvas");
    this.ring = element("div", {className: "lit", hidden: true});
    this.plane = element("div", {className: "plane"}, this.canvas, this.ring);
    this.viewport = viewport;
    container.append(this.plane);
    this.size = sizeOf(this.plane, () => this.refresh());
    const figure = container.closest("figure");
    if (figure) addExportButton(figure, this);
    viewport?.onCursor(() => this.point());
  }

  /** points: {x, y, t = x}, ringed where t is nearest to the cursor; more options: subclasses. */
  draw(options) {
    this.last = options;
    this.refresh();
  }

  refresh() {
    const {width, height} = this.size;
    const prepared = width && this.prepare(width, height);
    if (!prepared) return;
    this.frame = prepared.frame;
    paint(blank(this.canvas, this.size), {width, height, ...prepared});
    this.point();
    this.light(...this.lit);
  }

  /** Redraws once before the next frame. */
  soon() {
    this.frameAsked ||= requestAnimationFrame(() => {
      this.frameAsked = 0;
      this.refresh();
    });
  }

  /** Draws the plot for export. */
  paintAll(c, width, height) {
    const prepared = this.prepare(width, height, true);
    if (prepared) paint(c, {width, height, ...prepared});
  }

  /** Follows the cursor. */
  point() {
    const {x, y, t = x} = this.last?.points ?? {};
    const {cursor} = this.viewport ?? {};
    if (!x || cursor == null) return;
    const i = nearest(t, cursor);
    this.light(x[i], y[i]);
  }

  /** Rings a point; hides the ring without one or when the point is out of view. */
  light(x, y) {
    this.lit = [x, y];
    const {frame, ring} = this;
    const [left, top] = frame ? [frame.px(x ?? NaN), frame.py(y ?? NaN)] : [];
    ring.hidden = !frame?.holds(left, top);
    if (!ring.hidden) ring.style.transform = `translate(${left}px, ${top}px)`;
  }
}

/** A plot over a viewport. Plots that share a viewport zoom together and show one cursor. */
export class ZoomablePlot extends Plot {
  /** across: of y. Subclasses have click(at, reach, {top, y, touch}) and, if any, cursorText(cursor). */
  constructor(figure, viewport = new Viewport(), across = null) {
    const className = figure.dataset.plot.replace("lines", "plot");
    const node = element("div", {className, id: plotId(figure)});
    figure.append(node);
    super(node, viewport);
    this.cursor = element("div", {className: "cursor", hidden: true});
    const over = element("div", {className: "over"}, this.cursor);
    Object.assign(this, {node, across, over});
    this.plane.append(over);
    for (const each of [viewport, across]) each?.onZoom(() => this.soon());
    listen(over, viewport, (...where) => this.click(...where), across);
  }

  point() {
    super.point();
    if (!this.frame) return;
    const {box, width, height} = this.frame;
    const place = {left: box.left, top: box.top, width, height};
    for (const [name, px] of Object.entries(place)) this.over.style[name] = `${px}px`;
    const {cursor, range} = this.viewport;
    const share = cursor === null ? -1 : (cursor - range[0]) / this.viewport.width;
    this.cursor.hidden = share < 0 || share > 1;
    if (this.cursor.hidden) return;
    this.cursor.style.transform = `translateX(${Math.round(share * width)}px)`;
    this.cursor.dataset.at = this.cursorText?.(cursor) ?? "";
  }
}

/** The marks with a label; they share x. */
const seriesOf = (marks) => marks.filter(({label}) => label);

/** Lines over a shared axis, drawn where visible; their legend shows the values at the cursor. */
class LinePlot extends ZoomablePlot {
  values = []; // elements of the legend

  /** viewport: shared with other plots over the same time. */
  constructor(figure, viewport) {
    super(figure, viewport);
    this.legend = element("div", {className: "legend line"});
    this.node.prepend(this.legend);
  }

  /**
   * x: {label, factor, aligned: numbers at the side as in large plots}; y: {range, log, label}, the
   * range by default that of the series; span: [from, to] of the full axis, if this plot sets it;
   * unit: of the series; click(x, reach): reach is 6 px in units of x; points: as in Plot.
   *
   * marks: the labelled ones are series, whose text(value, ended) is their value in the legend; or
   * trace(from, to, columns), which returns the marks of the visible range, and samples(from, to),
   * which returns those for the table. under: further marks, drawn first.
   */
  draw(options) {
    if (options.span) this.viewport.span(...options.span);
    super.draw(options);
  }

  click(...where) {
    this.last?.click?.(...where);
  }

  /** alone: for export, with the names of the series in place of the legend. */
  prepare(width, height, alone = false) {
    if (!this.last) return null;
    const {x, y, under = [], trace} = this.last;
    const {range} = this.viewport;
    const marks = this.last.marks ?? trace(...range, Math.max(width - 60, 10));
    const series = seriesOf(marks);
    if (!alone) this.writeLegend(series);
    const columns = series.map((one) => one.y);
    const ofY = {range: rangeOf(columns, y.log) ?? [0, 1], ...y};
    const bare = height < small && !x.aligned;
    const frame = new Frame(width, height, {...x, range, bare}, ofY);
    const named = alone && series.length > 1 ? [names({series})] : [];
    return {frame, marks: [...under, ...marks, ...named]};
  }

  /** {names, rows} of the visible range. */
  numbers() {
    const {x, marks, samples, unit} = this.last;
    const series = seriesOf(marks ?? samples(...this.viewport.range));
    const time = [...(series[0]?.x ?? [])];
    const row = (t, i) => [t * x.factor, ...series.map(({y}) => y[i])];
    return {
      names: [x.label, ...series.map(({label}) => (unit ? `${label} (${unit})` : label))],
      rows: time.map(row).filter((_, i) => this.viewport.holds(time[i])),
    };
  }

  /** Shows the cursor, and the values there in the legend. */
  point() {
    super.point();
    const {cursor: t} = this.viewport;
    const plain = (value) => (value === null ? "" : short(value));
    seriesOf(this.last?.marks ?? []).forEach(({x, y, text = plain}, k) => {
      const i = t === null ? -1 : lastUpTo(x, t);
      const within = t > x[i] ? i + 1 : i; // a line has no value after its end
      const value = y[within] === null ? null : (y[i] ?? null);
      const shown = text(value, y.findLastIndex((v) => v !== null) < within);
      const node = this.values[k];
      if (node && node.textContent !== shown) node.textContent = shown;
    });
  }

  cursorText(cursor) {
    return short(cursor * this.last.x.factor);
  }

  /** The legend; empty for a single series. */
  writeLegend(series) {
    this.values = series.map(() => element("b"));
    const keys = series.map(({label, colour, dash}, i) =>
      keyOf(dash ? "╍╍" : "━━", colour, label, " ", this.values[i]),
    );
    this.legend.replaceChildren(...(keys.length > 1 ? keys : []));
  }
}

const reach = 14; // px within which a point is picked

/** Plots of points and curves in a plane. Points can be picked with the pointer. */
class ScatterPlot extends Plot {
  /** viewport: whose cursor the ring follows. */
  constructor(figure, viewport) {
    super(figure, viewport);
    const hover = (event) => this.hover(event);
    on(this.canvas, {pointermove: hover, click: hover});
    this.canvas.id = plotId(figure);
  }

  /** The marks with points. */
  get groups() {
    return this.last.marks.filter(({x, y}) => x && y);
  }

  /**
   * marks; x, y: {label, range}, the range by default that of the points; equal: scale on both
   * axes; empty: text without points; points: as in Plot, picked where they have use(i, clicked).
   */
  prepare(width, height) {
    if (!this.last) return null;
    const {marks, equal, empty = "no impacts"} = this.last;
    const axes = ["x", "y"].map((key) => {
      const range = rangeOf(this.groups.map((group) => group[key]));
      return {range, ...this.last[key]};
    });
    if (!axes.every(({range}) => range)) return {frame: null, empty};
    axes[0].bare = height < small;
    const frame = new Frame(width, height, ...axes);
    return {marks, frame: equal ? new Frame(width, height, ...sameScale(axes, frame)) : frame};
  }

  /** {names, rows}: points and curves with their group. */
  numbers() {
    const rowsOf = ({x, y, colour, label = colour}) => x.map((v, i) => [v, y[i], label]);
    const {x, y} = this.last;
    return {names: [x.label, y.label, "group"], rows: this.groups.flatMap(rowsOf)};
  }

  /** Picks the point nearest to the pointer, preferably one whose time is in view. */
  hover({offsetX, offsetY, type}) {
    const {x, y, t, use} = this.last?.points ?? {};
    if (!use || !this.frame) return;
    const {px, py} = this.frame;
    let best = 2 * reach;
    let found = -1;
    x.forEach((v, i) => {
      const distance = Math.hypot(px(v) - offsetX, py(y[i]) - offsetY);
      const away = distance + (this.viewport.holds(t[i]) ? 0 : reach);
      if (distance < reach && away < best) [best, found] = [away, i];
    });
    if (found < 0) return;
    this.light(x[found], y[found]);
    use(found, type === "click");
  }
}

/** Axes extended so that a unit has the same length on both. */
function sameScale(axes, {width, height}) {
  const pixels = [width, height];
  const size = ({range: [min, max]}) => max - min;
  const unit = Math.min(...axes.map((axis, i) => pixels[i] / size(axis)));
  return axes.map((axis, i) => {
    const more = (pixels[i] / unit - size(axis)) / 2;
    return {...axis, range: [axis.range[0] - more, axis.range[1] + more]};
  });
}

/** The plots in the figures of an element by name: planes, and lines over time. */
export class PlotGroup {
  /**
   * viewport: shared by all, if any; about(name): summary, caption and file name of an export;
   * moments(): times of the impacts.
   */
  constructor(container, viewport, {prefix = "figure-", about, moments}) {
    this.all = {};
    for (const figure of container.querySelectorAll("[data-plot]")) {
      const {title} = captionOf(figure);
      const Kind = figure.dataset.plot === "plane" ? ScatterPlot : LinePlot;
      const plot = new Kind(figure, viewport);
      const name = figure.id.replace(prefix, "");
      plot.about = () => ({title, ...about(name)});
      makeAccessible(plot, title, moments, viewport);
      this.all[name] = plot;
    }
  }

  /** common: options of all plots over time, such as x. */
  draw(name, options) {
    this.all[name].draw({...this.common, ...options});
  }

  refresh() {
    for (const plot of Object.values(this.all)) plot.refresh();
  }
}

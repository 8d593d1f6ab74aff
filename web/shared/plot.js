// All plots: a frame and marks on a canvas, which is redrawn when its size changes, and a ring
// around one point.
import {bisectCenter, minIndex} from "d3-array";
import {element, keyOf, on} from "./dom.js";
import {addExportButton, captionOf} from "./export.js";
import {blank, Frame, font, rangeOf, sizeOf} from "./frame.js";
import {listen, makeAccessible} from "./gestures.js";
import {drawText, ink} from "./ink.js";
import {names} from "./marks.js";
import {lastUpTo, short} from "./numbers.js";
import {Viewport} from "./viewport.js";

const reach = 14; // px within which a point is picked

const pointsOf = (marks) => marks.filter(({x, y}) => x && y);

/** The frame of a plot; null where an axis has neither a range nor points. */
function frameOf(size, {x, y, marks, ...more}) {
  const withRange = (axis, columnOf) => {
    const range = axis.range ?? rangeOf(pointsOf(marks).map(columnOf), axis.log);
    return {...axis, range};
  };
  const axes = {x: withRange(x, (mark) => mark.x), y: withRange(y, (mark) => mark.y)};
  return axes.x.range && axes.y.range ? new Frame(size, {...axes, ...more}) : null;
}

/** Draws the content of a plot and returns its frame. */
function paint(c, size, {under = [], empty = "no impacts", ...content}) {
  const frame = frameOf(size, content);
  if (!frame) {
    c.font = font;
    ink(c, "soft");
    drawText(c, empty, size.width / 2, size.height / 2);
    return null;
  }
  const all = [...under, ...content.marks];
  frame.draw(c);
  frame.clip(c);
  for (const mark of all) if (!mark.above) mark.draw(c, frame);
  c.restore();
  for (const mark of all) if (mark.above) mark.draw(c, frame);
  return frame;
}

const plotId = ({id}) => id.replace("figure-", "plot-");

export class Plot {
  frame = null;
  lit = [];

  /** Adds itself to a container. In a figure about() is {title, summary, caption, name} of an export. */
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

  /**
   * x, y: axes as in Frame, their ranges by default those of the points; marks; under: marks drawn
   * first; equal, beside, above: as in Frame; empty: text without points; points: {x, y, t = x},
   * ringed where t is nearest to the cursor; more options: subclasses.
   */
  draw(options) {
    this.last = options;
    this.refresh();
  }

  /** What is drawn, as options of draw(); null for nothing. alone: for export. */
  content(_width, _alone) {
    return this.last;
  }

  refresh() {
    const {size} = this;
    const content = size.width && this.content(size.width);
    if (!content) return;
    this.frame = paint(blank(this.canvas, size), size, content);
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
    const content = this.content(width, true);
    if (content) paint(c, {width, height}, content);
  }

  /** Follows the cursor. */
  point() {
    const {x, y, t = x} = this.last?.points ?? {};
    const {cursor} = this.viewport ?? {};
    if (!x || cursor == null) return;
    const i = bisectCenter(t, cursor);
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

  /** Index of the point nearest to a place in px, preferably one with t in view; -1 if none is near. */
  pick({x, y, t = x}, left, top) {
    const {px, py} = this.frame;
    return minIndex(x, (v, i) => {
      const distance = Math.hypot(px(v) - left, py(y[i]) - top);
      const outOfView = this.viewport.holds(t[i]) ? 0 : reach;
      return distance < reach ? distance + outOfView : null;
    });
  }
}

/** The marks with a label; they share x. */
const seriesOf = (marks) => marks.filter(({label}) => label);

/**
 * A plot over a viewport: lines drawn where visible, whose legend shows the values at the cursor.
 * Plots that share a viewport zoom together and show one cursor.
 */
export class ZoomablePlot extends Plot {
  values = []; // elements of the legend

  /** across: viewport of y, if any. */
  constructor(figure, viewport = new Viewport(), across = null) {
    const className = figure.dataset.plot.replace("lines", "plot");
    const legend = element("div", {className: "legend line"});
    const node = element("div", {className, id: plotId(figure)}, legend);
    figure.append(node);
    super(node, viewport);
    this.cursor = element("div", {className: "cursor", hidden: true});
    const over = element("div", {className: "over"}, this.cursor);
    Object.assign(this, {node, legend, across, over});
    this.plane.append(over);
    for (const each of [viewport, across]) each?.onZoom(() => this.soon());
    listen(over, viewport, (...where) => this.click(...where), across);
  }

  /** reach: 6 px in units of x; where: {top, y, touch}. */
  click(x, reach, where) {
    this.last?.click?.(x, reach, where);
  }

  /**
   * Options of draw() in addition to those of a Plot: unit: of the series; click: see click(). marks:
   * the labelled ones are series, whose text(value, ended) is their value in the legend; or
   * trace(from, to, columns), which returns the marks of a range, by default those for the table.
   * alone: for export, with the names of the series in place of the legend.
   */
  content(width, alone = false) {
    if (!this.last) return null;
    const {range} = this.viewport;
    const {x, marks = this.last.trace(...range, Math.max(width - 60, 10)), ...rest} = this.last;
    const series = seriesOf(marks);
    if (!alone) this.writeLegend(series);
    const named = alone && series.length > 1 ? [names({series, above: true})] : [];
    return {...rest, x: {...x, range}, marks: [...marks, ...named]};
  }

  /** {names, rows} of the visible range. */
  numbers() {
    const {x, trace, unit, marks = trace(...this.viewport.range)} = this.last;
    const series = seriesOf(marks);
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
    if (!this.frame) return;
    const {box, width, height} = this.frame;
    const place = {left: box.left, top: box.top, width, height};
    for (const [name, px] of Object.entries(place)) this.over.style[name] = `${px}px`;
    const {cursor, range} = this.viewport;
    const share = cursor === null ? -1 : (cursor - range[0]) / this.viewport.width;
    this.cursor.hidden = share < 0 || share > 1;
    this.showValues(cursor);
    if (this.cursor.hidden) return;
    this.cursor.style.transform = `translateX(${Math.round(share * width)}px)`;
    this.cursor.dataset.at = this.last ? short(cursor * this.last.x.factor) : "";
  }

  showValues(cursor) {
    const plain = (value) => (value === null ? "" : short(value));
    seriesOf(this.last?.marks ?? []).forEach(({x, y, text = plain}, k) => {
      const i = cursor === null ? -1 : lastUpTo(x, cursor);
      const within = cursor > x[i] ? i + 1 : i; // a line has no value after its end
      const value = y[within] == null ? null : (y[i] ?? null);
      const shown = text(value, y.findLastIndex((v) => v !== null) < within);
      const node = this.values[k];
      if (node && node.textContent !== shown) node.textContent = shown;
    });
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

/** Points and curves in a plane, with use(i, clicked) of its `points` called for a picked one. */
class ScatterPlot extends Plot {
  /** viewport: whose cursor the ring follows. */
  constructor(figure, viewport) {
    super(figure, viewport);
    const hover = (event) => this.hover(event);
    on(this.canvas, {pointermove: hover, click: hover});
    this.canvas.id = plotId(figure);
  }

  /** {names, rows}: points and curves with their group. */
  numbers() {
    const rowsOf = ({x, y, colour, label = colour}) => x.map((v, i) => [v, y[i], label]);
    const {x, y, marks} = this.last;
    return {names: [x.label, y.label, "group"], rows: pointsOf(marks).flatMap(rowsOf)};
  }

  hover({offsetX, offsetY, type}) {
    const {points} = this.last ?? {};
    if (!points?.use || !this.frame) return;
    const found = this.pick(points, offsetX, offsetY);
    if (found < 0) return;
    this.light(points.x[found], points.y[found]);
    points.use(found, type === "click");
  }
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
      const Kind = figure.dataset.plot === "plane" ? ScatterPlot : ZoomablePlot;
      const plot = new Kind(figure, viewport);
      const name = figure.id.replace(prefix, "");
      plot.about = () => ({title, ...about(name)});
      makeAccessible(plot, title, moments, viewport);
      this.all[name] = plot;
    }
  }

  /** Hides the figure without options. common: options of all plots over time, such as x. */
  draw(name, options) {
    const plot = this.all[name];
    plot.canvas.closest("figure").hidden = !options;
    if (!options) return;
    plot.draw({...(plot instanceof ZoomablePlot && this.common), ...options});
  }

  refresh() {
    for (const plot of Object.values(this.all)) plot.refresh();
  }
}

// A sweep over one axis: the bifurcation diagram of its section, lambda1, and another quantity with
// the regimes, over each other.

import uPlot from "../node_modules/uplot/dist/uPlot.esm.js";
import {colour} from "../shared/colours.js";
import {element} from "../shared/dom.js";
import {
  coordinates,
  describe,
  otherMotion,
  quantities,
  quantityOf,
  regimeColour,
  startNames,
  symbolOf,
  verdictColour,
} from "../shared/quantities.js";
import {Tip} from "../shared/tip.js";
import {inSeconds} from "../shared/units.js";
import {
  afresh,
  clipped,
  coordinate,
  nameOf,
  plotAxis,
  point,
  rule,
  whereOf,
  wholeOrZoomed,
} from "./axes.js";

export const startColours = ["c1", "before", "c2", "c4", "c3"];
const startColour = (s) => startColours[s % startColours.length];

// The symbols of the starts, around (x, y), in a path.
const symbols = [
  (c, x, y, r) => c.arc(x, y, r, 0, 2 * Math.PI),
  (c, x, y, r) => c.rect(x - r * 0.9, y - r * 0.9, 1.8 * r, 1.8 * r),
  (c, x, y, r) => {
    c.moveTo(x, y - 1.25 * r);
    c.lineTo(x + 1.15 * r, y + r);
    c.lineTo(x - 1.15 * r, y + r);
  },
  (c, x, y, r) => {
    c.moveTo(x, y - 1.3 * r);
    c.lineTo(x + 1.3 * r, y);
    c.lineTo(x, y + 1.3 * r);
    c.lineTo(x - 1.3 * r, y);
  },
  (c, x, y, r) => {
    c.moveTo(x, y + 1.25 * r);
    c.lineTo(x + 1.15 * r, y - r);
    c.lineTo(x - 1.15 * r, y - r);
  },
];

function symbol(c, start, x, y, r) {
  c.beginPath();
  symbols[start % symbols.length](c, x, y, r);
  c.closePath();
  c.fill();
}

const untouched = (p) => p.verdict === null && p.regime === "none";

/** The extent of values and a margin; a logarithmic one keeps above 0. */
function extent(values, {log = false, from0 = false, least = 0} = {}) {
  let min = from0 ? 0 : Infinity;
  let max = -Infinity;
  for (const v of values) {
    if (!Number.isFinite(v) || (log && v <= least)) continue;
    if (v < min) min = v;
    if (v > max) max = v;
  }
  if (!(min <= max) || (from0 && max <= 0)) return log ? [0.1, 10] : [from0 ? 0 : -1, 1];
  if (log) return [min / 1.3, max * 1.3];
  const margin = (max - min) * 0.06 || Math.abs(max) * 0.06 || 1;
  return [from0 ? 0 : min - margin, max + margin];
}

/** Bytes of a colour of the style sheet. */
function bytes(name) {
  const c = new OffscreenCanvas(1, 1).getContext("2d", {willReadFrequently: true});
  c.fillStyle = colour(name);
  c.fillRect(0, 0, 1, 1);
  return c.getImageData(0, 0, 1, 1).data;
}

/** Moves of the keyboard along an axis. */
const steps = {
  ArrowLeft: -1,
  ArrowRight: 1,
  PageUp: -10,
  PageDown: 10,
  Home: -Infinity,
  End: Infinity,
};

export class SweepPlots {
  /**
   * containers: {section, lambda, other}; units(parameter): as in " (m)"; open(index): a point was
   * chosen.
   */
  constructor(root, containers, units, open) {
    Object.assign(this, {root, containers, units, open});
    Object.assign(this, {panels: null, data: null, current: null, zooming: false});
    this.tip = new Tip(root);
    new ResizeObserver(() => this.resize()).observe(root);
    root.addEventListener("keydown", (event) => this.key(event));
    root.addEventListener("focusout", (event) => {
      if (!root.contains(event.relatedTarget)) this.leave();
    });
  }

  /** Another sweep; coordinate: of the section, quantity: of the third plot. */
  show(data, choice) {
    this.data = data;
    this.choice = choice;
    this.recreate();
  }

  recreate() {
    for (const panel of this.panels ?? []) panel.destroy();
    this.panels = null;
    this.tip.hide();
    if (this.data?.axes?.length === 1 && this.root.clientWidth) this.create();
  }

  /** A change of what is shown, not of the axis: the zoom stays. */
  choose(choice) {
    const logNow = this.coordinate()?.log;
    this.choice = choice;
    const zoom = this.panels?.[0].scales.x;
    if (this.coordinate()?.log === logNow) return this.refresh();
    this.recreate();
    if (zoom && this.panels) this.panels[0].setScale("x", {min: zoom.min, max: zoom.max});
  }

  /** More points have come. */
  refresh() {
    if (!this.data?.axes) return;
    if (!this.panels) return this.recreate();
    for (const panel of this.panels) {
      const {min, max} = panel.scales.x;
      panel.setScale("x", {min, max}); // ranges the other axis again
    }
    if (this.current !== null) this.tell(...this.current);
  }

  resize() {
    if (!this.root.clientWidth) return;
    if (!this.panels) return this.recreate();
    for (const panel of this.panels) panel.setSize(this.sizeOf(panel.root.parentNode));
  }

  sizeOf(container) {
    return {width: container.clientWidth, height: container.clientHeight};
  }

  coordinate() {
    return coordinates[this.data?.section]?.[this.choice.coordinate];
  }

  quantity() {
    return quantityOf(this.choice.quantity, this.data);
  }

  /** Whether the section's velocities are drawn in mm/s. */
  seconds() {
    return Boolean(this.coordinate()?.seconds && this.data.parameters.si && inSeconds());
  }

  sectionLabel() {
    return (this.seconds() ? this.coordinate().seconds.label : this.coordinate()?.label) ?? "";
  }

  sectionOf(p) {
    return p?.section?.[`${this.choice.coordinate}${this.seconds() ? "_SI" : ""}`] ?? [];
  }

  starts() {
    return Array.from({length: this.data.starts}, (_, s) => s);
  }

  /** f(point, k) of the points of a start that have come. */
  each(start, f) {
    for (let k = 0; k < this.data.axes[0].values.length; ++k) {
      const p = this.data.at(k, 0, start);
      if (p && !p.error) f(p, k);
    }
  }

  /** All values of all points, for a range; of(point): those of one. */
  *values(of) {
    for (const p of this.data.points) {
      if (!p || p.error) continue;
      for (const v of of(p)) if (v !== null && v !== undefined) yield v;
    }
  }

  create() {
    const lambda = {
      label: () => "λ",
      range: () => extent([0, ...this.values((p) => this.lambdasOf(p))]),
      paint: (u) => this.paintLambda(u),
    };
    const other = {
      label: () => this.quantity().label,
      range: () => this.otherRange(),
      paint: (u) => this.paintOther(u),
      under: (u) => this.paintRegimes(u),
    };
    const section = {
      label: () => this.sectionLabel(),
      range: () => this.sectionRange(),
      paint: (u) => this.paintSection(u),
      log: Boolean(this.coordinate()?.log),
      turns: () => Boolean(this.coordinate()?.turns),
    };
    this.panels = [
      [this.containers.section, section],
      [this.containers.lambda, lambda],
      [this.containers.other, other],
    ]
      .filter(([container]) => !container.closest("figure").hidden)
      .map(([container, spec]) => this.panel(container, spec));
  }

  /** What the axis of lambda has to hold of a point. */
  lambdasOf(p) {
    const [lambda = null, second] = p.lambda ?? [];
    const error = p.standard_error?.[0] ?? 0;
    if (lambda === null) return [];
    return [lambda - error, lambda + error, second, otherMotion(p)?.lambda?.[0]];
  }

  panel(container, {label, range, paint, under = () => {}, log = false, turns}) {
    const [axis] = this.data.axes;
    const name = nameOf(axis, this.units);
    const options = {
      ...this.sizeOf(container),
      padding: [8, 12, 0, 0],
      legend: {show: false},
      scales: {
        x: {time: false, distr: axis.log ? 3 : 1, range: wholeOrZoomed(axis)},
        y: {range, distr: log ? 3 : 1},
      },
      axes: [
        plotAxis({size: 24, gap: 2, label: name, labelSize: 16}, {log: () => axis.log}),
        plotAxis({side: 3, size: 52, gap: 3, label, labelSize: 18}, {log: () => log, turns}),
      ],
      series: [{}, {paths: () => null, points: {show: false}}],
      cursor: {sync: {key: "sweep"}, y: false, drag: {x: true, y: false}, points: {show: false}},
      hooks: {
        drawClear: [(u) => clipped(u, () => under(u))],
        draw: [(u) => clipped(u, () => paint(u)), (u) => clipped(u, () => this.strip(u))],
        setScale: [(u, key) => this.zoomAll(u, key)],
      },
    };
    const u = new uPlot(options, [axis.values, axis.values.map(() => null)], container);
    const at = (left) => u.posToIdx(left);
    point(u.over, {
      move: (left) => this.tell(u, at(left)),
      leave: () => this.leave(),
      open: (left, top) => this.open(this.nearest(u, at(left), top)),
      touch: (left) => this.tell(u, at(left), true),
    });
    return u;
  }

  zoomAll(source, key) {
    if (key !== "x" || this.zooming || !this.panels) return;
    this.zooming = true;
    const {min, max} = source.scales.x;
    for (const panel of this.panels)
      if (panel !== source && (panel.scales.x.min !== min || panel.scales.x.max !== max))
        panel.setScale("x", {min, max});
    this.zooming = false;
  }

  /**
   * The index of the point at position k that lies next to the pointer: the starts have points at
   * the same place.
   */
  nearest(u, k, top) {
    const of = this.drawnIn(u);
    const away = (s) => {
      const p = this.data.at(k, 0, s);
      const v = p ? of(p) : null;
      return v === null ? Infinity : Math.abs(u.valToPos(v, "y") - top);
    };
    const next = this.starts().reduce((best, s) => (away(s) < away(best) ? s : best), 0);
    return this.data.index(k, 0, next);
  }

  /** The value of a point that a panel draws; the section has many. */
  drawnIn(u) {
    if (u === this.panels.at(-1)) return this.quantity().of;
    return u === this.panels.at(-2) ? quantities.lambda1.of : () => null;
  }

  leave() {
    this.current = null;
    this.tip.hide();
  }

  /** The tooltip of position k; act: with a button that opens it. */
  tell(u, k, act = false) {
    this.current = [u, k, act];
    const {data} = this;
    const [axis] = data.axes;
    const rows = [coordinate(axis, k, this.units)];
    for (const s of this.starts()) {
      if (data.starts > 1) rows.push([`start ${s + 1}`, ""]);
      rows.push(...this.describeStart(k, s));
    }
    const {start} = data.defaultSet ? (data.at(k) ?? {}) : {};
    const from = start ? `, from its start: ${startNames[start]}` : afresh(data);
    const box = this.root.getBoundingClientRect();
    const over = u.over.getBoundingClientRect();
    const left = over.left - box.left + u.valToPos(axis.values[k], "x");
    const top = over.top - box.top + over.height / 2;
    const open = {label: "Simulate this point", run: () => this.open(data.index(k))};
    this.tip.show(left, top, rows, `Click: simulate it${from}`, act ? open : null);
  }

  /** The rows of a start; of several starts not more than five each. */
  describeStart(k, start) {
    const p = this.data.at(k, 0, start);
    const rows = p ? describe(p, whereOf(this.data, this.units)) : [["", "still to come"]];
    return this.data.starts > 1 ? rows.slice(0, 5) : rows;
  }

  key(event) {
    if (!this.panels || event.target !== this.root) return;
    const [, k = -1] = this.current ?? [];
    const last = this.data.axes[0].values.length - 1;
    if (event.key in steps) {
      const next = Math.max(0, Math.min(last, k + steps[event.key]));
      for (const u of this.panels)
        u.setCursor({left: u.valToPos(u.data[0][next], "x"), top: 10}, false);
      this.tell(this.panels[0], next, true);
    } else if (event.key === "Enter" && k >= 0) this.open(this.data.index(k));
    else if (event.key === "Escape") this.leave();
    else return;
    event.preventDefault();
  }

  sectionRange() {
    const shown = this.coordinate();
    return shown?.range ?? (shown ? extent(this.sectionValues(), shown) : [0, 1]);
  }

  *sectionValues() {
    for (const p of this.data.points) yield* this.sectionOf(p);
  }

  otherRange() {
    const {of, levels = [], free = () => null, from0 = false} = this.quantity();
    const other = (p) => {
      const m = otherMotion(p);
      return m && of(m);
    };
    const [min, max] = extent([...this.values((p) => [of(p), free(p), other(p)])], {from0});
    if (!from0) return [min, max];
    return [min, Math.max(max, Math.min(levels[0] ?? 0, max * 1.5)) * 1.02];
  }

  /** The pixels from border to border of position k. */
  cell(u, k) {
    const {borders} = this.data.axes[0];
    const from = Math.round(u.valToPos(borders[k], "x", true));
    const to = Math.round(u.valToPos(borders[k + 1], "x", true));
    return [Math.max(from, u.bbox.left), Math.min(to, u.bbox.left + u.bbox.width)];
  }

  /**
   * How often the section comes to each pixel, as opacity: a periodic orbit is a few full dots,
   * chaos a cloud.
   */
  paintSection(u) {
    const shown = this.coordinate();
    if (!shown) return;
    const {left, top} = u.bbox;
    rule(u, shown.levels ?? [], "line");
    for (const start of this.starts()) {
      const rgb = bytes(this.data.starts > 1 ? startColour(start) : "c1");
      u.ctx.drawImage(density(this.countSection(u, start), rgb), left, top);
    }
  }

  /** {counts, most, width, height}: how often the section of a start comes to each pixel. */
  countSection(u, start) {
    const {width, height} = u.bbox;
    const {min, max} = u.scales.y;
    const at = this.coordinate().log ? Math.log : (v) => v;
    const scale = (height - 1) / (at(max) - at(min));
    const thick = Math.max(1, Math.round(1.4 * devicePixelRatio));
    const counts = new Uint16Array(width * height);
    let most = 8;
    const count = (j, from, to) => {
      for (let i = from; i < to; ++i) {
        const n = ++counts[j * width + i];
        if (n > most) most = n;
      }
    };
    this.each(start, (p, k) => {
      const [from, to] = this.columns(u, k);
      for (const v of this.sectionOf(p)) {
        if (!(v >= min && v <= max)) continue;
        const first = Math.round((at(max) - at(v)) * scale) - (thick >> 1);
        const end = Math.min(height, first + thick);
        for (let j = Math.max(0, first); j < end; ++j) count(j, from, to);
      }
    });
    return {counts, most, width, height};
  }

  /** The columns of pixels for position k: its cell, or the middle of a broad one. */
  columns(u, k) {
    const {left, width} = u.bbox;
    const broad = Math.round(4 * devicePixelRatio);
    const [begin, end] = this.cell(u, k);
    const isBroad = end - begin > broad;
    const from = isBroad ? Math.round((begin + end - broad) / 2) : begin;
    const to = isBroad ? from + broad : end;
    return [from - left, Math.min(Math.max(to, from + 1), left + width) - left];
  }

  /** Of the dots: smaller where there are many. */
  radius(u) {
    const {min, max} = u.scales.x;
    const {values} = this.data.axes[0];
    const shown = Math.max(1, values.filter((v) => v >= min && v <= max).length);
    const room = (u.bbox.width / devicePixelRatio / shown) * 0.62;
    const several = this.data.starts > 1 ? 1.15 : 1;
    return Math.max(1.3, Math.min(3.4, room)) * devicePixelRatio * several;
  }

  /** A line through the points of a start that follow each other without a gap. */
  line(u, start, of, name, width, alpha = 1, dash = []) {
    const {ctx} = u;
    const [axis] = this.data.axes;
    ctx.setLineDash(dash.map((v) => v * devicePixelRatio));
    Object.assign(ctx, {
      strokeStyle: colour(name),
      lineWidth: width * devicePixelRatio,
      globalAlpha: alpha,
    });
    ctx.beginPath();
    let last = -2;
    this.each(start, (p, k) => {
      const v = of(p) ?? null;
      if (v === null) return;
      const x = u.valToPos(axis.values[k], "x", true);
      const y = u.valToPos(v, "y", true);
      if (last === k - 1) ctx.lineTo(x, y);
      else ctx.moveTo(x, y);
      last = k;
    });
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
  }

  /**
   * The best of a point's motions, or one from another start that ends elsewhere, as rings on a
   * thin line.
   */
  rings(u, of) {
    const {ctx} = u;
    const [axis] = this.data.axes;
    const r = this.radius(u);
    const ofOther = (p) => {
      const m = otherMotion(p);
      return m && of(m);
    };
    this.line(u, 0, ofOther, "best", 1, 0.6);
    ctx.strokeStyle = colour("best");
    ctx.lineWidth = 1.5 * devicePixelRatio;
    this.each(0, (p, k) => {
      const v = ofOther(p);
      if (v === null || v === undefined) return;
      ctx.beginPath();
      ctx.arc(u.valToPos(axis.values[k], "x", true), u.valToPos(v, "y", true), r, 0, 2 * Math.PI);
      ctx.stroke();
    });
  }

  dots(u, start, of, nameOfPoint, errorOf = () => null) {
    const {ctx} = u;
    const [axis] = this.data.axes;
    const r = this.radius(u);
    ctx.lineWidth = Math.max(1, r / 2);
    this.each(start, (p, k) => {
      const v = of(p);
      if (v === null) return;
      const x = u.valToPos(axis.values[k], "x", true);
      const y = u.valToPos(v, "y", true);
      const error = errorOf(p);
      ctx.fillStyle = ctx.strokeStyle = colour(nameOfPoint(p));
      if (error) {
        ctx.globalAlpha = 0.45;
        ctx.beginPath();
        ctx.moveTo(x, u.valToPos(v - error, "y", true));
        ctx.lineTo(x, u.valToPos(v + error, "y", true));
        ctx.stroke();
        ctx.globalAlpha = 1;
      }
      symbol(ctx, start, x, y, r);
    });
  }

  paintLambda(u) {
    const of = (i) => (p) => p.lambda?.[i] ?? null;
    const several = this.data.starts > 1;
    rule(u, [0], "soft");
    const errorOf = (p) => p.standard_error?.[0];
    const ofUntouched = (p) => (untouched(p) ? 0 : null);
    for (const s of this.starts()) {
      const name = several ? () => startColour(s) : verdictColour;
      this.line(u, s, of(1), several ? startColour(s) : "second", 1, several ? 0.5 : 1);
      this.dots(u, s, of(0), name, errorOf);
      this.dots(u, s, ofUntouched, name);
    }
    if (!several) this.rings(u, of(0));
  }

  paintOther(u) {
    const {of, levels = [], free} = this.quantity();
    const several = this.data.starts > 1;
    rule(u, levels, "line");
    for (const s of this.starts()) {
      const name = several ? startColour(s) : "text";
      this.line(u, s, of, name, 1, 0.35);
      this.dots(u, s, of, () => name);
      if (free) this.line(u, s, free, "wall", 1.4, 1, [6, 4]);
    }
    if (!several) this.rings(u, of);
  }

  /** Neighbours of the same regime as one stretch: f(regime, from, to) in pixels. */
  stretches(u, start, f) {
    let open = null;
    const close = () => {
      if (open && open.to > open.from) f(open.regime, open.from, open.to);
    };
    this.each(start, (p, k) => {
      const [from, to] = this.cell(u, k);
      if (open && open.regime === p.regime && open.k === k - 1) Object.assign(open, {to, k});
      else {
        close();
        open = {regime: p.regime, from, to, k};
      }
    });
    close();
  }

  /** Pale bands with the regimes' numbers; several starts have none: theirs may differ. */
  paintRegimes(u) {
    if (this.data.starts > 1) return;
    const {ctx} = u;
    const {top, height} = u.bbox;
    ctx.font = `600 ${12 * devicePixelRatio}px system-ui`;
    Object.assign(ctx, {textAlign: "center", textBaseline: "top"});
    this.stretches(u, 0, (regime, from, to) => {
      ctx.globalAlpha = 0.2;
      ctx.fillStyle = colour(regimeColour(regime));
      ctx.fillRect(from, top, to - from, height);
      ctx.globalAlpha = 1;
      ctx.fillStyle = colour("text");
      if (ctx.measureText(regime).width + 4 < to - from)
        ctx.fillText(regime, (from + to) / 2, top + 12 * devicePixelRatio);
    });
  }

  /** The regimes as a narrow strip along the top, a lane for each start. */
  strip(u) {
    const lane = Math.round(5 * devicePixelRatio);
    for (const s of this.starts()) {
      const top = u.bbox.top + s * (lane + devicePixelRatio);
      this.stretches(u, s, (regime, from, to) => {
        u.ctx.fillStyle = colour(regimeColour(regime));
        u.ctx.fillRect(from, top, to - from, lane);
      });
    }
  }
}

/** Counts as an image of one colour. */
function density({counts, most, width, height}, [r, g, b]) {
  const image = new ImageData(width, height);
  const pixels = image.data;
  const scale = 0.58 / Math.log(most);
  for (let i = 0; i < counts.length; ++i) {
    if (!counts[i]) continue;
    pixels[4 * i] = r;
    pixels[4 * i + 1] = g;
    pixels[4 * i + 2] = b;
    pixels[4 * i + 3] = 255 * (0.42 + scale * Math.log(counts[i]));
  }
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

/** The keys of the starts: their symbol and state. */
export function startKeys(starts) {
  return starts.map((state, s) => {
    const className = `key start start${s % startColours.length}`;
    const values = Object.entries(state).map(([name, v]) => `${symbolOf(name)} = ${v}`);
    return element("span", {className, textContent: `${s + 1}: ${values.join(", ")}`});
  });
}

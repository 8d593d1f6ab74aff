// One axis shared by several plots: its full range, the visible range and the cursor.
import {clamp} from "./numbers.js";

const closest = 1e-9; // smallest visible fraction of the full range

const same = ([from, to], [first, last]) => from === first && to === last;

export class Viewport {
  full = [0, 1];
  range = [0, 1];
  initial = [0, 1];
  cursor = null;
  zoomListeners = [];
  cursorListeners = [];

  /** f() is called when the visible range changes. */
  onZoom(f) {
    this.zoomListeners.push(f);
  }

  /** f(by) is called when the cursor moves; `by` is "pointer", "play" or undefined. */
  onCursor(f) {
    this.cursorListeners.push(f);
  }

  get zoomed() {
    return !same(this.range, this.full);
  }

  /** True when the visible range is not the initial one. */
  get changed() {
    return !same(this.range, this.initial);
  }

  get width() {
    return this.range[1] - this.range[0];
  }

  get middle() {
    return this.range[0] + this.width / 2;
  }

  /** Sets the full range; keeps a zoom that overlaps it unless `fresh`. Calls no listeners. */
  span(from, to, initial = [from, to], fresh = false) {
    const stays = !fresh && this.changed && this.range[0] < to && this.range[1] > from;
    this.full = [from, to];
    this.initial = initial;
    this.range = stays ? this.range.map((v) => clamp(v, from, to)) : initial;
    if (this.cursor !== null) this.cursor = clamp(this.cursor, from, to);
  }

  zoom(from, to) {
    const [first, last] = this.full;
    const all = last - first;
    const width = clamp(to - from, closest * all, all);
    const start = clamp(from, first, last - width);
    const range = width < (1 - 1e-12) * all ? [start, start + width] : this.full;
    if (same(range, this.range)) return;
    this.range = range;
    for (const f of this.zoomListeners) f();
  }

  /** Zooms by `factor` (above 1: in) and keeps `t` where it is on the screen. */
  zoomAt(t, factor) {
    this.zoom(...this.range.map((end) => t + (end - t) / factor));
  }

  /** True when a value is visible. */
  holds(at) {
    return at >= this.range[0] && at <= this.range[1];
  }

  /** Scrolls a value that is out of view to the middle. */
  reveal(at) {
    if (!this.holds(at)) this.pan((at - this.range[0]) / this.width - 0.5);
  }

  /** Scrolls by a fraction of the visible range. */
  pan(fraction) {
    const [from, to] = this.range;
    const step = clamp(fraction * this.width, this.full[0] - from, this.full[1] - to);
    this.zoom(from + step, to + step);
  }

  /** Shows the initial range or, where that is visible already, the full range. */
  reset() {
    this.zoom(...(this.changed ? this.initial : this.full));
  }

  point(t, by) {
    this.cursor = t === null ? null : clamp(t, ...this.full);
    for (const f of this.cursorListeners) f(by);
  }
}

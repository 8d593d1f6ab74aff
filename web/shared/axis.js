// What plots over the same axis share: how far it reaches, the part that is in view, and one cursor.
import {clamp} from "./numbers.js";

const closest = 1e-9; // of the whole: as far as one can zoom in

const same = ([from, to], [first, last]) => from === first && to === last;

export class Axis {
  whole = [0, 1];
  view = [0, 1];
  home = [0, 1];
  cursor = null;
  viewers = [];
  pointers = [];

  /** f(): called when another part is in view. */
  onView(f) {
    this.viewers.push(f);
  }

  /** f(by): called when the cursor is elsewhere; by: "pointer", "play" or none. */
  onCursor(f) {
    this.pointers.push(f);
  }

  get zoomed() {
    return !same(this.view, this.whole);
  }

  /** Whether something else is in view than at first. */
  get away() {
    return !same(this.view, this.home);
  }

  /** How much is in view. */
  get width() {
    return this.view[1] - this.view[0];
  }

  /**
   * Another run, from..to, of which `home` is in view at first; a zoom stays, as far as it lies in
   * it, unless it is fresh. Tells nobody.
   */
  span(from, to, home = [from, to], fresh = false) {
    const stays = !fresh && this.away && this.view[0] < to && this.view[1] > from;
    this.whole = [from, to];
    this.home = home;
    this.view = stays ? this.view.map((v) => clamp(v, from, to)) : home;
    if (this.cursor !== null) this.cursor = clamp(this.cursor, from, to);
  }

  zoom(from, to) {
    const [first, last] = this.whole;
    const all = last - first;
    const width = clamp(to - from, closest * all, all);
    const start = clamp(from, first, last - width);
    const view = width < (1 - 1e-12) * all ? [start, start + width] : this.whole;
    if (same(view, this.view)) return;
    this.view = view;
    for (const f of this.viewers) f();
  }

  /** About a moment that stays where it is; factor: above 1 to see less. */
  zoomAt(t, factor) {
    this.zoom(...this.view.map((end) => t + (end - t) / factor));
  }

  /** About the cursor, or the middle of what is in view. */
  zoomAbout(factor) {
    this.zoomAt(this.cursor ?? this.view[0] + this.width / 2, factor);
  }

  /** Whether a place is in view. */
  holds(at) {
    return at >= this.view[0] && at <= this.view[1];
  }

  /** Brings a place into view, in the middle unless it is there already. */
  reveal(at) {
    if (!this.holds(at)) this.pan((at - this.view[0]) / this.width - 0.5);
  }

  /** By a share of what is in view. */
  pan(share) {
    const [from, to] = this.view;
    const step = clamp(share * this.width, this.whole[0] - from, this.whole[1] - to);
    this.zoom(from + step, to + step);
  }

  /** What was in view at first, and then the whole. */
  reset() {
    this.zoom(...(this.away ? this.home : this.whole));
  }

  point(t, by) {
    this.cursor = t === null ? null : clamp(t, ...this.whole);
    for (const f of this.pointers) f(by);
  }
}

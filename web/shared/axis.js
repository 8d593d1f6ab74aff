// What plots over the same axis share: how far it reaches, the part that is in view, and one cursor.

const closest = 1e-9; // of the whole: as far as one can zoom in

export class Axis {
  constructor() {
    this.whole = [0, 1];
    this.view = [0, 1];
    this.home = [0, 1];
    this.cursor = null;
    this.viewers = new Set();
    this.pointers = new Set();
  }

  /** f(): called when another part is in view. */
  onView(f) {
    this.viewers.add(f);
  }

  /** f(by): called when the cursor is elsewhere; by: "pointer", "key", "play", ... */
  onCursor(f) {
    this.pointers.add(f);
  }

  get zoomed() {
    return this.view[0] > this.whole[0] || this.view[1] < this.whole[1];
  }

  /** Whether something else is in view than at first. */
  get away() {
    return this.view[0] !== this.home[0] || this.view[1] !== this.home[1];
  }

  /**
   * Another run, from..to, of which `home` is in view at first; a zoom stays, as far as it lies in
   * it, unless it is fresh. Tells nobody.
   */
  span(from, to, home = [from, to], fresh = false) {
    const stays = !fresh && this.away && this.view[0] < to && this.view[1] > from;
    this.whole = [from, to];
    this.home = home;
    this.view = stays ? [Math.max(this.view[0], from), Math.min(this.view[1], to)] : home;
    if (this.cursor !== null) this.cursor = Math.min(Math.max(this.cursor, from), to);
  }

  zoom(from, to) {
    const [first, last] = this.whole;
    const least = closest * (last - first);
    const width = Math.min(Math.max(to - from, least), last - first);
    const start = Math.min(Math.max(from, first), last - width);
    const part = width < (1 - 1e-12) * (last - first);
    const view = part ? [start, start + width] : [first, last];
    if (view[0] === this.view[0] && view[1] === this.view[1]) return;
    this.view = view;
    for (const f of this.viewers) f();
  }

  /** About a moment that stays where it is; factor: above 1 to see less. */
  zoomAt(t, factor) {
    const [from, to] = this.view;
    this.zoom(t - (t - from) / factor, t + (to - t) / factor);
  }

  /** About the cursor, or the middle of what is in view. */
  zoomAbout(factor) {
    const [from, to] = this.view;
    this.zoomAt(this.cursor ?? (from + to) / 2, factor);
  }

  /** Brings a place into view, in the middle unless it is there already. */
  reveal(at) {
    const [from, to] = this.view;
    if (at < from || at > to) this.pan((at - (from + to) / 2) / (to - from));
  }

  /** By a share of what is in view. */
  pan(share) {
    const [from, to] = this.view;
    const step = share * (to - from);
    const [first, last] = this.whole;
    const kept = Math.min(Math.max(step, first - from), last - to);
    this.zoom(from + kept, to + kept);
  }

  /** What was in view at first, and then the whole. */
  reset() {
    this.zoom(...(this.away ? this.home : this.whole));
  }

  point(t, by) {
    const [first, last] = this.whole;
    this.cursor = t === null ? null : Math.min(Math.max(t, first), last);
    for (const f of this.pointers) f(by);
  }
}

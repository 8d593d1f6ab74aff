// Pointing at and zooming into a plot over an Axis, or over one for x and one for y: with a mouse,
// with fingers, by keys.
import {element, on} from "./dom.js";
import {clamp} from "./numbers.js";

const patience = 250; // ms in which a second click makes a double-click
const jitter = 4; // px that a click may move
const slim = 20; // px: a drag that is no wider zooms along the other axis alone

// How the places of events, boxes and styles name a direction.
const rightwards = {client: "clientX", start: "left", size: "width"};
const upwards = {client: "clientY", start: "top", size: "height", turned: true};

/** An axis along a direction of the screen. */
class Way {
  constructor(over, axis, direction) {
    Object.assign(this, {over, axis, ...direction});
  }

  /**
   * Of an event: its place, px from the start of the plot, which is `all` px long; the share of what
   * is in view that lies before it; the value of the axis there.
   */
  at(event) {
    const box = this.over.getBoundingClientRect();
    const all = box[this.size] || 1;
    const place = event[this.client] - box[this.start];
    const share = this.turned ? 1 - place / all : place / all;
    return {all, place, share, value: this.axis.view[0] + share * this.axis.width};
  }

  /** Pixels between two events. */
  between(one, other) {
    return Math.abs(other[this.client] - one[this.client]);
  }
}

/**
 * click(x, reach, {top, y, touch}): where one clicks; reach: a few pixels in units of the axis; top:
 * px in the plot; y: of the axis across, where there is one.
 */
export function listen(over, axis, click, across = null) {
  const x = new Way(over, axis, rightwards);
  const y = new Way(over, across ?? axis, upwards);
  // The axis across is first: who hears of the cursor along x reads where the other one is.
  const plot = {over, axis, across, ways: across ? [y, x] : [x]};
  const where = (event, touch) => {
    const {value, all} = x.at(event);
    const {place: top, value: height} = y.at(event);
    return [value, (6 / all) * axis.width, {top, y: height, touch}];
  };
  followMouse(plot, where, click);
  followWheel(plot);
  followFingers(plot);
  over.addEventListener("dblclick", () => {
    for (const way of plot.ways) way.axis.reset();
  });
}

/** The cursor to where the pointer is. */
function pointAt({ways}, event, by) {
  for (const way of ways) way.axis.point(way.at(event).value, by);
}

const ordered = (a, b) => (a < b ? [a, b] : [b, a]);
const isMouse = (event) => event.pointerType === "mouse";
const isZoomed = ({ways}) => ways.some((way) => way.axis.zoomed);

/** A drag zooms; its end is no click, nor is half of a double-click, which shows the whole. */
function followMouse(plot, where, click) {
  const {over, ways} = plot;
  const selection = element("div", {className: "selection", hidden: true});
  over.append(selection);
  let from = null;
  let waiting = 0;
  const moved = (event) => Math.max(...ways.map((way) => way.between(from, event)));
  const isAlong = (way, event) => way.between(from, event) >= Math.min(slim, moved(event));
  const select = (event) => {
    selection.hidden = moved(event) < jitter;
    for (const way of ways) {
      const {place, all} = way.at(event);
      const [first, last] = isAlong(way, event) ? ordered(way.at(from).place, place) : [0, all];
      selection.style[way.start] = `${first}px`;
      selection.style[way.size] = `${last - first}px`;
    }
  };
  on(over, {
    pointerdown(event) {
      from = event;
      if (event.button === 0) over.setPointerCapture(event.pointerId); // of fingers, too
    },
    pointermove(event) {
      if (!isMouse(event)) return;
      if (event.buttons && from) select(event);
      else pointAt(plot, event, "pointer");
    },
    pointerup(event) {
      if (selection.hidden) return;
      selection.hidden = true;
      for (const way of ways)
        if (isAlong(way, event)) way.axis.zoom(...ordered(way.at(from).value, way.at(event).value));
    },
    click(event) {
      clearTimeout(waiting);
      if (event.detail > 1 || (from && moved(event) > jitter)) return;
      const touch = Boolean(from) && !isMouse(from);
      pointAt(plot, event);
      waiting = setTimeout(click, patience, ...where(event, touch));
    },
  });
}

/** The wheel zooms; one that would zoom out of the whole scrolls the page. Sideways it pans. */
function followWheel(plot) {
  const {over, axis, ways} = plot;
  const zoom = (event) => {
    const {deltaX, deltaY, deltaMode, shiftKey} = event;
    const sideways = Math.abs(deltaX) > Math.abs(deltaY) || shiftKey;
    if ((sideways || deltaY > 0) && !isZoomed(plot)) return;
    event.preventDefault();
    const lines = deltaMode ? 16 : 1;
    if (sideways) axis.pan(((deltaX || deltaY) * lines) / over.clientWidth);
    else
      for (const way of ways)
        way.axis.zoomAt(way.at(event).value, Math.exp(-0.0022 * lines * deltaY));
  };
  over.addEventListener("wheel", zoom, {passive: false});
}

/** One finger moves what is in view, or the cursor where all is; two zoom. */
function followFingers(plot) {
  const {over, across, ways} = plot;
  const fingers = new Map();
  /** The middle of the fingers, and how far apart they are. */
  const span = () => {
    const [a, b = a] = fingers.values();
    const apart = Math.hypot(...ways.map((way) => way.between(a, b)));
    const middle = (client) => (a[client] + b[client]) / 2;
    return {
      clientX: middle("clientX"),
      clientY: middle("clientY"),
      width: Math.max(apart, 8),
    };
  };
  const ends = (event) => fingers.delete(event.pointerId);
  // What is not zoomed leaves a stroke upwards to the page.
  const leave = () => {
    over.style.touchAction = across?.zoomed ? "none" : "pan-y";
  };
  leave();
  across?.onView(leave);
  on(over, {
    pointerdown(event) {
      if (!isMouse(event)) fingers.set(event.pointerId, event);
    },
    pointermove(event) {
      if (!fingers.has(event.pointerId)) return;
      const old = span();
      fingers.set(event.pointerId, event);
      const now = span();
      if (fingers.size < 2 && !isZoomed(plot)) return pointAt(plot, event, "pointer");
      for (const way of ways) {
        way.axis.pan(way.at(old).share - way.at(now).share);
        way.axis.zoomAt(way.at(now).value, now.width / old.width);
      }
    },
    pointerup: ends,
    pointercancel: ends,
  });
}

/**
 * Keys on a plot: arrows move the cursor (with Shift faster), + and − zoom about it, Page Up and
 * Down pan, 0 and Escape show the whole, n and p go to the next and the last impact.
 */
export function followKeys(node, axis, impacts = () => []) {
  const now = () => axis.cursor ?? axis.view[0];
  const go = (to) => to !== undefined && axis.point(to);
  const step = (event, way) => go(now() + way * (event.shiftKey ? 0.05 : 0.005) * axis.width);
  const zoom = (factor) => axis.zoomAt(clamp(now(), ...axis.view), factor);
  const acts = {
    ArrowLeft: (event) => step(event, -1),
    ArrowRight: (event) => step(event, 1),
    Home: () => go(axis.view[0]),
    End: () => go(axis.view[1]),
    PageUp: () => axis.pan(-0.8),
    PageDown: () => axis.pan(0.8),
    "+": () => zoom(1.5),
    "-": () => zoom(1 / 1.5),
    0: () => axis.reset(),
    n: () => go(impacts().find((t) => t > now())),
    p: () => go(impacts().findLast((t) => t < now())),
  };
  Object.assign(acts, {"=": acts["+"], Escape: acts[0]});
  node.addEventListener("keydown", (event) => {
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(event);
  });
}

// Pointing at and zooming into a plot over an Axis, or over one for x and one for y: with a mouse,
// with fingers, by keys.
import {element} from "./dom.js";

const patience = 250; // ms in which a second click makes a double-click
const jitter = 4; // px that a click may move
const slim = 20; // px: a drag that is no wider zooms along the other axis alone

/** The value of x and of y under a place of the plot, in pixels of the screen. */
function valuesAt(over, axis, across, {clientX, clientY}) {
  const box = over.getBoundingClientRect();
  const at = ({view: [from, to]}, share) => from + share * (to - from);
  const y = across && at(across, (box.bottom - clientY) / (box.height || 1));
  return {x: at(axis, (clientX - box.left) / (box.width || 1)), y};
}

/**
 * click(x, reach, {left, top, y, touch}): where one clicks; reach: a few pixels in units of the axis;
 * left, top: px in the plot; y: of the axis across.
 */
export function listen(over, axis, click, across = null) {
  const at = (event) => valuesAt(over, axis, across, event);
  const plot = {over, axis, across, at};
  followMouse(plot, click);
  followWheel(plot);
  followFingers(plot);
  over.addEventListener("dblclick", () => {
    axis.reset();
    across?.reset();
  });
}

/** The cursor to where the pointer is. */
function pointAt({axis, across, at}, event, by) {
  const {x, y} = at(event);
  across?.point(y, by);
  axis.point(x, by);
}

const ordered = (a, b) => (a < b ? [a, b] : [b, a]);

/** A drag zooms; its end is no click, nor is half of a double-click, which shows the whole. */
function followMouse(plot, click) {
  const {over, axis, across, at} = plot;
  const selection = element("div", {className: "selection", hidden: true});
  over.append(selection);
  let from = null;
  let waiting = 0;
  const isMouse = (event) => event.pointerType === "mouse";
  const place = ({clientX, clientY}) => {
    const {left, top} = over.getBoundingClientRect();
    return {left: clientX - left, top: clientY - top};
  };
  const width = (event) => Math.abs(event.clientX - from.clientX);
  const height = (event) => Math.abs(event.clientY - from.clientY);
  const along = (event) => !across || width(event) >= Math.min(slim, height(event));
  const upwards = (event) => across && height(event) >= Math.min(slim, width(event));
  const select = (event) => {
    const [a, b] = [place(from), place(event)];
    const [left, right] = along(event) ? ordered(a.left, b.left) : [0, over.clientWidth];
    const [top, bottom] = upwards(event) ? ordered(a.top, b.top) : [0, over.clientHeight];
    selection.hidden = Math.max(width(event), across ? height(event) : 0) < jitter;
    const box = {left, top, width: right - left, height: bottom - top};
    for (const [name, value] of Object.entries(box)) selection.style[name] = `${value}px`;
  };
  over.addEventListener("pointerdown", (event) => {
    from = event;
    if (isMouse(event) && event.button === 0) over.setPointerCapture(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    if (!isMouse(event)) return;
    if (event.buttons && from) select(event);
    else pointAt(plot, event, "pointer");
  });
  over.addEventListener("pointerup", (event) => {
    if (selection.hidden) return;
    selection.hidden = true;
    const [a, b] = [at(from), at(event)];
    if (along(event)) axis.zoom(...ordered(a.x, b.x));
    if (upwards(event)) across.zoom(...ordered(a.y, b.y));
  });
  over.addEventListener("click", (event) => {
    clearTimeout(waiting);
    const moved = from && Math.max(width(event), across ? height(event) : 0) > jitter;
    if (event.detail > 1 || moved) return;
    const {x, y} = at(event);
    const reach = at({clientX: event.clientX + 6, clientY: event.clientY}).x - x;
    pointAt(plot, event, "click");
    const touch = Boolean(from) && !isMouse(from);
    waiting = setTimeout(() => click(x, reach, {...place(event), y, touch}), patience);
  });
}

/** The wheel zooms; one that would zoom out of the whole scrolls the page. Sideways it pans. */
function followWheel({over, axis, across, at}) {
  const zoom = (event) => {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY) || event.shiftKey;
    const outside = event.deltaY > 0 && !sideways;
    if ((outside || sideways) && !axis.zoomed && !across?.zoomed) return;
    event.preventDefault();
    const lines = event.deltaMode ? 16 : 1;
    if (sideways) {
      axis.pan(((event.deltaX || event.deltaY) * lines) / over.clientWidth);
      return;
    }
    const {x, y} = at(event);
    const factor = Math.exp(-0.0022 * lines * event.deltaY);
    axis.zoomAt(x, factor);
    across?.zoomAt(y, factor);
  };
  over.addEventListener("wheel", zoom, {passive: false});
}

/** One finger moves what is in view, or the cursor where all is; two zoom. */
function followFingers(plot) {
  const {over, axis, across, at} = plot;
  const fingers = new Map();
  const span = () => {
    const [a, b] = [...fingers.values()];
    const [width, height] = [a.clientX - b.clientX, a.clientY - b.clientY];
    const middle = {clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2};
    return {...middle, width: Math.max(across ? Math.hypot(width, height) : Math.abs(width), 8)};
  };
  const pan = (by, to) => {
    axis.pan((by.clientX - to.clientX) / over.clientWidth);
    across?.pan((to.clientY - by.clientY) / over.clientHeight);
  };
  const ends = (event) => fingers.delete(event.pointerId);
  // What is not zoomed leaves a stroke upwards to the page.
  const leave = () => {
    over.style.touchAction = across?.zoomed ? "none" : "pan-y";
  };
  leave();
  across?.onView(leave);
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse") return;
    fingers.set(event.pointerId, event);
    over.setPointerCapture(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (before === undefined) return;
    const old = fingers.size === 2 ? span() : null;
    fingers.set(event.pointerId, event);
    if (old) {
      const now = span();
      pan(old, now);
      const {x, y} = at(now);
      axis.zoomAt(x, now.width / old.width);
      across?.zoomAt(y, now.width / old.width);
    } else if (axis.zoomed || across?.zoomed) pan(before, event);
    else pointAt(plot, event, "pointer");
  });
  over.addEventListener("pointerup", ends);
  over.addEventListener("pointercancel", ends);
}

/**
 * Keys on a plot: arrows move the cursor (with Shift faster), + and − zoom about it, Page Up and
 * Down pan, 0 and Escape show the whole, n and p go to the next and the last impact.
 */
export function followKeys(node, axis, impacts = () => []) {
  const step = (event) => (event.shiftKey ? 0.05 : 0.005) * (axis.view[1] - axis.view[0]);
  const now = () => axis.cursor ?? axis.view[0];
  const about = () => Math.min(Math.max(now(), axis.view[0]), axis.view[1]);
  const beside = (way) => {
    const list = impacts();
    const found =
      way > 0 ? list.find((t) => t > now()) : list[list.findIndex((t) => !(t < now())) - 1];
    if (found !== undefined) axis.point(found, "key");
  };
  const acts = {
    ArrowLeft: (event) => axis.point(now() - step(event), "key"),
    ArrowRight: (event) => axis.point(now() + step(event), "key"),
    Home: () => axis.point(axis.view[0], "key"),
    End: () => axis.point(axis.view[1], "key"),
    PageUp: () => axis.pan(-0.8),
    PageDown: () => axis.pan(0.8),
    "+": () => axis.zoomAt(about(), 1.5),
    "=": () => axis.zoomAt(about(), 1.5),
    "-": () => axis.zoomAt(about(), 1 / 1.5),
    0: () => axis.reset(),
    Escape: () => axis.reset(),
    n: () => beside(1),
    p: () => beside(-1),
  };
  node.addEventListener("keydown", (event) => {
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(event);
  });
}

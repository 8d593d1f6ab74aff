// Pointing at and zooming into a plot over a TimeAxis: with a mouse, with fingers, by keys.
import {element} from "./dom.js";

const patience = 250; // ms in which a second click makes a double-click
const jitter = 4; // px that a click may move

/** The moment under a place of the plot. */
function momentAt(over, axis, clientX) {
  const box = over.getBoundingClientRect();
  const [from, to] = axis.view;
  return from + ((clientX - box.left) / (box.width || 1)) * (to - from);
}

/** click(t, reach): where one clicks; reach: a few pixels in units of the axis. */
export function listen(over, axis, click) {
  followMouse(over, axis, click);
  followWheel(over, axis);
  followFingers(over, axis, click);
}

/** A drag zooms; its end is no click, nor is half of a double-click, which shows the whole. */
function followMouse(over, axis, click) {
  const selection = element("div", {className: "selection", hidden: true});
  over.append(selection);
  let from = null;
  let waiting = 0;
  const isMouse = (event) => event.pointerType === "mouse";
  const place = (event) => event.clientX - over.getBoundingClientRect().left;
  const select = (event) => {
    const [a, b] = [from, place(event)].sort((one, other) => one - other);
    selection.hidden = b - a < jitter;
    Object.assign(selection.style, {left: `${a}px`, width: `${b - a}px`});
  };
  over.addEventListener("pointerdown", (event) => {
    from = place(event);
    if (isMouse(event) && event.button === 0) over.setPointerCapture(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    if (!isMouse(event)) return;
    if (event.buttons && from !== null) select(event);
    else axis.point(momentAt(over, axis, event.clientX), "pointer");
  });
  over.addEventListener("pointerup", (event) => {
    if (selection.hidden) return;
    selection.hidden = true;
    const left = over.getBoundingClientRect().left;
    const ends = [from, place(event)].sort((one, other) => one - other);
    axis.zoom(...ends.map((at) => momentAt(over, axis, left + at)));
  });
  over.addEventListener("click", (event) => {
    clearTimeout(waiting);
    const moved = from !== null && Math.abs(place(event) - from) > jitter;
    if (event.detail > 1 || moved) return;
    const t = momentAt(over, axis, event.clientX);
    const reach = momentAt(over, axis, event.clientX + 6) - t;
    axis.point(t, "click");
    waiting = setTimeout(() => click(t, reach), patience);
  });
  over.addEventListener("dblclick", () => axis.reset());
}

/** The wheel zooms; one that would zoom out of the whole scrolls the page. Sideways it pans. */
function followWheel(over, axis) {
  const zoom = (event) => {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY) || event.shiftKey;
    const outside = event.deltaY > 0 && !sideways;
    if ((outside || sideways) && !axis.zoomed) return;
    event.preventDefault();
    const lines = event.deltaMode ? 16 : 1;
    if (sideways) axis.pan(((event.deltaX || event.deltaY) * lines) / over.clientWidth);
    else axis.zoomAt(momentAt(over, axis, event.clientX), Math.exp(-0.0022 * lines * event.deltaY));
  };
  over.addEventListener("wheel", zoom, {passive: false});
}

/** One finger moves what is in view, or the cursor where all is; two zoom. */
function followFingers(over, axis) {
  const fingers = new Map();
  const span = () => {
    const [a, b] = [...fingers.values()];
    return {middle: (a + b) / 2, width: Math.max(Math.abs(a - b), 8)};
  };
  const ends = (event) => fingers.delete(event.pointerId);
  over.style.touchAction = "pan-y";
  over.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse") return;
    fingers.set(event.pointerId, event.clientX);
    over.setPointerCapture(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (before === undefined) return;
    const old = fingers.size === 2 ? span() : null;
    fingers.set(event.pointerId, event.clientX);
    if (old) {
      const now = span();
      axis.pan((old.middle - now.middle) / over.clientWidth);
      axis.zoomAt(momentAt(over, axis, now.middle), now.width / old.width);
    } else if (axis.zoomed) axis.pan((before - event.clientX) / over.clientWidth);
    else axis.point(momentAt(over, axis, event.clientX), "pointer");
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

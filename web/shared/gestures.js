// Pointing at and zooming into a plot, over x and possibly y, with mouse, touch and keyboard.
import {attributes, element, on} from "./dom.js";
import {clamp, short} from "./numbers.js";

const doubleClickTime = 250; // ms within which a second click makes a double click
const jitter = 4; // px that a click may move
const slim = 20; // px: a drag thinner than this zooms along the other axis only

// Properties of events, boxes and styles along each direction of the screen.
const rightwards = {client: "clientX", start: "left", size: "width"};
const upwards = {client: "clientY", start: "top", size: "height", turned: true};

/** A viewport along a direction of the screen. */
function along(over, viewport, {client, start, size, turned}) {
  /** `place` of an event in px, of `all` px; its `share` of the visible range; `value`. */
  const at = (event) => {
    const box = over.getBoundingClientRect();
    const all = box[size] || 1;
    const place = event[client] - box[start];
    const share = turned ? 1 - place / all : place / all;
    return {all, place, share, value: viewport.range[0] + share * viewport.width};
  };
  const between = (one, other) => Math.abs(other[client] - one[client]); // px
  return {viewport, start, size, at, between};
}

/** Calls click(x, reach: 6 px on the axis, {top: px, y, touch}) on a click. */
export function listen(over, viewport, click, across = null) {
  const x = along(over, viewport, rightwards);
  const y = along(over, across ?? viewport, upwards);
  // The vertical axis moves first: listeners on the horizontal cursor read the vertical one.
  const plot = {over, viewport, across, directions: across ? [y, x] : [x]};
  const where = (event, touch) => {
    const {value, all} = x.at(event);
    const {place: top, value: height} = y.at(event);
    return [value, (6 / all) * viewport.width, {top, y: height, touch}];
  };
  followMouse(plot, where, click);
  followWheel(plot);
  followFingers(plot);
  over.addEventListener("dblclick", () => {
    for (const {viewport: each} of plot.directions) each.reset();
  });
}

/** Moves the cursor to the pointer. */
function pointAt({directions}, event, by) {
  for (const {viewport, at} of directions) viewport.point(at(event).value, by);
}

const ordered = (a, b) => (a < b ? [a, b] : [b, a]);
const isMouse = (event) => event.pointerType === "mouse";
const isZoomed = ({directions}) => directions.some(({viewport}) => viewport.zoomed);

/** A drag zooms and does not end in a click; a double click does not count as two clicks. */
function followMouse(plot, where, click) {
  const {over, directions} = plot;
  const selection = element("div", {className: "selection", hidden: true});
  over.append(selection);
  let from = null;
  let waiting = 0;
  const moved = (event) => Math.max(...directions.map(({between}) => between(from, event)));
  const isAlong = ({between}, event) => between(from, event) >= Math.min(slim, moved(event));
  const select = (event) => {
    selection.hidden = moved(event) < jitter;
    for (const direction of directions) {
      const {place, all} = direction.at(event);
      const [first, last] = isAlong(direction, event)
        ? ordered(direction.at(from).place, place)
        : [0, all];
      selection.style[direction.start] = `${first}px`;
      selection.style[direction.size] = `${last - first}px`;
    }
  };
  on(over, {
    pointerdown(event) {
      from = event;
      if (event.button === 0) over.setPointerCapture(event.pointerId); // applies to touch, too
    },
    pointermove(event) {
      if (!isMouse(event)) return;
      if (event.buttons && from) select(event);
      else pointAt(plot, event, "pointer");
    },
    pointerup(event) {
      if (selection.hidden) return;
      selection.hidden = true;
      for (const direction of directions)
        if (isAlong(direction, event))
          direction.viewport.zoom(...ordered(direction.at(from).value, direction.at(event).value));
    },
    click(event) {
      clearTimeout(waiting);
      if (event.detail > 1 || (from && moved(event) > jitter)) return;
      const touch = Boolean(from) && !isMouse(from);
      pointAt(plot, event);
      waiting = setTimeout(click, doubleClickTime, ...where(event, touch));
    },
  });
}

/** With Ctrl or the focus the wheel zooms, or scrolls sideways; otherwise a hint names the keys. */
function followWheel(plot) {
  const {over, viewport, directions} = plot;
  const hint = element("p", {className: "hint", textContent: "Ctrl + wheel zooms", hidden: true});
  over.append(hint);
  over.addEventListener("pointerleave", () => {
    hint.hidden = true;
  });
  const zoom = (event) => {
    const {deltaX, deltaY, deltaMode, shiftKey, ctrlKey} = event;
    hint.hidden = ctrlKey || over.closest("[tabindex='0']:focus") !== null;
    if (!hint.hidden) return;
    const sideways = Math.abs(deltaX) > Math.abs(deltaY) || shiftKey;
    if (!ctrlKey && (sideways || deltaY > 0) && !isZoomed(plot)) return;
    event.preventDefault();
    const lines = deltaMode ? 16 : 1;
    if (sideways) viewport.pan(((deltaX || deltaY) * lines) / over.clientWidth);
    else
      for (const {viewport: each, at} of directions)
        each.zoomAt(at(event).value, Math.exp(-0.0022 * lines * deltaY));
  };
  over.addEventListener("wheel", zoom, {passive: false});
}

/** One finger scrolls a zoomed plot, or else moves the cursor; two fingers zoom. */
function followFingers(plot) {
  const {over, across, directions} = plot;
  const fingers = new Map();
  /** Centre and distance of the fingers. */
  const span = () => {
    const [a, b = a] = fingers.values();
    const middle = (client) => (a[client] + b[client]) / 2;
    const apart = Math.hypot(...directions.map(({between}) => between(a, b)));
    return {clientX: middle("clientX"), clientY: middle("clientY"), width: Math.max(apart, 8)};
  };
  const ends = (event) => fingers.delete(event.pointerId);
  // Vertical strokes scroll the page unless the plot is zoomed vertically.
  const leave = () => {
    over.style.touchAction = across?.zoomed ? "none" : "pan-y";
  };
  leave();
  across?.onZoom(leave);
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
      for (const {viewport, at} of directions) {
        viewport.pan(at(old).share - at(now).share);
        viewport.zoomAt(at(now).value, now.width / old.width);
      }
    },
    pointerup: ends,
    pointercancel: ends,
  });
}

/** Calls acts[key](event) for the keys pressed in a node. */
export function listenToKeys(node, acts) {
  node.addEventListener("keydown", (event) => {
    const {target, key, ctrlKey, metaKey, altKey} = event;
    if (target !== node || !acts[key] || ctrlKey || metaKey || altKey) return;
    event.preventDefault();
    acts[key](event);
  });
}

/** Keys that zoom viewports at their cursor or, without one, in their middle. */
export function zoomKeys(viewports) {
  const onEach = (act) => () => {
    for (const each of viewports) act(each);
  };
  const zoom = (factor) =>
    onEach((each) => each.zoomAt(clamp(each.cursor ?? each.middle, ...each.range), factor));
  const reset = onEach((each) => each.reset());
  return {"+": zoom(1.5), "=": zoom(1.5), "-": zoom(1 / 1.5), 0: reset, Escape: reset};
}

/** Keys of a plot; impacts() returns the times for n and p, the next and the previous impact. */
function followKeys(node, viewport, impacts) {
  const now = () => viewport.cursor ?? viewport.range[0];
  const go = (to) => to !== undefined && viewport.point(to);
  const step = (event, sign) => go(now() + sign * (event.shiftKey ? 0.05 : 0.005) * viewport.width);
  listenToKeys(node, {
    ...zoomKeys([viewport]),
    ArrowLeft: (event) => step(event, -1),
    ArrowRight: (event) => step(event, 1),
    Home: () => go(viewport.range[0]),
    End: () => go(viewport.range[1]),
    PageUp: () => viewport.pan(-0.8),
    PageDown: () => viewport.pan(0.8),
    n: () => go(impacts().find((t) => t > now())),
    p: () => go(impacts().findLast((t) => t < now())),
  });
}

/** Names a plot for screen readers; with a `viewport` it is a slider with keys. */
export function makeAccessible(plot, name, moments, viewport) {
  const node = viewport ? plot.node : plot.canvas;
  attributes(node, {"aria-label": name, role: viewport ? "slider" : "img"});
  if (!viewport) return;
  node.tabIndex = 0;
  followKeys(node, viewport, moments);
  const tell = (by) => {
    if (by === "play") return; // not announced 60 times a second
    const now = viewport.cursor ?? viewport.range[0];
    const [least, most] = viewport.full;
    const value = {"aria-valuenow": now, "aria-valuetext": short(now)};
    attributes(node, {"aria-valuemin": least, "aria-valuemax": most, ...value});
  };
  tell();
  viewport.onCursor(tell);
}

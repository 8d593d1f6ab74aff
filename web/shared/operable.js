// What makes a plot one for the keyboard and for a reader of the screen.
import {followKeys} from "./gestures.js";
import {short} from "./numbers.js";

/**
 * Names a plot. One over an Axis takes the keys that move its cursor and zoom; moments(): what n and
 * p go to.
 */
export function operable(plot, name, moments) {
  const node = plot.container ?? plot.canvas;
  node.setAttribute("aria-label", name);
  node.setAttribute("role", plot.axis ? "slider" : "img");
  if (!plot.axis) return;
  const {axis} = plot;
  node.tabIndex = 0;
  followKeys(node, axis, moments);
  const tell = () => {
    const [least, most] = axis.whole;
    const now = axis.cursor ?? axis.view[0];
    node.setAttribute("aria-valuemin", least);
    node.setAttribute("aria-valuemax", most);
    node.setAttribute("aria-valuenow", now);
    node.setAttribute("aria-valuetext", short(now));
  };
  tell();
  axis.onCursor((by) => by !== "play" && tell()); // nobody is told sixty times a second
}

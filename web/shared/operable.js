// What makes a plot one for the keyboard and for a reader of the screen.
import {attributes} from "./dom.js";
import {followKeys} from "./gestures.js";
import {short} from "./numbers.js";

/**
 * Names a plot. One over an Axis, or beside plots over one, takes the keys that move its cursor and
 * zoom; moments(): what n and p go to.
 */
export function operable(plot, name, moments, axis = plot.axis) {
  const {container: node} = plot;
  attributes(node, {"aria-label": name, role: axis ? "slider" : "img"});
  if (!axis) return;
  node.tabIndex = 0;
  followKeys(node, axis, moments);
  const tell = () => {
    const now = axis.cursor ?? axis.view[0];
    attributes(node, {
      "aria-valuemin": axis.whole[0],
      "aria-valuemax": axis.whole[1],
      "aria-valuenow": now,
      "aria-valuetext": short(now),
    });
  };
  tell();
  axis.onCursor((by) => by !== "play" && tell()); // nobody is told sixty times a second
}

// A marker over a plot, moved along its axis by pointer and keys: a range whose thumb is the marker.
import {attributes, element, on} from "./dom.js";

const thumb = 14; // px, its width

export class Marker {
  /** Lies over a canvas. moved(value, dragging) is called when the user moves it. */
  constructor(canvas, moved, about) {
    const node = element("input", {type: "range", className: "marker", ...about});
    const move = (dragging) => () => moved(Number(node.value), dragging);
    on(node, {input: move(true), change: move(false)});
    canvas.after(node);
    Object.assign(this, {node});
  }

  /** Shows a value over the visible range of a frame. */
  show({box, width}, [min, max], value, text) {
    this.range = [min, max];
    Object.assign(this.node, {min, max, step: (max - min) / 500, value});
    attributes(this.node, {"aria-valuetext": text});
    Object.assign(this.node.style, {
      left: `${box.left - thumb / 2}px`,
      width: `${width + thumb}px`,
    });
  }

  /** The value under the pointer. */
  valueUnder({offsetX}) {
    const [min, max] = this.range;
    return min + ((offsetX - thumb / 2) / (this.node.offsetWidth - thumb)) * (max - min);
  }
}

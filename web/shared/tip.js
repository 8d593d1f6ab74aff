// A box beside the pointer that says what is there.
import {button, element} from "./dom.js";

/** It does not take the focus: without it the box would vanish under the click. */
const buttonFor = ({label, run}) =>
  button(label, run, {onmousedown: (event) => event.preventDefault()});

export class Tip {
  constructor(container) {
    this.container = container;
    this.node = element("div", {className: "tip", hidden: true, ariaLive: "polite"});
    container.append(this.node);
  }

  /**
   * rows: [term, value]; left, top: where, in the container; act: {label, run}, a button for those
   * who have no pointer to click with.
   */
  show(left, top, rows, note, act) {
    const entry = ([term, value]) => [element("dt", {}, term), element("dd", {}, value)];
    const list = element("dl", {}, ...rows.flatMap(entry));
    const last = act ? buttonFor(act) : element("p", {}, note);
    this.node.replaceChildren(list, last);
    this.node.hidden = false;
    this.node.classList.toggle("pinned", Boolean(act));
    const {offsetWidth: width, offsetHeight: height} = this.node;
    const gap = 14;
    const room = this.container.clientWidth;
    const beside = left + gap + width <= room ? left + gap : left - gap - width;
    const lowest = this.container.clientHeight - height;
    this.node.style.left = `${Math.max(0, Math.min(beside, room - width))}px`;
    this.node.style.top = `${Math.max(0, Math.min(top - height / 2, lowest))}px`;
  }

  hide() {
    this.node.hidden = true;
  }
}

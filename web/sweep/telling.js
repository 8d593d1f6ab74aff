// What tells of a point of a sweep: a box beside it, that follows the mouse, a finger or the keys.
import {Tip} from "../shared/tip.js";

const zooms = {"+": 1.5, "=": 1.5, "-": 1 / 1.5};

export class Telling {
  /**
   * root: what the box lies in, and what takes the keys; owner: {axes: Axis of what is drawn; leave():
   * nothing is told any longer; choose(): the point that is told of; move(key): goes to another
   * point, false if the key is none of its own}.
   */
  constructor(root, owner) {
    Object.assign(this, {root, owner, tip: new Tip(root)});
    root.addEventListener("pointerleave", (event) => {
      if (event.pointerType === "mouse") owner.leave();
    });
    root.addEventListener("keydown", (event) => {
      if (event.target === root && this.key(event.key)) event.preventDefault();
    });
    root.addEventListener("focusout", (event) => {
      if (!root.contains(event.relatedTarget)) owner.leave();
    });
  }

  key(key) {
    const {axes} = this.owner;
    if (key in zooms) for (const axis of axes) axis.zoomAbout(zooms[key]);
    else if (key === "0") for (const axis of axes) axis.reset();
    else if (key === "Enter") this.owner.choose();
    else if (key === "Escape") this.owner.leave();
    else return this.owner.move(key);
    return true;
  }

  /** Follows the mouse over a panel; tell(): of what is under the cursor. */
  follow(panel, tell) {
    panel.over.addEventListener("pointermove", (event) => {
      const mouse = event.pointerType === "mouse" && !event.buttons;
      if (mouse && panel.axis.cursor !== null) tell();
    });
  }

  /**
   * x, y: the place in a panel, y null in the middle of its height; rows: [term, value]; note: what a
   * click does; open: where one has no pointer, simulates the point, else null.
   */
  show({over, frame}, x, y, rows, note, open) {
    const box = this.root.getBoundingClientRect();
    const {left, top, height} = over.getBoundingClientRect();
    const down = y === null ? height / 2 : frame.py(y) - frame.box.top;
    const act = open && {label: "Simulate this point", run: open};
    const right = frame.px(x) - frame.box.left;
    this.tip.show(left - box.left + right, top - box.top + down, rows, `Click: ${note}`, act);
  }

  hide() {
    this.tip.hide();
    for (const axis of this.owner.axes) if (axis.cursor !== null) axis.point(null);
  }
}

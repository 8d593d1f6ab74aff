// An SVG drawing with the part of the canvas context's interface that the plots use.
import {attributes} from "./dom.js";

const fixed = (v) => Number(v.toFixed(2));
const anchors = {left: "start", center: "middle", right: "end"};
const baselines = {top: "hanging", middle: "central", bottom: "text-after-edge"};

/** An SVG element; numbers are rounded to two decimals. */
function svg(tag, all, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, v] of Object.entries(all))
    attributes(node, {[name]: v?.toFixed ? fixed(v) : v});
  node.append(...children);
  return node;
}

export class SvgPen {
  lineWidth = 1;
  globalAlpha = 1;
  font = "11px sans-serif";
  textAlign = "left";
  textBaseline = "alphabetic";
  dash = [];
  path = "";
  saved = [];

  constructor(width, height) {
    const viewBox = `0 0 ${width} ${height}`;
    this.root = this.group = svg("svg", {width, height, viewBox});
  }

  text() {
    return new XMLSerializer().serializeToString(this.root);
  }

  save() {
    this.saved.push({...this});
  }

  restore() {
    Object.assign(this, this.saved.pop());
  }

  /** Puts what follows into a group, until restore(). */
  within(all) {
    const group = svg("g", all);
    this.group.append(group);
    this.group = group;
  }

  translate(x, y) {
    this.within({transform: `translate(${x} ${y})`});
  }

  rotate(angle) {
    this.within({transform: `rotate(${(angle * 180) / Math.PI})`});
  }

  clip() {
    const id = `clip${this.root.querySelectorAll("clipPath").length}`;
    this.group.append(svg("clipPath", {id}, svg("path", {d: this.path})));
    this.within({"clip-path": `url(#${id})`});
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  beginPath() {
    this.path = "";
  }

  to(command, ...numbers) {
    this.path += command + numbers.map(fixed).join(" ");
  }

  moveTo(x, y) {
    this.to("M", x, y);
  }

  /** Draws a line from the current point; the first call starts the path. */
  lineTo(x, y) {
    this.to(this.path ? "L" : "M", x, y);
  }

  closePath() {
    this.to("z");
  }

  /** A full circle. */
  arc(x, y, r) {
    this.to("M", x + r, y);
    for (const to of [x - r, x + r]) this.to("A", r, r, 0, 0, 1, to, y);
  }

  rect(x, y, width, height) {
    const [right, bottom] = [x + width, y + height];
    this.to("M", x, y, right, y, right, bottom, x, bottom);
    this.closePath();
  }

  /** Adds an element with the current opacity. */
  add(tag, all, ...children) {
    const opacity = this.globalAlpha < 1 ? this.globalAlpha : null;
    this.group.append(svg(tag, {...all, opacity}, ...children));
  }

  stroke() {
    if (!this.path) return;
    this.add("path", {
      d: this.path,
      stroke: this.strokeStyle,
      "stroke-width": this.lineWidth,
      "stroke-dasharray": this.dash.join(" ") || null,
      fill: "none",
    });
  }

  fill() {
    if (this.path) this.add("path", {d: this.path, fill: this.fillStyle});
  }

  fillRect(x, y, width, height) {
    this.add("rect", {x, y, width, height, fill: this.fillStyle});
  }

  /** image: a canvas. */
  drawImage(image, x, y, width, height) {
    const style = {preserveAspectRatio: "none", "image-rendering": "pixelated"};
    this.add("image", {x, y, width, height, ...style, href: image.toDataURL()});
  }

  fillText(text, x, y) {
    // Separate attributes: the content security policy forbids inline styles.
    const [, weight, size, family] = /^(\d+ )?(\d+)px (.*)$/.exec(this.font);
    const font = {"font-weight": weight, "font-size": size, "font-family": family};
    const place = {
      "text-anchor": anchors[this.textAlign],
      "dominant-baseline": baselines[this.textBaseline],
    };
    this.add("text", {x, y, fill: this.fillStyle, ...font, ...place}, text);
  }
}

// Draws into SVG what a canvas' context would draw: as much of it as the plots use.

const escaped = (text) =>
  String(text).replace(
    /[&<>"]/g,
    (c) => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})[c],
  );
const fixed = (v) => String(Number(v.toFixed(2)));
const anchors = {left: "start", center: "middle", right: "end"};
const baselines = {top: "hanging", middle: "central", bottom: "text-after-edge"};

/** A font of a canvas as attributes. */
function fontOf(font) {
  const [, slant, weight, size, family] = /^(italic )?(\d+ )?(\d+)px (.*)$/.exec(font);
  return {
    "font-family": family,
    "font-size": size,
    ...(slant ? {"font-style": "italic"} : {}),
    ...(weight ? {"font-weight": weight.trim()} : {}),
  };
}

export class SvgPen {
  /** background: its colour. */
  constructor(width, height, background) {
    Object.assign(this, {width, height, background});
    Object.assign(this, {fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, globalAlpha: 1});
    Object.assign(this, {font: "11px sans-serif", textAlign: "left", textBaseline: "alphabetic"});
    Object.assign(this, {
      dash: [],
      moves: "",
      clipped: "",
      path: "",
      parts: [],
      clips: [],
      saved: [],
    });
  }

  /** The drawing so far. */
  text() {
    const {width, height, background, clips, parts} = this;
    const size = `width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`;
    const ground = `<rect width="${width}" height="${height}" fill="${background}"/>`;
    const defs = `<defs>${clips.join("")}</defs>`;
    return `<svg xmlns="http://www.w3.org/2000/svg" ${size}>${defs}${ground}${parts.join("")}</svg>`;
  }

  save() {
    const {fillStyle, strokeStyle, lineWidth, globalAlpha, font, textAlign, textBaseline} = this;
    const {dash, moves, clipped} = this;
    const style = {fillStyle, strokeStyle, lineWidth, globalAlpha, font, textAlign, textBaseline};
    this.saved.push({...style, dash, moves, clipped});
  }

  restore() {
    Object.assign(this, this.saved.pop());
  }

  translate(x, y) {
    this.moves += `translate(${fixed(x)} ${fixed(y)})`;
  }

  rotate(angle) {
    this.moves += `rotate(${fixed((angle * 180) / Math.PI)})`;
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  beginPath() {
    this.path = "";
  }

  moveTo(x, y) {
    this.path += `M${fixed(x)} ${fixed(y)}`;
  }

  /** From where the path is; the first one begins it. */
  lineTo(x, y) {
    this.path += `${this.path ? "L" : "M"}${fixed(x)} ${fixed(y)}`;
  }

  closePath() {
    this.path += "z";
  }

  /** A whole circle. */
  arc(x, y, r) {
    const half = (to) => `A${fixed(r)} ${fixed(r)} 0 0 1 ${fixed(to)} ${fixed(y)}`;
    this.path += `M${fixed(x + r)} ${fixed(y)}${half(x - r)}${half(x + r)}`;
  }

  rect(x, y, width, height) {
    this.path += `M${fixed(x)} ${fixed(y)}h${fixed(width)}v${fixed(height)}h${fixed(-width)}z`;
  }

  clip() {
    const id = `clip${this.clips.length}`;
    this.clips.push(`<clipPath id="${id}"><path d="${this.path}"/></clipPath>`);
    this.clipped = id;
  }

  /** An element with what holds for all of them. */
  add(name, attributes, content = "") {
    const all = {
      ...attributes,
      ...(this.globalAlpha < 1 ? {opacity: this.globalAlpha} : {}),
      ...(this.moves ? {transform: this.moves} : {}),
      ...(this.clipped ? {"clip-path": `url(#${this.clipped})`} : {}),
    };
    const list = Object.entries(all).map(([key, value]) => ` ${key}="${escaped(value)}"`);
    this.parts.push(`<${name}${list.join("")}>${content}</${name}>`);
  }

  stroke() {
    const dash = this.dash.length ? {"stroke-dasharray": this.dash.join(" ")} : {};
    const line = {stroke: this.strokeStyle, "stroke-width": this.lineWidth, fill: "none"};
    if (this.path) this.add("path", {d: this.path, ...line, ...dash});
  }

  fill() {
    if (this.path) this.add("path", {d: this.path, fill: this.fillStyle});
  }

  fillRect(x, y, width, height) {
    const place = {x: fixed(x), y: fixed(y), width: fixed(width), height: fixed(height)};
    this.add("rect", {...place, fill: this.fillStyle});
  }

  /** image: a canvas. */
  drawImage(image, x, y, width, height) {
    const place = {x: fixed(x), y: fixed(y), width: fixed(width), height: fixed(height)};
    const style = {preserveAspectRatio: "none", "image-rendering": "pixelated"};
    this.add("image", {...place, ...style, href: image.toDataURL()});
  }

  fillText(text, x, y) {
    const style = {
      ...fontOf(this.font),
      fill: this.fillStyle,
      "text-anchor": anchors[this.textAlign] ?? "start",
      "dominant-baseline": baselines[this.textBaseline] ?? "auto",
    };
    this.add("text", {x: fixed(x), y: fixed(y), ...style}, escaped(text));
  }
}

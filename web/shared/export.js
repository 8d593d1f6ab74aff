// Export of a plot: a dialog with its numbers as a table and CSV, its picture as PNG and SVG.
import {pathRound} from "d3-path";
import {$, attributes, button, save, setTexts, tableOf} from "./dom.js";
import {font} from "./frame.js";
import {drawText, ink} from "./ink.js";
import {joined, short} from "./numbers.js";

const size = {width: 900, height: 424};
const heading = 44; // px above the plot for title and parameters
const rowsShown = 200;
const sharpness = 2; // PNG pixels per CSS pixel

/** Draws a plot below its title and parameters, on a canvas context or an SvgPen. */
function drawPicture(c, plot, {title, caption}) {
  ink(c, "panel");
  c.fillRect(0, 0, size.width, size.height);
  c.font = `600 ${font.replace("11px", "14px")}`;
  ink(c, "text");
  drawText(c, title, 14, 16, "left");
  c.font = font;
  ink(c, "soft");
  drawText(c, caption, 14, 33, "left");
  c.translate(0, heading);
  plot.paintAll(c, size.width, size.height - heading);
}

function asPng(plot, about) {
  const canvas = new OffscreenCanvas(size.width * sharpness, size.height * sharpness);
  const c = canvas.getContext("2d");
  c.scale(sharpness, sharpness);
  drawPicture(c, plot, about);
  return canvas.convertToBlob();
}

function asSvg(plot, about) {
  const pen = new SvgPen();
  drawPicture(pen, plot, about);
  return new Blob([pen.text()], {type: "image/svg+xml"});
}

const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

const written = (value) => (typeof value === "string" ? value : short(value));

function show(plot) {
  const about = plot.about();
  const {title, caption, summary, name} = about;
  const {names, rows} = plot.numbers();
  const cut = `the first ${rowsShown} of ${rows.length} visible rows`;
  const note = joined([caption, rows.length > rowsShown && cut], " · ");
  setTexts({"data-title": title, "data-summary": summary, "data-note": note});
  const shown = rows.slice(0, rowsShown).map((values) => values.map(written));
  $("data-table").replaceChildren(...tableOf(names, shown));
  const csv = () => [names, ...rows].map((row) => `${row.map(quoted).join(",")}\n`);
  const files = {
    csv: () => new Blob(csv(), {type: "text/csv"}),
    svg: () => asSvg(plot, about),
    png: () => asPng(plot, about),
  };
  $("data").onclick = async ({target: {value}}) => {
    if (value in files) save(await files[value](), `${name}.${value}`);
  };
  $("data").showModal();
}

/** {title, notes} of a figure's caption. */
export function captionOf(figure) {
  const own = figure.querySelector("figcaption").cloneNode(true);
  for (const node of own.querySelectorAll(".params, span, button")) node.remove();
  const notes = [...own.querySelectorAll("small")];
  for (const node of notes) node.remove();
  return {title: own.textContent.trim(), notes: notes.map((node) => node.textContent).join(" ")};
}

/** Adds the export button to the caption of a plot. */
export function addExportButton(figure, plot) {
  const name = figure.ariaLabel ?? captionOf(figure).title;
  const menu = button("⋯", () => show(plot), {
    className: "menu",
    title: "numbers, CSV, SVG, PNG",
    ariaLabel: `${name}: data and pictures`,
  });
  figure.querySelector("figcaption").append(menu);
}

// Pictures as SVG.
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

/** An SVG drawing with the part of the canvas context's interface that the plots use. */
class SvgPen {
  root = svg("svg", {...size, viewBox: `0 0 ${size.width} ${size.height}`});
  group = this.root;
  globalAlpha = 1;
  path = pathRound(2);
  saved = [];

  /** Puts what follows into a group, until restore(). */
  within(all) {
    const group = svg("g", all);
    this.group.append(group);
    this.group = group;
  }

  /** Adds an element with the current opacity. */
  add(tag, all, ...children) {
    const opacity = this.globalAlpha < 1 ? this.globalAlpha : null;
    this.group.append(svg(tag, {...all, opacity}, ...children));
  }

  text = () => new XMLSerializer().serializeToString(this.root);
  save = () => this.saved.push({...this});
  restore = () => Object.assign(this, this.saved.pop());
  translate = (x, y) => this.within({transform: `translate(${x} ${y})`});
  rotate = (angle) => this.within({transform: `rotate(${(angle * 180) / Math.PI})`});
  setLineDash = (dash) => Object.assign(this, {dash: dash.join(" ") || null});
  beginPath = () => Object.assign(this, {path: pathRound(2)});
  moveTo = (...place) => this.path.moveTo(...place);
  lineTo = (...place) => this.path.lineTo(...place);
  closePath = () => this.path.closePath();
  rect = (...box) => this.path.rect(...box);
  arc = (...circle) => this.path.arc(...circle);
  fill = () => this.add("path", {d: this.path, fill: this.fillStyle});
  fillRect = (x, y, width, height) => this.add("rect", {x, y, width, height, fill: this.fillStyle});

  clip() {
    const id = `clip${this.root.querySelectorAll("clipPath").length}`;
    this.group.append(svg("clipPath", {id}, svg("path", {d: this.path})));
    this.within({"clip-path": `url(#${id})`});
  }

  stroke() {
    const dashes = {"stroke-width": this.lineWidth, "stroke-dasharray": this.dash};
    this.add("path", {d: this.path, fill: "none", stroke: this.strokeStyle, ...dashes});
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

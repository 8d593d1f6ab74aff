// Export of a plot: a dialog with its numbers as a table and as CSV, and its picture as PNG and SVG
// with title and parameters.
import {$, button, element, save, setTexts, tableOf} from "./dom.js";
import {font} from "./frame.js";
import {drawText, ink} from "./ink.js";
import {short} from "./numbers.js";
import {SvgPen} from "./svg_pen.js";

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

function asSvg(plot, about) {
  const pen = new SvgPen(size.width, size.height);
  drawPicture(pen, plot, about);
  return pen.text();
}

function asPng(plot, about) {
  const [width, height] = [size.width, size.height].map((v) => v * sharpness);
  const canvas = element("canvas", {width, height});
  const c = canvas.getContext("2d");
  c.scale(sharpness, sharpness);
  drawPicture(c, plot, about);
  return new Promise((resolve) => canvas.toBlob(resolve));
}

const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

const written = (value) => (typeof value === "string" ? value : short(value));

const rowsOf = ([first, ...others], most = Infinity) =>
  first.slice(0, most).map((v, i) => [v, ...others.map((column) => column[i])]);

function csv({names, columns}) {
  const lines = [names.map(quoted), ...rowsOf(columns)].map((row) => row.join(","));
  return `${lines.join("\n")}\n`;
}

function show(plot, about) {
  const {title, caption, summary, name} = about;
  const data = plot.numbers();
  const total = data.columns[0].length;
  const cut = total > rowsShown ? `the first ${rowsShown} of ${total} visible rows` : "";
  const note = [caption, cut].filter(Boolean).join(" · ");
  setTexts({"data-title": title, "data-summary": summary, "data-note": note});
  const rows = rowsOf(data.columns, rowsShown).map((values) => values.map(written));
  $("data-table").replaceChildren(...tableOf(data.names, rows));
  const files = {
    csv: () => new Blob([csv(data)], {type: "text/csv"}),
    svg: () => new Blob([asSvg(plot, about)], {type: "image/svg+xml"}),
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

const nameOf = (figure) => figure.ariaLabel ?? captionOf(figure).title;

/** Adds the export button to a plot's caption. about() returns {title, caption, summary, name}. */
export function addExportButton(figure, plot, about) {
  const menu = button("⋯", () => show(plot, about()), {
    className: "menu",
    title: "numbers, CSV, SVG, PNG",
    ariaLabel: `${nameOf(figure)}: data and pictures`,
  });
  figure.querySelector("figcaption").append(menu);
}

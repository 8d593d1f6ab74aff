// What each plot can be taken away as: its numbers as a table and as CSV, its picture as PNG and as
// SVG, with its title and parameters.
import {colour} from "./colours.js";
import {$, element} from "./dom.js";
import {font} from "./frame.js";
import {short} from "./numbers.js";
import {SvgPen} from "./svg_pen.js";
import {save} from "./take_away.js";

const size = {width: 900, height: 380};
const heading = 44; // px above the plot
const rowsShown = 200;
const sharpness = 2; // pixels of a PNG for one of the plot

/** A plot with its title above it and its parameters under that, as SVG. */
function drawing(plot, {title, caption}) {
  const pen = new SvgPen(size.width, size.height + heading, colour("panel"));
  pen.fillStyle = colour("text");
  pen.font = `600 ${font.replace("11px", "14px")}`;
  pen.fillText(title, 14, 20);
  pen.font = font;
  pen.fillStyle = colour("soft");
  pen.fillText(caption, 14, 37);
  pen.translate(0, heading);
  plot.paintAll(pen, size.width, size.height);
  return pen.text();
}

/** The same as a picture. */
async function picture(svg) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const [width, height] = [size.width, size.height + heading].map((v) => v * sharpness);
  const canvas = Object.assign(document.createElement("canvas"), {width, height});
  canvas.getContext("2d").drawImage(image, 0, 0, width, height);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

const written = (value) => (typeof value === "string" ? value : short(value));

/** Rows of numbers with their names above. */
function csv({names, columns}) {
  const rows = columns[0].length;
  const lines = [names.map(quoted).join(",")];
  for (let i = 0; i < rows; ++i) lines.push(columns.map((column) => column[i] ?? "").join(","));
  return `${lines.join("\n")}\n`;
}

function table({names, columns}) {
  const row = (tag, cells) =>
    element("tr", {}, ...cells.map((textContent) => element(tag, {textContent})));
  const rows = Math.min(columns[0].length, rowsShown);
  const body = Array.from({length: rows}, (_, i) =>
    row(
      "td",
      columns.map((column) => written(column[i])),
    ),
  );
  const head = element("thead", {}, row("th", names));
  return element("table", {className: "table"}, head, element("tbody", {}, ...body));
}

/** Shows the numbers of a plot, and in what forms they can be taken away. */
function show(plot, about) {
  const {title, caption, summary, name} = about;
  const data = plot.numbers();
  const total = data.columns[0].length;
  const said =
    total > rowsShown ? `the first ${rowsShown} of ${total} rows of what is in view` : "";
  const button = (text, make) =>
    element("button", {type: "button", textContent: text, onclick: make});
  const buttons = [
    button("CSV", () => save(new Blob([csv(data)], {type: "text/csv"}), `${name}.csv`)),
    button("SVG", () =>
      save(new Blob([drawing(plot, about)], {type: "image/svg+xml"}), `${name}.svg`),
    ),
    button("PNG", async () => save(await picture(drawing(plot, about)), `${name}.png`)),
  ];
  const close = button("Close", () => $("data").close());
  const scroll = element("div", {className: "scroll", tabIndex: 0}, table(data));
  $("data").replaceChildren(
    element("h2", {textContent: title, id: "data-title"}),
    element("p", {textContent: summary}),
    element("p", {className: "note", textContent: [caption, said].filter(Boolean).join(" · ")}),
    element("div", {className: "buttons"}, ...buttons, close),
    scroll,
  );
  $("data").showModal();
}

const nameOf = (figure) =>
  figure.ariaLabel ?? figure.querySelector("figcaption b, figcaption").textContent;

/** Adds the menu to a plot's caption. about(): {title, caption, summary, name}. */
export function addMenu(figure, plot, about) {
  const button = element("button", {
    type: "button",
    className: "menu",
    textContent: "⋯",
    title: "its numbers, CSV, SVG, PNG",
    ariaLabel: `${nameOf(figure)}: data and pictures`,
    onclick: () => show(plot, about()),
  });
  figure.querySelector("figcaption").append(button);
}

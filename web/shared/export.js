// Saving files, copying texts, and a request in forms to be pasted elsewhere.
import {absoluteUrl, asCurl} from "./api.js";
import {$, button, element, tableOf} from "./dom.js";
import {font} from "./frame.js";
import {colour, ink} from "./ink.js";
import {short} from "./numbers.js";
import {SvgPen} from "./svg_pen.js";

/** Saves a blob under a file name. */
export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Copies a text and reports it; without permission to copy, shows the text. */
export async function copy(text, say) {
  try {
    await navigator.clipboard.writeText(text);
    say("copied");
  } catch {
    say(text);
  }
}

/** A Python program for the request that needs only the standard library. */
const asPython = (path, fields) => `import json, urllib.request

request = json.loads(${JSON.stringify(JSON.stringify(fields))})
url = ${JSON.stringify(absoluteUrl(path))}
body = json.dumps(request).encode()
head = {"Content-Type": "application/json"}
with urllib.request.urlopen(urllib.request.Request(url, body, head)) as answer:
    result = json.load(answer)
print(result["exponents"].get("qr", {}).get("final"), result["regime"]["type"])
`;

/** A frame for another page, of a site that the service allows to embed it. */
function asFrame() {
  const address = new URL(location.href);
  address.searchParams.set("embed", "1");
  address.hash = "";
  return `<iframe src="${address}" width="800" height="600" allow="autoplay"></iframe>`;
}

/** Functions that return the text, by form. request() returns the fields of the request. */
export const formsOf = (path, request) => ({
  link: () => location.href,
  embed: asFrame,
  curl: () => asCurl({path, body: request()}),
  Python: () => asPython(path, {...request(), include: ["impacts", "exponents", "regime"]}),
  JSON: () => JSON.stringify(request(), null, 2),
});

// Export of a plot: a dialog with its numbers as a table and as CSV, and its picture as PNG and SVG
// with title and parameters.
const size = {width: 900, height: 424};
const heading = 44; // px above the plot for title and parameters
const rowsShown = 200;
const sharpness = 2; // PNG pixels per CSS pixel

/** A plot below its title and parameters, as SVG. */
function drawing(plot, {title, caption}) {
  const pen = new SvgPen(size.width, size.height, colour("panel"));
  pen.font = `600 ${font.replace("11px", "14px")}`;
  ink(pen, "text");
  pen.fillText(title, 14, 20);
  pen.font = font;
  ink(pen, "soft");
  pen.fillText(caption, 14, 37);
  pen.translate(0, heading);
  plot.paintAll(pen, size.width, size.height - heading);
  return pen.text();
}

/** The SVG rendered as a PNG blob. */
async function picture(svg) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const [width, height] = [size.width, size.height].map((v) => v * sharpness);
  const canvas = element("canvas", {width, height});
  canvas.getContext("2d").drawImage(image, 0, 0, width, height);
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

function table({names, columns}) {
  const rows = rowsOf(columns, rowsShown).map((values) => values.map(written));
  return element("table", {className: "table"}, ...tableOf(names, rows));
}

function show(plot, about) {
  const {title, caption, summary, name} = about;
  const data = plot.numbers();
  const total = data.columns[0].length;
  const said = total > rowsShown ? `the first ${rowsShown} of ${total} visible rows` : "";
  const svg = () => drawing(plot, about);
  const saveText = (text, type, ending) => save(new Blob([text], {type}), `${name}.${ending}`);
  const dialog = $("data");
  dialog.replaceChildren(
    element("h2", {id: "data-title"}, title),
    element("p", {}, summary),
    element("p", {className: "note"}, [caption, said].filter(Boolean).join(" · ")),
    element(
      "div",
      {className: "buttons"},
      button("CSV", () => saveText(csv(data), "text/csv", "csv")),
      button("SVG", () => saveText(svg(), "image/svg+xml", "svg")),
      button("PNG", async () => save(await picture(svg()), `${name}.png`)),
      button("Close", () => dialog.close()),
    ),
    element("div", {className: "scroll", tabIndex: 0}, table(data)),
  );
  dialog.showModal();
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

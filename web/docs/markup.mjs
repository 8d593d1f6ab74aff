// HTML as text: the build has no document.

class Markup {
  constructor(text) {
    this.text = text;
  }
}

const entities = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"};
const escaped = (text) => String(text).replace(/[&<>"]/g, (character) => entities[character]);

/** HTML of texts and elements in sequence. */
export const html = (nodes) =>
  nodes.map((node) => (node instanceof Markup ? node.text : escaped(node))).join("");

/** An element. Attributes that are null or undefined are omitted; children are texts or elements. */
export function element(name, attributes = {}, ...children) {
  const written = Object.entries(attributes)
    .filter(([, value]) => value != null)
    .map(([key, value]) => ` ${key}="${escaped(value)}"`);
  return new Markup(`<${name}${written.join("")}>${html(children)}</${name}>`);
}

export const code = (text) => element("code", {}, text);
export const small = (text) => element("small", {}, text);

/** A <details> element. summary: nodes. */
export const fold = (summary, nodes, attributes) =>
  element("details", attributes, element("summary", {}, ...summary), ...nodes);

/** One that docs.js fills, when it is opened, with a copy of the content of the element `id`. */
export const copyFold = (summary, id) => fold(summary, [], {"data-copy": id});

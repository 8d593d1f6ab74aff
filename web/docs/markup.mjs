// HTML as text: the build has no document.

/** HTML; other texts are escaped where they are inserted. */
class Markup extends String {}

const entities = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"};

function written(node) {
  if (Array.isArray(node)) return node.map(written).join("");
  return node instanceof Markup ? node : String(node).replace(/[&<>"]/g, (c) => entities[c]);
}

/** Tag of templates, whose values are texts, HTML, and lists of both. */
export const html = (raw, ...values) => new Markup(String.raw({raw}, ...values.map(written)));

export const fold = (summary, content) =>
  html`<details><summary>${summary}</summary>${content}</details>`;

/** A fold that docs.js fills, when it is opened, with a copy of the content of the element `id`. */
export const copyFold = (summary, id) =>
  html`<details data-copy="${id}"><summary>${summary}</summary></details>`;

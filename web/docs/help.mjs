// The pages /help and /help/NAME, made from the documents in docs/ at build time.
import {Marked} from "marked";

/** Documents in the order of the list on each page; the first one is also /help. */
const names = [
  "tutorial",
  "page",
  "choosing-an-absorber",
  "attractors",
  "measurements",
  "physics",
  "numerics",
  "paper",
  "api",
  "operations",
];

/** The anchor of a heading, as code hosts write it. */
const anchorOf = (text) =>
  text
    .toLowerCase()
    .replace(/<[^>]*>|&#?\w+;/g, "")
    .replace(/[^\p{L}\p{N}_ -]/gu, "")
    .replaceAll(" ", "-");

/** Address of a link's target; null if it is not served. to: prefix of the documents' paths. */
function addressOf(href, to) {
  const [, name, anchor = ""] = href.match(/^([\w-]*)(?:\.md)?(#.*)?$/) ?? [];
  if (name === "") return anchor;
  return names.includes(name) ? `${to}${name}${anchor}` : null;
}

const titleOf = (markdown) => markdown.match(/^# (.*)$/m)[1];

/** A document as HTML; links show titles. to, up: prefixes of paths to documents and to the page. */
function bodyOf(markdown, titles, to, up) {
  const renderer = {
    heading({tokens, depth}) {
      const text = this.parser.parseInline(tokens);
      return `<h${depth} id="${anchorOf(text)}">${text}</h${depth}>\n`;
    },
    link({href, tokens}) {
      const written = this.parser.parseInline(tokens);
      const text = titles.get(written.replace(/\.md$/, "")) ?? written;
      const address = href.startsWith("http") ? href : addressOf(href, to);
      return address === null ? text : `<a href="${address}">${text}</a>`;
    },
    image: ({href, text}) =>
      href.endsWith(".svg") ? `<img src="${up}${href.split("/").at(-1)}" alt="${text}">` : "",
    html: () => "", // comments
  };
  return new Marked({renderer}).parse(markdown);
}

/** [path, HTML] of each page. read(name) returns a document; {{names}} of the template are filled. */
export function helpPages(template, read) {
  const documents = new Map(names.map((name) => [name, read(name)]));
  const titles = new Map(names.map((name) => [name, titleOf(documents.get(name))]));
  const page = (path, name, to, up) => {
    const entries = names.map((other) => {
      const current = other === name ? 'aria-current="page"' : "";
      return `<li><a href="${to}${other}" ${current}>${titles.get(other)}</a></li>`;
    });
    const parts = {
      up,
      title: titles.get(name),
      contents: entries.join(""),
      body: bodyOf(documents.get(name), titles, to, up),
    };
    return [path, template.replace(/\{\{(\w+)\}\}/g, (_, part) => parts[part])];
  };
  return [
    page("/help", names[0], "help/", ""),
    ...names.map((name) => page(`/help/${name}`, name, "", "../")),
  ];
}

// Reads from a Markdown document: marked tables and transcripts, links, and anchors of headings.
import {readFile} from "node:fs/promises";

export const root = new URL("../../", import.meta.url);

export const read = (name) => readFile(new URL(name, root), "utf8");

/** Contents of the code spans of a text. */
export const codes = (text) => [...text.matchAll(/`([^`]+)`/g)].map((found) => found[1]);

const cellsOf = (line) =>
  line
    .split(/(?<!\\)\|/)
    .slice(1, -1)
    .map((cell) => cell.trim());

/**
 * {argument, lines} for each marker `<!-- kind -->` or `<!-- kind: argument -->`. lines: all lines
 * after the marker.
 */
function marked(markdown, kind) {
  const marker = new RegExp(`^<!-- ${kind}(?:: (.*?))? ?-->$`);
  const lines = markdown.split("\n");
  return lines.flatMap((line, at) => {
    const found = line.match(marker);
    return found ? [{argument: (found[1] ?? "").trim(), lines: lines.slice(at + 1)}] : [];
  });
}

/** The marked tables: {argument, rows}, each row an object by the names of its columns. */
export const tables = (markdown, kind) =>
  marked(markdown, kind).map(({argument, lines}) => {
    const end = lines.findIndex((line) => !line.startsWith("|"));
    const [header, , ...rest] = end < 0 ? lines : lines.slice(0, end);
    if (!header) throw new Error(`no table after <!-- ${kind}: ${argument} -->`);
    const names = cellsOf(header);
    const rows = rest.map((line) => {
      const cells = cellsOf(line);
      if (cells.length !== names.length) throw new Error(`${cells.length} cells in ${line}`);
      return Object.fromEntries(names.map((name, k) => [name, cells[k]]));
    });
    return {argument, rows};
  });

/**
 * The marked transcripts: lists of {command, output}. A line that starts with a space continues
 * the command, unless its output has begun.
 */
export const transcripts = (markdown) =>
  marked(markdown, "run").map(({lines}) => {
    if (lines[0] !== "```console") throw new Error("no ```console after <!-- run -->");
    const steps = [];
    for (const line of lines.slice(1, lines.indexOf("```"))) {
      if (line.startsWith("$ ")) steps.push({command: line.slice(2), output: ""});
      else if (line.startsWith(" ") && !steps.at(-1).output) steps.at(-1).command += `\n${line}`;
      else steps.at(-1).output += `${line}\n`;
    }
    return steps;
  });

/** Text between `<!-- name: begin -->` and `<!-- name: end -->`. */
export function between(markdown, name) {
  const begin = `<!-- ${name}: begin -->\n`;
  const from = markdown.indexOf(begin);
  const to = markdown.indexOf(`<!-- ${name}: end -->`);
  if (from < 0 || to < from) throw new Error(`no text between the markers of ${name}`);
  return markdown.slice(from + begin.length, to);
}

export const withoutBlocks = (markdown) => markdown.replace(/^```[\s\S]*?^```$/gm, "");

/** Targets of the links and images of a document. */
export const links = (markdown) =>
  [...withoutBlocks(markdown).matchAll(/\]\(([^)\s]+)\)/g)].map((found) => found[1]);

/** The anchor of a heading, as GitHub makes it for distinct headings. */
export const anchorOf = (title) =>
  title
    .toLowerCase()
    .replace(/[^\p{L}\p{N} _-]/gu, "")
    .replaceAll(" ", "-");

export const anchors = (markdown) =>
  [...withoutBlocks(markdown).matchAll(/^#+ (.*)$/gm)].map((found) => anchorOf(found[1]));

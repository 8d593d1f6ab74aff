#!/usr/bin/env -S node
// bundle.mjs OPENAPI.json OUTPUT.cpp: bundles the pages with esbuild and writes each file to
// OUTPUT.cpp twice: as it is (scripts and style sheets minified), and compressed. The generated
// table maps request paths to contents. Scripts, style sheets and SVG images lie in a folder named
// by a hash of their contents, so browsers can cache them indefinitely.
import {createHash} from "node:crypto";
import {readdirSync, readFileSync, writeFileSync} from "node:fs";
import {dirname, join, relative} from "node:path";
import {fileURLToPath} from "node:url";
import {gzipSync} from "node:zlib";
import {buildSync} from "esbuild";
import {helpPages} from "./docs/help.mjs";
import {docsPage} from "./docs/page.mjs";

const web = dirname(fileURLToPath(import.meta.url));
const [openapiPath, output] = process.argv.slice(2);
const read = (name) => readFileSync(join(web, name), "utf8");

/** Bundles a script and a style sheet, with the modules imported dynamically: [name, text] each. */
const bundled = (...entryPoints) =>
  buildSync({
    absWorkingDir: web,
    entryPoints,
    outbase: ".",
    outdir: "built",
    bundle: true,
    splitting: true,
    minify: true,
    format: "esm",
    target: "es2022",
    write: false,
  }).outputFiles.map(({path, text}) => [relative(join(web, "built"), path), text]);

// Each page is bundled by itself, so that it loads no module for the sake of the other.
const files = [
  ...bundled("main.js", "style.css"),
  ...bundled("docs/docs.js", "docs/docs.css"),
  ...readdirSync(web)
    .filter((name) => name.endsWith(".svg"))
    .map((name) => [name, read(name)]),
];
const hash = createHash("sha256").update(files.flat().join("\0")).digest("hex").slice(0, 12);

/** Adds the folder to the names of files, which the pages write in quotes, maybe after "../". */
const page = (html) =>
  ["", "../"].reduce(
    (text, up) =>
      files.reduce((t, [name]) => t.replaceAll(`"${up}${name}"`, `"${up}${hash}/${name}"`), text),
    html,
  );
const documentOf = (name) => read(`../docs/${name}.md`);
const servedFiles = [
  ["/", page(read("index.html"))],
  ["/docs", page(docsPage(read("docs.html"), openapiPath))],
  ...helpPages(read("help.html"), documentOf).map(([path, html]) => [path, page(html)]),
  ...files.map(([name, text]) => [`/${hash}/${name}`, text]),
];

/** Bytes as a string literal of C++ (without trigraphs), faster to compile than a list of numbers. */
function literal(bytes) {
  const written = (byte) =>
    byte < 32 || byte > 126 || `"?\\`.includes(String.fromCharCode(byte))
      ? `\\${byte.toString(8).padStart(3, "0")}`
      : String.fromCharCode(byte);
  return `"${Array.from(bytes, written).join("")}"sv`;
}
const table = servedFiles.map(([path, text]) => {
  const contents = [Buffer.from(text), gzipSync(text, {level: 9})].map(literal);
  return `    {"${path}", ${contents.join(", ")}},`;
});

writeFileSync(
  output,
  `#include "http/page.hpp"

namespace vines::http {

namespace {

using namespace std::literals;

// clang warns of literals longer than every compiler must support.
#pragma GCC diagnostic ignored "-Woverlength-strings"

constexpr Asset table[] = {
${table.join("\n")}
};

}  // namespace

std::span<const Asset> assets() { return table; }

}  // namespace vines::http
`,
);

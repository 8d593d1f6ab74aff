#!/usr/bin/env -S node
// bundle.mjs OUTPUT.cpp: bundles the pages with esbuild and writes each file to OUTPUT.cpp twice:
// minified, and minified and compressed. The generated table maps request paths to contents.
// Scripts, style sheets and SVG images lie in a folder named by a hash of their contents, so
// browsers can cache them indefinitely.
import {execFileSync} from "node:child_process";
import {createHash} from "node:crypto";
import {readdirSync, readFileSync, unlinkSync, writeFileSync} from "node:fs";
import {dirname, join, relative} from "node:path";
import {fileURLToPath} from "node:url";
import {buildSync} from "esbuild";
import {minify} from "terser";

const web = dirname(fileURLToPath(import.meta.url));

/** Source file of each page by request path. */
const pages = {"/": "index.html", "/docs": "docs.html"};

/** One script and one style sheet for each page. */
const {outputFiles} = buildSync({
  absWorkingDir: web,
  entryPoints: ["main.js", "style.css", "docs/docs.js", "docs/docs.css"],
  outbase: ".",
  outdir: "built",
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  write: false,
});
/** Scripts minified again by terser, which saves 4 % more than esbuild alone. */
const minifyScript = async (path, text) =>
  path.endsWith(".js")
    ? (await minify(text, {module: true, ecma: 2022, compress: {passes: 3}})).code
    : text;
const bundledFiles = outputFiles.map(async ({path, text}) => [
  relative(join(web, "built"), path),
  await minifyScript(path, text),
]);
const svgFiles = readdirSync(web).filter((name) => name.endsWith(".svg"));
const files = [
  ...(await Promise.all(bundledFiles)),
  ...svgFiles.map((name) => [name, readFileSync(join(web, name), "utf8")]),
];
const hash = createHash("sha256").update(files.flat().join("\0")).digest("hex").slice(0, 12);
/** Line breaks before block elements, which have no effect. The pages contain no text in <pre>. */
const beforeBlock =
  />\n(?=<\/?(?:body|details|div|dl|fig\w+|footer|form|head|header|h\d|link|main|meta|nav|p|script|section|summary|title|ul)\b)/g;
const page = (name) =>
  readFileSync(join(web, name), "utf8")
    .replace(/(href|src)="([^":#]+\.(?:js|css|svg))"/g, `$1="${hash}/$2"`)
    .replace(/\n\s*/g, "\n")
    .replace(beforeBlock, ">");
const servedFiles = [
  ...Object.entries(pages).map(([path, name]) => [path, page(name)]),
  ...files.map(([name, text]) => [`/${hash}/${name}`, text]),
];

/** Compresses with the program zopfli: 4 % smaller than with zlib. */
function gzip(input) {
  const file = `${process.argv[2]}.plain`; // zopfli reads files only
  writeFileSync(file, input);
  const compressed = execFileSync("zopfli", ["-c", file]);
  unlinkSync(file);
  return compressed;
}
const bytes = (buffer) => [...buffer].join(",");
const arrays = [];
const table = servedFiles.map(([path, text], n) => {
  const plain = Buffer.from(text);
  arrays.push(
    `const unsigned char file${n}[] = {${bytes(plain)}};`,
    `const unsigned char gzipped${n}[] = {${bytes(gzip(plain))}};`,
  );
  return `    {"${path}", view(file${n}), view(gzipped${n})},`;
});

writeFileSync(
  process.argv[2],
  `#include "http/page.hpp"

namespace vines::http {

namespace {

template <std::size_t size>
std::string_view view(const unsigned char (&bytes)[size]) {
    return {reinterpret_cast<const char*>(bytes), size};
}

${arrays.join("\n")}
const Asset table[] = {
${table.join("\n")}
};

}  // namespace

std::span<const Asset> assets() { return table; }

}  // namespace vines::http
`,
);

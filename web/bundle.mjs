#!/usr/bin/env -S node
// bundle.mjs OUTPUT.cpp: bundles the pages with esbuild and writes their files as C++, both
// minified and compressed. The table maps request paths to files. Scripts, styles and drawings
// lie under a folder named by a hash of their content, so browsers can cache them indefinitely.
import {execFileSync} from "node:child_process";
import {createHash} from "node:crypto";
import {readdirSync, readFileSync, unlinkSync, writeFileSync} from "node:fs";
import {dirname, join, relative} from "node:path";
import {fileURLToPath} from "node:url";
import {buildSync} from "esbuild";
import {minify} from "terser";

const web = dirname(fileURLToPath(import.meta.url));

/** File by request path. */
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
const smallest = async (path, text) =>
  path.endsWith(".js")
    ? (await minify(text, {module: true, ecma: 2022, compress: {passes: 3}})).code
    : text;
const built = outputFiles.map(async ({path, text}) => [
  relative(join(web, "built"), path),
  await smallest(path, text),
]);
const drawings = readdirSync(web).filter((name) => name.endsWith(".svg"));
const files = [
  ...(await Promise.all(built)),
  ...drawings.map((name) => [name, readFileSync(join(web, name), "utf8")]),
];
const hash = createHash("sha256").update(files.flat().join("\0")).digest("hex").slice(0, 12);
/** Invisible white space before block elements. */
const beforeBlock =
  />\n(?=<\/?(?:body|details|div|dl|fig\w+|footer|form|head|header|h\d|link|main|meta|nav|p|script|section|summary|title|ul)\b)/g;
const page = (name) =>
  readFileSync(join(web, name), "utf8")
    .replace(/(href|src)="([^":#]+\.(?:js|css|svg))"/g, `$1="${hash}/$2"`)
    .replace(/\n\s*/g, "\n")
    .replace(beforeBlock, ">");
const requested = [
  ...Object.entries(pages).map(([path, name]) => [path, page(name)]),
  ...files.map(([name, text]) => [`/${hash}/${name}`, text]),
];

/** Compresses with zopfli: 4 % smaller than zlib. */
function gzip(input) {
  const file = `${process.argv[2]}.plain`; // zopfli reads files only
  writeFileSync(file, input);
  const compressed = execFileSync("zopfli", ["-c", file]);
  unlinkSync(file);
  return compressed;
}
const bytes = (buffer) => [...buffer].join(",");
const arrays = [];
const table = requested.map(([path, text], n) => {
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

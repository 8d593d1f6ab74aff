#!/usr/bin/env -S node
// embed.mjs OUTPUT.cpp: writes the page's files as a C++ source, each under the path it is requested
// by: minified, compressed, and all but index.html under a folder that is named by their content, so
// that a browser keeps them as long as they are the same.
import {createHash} from "node:crypto";
import {readdirSync, readFileSync, writeFileSync} from "node:fs";
import {dirname, join, relative} from "node:path";
import {fileURLToPath} from "node:url";
import {gzipSync} from "node:zlib";
import {buildSync} from "esbuild";

const web = dirname(fileURLToPath(import.meta.url));

/** Scripts and style sheets: one of each, and one for each tab that is loaded later. */
const {outputFiles} = buildSync({
  absWorkingDir: web,
  entryPoints: ["main.js", "style.css"],
  outdir: "built",
  bundle: true,
  splitting: true,
  minify: true,
  format: "esm",
  target: "es2022",
  write: false,
});
const drawings = readdirSync(web).filter((name) => name.endsWith(".svg"));
const files = [
  ...outputFiles.map(({path, text}) => [relative(join(web, "built"), path), text]),
  ...drawings.map((name) => [name, readFileSync(join(web, name), "utf8")]),
];
const hash = createHash("sha256").update(files.flat().join("\0")).digest("hex").slice(0, 12);
const index = readFileSync(join(web, "index.html"), "utf8")
  .replace(/(href|src)="([^":#]+\.(?:js|css|svg))"/g, `$1="${hash}/$2"`)
  .replace(/\n\s*/g, "\n");

const bytes = (buffer) => [...buffer].join(",");
const arrays = [];
const table = [["", index], ...files].map(([name, text], n) => {
  const plain = Buffer.from(text);
  const gzipped = gzipSync(plain, {level: 9});
  arrays.push(
    `const unsigned char file${n}[] = {${bytes(plain)}};`,
    `const unsigned char gzipped${n}[] = {${bytes(gzipped)}};`,
  );
  const path = name ? `/${hash}/${name}` : "/";
  return `    {"${path}", view(file${n}), view(gzipped${n})},`;
});

writeFileSync(
  process.argv[2],
  `#include "http/assets.hpp"

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

// Plots of answers, in the terminal and as SVG.
import assert from "node:assert/strict";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {hasComputed, parsed, run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-plots-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);

const esc = "\u001b";
const plain = {LC_ALL: "", LC_CTYPE: "", LANG: "", NO_COLOR: "", TERM: "xterm"};

async function told(args, {env = {}, ...options} = {}) {
  const {code, out, errors} = await run(args, {...options, env: {...plain, ...env}});
  assert.equal(code, 0, `${args.join(" ")}: ${errors}`);
  return out;
}

const orbit = ["simulate", "-p", "preset=fig11", "-p", "tau_end=60"];
const sweep = ["sweep", "-a", "b=0.008:0.03:12", "-p", "cycles=60", "-p", "section=impact"];

test("a run is drawn with its sentence, its walls and its time", async () => {
  const out = await told([...orbit, "--plot"]);
  const lines = out.trimEnd().split("\n");
  assert.match(lines[0], /^b = 15 mm: regime \w+, (regular|chaotic|not_decided)/);
  for (const label of ["x (mm)", "y - x (mm)", "exponents (qr)"]) assert.ok(lines.includes(label));
  assert.ok(out.includes("┄┄┄"), "a wall, or zero");
  assert.match(out, /[\u2801-\u28ff]/);
  assert.match(lines.at(-2), /^ +0 +20 +40 +60$|^ +0 +\d+( +\d+)+$/);
  assert.equal(lines.at(-1).trim(), "tau");
  for (const line of lines) assert.ok([...line].length < 80, line);
});

test("the curve of a run goes through its values", async () => {
  const {series} = JSON.parse(await told([...orbit, "-p", "include=series"]));
  const out = await told([...orbit, "-p", "include=series", "--plot"]);
  const rows = out.split("\n");
  const first = rows.indexOf("x (mm)") + 1;
  const frame = rows.slice(first, rows.indexOf("y - x (mm)")).map((row) => [...row].slice(9));
  const width = 80 - 1 - 9;
  const x = series.x.map((value) => 1000 * value);
  const [low, high] = [Math.min(...x), Math.max(...x)];
  const margin = 0.06 * (high - low);
  const dots = (cell) => (cell && cell !== " " ? cell.codePointAt(0) - 0x2800 : 0);
  const bit = [
    [0x01, 0x02, 0x04, 0x40],
    [0x08, 0x10, 0x20, 0x80],
  ];
  series.tau.forEach((tau, i) => {
    const across = Math.round((tau / series.tau.at(-1)) * (2 * width - 1));
    const share = (high + margin - x[i]) / (high - low + 2 * margin);
    const down = Math.round(share * (4 * frame.length - 1));
    const cell = frame[down >> 2][across >> 1];
    assert.ok(dots(cell) & bit[across & 1][down & 3], `tau = ${tau}: ${cell}`);
  });
});

test("a sweep is drawn by verdict and by regime, as its lines are by vines plot", async () => {
  const drawn = await told([...sweep, "--plot"]);
  const lines = await told(sweep);
  assert.equal(await told(["plot"], {input: lines}), drawn);
  writeFileSync(at("sweep.ndjson"), lines);
  assert.equal(await told(["plot", at("sweep.ndjson")]), drawn);
  for (const label of ["x in the section (mm)", "lambda1, by verdict", "max |x| (mm), by regime"])
    assert.ok(drawn.includes(label), label);
  const points = parsed(lines).filter(({type}) => type === "point");
  for (const word of points.flatMap(({verdict, regime}) => [verdict, regime]))
    assert.match(drawn, new RegExp(`  +${word}$`, "m"));
  assert.match(drawn, / b \(mm\)\n$/);
});

test("SVG goes into a file of that name, with every point of a sweep", async () => {
  await told([...sweep, "--plot", "-o", at("sweep.svg")]);
  const svg = readFileSync(at("sweep.svg"), "utf8");
  assert.ok(svg.startsWith("<svg ") && svg.endsWith("</svg>\n"));
  const points = parsed(await told(sweep)).filter(({type}) => type === "point");
  const states = points.reduce((sum, {section}) => sum + section.x.length, 0);
  const circles = svg.match(/<circle /g).length;
  assert.ok(circles >= states + 3 * points.length, `${circles} of ${states} and more`);
  await told(["plot", "-", "-o", at("run.svg")], {input: await told(orbit)});
  assert.match(readFileSync(at("run.svg"), "utf8"), />lambda1</);
});

test("a terminal without UTF-8 is drawn to in ASCII, one with colours in them unless unwanted", async () => {
  const ascii = await told([...orbit, "--plot"], {env: {LC_ALL: "C"}});
  assert.match(ascii, /^[\n -~]+$/);
  assert.match(ascii, /\*{2}/);
  assert.ok(!(await told([...orbit, "--plot"])).includes(esc));
  const shell = `script -qec "stty cols 100; $VINES ${orbit.join(" ")} --plot" /dev/null </dev/null`;
  const coloured = await told([], {shell});
  assert.ok(coloured.includes(`${esc}[38;5;`));
  const seen = coloured.replaceAll(new RegExp(`${esc}\\[[\\d;]*m`, "g"), "").split("\n");
  assert.ok(seen.some((line) => [...line].length > 80));
  assert.ok(!(await told([], {shell, env: {NO_COLOR: "1"}})).includes(esc));
});

test("what cannot be drawn is said before anything is computed", async () => {
  const map = ["sweep", "-a", "b=0.01:0.03:900", "-a", "R=0.5:0.9:900", "-p", "cycles=1000"];
  for (const [args, input, code, said] of [
    [[...map, "--plot"], "", 2, /one axis; of more the page draws a map/],
    [[...sweep, "--plot", "--resume"], "", 2, /--resume completes lines of JSON/],
    [["plot"], "{}", 1, /nothing to draw/],
    [["plot"], "[]", 2, /object/],
    [["plot"], '{"type":"point","index":0}\n', 1, /without its first line/],
    [["plot", at("none")], "", 1, /none/],
    [[...orbit, "-p", "include=energy", "--plot"], "", 1, /nothing to draw/],
  ]) {
    const ended = await run(args, {input});
    assert.equal(ended.code, code, args.join(" "));
    assert.match(ended.errors, said);
    assert.equal(ended.out, "");
  }
});

test("a sweep that is stopped is drawn as far as it came", async () => {
  const long = ["sweep", "-a", "b=0.01:0.03:100000", "-p", "cycles=100", "--plot"];
  const {code, out, errors} = await run(long, {signal: "SIGINT", until: hasComputed(0.5)});
  assert.equal(code, 130);
  assert.match(errors, /stopped after \d+ of 100000 points/);
  assert.match(out, /lambda1, by verdict/);
});

// Plots of answers, in the terminal and as SVG.
import assert from "node:assert/strict";
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {hasComputed, parsed, run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-plots-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);

const esc = "\u001b";
const plain = {LC_ALL: "", LC_CTYPE: "", LANG: "", NO_COLOR: "", TERM: "xterm"};

async function outputOf(args, {env = {}, ...options} = {}) {
  const {code, out, errors} = await run(args, {...options, env: {...plain, ...env}});
  assert.equal(code, 0, `${args.join(" ")}: ${errors}`);
  return out;
}

const orbit = ["simulate", "-p", "preset=fig11", "-p", "tau_end=60"];
const sweep = ["sweep", "-a", "b=0.008:0.03:12", "-p", "cycles=60", "-p", "section=impact"];

test("a run's plot has its title, its walls and its time axis", async () => {
  const out = await outputOf([...orbit, "--plot"]);
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
  const {series} = JSON.parse(await outputOf([...orbit, "-p", "include=series"]));
  const out = await outputOf([...orbit, "-p", "include=series", "--plot"]);
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

test("a sweep is drawn by verdict and by regime, the same with --plot as with vines plot", async () => {
  const drawn = await outputOf([...sweep, "--plot"]);
  const lines = await outputOf(sweep);
  assert.equal(await outputOf(["plot"], {input: lines}), drawn);
  writeFileSync(at("sweep.ndjson"), lines);
  assert.equal(await outputOf(["plot", at("sweep.ndjson")]), drawn);
  for (const label of ["x in the section (mm)", "lambda1, by verdict", "max |x| (mm), by regime"])
    assert.ok(drawn.includes(label), label);
  const points = parsed(lines).filter(({type}) => type === "point");
  for (const word of points.flatMap(({verdict, regime}) => [verdict, regime]))
    assert.match(drawn, new RegExp(`  +\\S ${word}$`, "m"));
  assert.match(drawn, / b \(mm\)\n$/);
});

test("another image format is refused before anything is computed or written", async () => {
  const commands = [
    [...orbit, "--plot"],
    [...sweep, "--plot"],
    ["plot", "-"],
  ];
  for (const name of ["a.pdf", "a.PNG"])
    for (const command of commands) {
      const {code, errors} = await run([...command, "-o", at(name)]);
      assert.equal(code, 2, errors);
      assert.match(JSON.parse(errors).detail, /a\.(pdf|PNG): plots are SVG/);
      assert.equal(existsSync(at(name)), false);
    }
});

test("a file named .svg receives SVG with every point of a sweep", async () => {
  await outputOf([...sweep, "--plot", "-o", at("sweep.svg")]);
  const svg = readFileSync(at("sweep.svg"), "utf8");
  assert.ok(svg.startsWith("<svg ") && svg.endsWith("</svg>\n"));
  const points = parsed(await outputOf(sweep)).filter(({type}) => type === "point");
  const states = points.reduce((sum, {section}) => sum + section.x.length, 0);
  const circles = svg.match(/<circle /g).length;
  assert.ok(circles >= states + 3 * points.length, `${circles} of ${states} and more`);
  await outputOf(["plot", "-", "-o", at("run.svg")], {input: await outputOf(orbit)});
  assert.match(readFileSync(at("run.svg"), "utf8"), />lambda1</);
});

test("a terminal without UTF-8 gets ASCII, and one with colours gets colours unless NO_COLOR is set", async () => {
  const ascii = await outputOf([...orbit, "--plot"], {env: {LC_ALL: "C"}});
  assert.match(ascii, /^[\n -~]+$/);
  assert.match(ascii, /\*{2}/);
  assert.ok(!(await outputOf([...orbit, "--plot"])).includes(esc));
  const shell = `script -qec "stty cols 100; $VINES ${orbit.join(" ")} --plot" /dev/null </dev/null`;
  const coloured = await outputOf([], {shell});
  assert.ok(coloured.includes(`${esc}[38;5;`));
  const seen = coloured.replaceAll(new RegExp(`${esc}\\[[\\d;]*m`, "g"), "").split("\n");
  assert.ok(seen.some((line) => [...line].length > 80));
  assert.ok(!(await outputOf([], {shell, env: {NO_COLOR: "1"}})).includes(esc));
});

test("parts left out of an answer are left out of its plots", async () => {
  const whole = ["simulate", "-p", "preset=fig11", "-p", "tau_end=60"];
  const all = "include=series,impacts,exponents,regime";
  for (const [fields, title, labels] of [
    ["series", "", ["x (mm)", "y - x (mm)"]],
    ["series,impacts.tau,regime", "regime I", ["x (mm)", "y - x (mm)"]],
    ["parameters,series.tau,series.x", "b = 15 mm", ["x (mm)"]],
    ["series,exponents.verdict", "not_decided", ["x (mm)", "y - x (mm)"]],
    ["exponents.qr.history.tau,exponents.qr.history.lambda1", "", ["exponents (qr)"]],
  ]) {
    const thinned = [...whole, "-p", all, "-p", `fields=${fields}`];
    const drawn = await outputOf([...thinned, "--plot"]);
    assert.deepEqual(
      drawn.split("\n").filter((line) => /\(mm\)|\(qr\)|^b =|^regime|^not_/.test(line)),
      [...(title ? [title] : []), ...labels],
      fields,
    );
    assert.equal(await outputOf(["plot"], {input: await outputOf(thinned)}), drawn);
  }
  const others = ["-p", "include=series,exponents", "-p", "exponents=eigenvalues", "--plot"];
  assert.match(await outputOf([...whole, ...others]), /^b = 15 mm\nx \(mm\)\n/);
});

test("a text that is not an answer gives an error message instead of a plot", async () => {
  const run_of = (series, more = {}) => JSON.stringify({series, parameters: {b: 1}, ...more});
  for (const input of [
    run_of({tau: [1, 2, 3], x: [1]}),
    run_of({tau: [null, 2], x: [1, 2]}),
    run_of([1]),
    '{"type":"start","axes":3}\n{"type":"point"}\n',
    '{"type":"start","axes":[{"parameter":"b","values":[1]}]}\n{"type":"point","b":"x","lambda":[1]}\n',
  ]) {
    const {code, out, errors} = await run(["plot"], {input});
    assert.deepEqual({code, out}, {code: 1, out: ""}, input);
    assert.match(errors, /nothing to draw|first line of the sweep is missing/, input);
  }
  const sound = {tau: [1, 2], x: [0, 0], y: [0, 0]};
  for (const impacts of [{}, [], {tau: [1]}, {tau: [1], side: []}])
    assert.equal(
      await outputOf(["plot"], {input: run_of(sound, {impacts})}),
      await outputOf(["plot"], {input: run_of(sound)}),
    );
  for (const series of [
    {tau: [1e16, 10000000000000004], x: [1, 2]},
    {tau: [1, 2], x: [1e17, 1e17]},
  ])
    assert.match(await outputOf(["plot"], {input: run_of(series)}), /^b = 1000 mm\nx \(mm\)\n/);
});

test("the walls are visible for a run without impacts", async () => {
  const free = ["simulate", "-p", "b=0.5", "-p", "y0=0", "-p", "tau_end=30", "--plot"];
  const rows = (await outputOf(free)).split("\n");
  const frame = rows.slice(rows.indexOf("y - x (mm)") + 1);
  for (const wall of [500, -500])
    assert.ok(
      frame.some((row) => row.startsWith(`${wall} ┤┄┄┄`.padStart(12))),
      `${wall}`,
    );
});

test("a reduced sweep is drawn over its other axis, also with a single point", async () => {
  const reduced = ["-a", "Omega=0.9:1.1:3", "-p", "cycles=5", "-p", "reduce=max over Omega"];
  for (const axis of ["b=0.01:0.02:4", "b=0.01"]) {
    const args = ["sweep", "-a", axis, ...reduced];
    const drawn = await outputOf([...args, "--plot"]);
    assert.match(drawn, /\npeak of \|x\| \(mm\), by regime\n(.*\n)+ *b \(mm\)\n$/);
    assert.equal(await outputOf(["plot"], {input: await outputOf(args)}), drawn);
  }
  const point = ["sweep", "-a", "b=0.01", "-a", "R=0.6", "-p", "cycles=5", "--plot"];
  assert.match(await outputOf(point), / b \(mm\)\n$/);
  assert.equal((await run(["sweep", ...reduced, "--plot"])).code, 2);
});

test("points without a valid system are left out of a plot, and an error if there are no others", async () => {
  const some = ["sweep", "-a", "x0=0,0.05,0.03", "-p", "y0=0.02", "-p", "cycles=5"];
  const points = parsed(await outputOf(some)).filter(({type}) => type === "point");
  assert.deepEqual(
    points.map((point) => "error" in point),
    [false, true, false],
  );
  assert.match(await outputOf([...some, "--plot"]), /max \|x\| \(mm\), by regime/);
  const none = await run([...some, "-p", "indices=[1]", "--plot"]);
  assert.deepEqual({code: none.code, out: none.out}, {code: 1, out: ""});
  assert.match(none.errors, /nothing to draw/);
});

test("an incomplete last line is left out of the plot", async () => {
  const lines = await outputOf(sweep);
  const whole = lines.trimEnd().split("\n").slice(0, 5).join("\n");
  const cut = `${whole}\n${lines.split("\n")[5].slice(0, 100)}`;
  assert.equal(await outputOf(["plot"], {input: cut}), await outputOf(["plot"], {input: whole}));
});

test("without colours points of different words have different marks", async () => {
  for (const [env, one] of [
    [{}, "•"],
    [{LC_ALL: "C"}, "o"],
  ]) {
    const rows = (await outputOf([...sweep, "--plot"], {env})).split("\n");
    const first = rows.findIndex((row) => row.startsWith("max |x|")) + 1;
    const frame = rows.slice(first, first + 8);
    const labels = frame.flatMap((row) => row.match(/(\S) (\w+)$/)?.slice(1, 3) ?? []);
    const marks = labels.filter((_, k) => k % 2 === 0);
    assert.ok(marks.length > 2 && marks.includes(one), marks.join());
    assert.equal(new Set(marks).size, marks.length);
    const drawn = frame.map((row) => [...row].slice(9, -10).join("")).join("");
    for (const mark of marks) assert.ok(drawn.includes(mark), mark);
  }
});

test("ticks of a narrow range differ, and long ones leave the frame in line", async () => {
  const narrow = ["sweep", "-a", "Omega=1:1.0000001:3", "-p", "cycles=5", "--plot"];
  const ticks = (await outputOf(narrow)).trimEnd().split("\n").at(-2).trim().split(/ +/);
  assert.ok(ticks.length > 1 && new Set(ticks).size === ticks.length, ticks.join());
  const series = {tau: [1, 2], x: [1e4, 1e4 + 0.5]};
  const long = await outputOf(["plot"], {input: JSON.stringify({series})});
  const frame = long.split("\n").filter((row) => /[│┤]/.test(row));
  assert.equal(new Set(frame.map((row) => row.search(/[│┤]/))).size, 1, long);
  assert.match(long, /^10000400 ┤/m);
});

test("a plot written to a file has no terminal colours", async () => {
  const file = at("plot.txt");
  const shell = `script -qec "stty cols 200; $VINES ${orbit.join(" ")} --plot -o ${file}" /dev/null </dev/null`;
  await outputOf([], {shell});
  assert.equal(readFileSync(file, "utf8"), await outputOf([...orbit, "--plot"]));
});

test("a request that cannot be drawn is refused before anything is computed", async () => {
  const map = ["sweep", "-a", "b=0.01:0.03:900", "-a", "R=0.5:0.9:900", "-p", "cycles=1000"];
  for (const [args, input, code, message] of [
    [[...map, "--plot"], "", 2, /a sweep along one axis; the web page draws maps/],
    [[...sweep, "--plot", "--resume"], "", 2, /--resume needs --format ndjson/],
    [
      [...sweep, "--plot", "--format", "csv"],
      "",
      2,
      /--(format excludes --plot|plot excludes --format)/,
    ],
    [
      [...orbit, "--plot", "--format", "csv"],
      "",
      2,
      /--(format excludes --plot|plot excludes --format)/,
    ],
    [["plot"], "{}", 1, /nothing to draw/],
    [["plot"], "[]", 2, /object/],
    [["plot"], '{"type":"point","index":0}\n', 1, /first line of the sweep is missing/],
    [["plot", at("none")], "", 1, /none/],
    [[...orbit, "-p", "include=energy", "--plot"], "", 1, /nothing to draw/],
  ]) {
    const ended = await run(args, {input});
    assert.equal(ended.code, code, args.join(" "));
    assert.match(ended.errors, message);
    assert.equal(ended.out, "");
  }
});

test("a stopped sweep is drawn with its points so far", async () => {
  const long = ["sweep", "-a", "b=0.01:0.03:100000", "-p", "cycles=100", "--plot"];
  const {code, out, errors} = await run(long, {signal: "SIGINT", until: hasComputed(0.5)});
  assert.equal(code, 130);
  assert.match(errors, /stopped after \d+ of 100000 points/);
  assert.match(out, /lambda1, by verdict/);
});

// The files that the command line writes, also after errors and signals.
import assert from "node:assert/strict";
import {execFileSync, spawn} from "node:child_process";
import {
  appendFileSync,
  chmodSync,
  existsSync,
  lstatSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  readlinkSync,
  rmSync,
  statSync,
  symlinkSync,
  truncateSync,
  writeFileSync,
} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {parsed, run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-files-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);
const text = (name) => readFileSync(at(name), "utf8");
/** Creates a folder for one test. */
const newFolder = (name) => {
  mkdirSync(at(name));
  return name;
};

const request = '{"b":0.015,"tau_end":1000,"include":["impacts"]}';
const fields = {
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 40}],
  cycles: 20,
};
const sweep = JSON.stringify(fields);
// Takes so long that a check of its file ends before it.
const long = JSON.stringify({...fields, cycles: 100000});

let answer;
let whole;
before(async () => {
  answer = (await run(["simulate"], {input: request})).out;
  whole = (await run(["sweep"], {input: sweep})).out;
  writeFileSync(at("shard"), whole);
});
/** The commands with -o, given the path of their file, and the expected content. */
const writers = () => [
  {args: (path) => ["simulate", "-o", path], input: request, expected: answer},
  {args: (path) => ["sweep", "-o", path], input: sweep, expected: whole, resumable: true},
  {args: (path) => ["merge", at("shard"), "-o", path], input: "", expected: whole},
];
const points = (name) => text(name).split("\n").length - 2;

/**
 * A device with this minor number. For root it is a copy in the test's folder, since a faulty program
 * could replace the one in /dev by a file.
 */
function device(name, minor) {
  if (process.getuid() !== 0) return `/dev/${name}`;
  if (!existsSync(at(name))) execFileSync("mknod", [at(name), "c", "1", minor]);
  return at(name);
}

test("a device remains a device after an answer was written to it", async () => {
  const none = device("null", "3");
  for (const {args, input} of writers()) {
    const {code, errors} = await run(args(none), {input});
    assert.equal(code, 0, errors);
    assert.ok(lstatSync(none).isCharacterDevice());
  }
});

test("a named pipe receives the answer and remains", async (t) => {
  const pipe = at("pipe");
  execFileSync("mkfifo", [pipe]);
  for (const {args, input, expected} of writers()) {
    const reader = spawn("cat", [pipe]);
    t.after(() => reader.kill()); // it waits if no command opens the pipe
    let read = "";
    reader.stdout.on("data", (d) => (read += d));
    const ended = new Promise((resolve) => reader.on("close", resolve));
    assert.equal((await run(args(pipe), {input})).code, 0);
    await ended;
    assert.equal(read, expected);
    assert.ok(lstatSync(pipe).isFIFO());
  }
});

test("/dev/stdout is the process's stdout: a pipe, or a file that others write to before and after", async () => {
  symlinkSync("/dev/stdout", at("stdout")); // a link, so that a faulty program replaces only that
  for (const {args, input, expected} of writers())
    for (const path of [at("stdout"), "/proc/self/fd/1"]) {
      assert.equal((await run(args(path), {input})).out, expected);
      const shell = `{ echo before; "$VINES" "$@"; echo after; } >${at("between")}`;
      assert.equal((await run(args(path), {input, shell})).code, 0);
      assert.equal(text("between"), `before\n${expected}after\n`);
    }
});

test("a symbolic link remains; the answer is in the file that it leads to, existing or new", async () => {
  for (const [k, {args, input, expected, resumable}] of writers().entries()) {
    const inside = newFolder(`links${k}`);
    mkdirSync(at(`${inside}/real`));
    symlinkSync("real/file", at(`${inside}/link`));
    symlinkSync("link", at(`${inside}/second`));
    assert.equal((await run(args(at(`${inside}/second`)), {input})).code, 0);
    assert.equal(text(`${inside}/real/file`), expected);
    const again = args(at(`${inside}/link`));
    assert.equal((await run(resumable ? [...again, "--resume"] : again, {input})).code, 0);
    assert.equal(readlinkSync(at(`${inside}/link`)), "real/file");
    assert.equal(readlinkSync(at(`${inside}/second`)), "link");
    assert.deepEqual(readdirSync(at(`${inside}/real`)), ["file"]);
  }
  symlinkSync("round", at("round"));
  const round = await run(["simulate", "-o", at("round")], {input: request});
  assert.deepEqual(
    [round.code, round.errors.split(": ").pop()],
    [1, "Too many levels of symbolic links\n"],
  );
});

test("a file keeps its mode, and a new one obeys umask", async () => {
  for (const [k, {args, input, expected, resumable}] of writers().entries()) {
    const file = at(`mode${k}`);
    const shell = 'umask 027; "$VINES" "$@"';
    assert.equal((await run(args(file), {input, shell})).code, 0);
    assert.equal(statSync(file).mode & 0o777, 0o640);
    chmodSync(file, 0o604);
    if (resumable) truncateSync(file, 1000);
    const resumed = resumable ? [...args(file), "--resume"] : args(file);
    assert.equal((await run(resumed, {input, shell})).code, 0);
    assert.equal(statSync(file).mode & 0o777, 0o604);
    assert.equal(text(`mode${k}`), expected);
  }
});

test("other files are not changed and no temporary file remains, with and without an error", async () => {
  for (const [k, {args, input, expected, resumable}] of writers().entries()) {
    const inside = newFolder(`alone${k}`);
    writeFileSync(at(`${inside}/f.part`), "mine");
    assert.equal((await run(args(at(`${inside}/f`)), {input})).code, 0);
    assert.equal(text(`${inside}/f`), expected);
    assert.equal(text(`${inside}/f.part`), "mine");
    // 4 kB is more than the start of the sweep, and less than each answer.
    const shell = 'ulimit -f 4; "$VINES" "$@"';
    const failed = await run(args(at(`${inside}/g`)), {input, shell});
    assert.equal(failed.code, 1);
    assert.match(failed.errors, /^vines: cannot write .*\/g: File too large.*\n$/);
    assert.deepEqual(readdirSync(at(inside)), resumable ? ["f", "f.part", "g"] : ["f", "f.part"]);
  }
});

test("a failure keeps the existing file", async () => {
  writeFileSync(at("old"), "old");
  const shell = 'ulimit -f 4; "$VINES" "$@"';
  assert.equal((await run(["simulate", "-o", at("old")], {input: request, shell})).code, 1);
  assert.equal(text("old"), "old");
});

test("a file that cannot be written or read is named in one line, with exit code 1", async () => {
  const inside = newFolder("folder");
  for (const {args, input} of writers()) {
    const {code, errors} = await run(args(at(inside)), {input});
    assert.equal(code, 1);
    assert.match(errors, /^vines: (cannot write )?\S+folder: Is a directory\n$/);
  }
  for (const command of ["simulate", "sweep", "identify", "merge", "verify"]) {
    const {code, errors} = await run([command, at(inside)]);
    assert.deepEqual(
      {code, errors},
      {code: 1, errors: `vines: cannot read ${at(inside)}: Is a directory\n`},
    );
  }
  for (const command of ["simulate", "sweep", "identify", "verify"]) {
    const {code, errors} = await run([command], {shell: '"$VINES" "$@" <&-'});
    assert.deepEqual(
      {code, errors},
      {code: 1, errors: "vines: cannot read stdin: Bad file descriptor\n"},
    );
  }
});

test("messages do not get into the answer if stderr is closed", async () => {
  const shell = '"$VINES" "$@" 2>&-';
  // A warning: these motions depend on the start.
  const input = JSON.stringify({
    ...fields,
    axes: [{parameter: "b", from: 0.016, to: 0.03, count: 20}],
  });
  const {out, errors} = await run(["sweep"], {input});
  assert.match(errors, /depends on the start/);
  await run(["sweep", "-o", at("quiet")], {input, shell});
  assert.equal(text("quiet"), out);
});

const resume = (name, input = sweep, more = []) =>
  run(["sweep", "--resume", "-o", at(name), ...more], {input});

test("a resumed sweep continues in its own file, without a temporary one while it computes", async () => {
  const inside = newFolder("inplace");
  const name = `${inside}/file`;
  const grown = (n) => () => existsSync(at(name)) && points(name) >= n;
  await run(["sweep", "-o", at(name)], {input: long, signal: "SIGKILL", until: grown(4)});
  const {ino} = statSync(at(name));
  const before = text(name);
  const kept = before.slice(0, before.lastIndexOf("\n") + 1);
  appendFileSync(at(name), '{"type":"point","index":5');
  let others = [];
  await run(["sweep", "--resume", "-o", at(name)], {
    input: long,
    signal: "SIGINT",
    until: () => {
      others = [...new Set([...others, ...readdirSync(at(inside))])];
      return grown(8)();
    },
  });
  assert.deepEqual(others, ["file"]);
  assert.equal(statSync(at(name)).ino, ino);
  assert.ok(text(name).startsWith(kept));
  assert.ok(parsed(text(name)).length > 8);
});

test("a complete file is not written again; one that lacks only its last line is completed in place", async () => {
  writeFileSync(at("complete"), whole);
  const {ino, mtimeMs} = statSync(at("complete"));
  assert.equal((await resume("complete")).code, 0);
  assert.deepEqual(
    [statSync(at("complete")).ino, statSync(at("complete")).mtimeMs],
    [ino, mtimeMs],
  );
  truncateSync(at("complete"), whole.lastIndexOf('{"type":"done"'));
  assert.equal((await resume("complete")).code, 0);
  assert.equal(statSync(at("complete")).ino, ino);
  assert.equal(text("complete"), whole);
});

test("--resume does not change a file that is not a sweep's, even without a line feed", async () => {
  for (const other of ["my thesis", "my thesis\n", '{"type":"start"}', '{"type":"start"}\n']) {
    writeFileSync(at("thesis"), other);
    const {code, errors} = await resume("thesis");
    assert.equal(code, 1);
    assert.match(errors, /^vines: .*thesis.*\n$/);
    assert.equal(text("thesis"), other);
  }
});

test("a second run on a file that is being written is refused while the first continues", async () => {
  const inside = newFolder("two");
  const name = at(`${inside}/file`);
  let second;
  let merged;
  const first = await run(["sweep", "-o", name], {
    input: long,
    signal: "SIGINT",
    until: async () => {
      if (!existsSync(name) || readFileSync(name, "utf8").split("\n").length < 3) return false;
      second = await run(["sweep", "--resume", "-o", name], {input: long});
      merged = await run(["merge", at("shard"), "-o", name]);
      return true;
    },
  });
  const message = `vines: another run of vines is writing ${name}; wait until it ends\n`;
  assert.deepEqual([second.code, second.errors], [1, message]);
  assert.deepEqual([merged.code, merged.errors], [1, message]);
  assert.equal(first.code, 130);
  assert.match(readFileSync(name, "utf8"), /^(\{.*\}\n)+$/);
  assert.deepEqual(readdirSync(at(inside)), ["file"]);
});

/** Runs a sweep whose file cannot grow any more, and checks its message and its file. */
async function sweepWithoutSpace(name, shell) {
  const {code, errors} = await run(["sweep", "-o", at(name)], {input: sweep, shell});
  assert.equal(code, 1);
  const [, kept] = errors.match(
    /^vines: cannot write .*; (\d+) of 40 points are kept, --resume completes the file\n$/,
  );
  assert.equal(points(name), Number(kept));
  assert.ok(Number(kept) > 2 && Number(kept) < 40);
  assert.ok(text(name).endsWith("}\n"), "no line is torn");
}

test("a sweep at the limit of its file's size reports the kept points, and can be completed later", async () => {
  await sweepWithoutSpace("limited", 'ulimit -f 12; "$VINES" "$@"');
  assert.equal((await resume("limited")).code, 0);
  assert.equal(text("limited"), whole);
});

/** Mounts a file system of this size. Returns undefined if that is not permitted. */
function small(name, kilobytes) {
  newFolder(name);
  try {
    execFileSync("mount", ["-t", "tmpfs", "-o", `size=${kilobytes}k`, "tmpfs", at(name)], {
      stdio: "ignore",
    });
    return name;
  } catch {
    return undefined;
  }
}

test("on a full disk a sweep keeps its points, and reports missing space for a sorted copy", async (t) => {
  const disk = small("disk", 24);
  if (!disk) return t.skip("no file system can be mounted");
  try {
    await sweepWithoutSpace(`${disk}/file`);
    // Space for one copy, but not for two.
    execFileSync("mount", ["-o", "remount,size=48k", at(disk)]);
    const {code, errors} = await resume(`${disk}/file`);
    assert.equal(code, 1);
    assert.match(
      errors,
      /No space left on device; all 40 points are kept but not sorted: --resume/,
    );
    assert.deepEqual(readdirSync(at(disk)), ["file"]);
    assert.equal((await run(["merge", at(`${disk}/file`)])).out, whole);
    const copy = await run(["simulate", "-o", at(`${disk}/answer`)], {
      input: request.replace("1000", "3000"),
    });
    assert.deepEqual([copy.code, readdirSync(at(disk))], [1, ["file"]]);
    execFileSync("mount", ["-o", "remount,size=1m", at(disk)]);
    assert.equal((await resume(`${disk}/file`)).code, 0);
    assert.equal(text(`${disk}/file`), whole);
  } finally {
    execFileSync("umount", [at(disk)]);
  }
});

test("every subcommand reports a failed write to stdout or to a full device", async () => {
  writeFileSync(at("answer"), answer);
  const commands = [
    {args: ["simulate"], input: request},
    {args: ["simulate"], input: request.replace("{", '{"format":"csv","fields":"impacts",')},
    {args: ["sweep"], input: sweep},
    {args: ["identify"], input: JSON.stringify({b: 0.015, impacts: JSON.parse(answer).impacts})},
    {args: ["merge", at("shard")]},
    {args: ["verify", at("answer")]},
    {args: ["verify", at("shard")]},
    {args: ["openapi"]},
    {args: ["--help"]},
    {args: ["sweep", "--help"]},
    {args: ["--version"]},
    {args: ["serve", "--port", "0"]},
    {args: ["reproduce"]},
  ];
  for (const {args, input} of commands)
    for (const [to, reason] of [
      [">/dev/full", "No space left on device"],
      [">&-", "Bad file descriptor"],
    ]) {
      if (args[0] === "reproduce" && to === ">&-") continue; // it takes seconds
      const {code, errors} = await run(args, {input, shell: `"$VINES" "$@" ${to}`});
      const message = errors.split("\n").filter((line) => line.startsWith("vines: "));
      assert.deepEqual(
        {code, message},
        {code: 1, message: [`vines: cannot write to stdout: ${reason}`]},
        `${args.join(" ")} ${to}`,
      );
    }
  for (const {args, input} of writers()) {
    const full = device("full", "7");
    const {code, errors} = await run(args(full), {input});
    const message = `vines: cannot write ${full}: No space left on device\n`;
    assert.deepEqual({code, errors}, {code: 1, errors: message});
  }
});

/** The sweep's text with the line of one point changed. */
const changed = (index, change) =>
  whole
    .split("\n")
    .map((line) => (line.includes(`"index":${index},`) ? change(line) : line))
    .join("\n");
const without = (name) => (line) => {
  const {[name]: _, ...rest} = JSON.parse(line);
  return JSON.stringify(rest);
};

const faults = () => [
  [
    changed(7, (line) => line.replace('"index":7', '"index":40')),
    9,
    /point 40 is outside the sweep, which has 40/,
  ],
  [
    changed(7, (line) => line.replace('"index":7', '"index":-1')),
    9,
    /point -1 is outside the sweep/,
  ],
  [changed(7, (line) => line.replace('"index":7', '"index":1e300')), 9, /is outside the sweep/],
  [
    changed(7, (line) => line.replace('"index":7', '"index":8')),
    9,
    /b is 0\.0119\d+, but point 8 lies at 0\.0125\d+/,
  ],
  [
    changed(7, (line) => line.replace(/"b":[\d.]+/, (b) => b.slice(0, -1))),
    9,
    /b is .* but point 7 lies at/,
  ],
  [changed(7, (line) => line.replace(/"b":[\d.]+/, '"b":"0.01"')), 9, /b is "0\.01", but point 7/],
  [changed(0, without("b")), 2, /b is missing/],
  [changed(0, without("second_start")), 2, /second_start is missing/],
  [changed(39, without("standard_error")), 41, /standard_error is missing/],
  [changed(39, without("reason")), 41, /reason is missing/],
  [changed(5, (line) => line.replace("}", ',"more":1}')), 7, /more is an unknown field/],
  [changed(5, (line) => line.replace(/,"z":[^,]+/, ',"z":"9"')), 7, /z is "9"/],
  [
    changed(5, (line) => line.replace(/"lambda":\[[^,]+,/, '"lambda":[')),
    7,
    /lambda has 3 entries/,
  ],
  [changed(5, (line) => line.replace(/"lambda":\[[^\]]+\]/, '"lambda":null')), 7, /lambda is null/],
  [
    changed(5, (line) => line.replace(/"reason":"\w+"/, '"reason":"transient_max_impacts"')),
    7,
    /lambda is \[/,
  ],
  [changed(5, (line) => line.replace(/,"lambda.*/, ',"error":"none"}')), 7, /lambda is missing/],
  [changed(5, (line) => line.replaceAll(",", ", ")), 7, /written in another way/],
  [
    changed(5, (line) => `${line}\n${line.replace(/"z":[\d.]+/, '"z":9.0')}`),
    8,
    /point 5 differs from the same point in line 7/,
  ],
  [changed(5, () => "\0\0\0"), 7, /not a line of a sweep/],
  [
    changed(5, (line) => line.replace("{", `{"a":${"[".repeat(1e5)}${"]".repeat(1e5)},`)),
    7,
    /not a line of a sweep/,
  ],
  [whole.replace('"request":', '"asked":'), 1, /the request is missing/],
  [whole.replace(/"count":40/, '"count":0'), 1, /count must lie in/],
];

test("an invalid or incomplete point is refused with the file's name and the line number", async () => {
  for (const [lines, number, why] of faults()) {
    writeFileSync(at("faulty"), lines);
    writeFileSync(at("result"), "old");
    const merged = await run(["merge", at("faulty"), at("shard"), "-o", at("result")]);
    assert.equal(merged.code, 1, merged.errors);
    assert.ok(merged.errors.startsWith(`vines: ${at("faulty")}, line ${number}: `), merged.errors);
    assert.match(merged.errors, why);
    assert.match(merged.errors, /^[^\n]*\n$/);
    assert.equal(text("result"), "old");
    const resumed = await resume("faulty");
    assert.equal(resumed.code, 1);
    assert.equal(resumed.errors, merged.errors);
    assert.equal(text("faulty"), lines, "the file is not changed");
  }
});

test("verify reports file and line of a point that does not belong to the sweep", async () => {
  writeFileSync(
    at("beyond"),
    changed(7, (line) => line.replace('"index":7', '"index":40')),
  );
  const {code, errors} = await run(["verify", at("beyond")]);
  assert.equal(code, 1);
  assert.match(errors, /^vines: .*beyond, line 9: point 40 is outside the sweep, which has 40/);
});

test("--resume refuses the file of another shard or of the whole sweep, with the line number", async () => {
  writeFileSync(at("undivided"), whole);
  const {code, errors} = await resume("undivided", sweep, ["--shard", "1/2"]);
  assert.equal(code, 1);
  assert.equal(
    errors,
    `vines: ${at("undivided")}, line 2: point 0 is not requested: the file belongs to another ` +
      "shard or to the whole sweep\n",
  );
  assert.equal(text("undivided"), whole);
});

/** The values of a point's line in a table, by column. */
const cellsOf = (line, before = "") =>
  Object.entries(line).flatMap(([name, value]) => {
    if (["type", "section"].includes(name) || value === null) return [];
    if (Array.isArray(value))
      return value.length === 4 && typeof value[0] !== "object"
        ? value.flatMap((v, k) => cellsOf({[`${name}${k + 1}`]: v}, before))
        : [];
    if (typeof value === "object") return cellsOf(value, `${before}${name}.`);
    return [[before + name, value]];
  });

/** Checks that the CSV has the values of the lines, and no others. */
async function checkTable(lines, input, kind) {
  const {code, out, errors} = await run(["sweep", "--format", "csv"], {input});
  assert.equal(code, 0, `${kind}: ${errors}`);
  const points = lines.filter(({type}) => type === "point");
  const [names, ...rows] = out
    .trimEnd()
    .split("\n")
    .map((row) => row.match(/(?<=^|,)("(?:[^"]|"")*"|[^,]*)/g));
  assert.equal(new Set(names).size, names.length, kind);
  assert.equal(rows.length, points.length, kind);
  rows.forEach((row, n) => {
    const cells = row.map((text, k) => [
      names[k],
      text.replace(/^"|"$/g, "").replaceAll('""', '"'),
    ]);
    const numeric = ([name, text]) => [name, Number.isNaN(Number(text)) ? text : Number(text)];
    const filled = (all) =>
      Object.fromEntries(
        all
          .map(([name, value]) => [name, String(value)])
          .filter(([, text]) => text !== "")
          .map(numeric),
      );
    assert.deepEqual(filled(cells), filled(cellsOf(points[n])), kind);
  });
}

test("a sweep of any kind has the same bytes after --resume and merge, and its CSV the same values", async () => {
  const base = {m1: 12, f0: 14, damping_ratio: 0.006, mass_ratio: 0.01, F: 0.0004, R: 0.4, b: 0.03};
  const f = {parameter: "f", from: 13.8, to: 14.2, count: 4};
  const b = {parameter: "b", values: [0.01, 0.03, 0.05]};
  const {b: _, ...withoutB} = base;
  const at14 = {...withoutB, f: 14};
  const kinds = {
    plain: {base, axes: [f]},
    "two axes": {base: withoutB, axes: [f, b]},
    "two starts": {base: at14, axes: [b], starts: [{}, {x0: 0.001}]},
    "no impacts": {base: {...base, b: 1}, axes: [f]},
    "default set": {base: at14, axes: [b], starts: "default set"},
    reduced: {base: withoutB, axes: [f, b], reduce: "max over f"},
    "reduced set": {base: withoutB, axes: [f, b], reduce: "min over f", starts: "default set"},
    "one axis reduced": {base, axes: [f], reduce: "max over f"},
    carried: {base: withoutB, axes: [b, f], carry_state: "down"},
    "section at impact": {base, axes: [f], section: "impact", section_points: 3},
    "section in reduced units": {
      axes: [{parameter: "b", from: 0.008, to: 0.02, count: 3}],
      section: "impact",
      section_points: 3,
    },
    stroboscopic: {base, axes: [f], section: "stroboscopic", section_points: 3},
    "no system at some": {
      axes: [{parameter: "b", values: [0.01, 0.0001, 0.02]}],
      base: {x0: 0, y0: 0.005},
    },
    "endless transients": {
      axes: [{parameter: "b", values: [1e-8, 0.02]}],
      base: {R: 1},
      cycles: 3,
      transient_cycles: 3,
    },
    "a wall that takes all": {axes: [{parameter: "R", values: [0, 0.5, 1]}], base: {b: 0.01}},
    "not forced": {axes: [{parameter: "b", values: [0.01, 0.02]}], base: {G: 0}},
  };
  const reasons = new Set();
  for (const [kind, asked] of Object.entries(kinds)) {
    const input = JSON.stringify({cycles: 30, transient_cycles: 20, ...asked});
    const {code, out, errors} = await run(["sweep"], {input});
    assert.equal(code, 0, `${kind}: ${errors}`);
    for (const line of parsed(out))
      if (line.reason || line.error) reasons.add(line.reason ?? "error");
    await checkTable(parsed(out), input, kind);
    writeFileSync(at("kind"), out.slice(0, -20));
    const resumed = await resume("kind", input);
    assert.equal(resumed.code, 0, `${kind}: ${resumed.errors}`);
    assert.equal(text("kind"), out, kind);
    assert.equal((await run(["merge", at("kind")])).out, out, kind);
    // Every second point is there, in any order: each of the others in turn precedes them.
    const lines = out.trimEnd().split("\n");
    for (let n = 1; n < lines.length - 1; n += 2) {
      const found = [lines[0], lines[n], ...lines.slice(1, -1).filter((_, k) => k % 2 === 1)];
      writeFileSync(at("kind"), `${found.join("\n")}\n`);
      assert.equal((await resume("kind", input)).code, 0, kind);
      assert.equal(text("kind"), out, kind);
    }
  }
  assert.ok(["complete", "transient_max_impacts", "error"].every((reason) => reasons.has(reason)));
});

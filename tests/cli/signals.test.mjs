// How the subcommands end after a signal, and after the reader of their output has left.
import assert from "node:assert/strict";
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {readFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {computed, hasComputed, parsed, run, waitsForSignals} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-signals-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);

const fields = {
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 40}],
};
// Runs longer than a check of its state takes on any machine.
const long = JSON.stringify({...fields, cycles: 100000});
const endless = JSON.stringify({...fields, cycles: 1e6});
const lines = (text) => text.split("\n").length - 1;

/** Asserts that a run neither computes nor waits for long after the signal. */
function endsSoon({computed, idle}, what) {
  assert.ok(computed < 0.1 && idle < 20, `${computed} s, idle ${idle} times, for ${what}`);
}

/** Asserts the exit code and stderr of a run, and that it ends soon. */
async function ends(args, options, code, message = /^$/) {
  const result = await run(args, options);
  const what = `${args.join(" ")} by ${options.signal}: ${result.errors}`;
  assert.equal(result.code, code, what);
  endsSoon(result, what);
  assert.match(result.errors, message, what);
  return result;
}

test("a command that waits for its input ends after a signal", async () => {
  for (const command of ["simulate", "sweep", "identify", "verify"])
    for (const [signal, code] of [
      ["SIGINT", 130],
      ["SIGTERM", 143],
      ["SIGHUP", 129],
    ])
      await ends([command], {open: true, input: "{", signal, until: waitsForSignals}, code);
});

test("a report ends after a signal, also if its parent ignores SIGINT", async () => {
  const until = hasComputed(0.2);
  await ends(["reproduce"], {signal: "SIGINT", until}, 130);
  await ends(["reproduce"], {signal: "SIGTERM", until}, 143);
  const shell = 'trap "" INT; exec "$VINES" "$@"';
  await ends(["reproduce"], {signal: "SIGINT", until, shell}, 130);
});

// Exit codes of commands with partial results: 130 ends a shell's loop, after 3 a scheduler can resume.
const stops = [
  ["SIGINT", 130],
  ["SIGTERM", 3],
];

test("a stopped run writes its answer up to that time", async () => {
  const input = '{"b":0.003,"R":1,"tau_end":1e7,"max_impacts":2000000,"include":["exponents"]}';
  const until = hasComputed(0.3);
  for (const [signal, code] of stops) {
    const {out} = await ends(["simulate"], {input, signal, until}, code);
    assert.equal(JSON.parse(out).status.reason, "interrupted");
  }
});

test("an identification of a list of impacts ends after a signal", async () => {
  const impacts = 500000; // takes more than 1 s to read and compute
  const column = (value) => Array.from({length: impacts}, (_, k) => value(k));
  const list = {
    tau: column((k) => Math.PI * k),
    side: column((k) => (k % 2 ? -1 : 1)),
    x: column(() => 0.001),
    x_dot_before: column(() => 0.01),
    x_dot_after: column(() => 0.009),
    y_dot_before: column((k) => (k % 2 ? 0.02 : -0.02)),
    y_dot_after: column((k) => (k % 2 ? -0.01 : 0.01)),
  };
  writeFileSync(at("list.json"), JSON.stringify({b: 0.015, impacts: list}));
  const options = {signal: "SIGINT", until: hasComputed(0.6)};
  await ends(["identify", at("list.json")], options, 130, /^vines: the identification was stopped/);
});

test("a sweep ends after a signal, however long each point takes", async () => {
  const cases = [[{}], "default set"].flatMap((starts) => stops.map((stop) => [starts, ...stop]));
  for (const [starts, signal, code] of cases) {
    const input = JSON.stringify({...JSON.parse(endless), starts});
    // The start line is written once a stop is possible.
    const hasStarted = async (pid, written) => written !== "" && (await hasComputed(0.1)(pid));
    const options = {input, signal, until: hasComputed(0.3)};
    const {out} = await ends(
      ["sweep"],
      {...options, until: hasStarted},
      code,
      /^vines: stopped after \d+ of 40 points\n$/m,
    );
    assert.ok(lines(out) >= 1);
    const shell = 'rm -f "$3"; exec "$VINES" "$@"';
    const message = /^vines: stopped after \d+ of 40 points; --resume completes the file\n$/m;
    await ends(["sweep", "-o", at("endless")], {...options, shell}, code, message);
    assert.match(readFileSync(at("endless"), "utf8"), /^(\{.*\}\n)+$/);
  }
});

test("a stopped sweep replaces no table", async () => {
  for (const [signal, code] of [
    ["SIGINT", 130],
    ["SIGTERM", 143],
  ])
    for (const format of ["csv", "npz", "cbor"]) {
      writeFileSync(at(`old.${format}`), "old");
      const options = {input: endless, signal, until: hasComputed(0.3)};
      await ends(["sweep", "-o", at(`old.${format}`)], options, code);
      assert.equal(readFileSync(at(`old.${format}`), "utf8"), "old");
    }
});

test("basins that are stopped while their pairs run lack a point and their result", async () => {
  const input = JSON.stringify({
    base: {damping: "closed_form", b: 0.0065, y0: 0},
    box: {x0: [-0.003, 0.003], y_dot0: [-0.02, 0.02]},
    count: 60,
    pairs: 60,
    transient_cycles: 10000,
  });
  const until = (_, written) => lines(written) === 60; // the start line and all points but one
  const options = {input, signal: "SIGINT", until};
  const message = /stopped after 59 of 60 points/;
  const {out} = await ends(["basins", "--threads", "1"], options, 130, message);
  assert.doesNotMatch(out, /"done"/);
});

test("verify ends after a signal", async () => {
  const {out} = await run(["sweep"], {
    input: long,
    signal: "SIGINT",
    until: (_, written) => lines(written) > 20,
  });
  writeFileSync(at("some"), out);
  const options = {signal: "SIGINT", until: hasComputed(0.1)};
  const {out: message} = await ends(["verify", at("some")], options, 130);
  assert.match(message, /recomputed: \d+ of \d+ points are the same/);
  const request = '{"b":0.015,"tau_end":1e7,"max_impacts":2000000,"include":["exponents"]}';
  const answer = JSON.parse(
    (await run(["simulate"], {input: request.replace("2000000", "10")})).out,
  );
  answer.provenance.request.max_impacts = 2000000;
  writeFileSync(at("answer"), JSON.stringify(answer));
  const {out: compared} = await ends(
    ["verify", at("answer")],
    options,
    130,
    /stopped before everything/,
  );
  assert.doesNotMatch(compared, /recomputed:/);
});

test("a signal while a large answer is written keeps the existing file", async () => {
  writeFileSync(at("large"), "old");
  const input = '{"b":0.015,"tau_end":1e7,"max_impacts":1000000,"include":["impacts"]}';
  const until = () => readdirSync(folder).some((name) => name.startsWith(".vines-"));
  await ends(["simulate", "-o", at("large")], {input, signal: "SIGINT", until}, 130);
  assert.equal(readFileSync(at("large"), "utf8"), "old");
  assert.deepEqual(
    readdirSync(folder).filter((name) => name.startsWith(".vines-")),
    [],
  );
});

test("a sweep writes each line to a pipe in order as it is computed, also when it is stopped", async () => {
  let first;
  const {code, out, errors} = await run(["sweep"], {
    input: long,
    signal: "SIGINT",
    until: (_, written) => {
      first ??= written;
      return lines(written) > 4;
    },
  });
  assert.equal(lines(first), 0, "lines are written before all are computed");
  assert.equal(code, 130);
  const [start, ...points] = parsed(out);
  assert.equal(start.type, "start");
  assert.ok(points.length < 40);
  const indices = points.map((point) => point.index);
  assert.deepEqual(indices.slice(0, 4), [0, 1, 2, 3]);
  assert.deepEqual(
    indices,
    [...indices].sort((a, b) => a - b),
  );
  assert.match(errors, new RegExp(`^vines: stopped after ${points.length} of 40 points\n$`, "m"));
});

test("the first line of a sweep is written before its first point", async () => {
  const {code, out} = await run(["sweep"], {
    input: endless,
    signal: "SIGKILL",
    until: (_, written) => written.includes("\n"),
  });
  assert.equal(code, null, "it was still computing");
  assert.equal(parsed(out)[0].type, "start");
});

test("a closed pipe ends a command without a message, with exit code 141", async () => {
  // More than a pipe holds.
  const many = JSON.stringify({axes: [{...fields.axes[0], count: 400}], cycles: 10});
  const large = '{"b":0.015,"tau_end":1e5,"include":["impacts"]}';
  const shell = 'set -o pipefail; "$VINES" "$@" | head -c 100 >/dev/null';
  for (const [args, input] of [
    [["sweep"], long],
    [["sweep"], many],
    [["simulate"], large],
    [["simulate", "-o", "/proc/self/fd/1"], large],
    [["openapi"], ""],
  ]) {
    const {code, errors} = await run(args, {input, shell});
    assert.deepEqual({code, errors}, {code: 141, errors: ""}, args.join(" "));
  }
});

test("a closed stderr does not end a sweep into a file", async () => {
  const many = JSON.stringify({...fields, cycles: 100});
  const shell = '"$VINES" "$@" 2> >(exec true); exit $?';
  const {code} = await run(["sweep", "-o", at("told")], {input: many, shell});
  assert.equal(code, 0);
  assert.equal(lines(await readFile(at("told"), "utf8")), 42);
});

test("a reader that does not read cannot keep a command from ending", async () => {
  const still = JSON.stringify({
    ...fields,
    axes: [{parameter: "b", from: 0.008, to: 0.03, count: 4000}],
    cycles: 20,
    transient_cycles: 10,
    section: "impact",
  });
  const large = '{"b":0.015,"tau_end":1e5,"include":["impacts"]}';
  // Descriptor 9 keeps the pipe open, and nothing reads from it.
  const shell = 'mkfifo "$PIPE"; exec 9<>"$PIPE"; exec "$VINES" "$@" >"$PIPE"';
  for (const [k, [args, input, code]] of [
    [["sweep"], still, 130],
    [["simulate"], large, 130],
  ].entries()) {
    const env = {PIPE: at(`still${k}`)};
    const used = [];
    const sleeps = async (pid) => {
      used.push(await computed(pid));
      return (await waitsForSignals(pid)) && used.at(-1) === used.at(-60);
    };
    const result = await run(args, {input, env, shell, signal: "SIGINT", until: sleeps});
    assert.equal(result.code, code, result.errors);
    endsSoon(result, args.join(" "));
  }
});

// Usage errors, help, and output to a terminal.
import assert from "node:assert/strict";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-usage-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);

test("a usage error gives one line with the fault and the help to read, and exit code 2", async () => {
  for (const [args, message] of [
    [[], /no subcommand given; expected one of: simulate, sweep, .*; see vines --help/],
    [["swep"], /unknown subcommand swep; did you mean sweep\?; see vines --help/],
    [["Simulate"], /unknown subcommand Simulate; did you mean simulate\?/],
    [["foo"], /unknown subcommand foo; see vines --help/],
    [["x".repeat(100)], /unknown subcommand x+; see/],
    [["--foo"], /unknown flag --foo; see vines --help/],
    [["simulate", "--foo"], /--foo; see vines simulate --help/],
    [["simulate", "a", "b"], /not expected: b; see vines simulate/],
    [["simulate", "-o"], /--output/],
    [["simulate", "-o", "a", "-o", "b"], /--output/],
    [["sweep", "--threads", "many"], /--threads/],
    [["sweep", "--shards", "0"], /--shards/],
    [["merge"], /files is required/],
    [["serve", "--port", "99999"], /--port/],
    [["serve", "--log-format", "yaml"], /--log-format/],
    [["healthcheck", "--port", "x"], /--port/],
    [["openapi", "x"], /x/],
    [["reproduce", "x"], /x/],
  ]) {
    const {code, out, errors} = await run(args);
    assert.deepEqual({code, out}, {code: 2, out: ""}, args.join(" "));
    assert.match(errors, /^vines: [^\n]+; see vines( \w+)? --help\n$/);
    assert.match(errors, message);
  }
});

test("the program's help fits one screen, and a subcommand's help has examples that run", async () => {
  const {out} = await run(["--help"]);
  const lines = out.trimEnd().split("\n");
  assert.ok(lines.length <= 32, `${lines.length} lines`);
  for (const line of lines) assert.ok(line.length <= 80, line);
  const examples = out.split("Examples:\n")[1];
  for (const command of examples.match(/^ {2}vines (?!serve|identify).*$/gm))
    assert.equal((await run(command.trim().split(" ").slice(1))).code, 0, command);
  const [list] = out.split("Subcommands:\n")[1].split("\n\n");
  for (const [, name] of list.matchAll(/^ {2}(\w+)/gm)) {
    const own = (await run([name, "--help"])).out;
    assert.match(own, new RegExp(`\nExamples:\n( {2}.*\n)* {2}.*vines ${name}\\b`), name);
  }
});

test("a command that reads its request from a terminal prompts for it", async () => {
  const shell = 'script -qec "$VINES simulate" /dev/null <<<"{"tau_end":5}"$\'\\n\\x04\'';
  assert.match((await run([], {shell})).out, /vines: reading from the terminal; Ctrl-D ends it/);
});

test("an environment variable of one subcommand does not affect another", async () => {
  const env = {VINES_PORT: "x", VINES_SHARDS: "x"};
  const input = '{"b":0.015,"tau_end":10}';
  assert.equal((await run(["simulate"], {input, env})).code, 0);
  assert.match((await run(["sweep"], {env})).errors, /--shards/);
});

/** Successive contents of the progress line of a sweep in a terminal of this width. */
async function drawn(columns) {
  const axes = [{parameter: "b", from: 0.008, to: 0.03, count: 400}];
  writeFileSync(at("sweep.json"), JSON.stringify({axes, cycles: 300}));
  const command = `stty cols ${columns}; "$VINES" sweep ${at("sweep.json")} >/dev/null`;
  const {code, out} = await run([command], {shell: 'script -qec "$1" /dev/null </dev/null'});
  assert.equal(code, 0, out);
  return out.split("\n")[0].split("\r").filter(Boolean);
}

test("a sweep's progress bar fits the terminal's width, and a narrow line does not wrap", async () => {
  for (const columns of [30, 50, 80, 200]) {
    const lines = await drawn(columns);
    assert.ok(lines.length > 1);
    for (const line of lines) assert.ok(line.length < columns, `${line.length}: ${line}`);
    const last = lines.at(-1);
    assert.match(last, /400 of 400 points/);
    if (columns >= 80) assert.equal(last.trimEnd().length, columns - 1);
    if (columns >= 80) assert.match(last, /^\[#+\] /);
  }
});

test("without a terminal there is no bar", async () => {
  const axes = [{parameter: "b", from: 0.02, to: 0.03, count: 4}];
  const {code, errors} = await run(["sweep", "-o", at("plain")], {
    input: JSON.stringify({axes, cycles: 20}),
  });
  assert.equal(code, 0);
  assert.doesNotMatch(errors, /[[\r#]/);
});

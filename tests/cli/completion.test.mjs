// Completion in three shells and the manual page, for every flag of the program.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdirSync, mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {delimiter, dirname, join, resolve} from "node:path";
import {after, before, test} from "node:test";
import {program} from "../service.mjs";
import {run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-completion-"));
after(() => rmSync(folder, {recursive: true}));

/** Output of a subcommand that must succeed without messages. */
async function written(...args) {
  const {code, out, errors} = await run(args);
  assert.deepEqual({code, errors}, {code: 0, errors: ""}, args.join(" "));
  return out;
}

/** Names of the flags in the help, by subcommand; "" for the program. */
const flags = {};
before(async () => {
  const top = await written("--help");
  const [list] = top.split("Subcommands:")[1].split("\n\n");
  const names = [...list.matchAll(/^ {2}(\w+)/gm)].map(([, name]) => name);
  for (const name of ["", ...names]) {
    const help = await written(...(name ? [name] : []), "--help");
    const lines = [...help.matchAll(/^ {2}(-[\w,-]+)/gm)];
    flags[name] = lines.flatMap(([, list]) => list.split(","));
  }
  for (const shell of ["bash", "zsh", "fish"])
    writeFileSync(join(folder, shell), await written("completion", shell));
  mkdirSync(join(folder, "files/folder"), {recursive: true});
  writeFileSync(join(folder, "files/a request.json"), "");
});

/** Test options that skip the test if a program is missing. */
const needs = (name) =>
  spawnSync("sh", ["-c", `command -v ${name}`]).status === 0
    ? {}
    : {skip: `there is no ${name} (scripts/setup test)`};

/** Output of a shell that finds `vines`, run in the folder of files. */
function shell(file, args, input) {
  const {status, stdout, stderr} = spawnSync(file, args, {
    cwd: join(folder, "files"),
    encoding: "utf8",
    env: {...process.env, PATH: dirname(resolve(program)) + delimiter + process.env.PATH},
    input,
  });
  assert.deepEqual({status, stderr}, {status: 0, stderr: ""});
  return stdout;
}

const sorted = (words) => [...words].sort();

/** Expected completions of a line's last word, the same in bash and fish. */
const offers = () => [
  ["si", ["simulate"]],
  ["", Object.keys(flags).filter(Boolean)],
  ["serve --log-format ", ["json", "text"]],
  ["serve --log-format=t", ["text"]],
  ["completion z", ["zsh"]],
  ["simulate a", ["a request.json"]],
  ["sweep --output a", ["a request.json"]],
  ["merge -o f", ["folder"]],
  ["reproduce --output ", ["folder"]],
  ["serve --port ", []],
  ["sweep --resume --sh", ["--shard", "--shards"]],
  ["nonsense ", []],
  ...Object.entries(flags).map(([name, all]) => [
    name ? `${name} --` : "--",
    all.filter((flag) => flag.startsWith("--")),
  ]),
];

test("bash completes subcommands, flags, values and files", () => {
  // Words as readline splits them: "=" is a word.
  const script = `source ../bash
    while IFS= read -r line; do
      mapfile -t COMP_WORDS < <(sed 's/=/ = /; s/ /\\n/g; s/ $/\\n/' <<<"vines $line")
      COMP_CWORD=$((\${#COMP_WORDS[@]} - 1))
      _vines
      printf '%s\\t' "\${COMPREPLY[@]}"
      echo
    done`;
  const lines = offers();
  const answers = shell("bash", ["-c", script], lines.map(([line]) => `${line}\n`).join(""));
  const answered = answers.split("\n");
  for (const [at, [line, expected]] of lines.entries())
    assert.deepEqual(sorted(answered[at].split("\t").filter(Boolean)), sorted(expected), line);
});

test("fish completes the same", needs("fish"), () => {
  shell("fish", ["-n", "../fish"]);
  for (const [line, expected] of offers()) {
    const out = shell("fish", ["-c", `source ../fish; complete -C "vines ${line}"`]);
    const words = out.split("\n").filter(Boolean);
    const names = words.map((word) => word.split("\t")[0].replace(/^.*=|\/$/g, ""));
    assert.deepEqual(sorted(names), sorted(expected), line);
  }
});

test("zsh completes a typed line", needs("zsh"), () => {
  shell("zsh", ["-n", "../zsh"]);
  // An interactive zsh in a pseudo-terminal; it writes the completed line to a file.
  const script = `zmodload zsh/zpty
    zpty z zsh -f -i
    type() { zpty -w z "$1"; }
    type 'PS1=; autoload -U compinit; compinit -u -D; source ../zsh; vines() { print -rl -- "$@" >../typed.new; mv ../typed.new ../typed; }'
    while IFS= read -r line; do
      rm -f ../typed
      zpty -w -n z "vines $line"$'\\t\\n'
      for ((k = 0; k < 500; ++k)); do [[ -e ../typed ]] && break; sleep .02; done
      paste -sd'|' ../typed
    done
    zpty -d z`;
  const lines = [
    ["si", "simulate"],
    ["--ver", "--version"],
    ["serve --log-format t", "serve|--log-format|text"],
    ["serve --log-format=t", "serve|--log-format=text"],
    ["serve --embed", "serve|--embed-origin"],
    ["completion f", "completion|fish"],
    ["simulate a", "simulate|a request.json"],
    ["sweep -o a", "sweep|-o|a request.json"],
    ["reproduce --output f", "reproduce|--output|folder"],
    ["sweep --res", "sweep|--resume"],
  ];
  const out = shell("zsh", ["-fc", script], lines.map(([line]) => `${line}\n`).join(""));
  assert.deepEqual(
    out.trim().split("\n"),
    lines.map(([, typed]) => typed),
  );
});

test("options for files and folders have the type FILE or DIR", async () => {
  for (const name of Object.keys(flags).filter(Boolean)) {
    const help = await written(name, "--help");
    const entries = help.replace(/\n {10,}/g, "  ").split("\n");
    for (const entry of entries)
      if (/ {2}(file|folder) /.test(entry)) assert.match(entry, /\b(FILE|DIR)\b/, entry);
  }
});

test("the manual page has every subcommand, flag and variable, and no formatting error", async () => {
  // Environment variables of other subcommands have no effect.
  const {out: page} = await run(["manual"], {env: {VINES_PORT: "x", VINES_COMPUTE_THREADS: "1"}});
  assert.equal(page, await written("manual"));
  const text = page.replaceAll("\\-", "-");
  for (const [name, names] of Object.entries(flags)) {
    const section = name ? text.split(`.SS \\fB${name}\\fR`)[1].split(/^\.S[SH]/m)[0] : text;
    for (const flag of names) assert.ok(section.includes(`\\fB${flag}\\fR`), `${flag} of ${name}`);
    if (!name) continue;
    const help = await written(name, "--help");
    for (const [variable] of help.matchAll(/(?<=\(Env:)\w+/g)) {
      assert.ok(section.includes(`Environment: ${variable}.`), variable);
      assert.ok(text.includes(`.TP\n\\fB${variable}\\fR\n`), variable);
    }
  }
});

test("man shows the manual page without a warning", needs("man"), async () => {
  writeFileSync(join(folder, "vines.1"), await written("manual"));
  const out = shell("man", ["--warnings", "-l", "../vines.1"]);
  assert.match(out, /--compute-threads value\n.*Computations at once/);
});

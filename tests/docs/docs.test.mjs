// Compares the documents with the program.
import assert from "node:assert/strict";
import {execFile} from "node:child_process";
import {access, mkdtemp, readdir, rm, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {after, before, test} from "node:test";
import {program, startService} from "../service.mjs";
import {answeredKeys} from "./answers.mjs";
import {describedKeys, withKeyTables} from "./described.mjs";
import {
  anchors,
  between,
  codes,
  links,
  read,
  root,
  tables,
  transcripts,
  withoutBlocks,
} from "./markdown.mjs";

const documents = {};
let service;
let parameters;
let openapi;
before(async () => {
  const names = (await readdir(root)).filter((name) => name.endsWith(".md"));
  for (const name of await readdir(new URL("docs/", root)))
    if (name.endsWith(".md")) names.push(`docs/${name}`);
  for (const name of names) documents[name] = await read(name);
  service = await startService();
  parameters = await (await fetch(`${service.url}/v1/parameters`)).json();
  openapi = await (await fetch(`${service.url}/v1/openapi.json`)).json();
});
after(() => service.stop());

/** Runs a program; returns its stdout. */
const run = (file, args, options = {}) =>
  new Promise((resolve, reject) => {
    execFile(file, args, {maxBuffer: 1 << 26, ...options}, (error, stdout, stderr) =>
      error ? reject(new Error(`${args.join(" ")}: ${error.message}\n${stderr}`)) : resolve(stdout),
    );
  });

/** The same names, in any order. */
const sameNames = (got, expected, what) => assert.deepEqual(new Set(got), new Set(expected), what);

const named = (table, column) =>
  new Map(table.rows.map((row) => [codes(row[column]).join(","), row]));

// Fields.

/** A table's text for a range: "1e-9 to 1000", or the choices. */
function rangeOf(row) {
  if (row.range.includes("`")) return codes(row.range);
  return row.range ? row.range.split(" to ").map(Number) : [];
}

/** A table's text for a default: [value or null, note]. */
function defaultOf(row) {
  const [, value, note] = row.default.match(/^(?:`([^`]*)`)?(?:; )?(.*)$/);
  if (value === undefined) return [null, note];
  try {
    return [JSON.parse(value), note];
  } catch {
    return [value, note];
  }
}

const groups = ["system", "reduced", "SI", "laws", "load", "start", "run", "output"];

test("every field is in a table with its type, unit, range and default", () => {
  const marked = tables(documents["docs/api.md"], "fields");
  const table = (name) => named(marked.find((t) => t.argument === name) ?? {rows: []}, "field");
  const shared = new Map(groups.flatMap((group) => [...table(group)]));
  for (const [list, fields] of Object.entries(parameters).filter(([name]) => name !== "model"))
    for (const field of fields) {
      const row = table(list).get(field.name) ?? shared.get(field.name);
      const what = `${field.name} of ${list}`;
      assert.ok(row, `${what} is in a table`);
      assert.equal(row.type, field.type, `type of ${what}`);
      assert.equal(row.unit, field.unit, `unit of ${what}`);
      const range = "minimum" in field ? [field.minimum, field.maximum] : (field.choices ?? []);
      assert.deepEqual(rangeOf(row), range, `range of ${what}`);
      assert.deepEqual(
        defaultOf(row),
        [field.default, field.default_note ?? ""],
        `default of ${what}`,
      );
      assert.ok(row.meaning, `meaning of ${what}`);
    }
});

test("no table has a field that the service does not know, or in another group", () => {
  for (const {argument, rows} of tables(documents["docs/api.md"], "fields")) {
    const known = groups.includes(argument)
      ? parameters.fields.filter((field) => field.group === argument)
      : parameters[argument];
    const names = known.map((field) => field.name);
    for (const row of rows)
      assert.ok(names.includes(codes(row.field)[0]), `${row.field} of ${argument}`);
  }
});

// Routes.

test("the tables of routes and statuses are the OpenAPI document's", async () => {
  const [table] = tables(documents["docs/api.md"], "routes");
  const rows = named(table, "route");
  sameNames(rows.keys(), Object.keys(openapi.paths));
  const [statuses] = tables(documents["docs/api.md"], "statuses");
  const explained = named(statuses, "status");
  const ofAny = (method) =>
    [...explained]
      .filter(([, {of}]) => of === "any" || of === `any \`${method}\``)
      .map(([status]) => status);
  for (const [path, methods] of Object.entries(openapi.paths)) {
    const row = rows.get(path);
    const allowed = Object.keys(methods).map((method) => method.toUpperCase());
    sameNames(codes(row.method), allowed, path);
    for (const method of allowed) {
      const {responses} = methods[method.toLowerCase()];
      const known = [...codes(row.statuses), ...ofAny(method)];
      sameNames(Object.keys(responses), known, `${method} ${path}`);
      for (const status of known) assert.ok(explained.has(status), status);
    }
  }
});

// Keys of answers.

test("the table of metrics names each one that is served, with its type and labels", async () => {
  await fetch(`${service.url}/v1/simulate`);
  const text = await (await fetch(`${service.url}/metrics`)).text();
  const types = Object.fromEntries(
    [...text.matchAll(/^# TYPE (\S+) (\S+)$/gm)].map(([, name, type]) => [name, type]),
  );
  const [table] = tables(documents["docs/operations.md"], "metrics");
  const told = {};
  for (const row of table.rows) {
    for (const name of codes(row.metric)) {
      told[name] = row.type;
      const sample = text.split("\n").find((line) => /^[^#]/.test(line) && line.startsWith(name));
      const labels = [...sample.matchAll(/(\w+)="/g)].map(([, label]) => label);
      sameNames(
        labels.filter((label) => label !== "le"),
        codes(row.labels),
        name,
      );
    }
  }
  assert.deepEqual(told, types);
});

test("every key of every answer is in the OpenAPI document, and no other one", async () => {
  const described = describedKeys(openapi);
  const answered = await answeredKeys(service.url);
  sameNames(described.keys(), answered.keys());
  for (const [part, paths] of answered) {
    const keys = described.get(part);
    const known = keys.flatMap(({path, si}) => [path, si]);
    // A value that is null or an empty list in one answer has its keys in another.
    for (const path of paths)
      assert.ok(
        known.some((k) => k === path || k.startsWith(`${path}.`) || k.startsWith(`${path}[]`)),
        `${part}: ${path} is answered, but not described`,
      );
    for (const {path, isObject} of keys)
      assert.ok(isObject || paths.has(path), `${part}: ${path} is not answered`);
  }
});

// PUBLISH=1 writes the tables of keys, the printed outputs and the findings.
test("the tables of keys are the OpenAPI document's", async () => {
  const text = documents["docs/api.md"];
  const generated = withKeyTables(text, describedKeys(openapi));
  if (process.env.PUBLISH) return writeFile(new URL("docs/api.md", root), generated);
  const [own, expected] = [text, generated].map((one) => one.split("\n"));
  for (const [n, line] of expected.entries()) assert.equal(own[n], line, `line ${n + 1}`);
});

// The command line.

/** The flags of a subcommand's help: {names, environment, range, standard}. */
function flagsOf(help) {
  const found = [...help.matchAll(/^ {2}((?:-\w,)?--[\w-]+)(?: (.*))?$/gm)];
  return found.map(([, names, rest = ""]) => {
    const [kind] = rest.split(/ {2,}/);
    const range = kind.match(/:\[(\S+) - ([^\]]+)\]/);
    return {
      names,
      environment: kind.match(/\(Env:(\w+)\)/)?.[1] ?? "",
      range: range ? range.slice(1).map(Number) : [],
      standard: kind.replace(/:\[[^\]]*\]/, "").match(/=(.+?)(?= \(Env:|$)/)?.[1] ?? "",
    };
  });
}

const help = (command) => run(program, [command, "--help"].filter(Boolean));
const commandsOf = (text) =>
  [
    ...text
      .split("Subcommands:")[1]
      .split("\n\n")[0]
      .matchAll(/^ {2}(\w+)/gm),
  ].map((found) => found[1]);

test("every flag of every subcommand is in a table with its variable, default and range", async () => {
  const marked = tables(documents["docs/operations.md"], "flags");
  const commands = ["", ...commandsOf(await help(""))];
  sameNames(
    marked.map((table) => table.argument),
    commands,
  );
  for (const {argument, rows} of marked) {
    const flags = flagsOf(await help(argument));
    const documented = named({rows}, "flag");
    sameNames(
      documented.keys(),
      flags.map((flag) => flag.names),
      `flags of vines ${argument}`,
    );
    for (const {names, environment, range, standard} of flags) {
      const row = documented.get(names);
      const what = `${names} of vines ${argument}`;
      assert.equal(codes(row.environment).join(), environment, `variable of ${what}`);
      assert.deepEqual(rangeOf(row), range, `range of ${what}`);
      assert.equal(codes(row.default)[0] ?? row.default, standard, `default of ${what}`);
      assert.ok(row.meaning, `meaning of ${what}`);
    }
  }
});

test("every subcommand, positional and environment variable is in the operations document", async () => {
  const known = new Set(codes(documents["docs/operations.md"]));
  for (const command of commandsOf(await help(""))) {
    assert.ok(known.has(command) || known.has(`vines ${command}`), command);
    const text = await help(command);
    for (const [name] of text.matchAll(/\b(?:VINES|SLURM|JOB)(?:_[A-Z]+)+\b/g))
      assert.ok(known.has(name), name);
    for (const [, name] of text.matchAll(/^ {2}(\w+) (?:TEXT|FILE|DIR)/gm))
      assert.ok(known.has(name), name);
  }
});

// Commands and their output.

const number = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/gi;

/** Equal but for the last digits of numbers. */
function sameOutput(shown, got, command) {
  assert.equal(got.replace(number, "#"), shown.replace(number, "#"), `${command}\n${got}`);
  const numbers = got.match(number) ?? [];
  (shown.match(number) ?? []).forEach((text, k) => {
    const off = Math.abs(Number(text) - Number(numbers[k]));
    assert.ok(off <= 1e-9 * Math.abs(Number(text)), `${command}\n${text} is ${numbers[k]}`);
  });
}

/** Fails if `check` does, or with PUBLISH=1 writes `got` in place of `shown`: pairs of both. */
async function published(name, pairs, check) {
  try {
    check();
  } catch (error) {
    if (!process.env.PUBLISH) throw error;
    let text = await read(name);
    for (const [shown, got] of pairs) {
      assert.equal(text.split(shown).length, 2, `${name} shows once:\n${shown}`);
      text = text.replace(shown, () => got);
    }
    await writeFile(new URL(name, root), text);
  }
}

/** The command with this service, this program and this checkout. */
const here = (command) =>
  command
    .replaceAll("127.0.0.1:8080", new URL(service.url).host)
    .replaceAll("build/release/vines", program);

test("the commands that the documents show print what they show", async () => {
  const folder = await mkdtemp(join(tmpdir(), "vines-docs-"));
  // The environment of a reader who has followed the tutorial, with the program on the PATH.
  const env = {...process.env, PATH: `${dirname(program)}:${process.env.PATH}`, LC_ALL: "C.UTF-8"};
  let count = 0;
  for (const [name, text] of Object.entries(documents))
    for (const {command, output} of transcripts(text).flat()) {
      const got = await run("bash", ["-o", "pipefail", "-c", here(command)], {cwd: folder, env});
      await published(name, [[output, got]], () => sameOutput(output, got, `${name}: ${command}`));
      ++count;
    }
  await rm(folder, {recursive: true});
  assert.ok(count >= 8, `${count} commands`);
});

test("the bottom line and the table of the findings are what vines reproduce prints", async () => {
  const shown = ["bottom line", "reproduce"].map((name) =>
    between(documents["docs/paper.md"], name),
  );
  const printed = await run(program, ["reproduce"]);
  const end = printed.indexOf("\n") + 1;
  const parts = [printed.slice(0, end), printed.slice(end + 1)];
  await published(
    "docs/paper.md",
    [0, 1].map((k) => [shown[k], parts[k]]),
    () => assert.equal(shown.join("\n"), printed),
  );
  const rows = shown[1].split("\n").filter((line) => line.startsWith("|"));
  for (const row of rows) assert.equal(row.split("|").length, 10, row);
});

// The documents themselves.

test("links lead to files and headings that are there", async () => {
  for (const [name, text] of Object.entries(documents))
    for (const link of links(text)) {
      if (/^https?:/.test(link)) continue;
      const url = new URL(link, new URL(name, root));
      const target = url.href.slice(root.href.length).replace(url.hash, "");
      await access(new URL(target, root)).catch(() => assert.fail(`${name}: ${link}`));
      if (!url.hash) continue;
      const headings = anchors(documents[target] ?? "");
      assert.ok(headings.includes(url.hash.slice(1)), `${name}: ${link}`);
    }
});

test("the architecture names only files and identifiers that exist", async () => {
  const folders = ["src", "web", "tests", "scripts", "clients", "deploy", "packaging", ".ci"];
  const listed = await Promise.all(
    folders.map(async (folder) => {
      const names = await readdir(new URL(folder, root), {recursive: true});
      return names
        .filter((name) => !name.includes("node_modules"))
        .map((name) => `${folder}/${name}`);
    }),
  );
  const files = [...listed.flat(), ...(await readdir(root))];
  const isSource = /\.(cpp|hpp|js|mjs|css|html|cmake|txt|py|service)$|scripts\/[\w-]+$/;
  const sources = await Promise.all(files.filter((name) => isSource.test(name)).map(read));
  const known = new Set(`${sources.join("\n")} ${files.join(" ")}`.match(/\w+/g));
  const placeholders = /[A-Z]{4}/; // NAME, PREFIX
  for (const code of codes(withoutBlocks(documents["docs/design.md"]))) {
    if (code.startsWith("#include")) continue;
    const [file] = code.match(/[\w./*-]+\.(cpp|hpp|js|mjs|css|html)\b/) ?? [];
    if (file && !placeholders.test(file)) {
      const pattern = file.replaceAll(".", "\\.").replaceAll("*", "[^/]*");
      assert.ok(
        files.some((name) => new RegExp(`(^|/)${pattern}$`).test(name)),
        code,
      );
    }
    for (const word of code.match(/[A-Za-z_]\w{3,}/g) ?? [])
      assert.ok(known.has(word) || placeholders.test(word), code);
  }
});

test("every document is linked from the README", () => {
  const linked = links(documents["README.md"]);
  for (const name of Object.keys(documents))
    if (name !== "README.md") assert.ok(linked.includes(name), name);
});

test("the newest version of the changelog is the program's", async () => {
  const newest = documents["CHANGELOG.md"].match(/^## (\S+)/m)[1];
  assert.match(await run(program, ["--version"]), new RegExp(`^(vines )?${newest}$`, "m"));
  assert.match(await read("CMakeLists.txt"), new RegExp(`project\\(vines VERSION ${newest} `));
});

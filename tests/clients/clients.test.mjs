// Tests of the Python client with a running service and the program, and of the list of fields in
// each client.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {readFileSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath} from "node:url";
import {program} from "../service.mjs";
import {key, outcome, startServices} from "./services.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const python = (args, env = {}, cwd = root) =>
  spawnSync("/usr/bin/python3", args, {
    cwd,
    encoding: "utf8",
    env: {
      ...process.env,
      PYTHONPATH: join(root, "clients/python"),
      PYTHONDONTWRITEBYTECODE: "1",
      ...env,
    },
  });

let services;
before(async () => {
  services = await startServices();
});
after(() => services.stop());

test("the Python client gives the same answers and errors with service and program", () => {
  const {folder, open, locked} = services;
  const suite = ["-W", "error::ResourceWarning", "-m", "unittest", "-v", "test_vines"];
  const ended = python(suite, {
    PYTHONPATH: `${join(root, "clients/python")}:${join(root, "tests/clients")}`,
    VINES_PROGRAM: program,
    TEST_SERVICE: open.url,
    TEST_LOCKED: locked.url,
    TEST_KEY: key,
    TEST_RECORD: join(folder, "record.csv"),
  });
  assert.equal(ended.status, 0, outcome(ended));
  assert.match(ended.stderr, /^Ran \d{2} tests/m);
  // Prints the tests skipped for a missing package.
  for (const [skipped] of ended.stderr.matchAll(/^.*skipped.*$/gm)) console.log(skipped);
});

test("the Python client has the fields of the service", () => {
  const ended = python([join(root, "clients/python/fields.py"), "--check", program]);
  assert.equal(ended.status, 0, outcome(ended));
});

test("the Python client and the citation have the version of the project", () => {
  const declared = (file, pattern) => readFileSync(join(root, file), "utf8").match(pattern)[1];
  const version = declared("CMakeLists.txt", /VERSION ([0-9.]+) LANG/);
  assert.equal(declared("clients/python/pyproject.toml", /^version = "(.*)"$/m), version);
  assert.equal(declared("CITATION.cff", /^version: (.*)$/m), version);
});

test("the Python examples in the documents work unchanged", () => {
  const {folder, open} = services;
  const hasPandas = python(["-c", "import pandas"]).status === 0;
  for (const [file, shown] of [
    ["README.md", /^(\S+ \S+ \S+\n){5}$/],
    ["clients/python/README.md", /^41\/41 /m],
  ]) {
    const [, lines] = readFileSync(join(root, file), "utf8").match(/```python\n([\s\S]*?)```/);
    const runnable = hasPandas ? lines : lines.replace(/^run\.frame.*$/m, "");
    writeFileSync(join(folder, "lines.py"), runnable);
    for (const way of [{VINES_URL: open.url}, {VINES_PROGRAM: program}]) {
      const ended = python(["lines.py"], way, folder);
      assert.equal(ended.status, 0, outcome(ended));
      assert.match(ended.stdout, shown);
    }
  }
});

test("the Octave client knows which fields are lists", () => {
  const {schemas} = JSON.parse(
    spawnSync(program, ["openapi"], {encoding: "utf8"}).stdout,
  ).components;
  const known = readFileSync(join(root, "clients/octave/+vines/+internal/list_depth.m"), "utf8");
  const named = [...known.matchAll(/'(\w+)'/g)].map(([, name]) => name);
  const asked = [
    "SimulateRequest",
    "SweepRequest",
    "SweepBase",
    "Axis",
    "Start",
    "IdentifyRequest",
  ];
  const isList = ({type, anyOf = []}) => type === "array" || anyOf.some(isList);
  const lists = asked.flatMap((name) =>
    Object.entries(schemas[name].properties).flatMap(([key, field]) =>
      isList(field) ? [key] : [],
    ),
  );
  assert.deepEqual(new Set(named), new Set(lists));
});

// The client for Python, against the running service and the program, and what every client knows of
// the fields.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {readFileSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath} from "node:url";
import {program} from "../service.mjs";
import {key, said, startServices} from "./services.mjs";

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

test("the Python client has the same answers, errors and ends from service and program", () => {
  const {room, open, locked} = services;
  const suite = ["-W", "error::ResourceWarning", "-m", "unittest", "-v", "test_vines"];
  const ended = python(suite, {
    PYTHONPATH: `${join(root, "clients/python")}:${join(root, "tests/clients")}`,
    VINES_PROGRAM: program,
    TEST_SERVICE: open.url,
    TEST_LOCKED: locked.url,
    TEST_KEY: key,
    TEST_RECORD: join(room, "record.csv"),
  });
  assert.equal(ended.status, 0, said(ended));
  assert.match(ended.stderr, /^Ran \d{2} tests/m);
  // What is missing on this machine is said, not hidden.
  for (const [skipped] of ended.stderr.matchAll(/^.*skipped.*$/gm)) console.log(skipped);
});

test("its fields are those of the service", () => {
  const ended = python([join(root, "clients/python/fields.py"), "--check", program]);
  assert.equal(ended.status, 0, said(ended));
});

test("its version is that of the project", () => {
  const declared = (file, pattern) => readFileSync(join(root, file), "utf8").match(pattern)[1];
  assert.equal(
    declared("clients/python/pyproject.toml", /^version = "(.*)"$/m),
    declared("CMakeLists.txt", /VERSION ([0-9.]+) LANG/),
  );
});

test("the lines of Python in the documents work as they stand", () => {
  const {room, open} = services;
  const hasPandas = python(["-c", "import pandas"]).status === 0;
  for (const [file, shown] of [
    ["README.md", /^(\S+ \S+ \S+\n){5}$/],
    ["clients/python/README.md", /^41\/41 /m],
  ]) {
    const [, lines] = readFileSync(join(root, file), "utf8").match(/```python\n([\s\S]*?)```/);
    writeFileSync(join(room, "lines.py"), hasPandas ? lines : lines.replace(/^run\.frame.*$/m, ""));
    for (const way of [{VINES_URL: open.url}, {VINES_PROGRAM: program}]) {
      const ended = python(["lines.py"], way, room);
      assert.equal(ended.status, 0, said(ended));
      assert.match(ended.stdout, shown);
    }
  }
});

test("the fields that are lists are known to the Octave client", () => {
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

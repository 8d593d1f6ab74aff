// Tests of the client for Octave and MATLAB in Octave, with a running service and the program.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdirSync, readFileSync, symlinkSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath} from "node:url";
import {program} from "../service.mjs";
import {key, outcome, startServices} from "./services.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const octave = (args, options = {}) =>
  spawnSync("octave-cli", ["--quiet", "--norc", "--path", join(root, "clients/octave"), ...args], {
    encoding: "utf8",
    ...options,
    env: {...process.env, ...options.env},
  });
const isThere = octave(["--version"]).status === 0;
// CTest recognises a skipped suite by this text.
const skip = isThere ? false : "there is no Octave; scripts/setup test installs it";

let services;
before(async () => {
  if (isThere) services = await startServices();
});
after(() => services?.stop());

test("the Octave client gives the same answers and errors with service and program", {
  skip,
}, () => {
  const {folder, open, locked} = services;
  const own = join(folder, "its $(own)'s"); // a name that a shell would expand
  symlinkSync(program, own);
  mkdirSync(join(folder, "tmp"));
  const ended = octave([join(root, "tests/clients/test_vines.m")], {
    cwd: folder,
    env: {
      VINES_PROGRAM: own,
      TEST_SERVICE: open.url,
      TEST_LOCKED: locked.url,
      TEST_KEY: key,
      TEST_RECORD: join(folder, "record.csv"),
      TEST_FOLDER: folder,
      TMPDIR: join(folder, "tmp"),
    },
  });
  assert.equal(ended.status, 0, outcome(ended));
  assert.match(ended.stdout, /^(ok - .*\n){30,}0 failed$/m);
  // Octave itself can print a line at its end, also of an error that it ignores then.
  assert.doesNotMatch(ended.stderr, /^(warning|error): (?!ignoring .* while preparing to exit)/m);
});

test("the Octave example in the README works unchanged", {skip}, () => {
  const {folder, open} = services;
  const text = readFileSync(join(root, "clients/octave/README.md"), "utf8");
  const [, lines] = text.match(/```octave\n([\s\S]*?)```/);
  const [, expected] = lines.match(/% (422: .*)$/m);
  writeFileSync(join(folder, "shown.m"), lines);
  for (const env of [{VINES_URL: open.url}, {VINES_PROGRAM: program}]) {
    const ended = octave(["shown.m"], {cwd: folder, env});
    assert.equal(ended.status, 0, outcome(ended));
    assert.match(ended.stdout, /^41\/41 /m);
    assert.ok(ended.stdout.includes(expected), outcome(ended));
  }
});

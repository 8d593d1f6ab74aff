// The client for Octave and MATLAB, against the running service and the program, by Octave.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdirSync, readFileSync, symlinkSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath} from "node:url";
import {program} from "../service.mjs";
import {key, said, startServices} from "./services.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const octave = (args, options = {}) =>
  spawnSync("octave-cli", ["--quiet", "--norc", "--path", join(root, "clients/octave"), ...args], {
    encoding: "utf8",
    ...options,
    env: {...process.env, ...options.env},
  });
const isThere = octave(["--version"]).status === 0;
// CTest takes these words for a suite that is skipped.
const skip = isThere ? false : "there is no Octave; scripts/setup test installs it";

let services;
before(async () => {
  if (isThere) services = await startServices();
});
after(() => services?.stop());

test("the Octave client has the same answers, errors and ends from service and program", {
  skip,
}, () => {
  const {room, open, locked} = services;
  const own = join(room, "its $(own)'s"); // a name that a shell would make something else of
  symlinkSync(program, own);
  mkdirSync(join(room, "tmp"));
  const ended = octave([join(root, "tests/clients/test_vines.m")], {
    cwd: room,
    env: {
      VINES_PROGRAM: own,
      TEST_SERVICE: open.url,
      TEST_LOCKED: locked.url,
      TEST_KEY: key,
      TEST_RECORD: join(room, "record.csv"),
      TEST_ROOM: room,
      TMPDIR: join(room, "tmp"),
    },
  });
  assert.equal(ended.status, 0, said(ended));
  assert.match(ended.stdout, /^(ok - .*\n){30,}0 failed$/m);
  assert.equal(ended.stderr, "");
});

test("the lines of Octave in its document work as they stand", {skip}, () => {
  const {room, open} = services;
  const text = readFileSync(join(root, "clients/octave/README.md"), "utf8");
  const [, lines] = text.match(/```octave\n([\s\S]*?)```/);
  const [, promised] = lines.match(/% (422: .*)$/m);
  writeFileSync(join(room, "shown.m"), lines);
  for (const env of [{VINES_URL: open.url}, {VINES_PROGRAM: program}]) {
    const ended = octave(["shown.m"], {cwd: room, env});
    assert.equal(ended.status, 0, said(ended));
    assert.match(ended.stdout, /^41\/41 /m);
    assert.ok(ended.stdout.includes(promised), said(ended));
  }
});

// Starting a service for tests fails with a reason, and leaves no process behind.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {chmodSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {until} from "./http/raw.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-service-"));
after(() => rmSync(folder, {recursive: true}));

/** Runs a script that imports startService() as `start`, with another program for the service. */
const withProgram = (program, script) =>
  spawnSync(process.execPath, ["--input-type=module", "-e", script], {
    encoding: "utf8",
    env: {...process.env, VINES: program},
    timeout: 60000,
  });
const importing = `import {startService as start} from "${new URL("service.mjs", import.meta.url)}";`;

test("a program that does not exist is reported", () => {
  const script = `${importing} await start().catch((error) => console.log(error.message));`;
  const {status, stdout, stderr} = withProgram("/no/such/file", script);
  assert.deepEqual(
    {status, stdout, stderr},
    {status: 0, stdout: "spawn /no/such/file ENOENT\n", stderr: ""},
  );
});

test("a program that never listens ends with the process that started it", async () => {
  const silent = join(folder, "silent");
  const pidFile = join(folder, "pid");
  writeFileSync(
    silent,
    `#!/bin/sh\necho $$ >'${pidFile}.new'; mv '${pidFile}.new' '${pidFile}'; exec sleep 600\n`,
  );
  chmodSync(silent, 0o755);
  const script = `${importing}
    import {existsSync} from "node:fs";
    start();
    setInterval(() => existsSync("${pidFile}") && process.exit(7), 5);`;
  assert.equal(withProgram(silent, script).status, 7);
  const pid = Number(readFileSync(pidFile, "utf8"));
  // Without a parent that reads its exit code an ended process can stay as a zombie.
  const hasEnded = () => {
    try {
      return readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].startsWith("Z");
    } catch {
      return true;
    }
  };
  await until(hasEnded);
});

// Starts and stops a service for tests.
import {spawn} from "node:child_process";

export const program =
  process.env.VINES ?? new URL("../build/release/vines", import.meta.url).pathname;

// Kills services that a failed test did not stop.
const started = new Set();
process.once("exit", () => {
  for (const child of started) child.kill("SIGKILL");
});

const startLimit = 60000; // ms; on a machine under load it takes a second

/**
 * Starts `vines serve`. freePort: on a free port; otherwise the port is in `flags` or
 * `environment`. Resolves to {url, pid, log, stop} once the service listens; log() returns its log so
 * far, stop() resolves to the exit code. Rejects if the service does not start, or ends before it listens.
 */
export async function startService(flags = [], environment = {}, freePort = true) {
  const child = spawn(program, ["serve", ...(freePort ? ["--port", "0"] : []), ...flags], {
    stdio: ["ignore", "pipe", "pipe"],
    env: {...process.env, ...environment},
  });
  started.add(child);
  const ended = new Promise((resolve) => child.on("exit", resolve));
  ended.then(() => started.delete(child));
  let log = "";
  child.stderr.on("data", (data) => {
    log += data;
  });
  let timer;
  const url = await new Promise((resolve, reject) => {
    let text = "";
    const fail = (how) => reject(new Error(`${program} ${how}: ${text}${log}`));
    child.on("error", reject);
    child.stdout.on("data", (data) => {
      text += data;
      const found = text.match(/listens on (\S+)/);
      if (found) resolve(found[1]);
    });
    ended.then((code) => fail(`ended with ${code}`));
    timer = setTimeout(() => {
      child.kill("SIGKILL");
      fail("does not listen");
    }, startLimit);
  }).finally(() => clearTimeout(timer));
  // A running service does not keep the test process alive; stop() waits for its end.
  child.unref();
  child.stdout.unref();
  child.stderr.unref();
  const stop = () => {
    child.ref();
    child.kill("SIGTERM");
    return ended;
  };
  return {url, pid: child.pid, log: () => log, stop};
}

// Starts and stops a service for tests.
import {spawn} from "node:child_process";

export const program =
  process.env.VINES ?? new URL("../build/release/vines", import.meta.url).pathname;

// Kills services that a failed test did not stop.
const started = new Set();
process.once("exit", () => {
  for (const child of started) child.kill("SIGKILL");
});

/**
 * Starts `vines serve`. freePort: on a free port; otherwise the port is in `flags` or
 * `environment`. Resolves to {url, pid, stop} once the service listens; stop() resolves to the exit
 * code. Rejects if the service ends before it listens.
 */
export async function startService(flags = [], environment = {}, freePort = true) {
  const child = spawn(program, ["serve", ...(freePort ? ["--port", "0"] : []), ...flags], {
    stdio: ["ignore", "pipe", "ignore"],
    env: {...process.env, ...environment},
  });
  const ended = new Promise((resolve) => child.on("exit", resolve));
  ended.then(() => started.delete(child));
  const url = await new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      const found = text.match(/listens on (\S+)/);
      if (found) resolve(found[1]);
    });
    ended.then((code) => reject(new Error(`${program} ended with ${code}: ${text}`)));
  });
  // A running service does not keep the test process alive; stop() waits for its end.
  child.unref();
  child.stdout.unref();
  started.add(child);
  const stop = () => {
    child.ref();
    child.kill("SIGTERM");
    return ended;
  };
  return {url, pid: child.pid, stop};
}

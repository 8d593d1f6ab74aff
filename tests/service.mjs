// Starts and stops a service for tests.
import {spawn} from "node:child_process";

export const program =
  process.env.VINES ?? new URL("../build/release/vines", import.meta.url).pathname;

// Stops the services of tests that failed before they could do so.
const started = new Set();
process.once("exit", () => {
  for (const child of started) child.kill("SIGKILL");
});

/**
 * Starts `vines serve` on a free port; resolves to {url, pid, stop}, where stop resolves to the
 * exit code.
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

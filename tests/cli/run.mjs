// Runs the program for the tests.
import {spawn} from "node:child_process";
import {readdir, readFile} from "node:fs/promises";
import {setTimeout as sleep} from "node:timers/promises";
import {program} from "../service.mjs";

/**
 * Runs the program to its end, or sends it one signal once `until(pid, stdout so far)` is true.
 * shell: a command line in which $VINES is the program and "$@" its arguments. Resolves to
 * {code, out, errors, computed, idle}: the CPU time in s from the signal to the end, and how often
 * all threads slept when they were looked at meanwhile, every 5 ms. Both are small on a busy machine, too.
 */
export const run = (args, {input = "", open = false, env = {}, signal, until, shell} = {}) =>
  new Promise((resolve) => {
    const [file, words] = shell ? ["bash", ["-c", shell, "vines", ...args]] : [program, args];
    const child = spawn(file, words, {env: {...process.env, VINES: program, ...env}});
    let out = "";
    let errors = "";
    const since = {};
    child.stdout.on("data", (d) => (out += d));
    child.stderr.on("data", (d) => (errors += d));
    child.on("close", (code) => resolve({code, out, errors, ...since}));
    child.stdin.on("error", () => {});
    child.stdin.write(input);
    if (!open) child.stdin.end();
    // Checked one after the other: a second signal would end the program at once.
    const check = async () => {
      if (child.exitCode !== null) return;
      if (await until(child.pid, out)) {
        watch(child.pid, since);
        child.kill(signal);
      } else setTimeout(check, 5);
    };
    if (signal) check();
  });

/** Returns whether a process has blocked SIGINT; it then waits for it in a thread. */
export const waitsForSignals = async (pid) =>
  (BigInt(`0x${(await readFile(`/proc/${pid}/status`, "utf8")).match(/^SigBlk:\s+(\w+)/m)[1]}`) &
    2n) !==
  0n;

/** CPU time of a process in s. */
export async function computed(pid) {
  const fields = (await readFile(`/proc/${pid}/stat`, "utf8")).split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

/** Sets, until the process ends, the CPU time that it uses from now on, and how often it was idle. */
async function watch(pid, since) {
  Object.assign(since, {computed: 0, idle: 0});
  try {
    for (const before = await computed(pid); ; await sleep(5)) {
      const folder = `/proc/${pid}/task`;
      const threads = await readdir(folder);
      const read = (id) => readFile(`${folder}/${id}/stat`, "utf8").catch(() => ""); // it has ended
      const stats = await Promise.all(threads.map(read));
      if (stats.every((text) => text.split(") ")[1].startsWith("S"))) ++since.idle;
      since.computed = (await computed(pid)) - before;
    }
  } catch {} // the process has ended
}

/** Condition for `until`: the process has used this CPU time, so it has read its request. */
export const hasComputed = (seconds) => async (pid) => (await computed(pid)) >= seconds;

/** Parses lines of JSON. */
export const parsed = (text) =>
  text
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));

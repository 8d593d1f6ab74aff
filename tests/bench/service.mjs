// How long a sweep makes others wait, in the running service, and how fast it answers beside a bare
// server: node tests/bench/service.mjs [PORT...], where the ports are those of other services to be
// measured in turn with it.
import {spawnSync} from "node:child_process";
import {startService} from "../service.mjs";

const service = await startService(["--sweeps", "1"]);
const sweep = JSON.stringify({
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 20000}],
  cycles: 2000,
});
const run = JSON.stringify({
  b: 0.022,
  damping: "closed_form",
  tau_end: 20000,
  include: ["exponents"],
});
const post = (path, body, options = {}) =>
  fetch(service.url + path, {method: "POST", body, ...options});

/** Starts a sweep as soon as there is room for one and returns, once its first line has come, how to leave it. */
const startSweep = async () => {
  for (;;) {
    const leaving = new AbortController();
    const response = await post("/v1/sweep", sweep, {signal: leaving.signal});
    if (response.status === 200) {
      await response.body.getReader().read();
      return () => leaving.abort();
    }
    await response.text();
    await new Promise((resolve) => setTimeout(resolve, 2));
  }
};

/** Least and median of so many times, in ms. What else the machine does only adds. */
const timed = async (count, work) => {
  const times = [];
  for (let i = 0; i < count; ++i) times.push(await work());
  times.sort((a, b) => a - b);
  return {least: times[0], median: times[count >> 1]};
};

const simulation = async () => {
  const started = performance.now();
  await (await post("/v1/simulate", run)).text();
  return performance.now() - started;
};
await simulation();
const alone = await timed(31, simulation);
let leave = await startSweep();
const beside = await timed(31, simulation);
const free = await timed(9, async () => {
  leave();
  const left = performance.now();
  leave = await startSweep();
  return performance.now() - left;
});
leave();
const answers = new URL("../../build/release/tests/bench_answers", import.meta.url).pathname;
const ports = [new URL(service.url).port, ...process.argv.slice(2)];
spawnSync(answers, ports, {stdio: "inherit"});
await service.stop();

const ms = (x) => `${x.toFixed(1)} ms`;
console.log(
  `a simulation alone: ${ms(alone.median)}, beside a sweep on all cores: ${ms(beside.median)} (median of 31); ratio of the least: ${(beside.least / alone.least).toFixed(2)}, to be below 2`,
);
console.log(
  `a sweep whose client left gives its room back after ${ms(free.median)} (median of 9), to be below 200 ms`,
);

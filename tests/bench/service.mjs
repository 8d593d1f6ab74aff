// Waiting time caused by a sweep in the running service, rate of its lines, and response times next
// to a bare server, as rows of scripts/bench's table: node tests/bench/service.mjs [PORT...], where
// PORTs are those of other services to be measured in turn.
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

/** Starts a sweep once it is accepted. Resolves, after its first line, to its cancel function. */
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

/** Times of repeated calls in ms, ascending. Other load on the machine only adds to them. */
const timed = async (count, work) => {
  const times = [];
  for (let i = 0; i < count; ++i) times.push(await work());
  return times.sort((a, b) => a - b);
};

const ms = (x) => x.toFixed(1);
const row = (what, times, remark = "") =>
  console.log(
    `| ${what} | ${ms(times[times.length >> 1])} ms${remark} | ${ms(times[0])} to ${ms(times.at(-1))} |`,
  );

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

// A sweep with cheap points shows the cost of its lines.
const many = JSON.stringify({
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.002, to: 0.04, count: 1000}],
  transient_cycles: 0,
  cycles: 1,
});
let size = 0;
const lines = await timed(9, async () => {
  for (;;) {
    const started = performance.now();
    const response = await post("/v1/sweep", many);
    const text = await response.text();
    size = text.length;
    if (response.status === 200) return performance.now() - started;
  }
});

row("over HTTP: a simulation alone", alone);
row("the same next to a sweep on all cores", beside);
console.log(
  `| ratio of the shortest times | ${(beside[0] / alone[0]).toFixed(2)}, to be below 2 | |`,
);
row("time until a sweep whose client left is replaced", free, ", to be below 200");
row(`over HTTP: a sweep of 1000 points of one cycle each, ${size} bytes of lines`, lines);
const answers = new URL("../../build/release/tests/bench_answers", import.meta.url).pathname;
const ports = [new URL(service.url).port, ...process.argv.slice(2)];
spawnSync(answers, ports, {stdio: "inherit"});
await service.stop();

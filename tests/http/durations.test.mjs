// Times of the service. LONG=1: durations that an operator would try once.
import assert from "node:assert/strict";
import {execFile} from "node:child_process";
import {test} from "node:test";
import {promisify} from "node:util";
import {computed, memory, send, serviceFor, sleep, textOf} from "./raw.mjs";

const long = Boolean(process.env.LONG);
// A program with sanitizers is several times slower and keeps freed memory for a while.
const sanitized = Boolean(process.env.SANITIZED);
const slower = sanitized ? 6 : 1;

/** Durations of requests to /livez, ms, measured for `ms` by a separate process. */
async function probed(url, ms) {
  const prober = new URL("prober.mjs", import.meta.url).pathname;
  return JSON.parse((await promisify(execFile)(process.execPath, [prober, url, ms])).stdout);
}

test("under overload each answer is 200 or 503 with Retry-After, and health is faster than a queued request", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1", "--compute-queue", "8"]);
  const body = '{"damping": "closed_form", "tau_end": 60000, "include": ["regime"]}';
  const ms = long ? 60000 : 4000;
  const end = performance.now() + ms;
  const counts = {};
  const durations = []; // of the requests that were computed, ms
  const client = async () => {
    while (performance.now() < end) {
      const began = performance.now();
      const answer = await send(one.url, "/v1/simulate", body);
      await answer.text();
      counts[answer.status] = (counts[answer.status] ?? 0) + 1;
      if (answer.status === 200) durations.push(performance.now() - began);
      if (answer.status === 503) {
        assert.equal(answer.headers.get("retry-after"), "1");
        await sleep(100);
      }
    }
  };
  const [times] = await Promise.all([probed(one.url, ms), ...Array.from({length: 64}, client)]);
  assert.deepEqual(Object.keys(counts), ["200", "503"]); // in numerical order
  times.sort((a, b) => a - b);
  // In a short run single slow requests are caused by the machine.
  const slowest = times[Math.floor(times.length * (long ? 0.99 : 0.95))];
  t.diagnostic(
    `200: ${counts[200]}, 503: ${counts[503]}, /livez ${slowest.toFixed(1)} ms of ${times.length}`,
  );
  durations.sort((a, b) => a - b);
  const median = durations[Math.floor(durations.length / 2)];
  assert.ok(
    slowest < Math.max(median, 50 * slower),
    `/livez: ${slowest.toFixed(1)} ms, a computed request: ${median.toFixed(1)} ms`,
  );
  await textOf(await send(one.url, "/v1/simulate", body));
});

test("a large body is read within the deadline, in a few times its size, and its memory is released", async (t) => {
  const one = await serviceFor(t, ["--deadline", "1"]);
  const size = 60_000_000;
  const list = (entry) => `{"q":[${entry.repeat(size / entry.length)}0]}`;
  const query = "/v1/identify?preset=fig20&b=0.015";
  const bodies = [
    ["/v1/identify", list("[0],"), "application/json"],
    ["/v1/identify", list("0,"), "application/json"],
    ["/v1/identify", list('{"":0},'), "application/json"],
    [query, "a\n".repeat(size / 2), "text/csv"],
    [query, `t,x\n${"1,1\n".repeat(size / 4)}`, "text/csv"],
  ];
  const before = await memory(one.pid);
  for (const [path, body, type] of bodies) {
    const began = await computed(one.pid);
    const {status} = await send(one.url, path, body, {headers: {"Content-Type": type}});
    const what = body.slice(0, 20);
    assert.ok(status === 413 || status === 422, `${what}: ${status}`);
    const seconds = (await computed(one.pid)) - began;
    assert.ok(seconds < 2 * slower, `${what}: ${seconds} s`);
    // A sanitizer keeps freed memory.
    if (!sanitized) assert.ok((await memory(one.pid)) - before < 60, what);
  }
  if (!sanitized) assert.ok((await memory(one.pid, "VmHWM")) < 300);
});

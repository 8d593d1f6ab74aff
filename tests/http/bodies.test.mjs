// Memory of the service while it reads and computes the largest bodies that its default limits admit, hostile
// ones included, several at once.
import assert from "node:assert/strict";
import {test} from "node:test";
import {startService} from "../service.mjs";
import {memory, metric, serviceFor, until} from "./raw.mjs";

const record = 64 << 20; // --record-limit
const payload = 1 << 20; // --payload-limit
const plan = 5 << 20; // body of a sweep
// A sanitizer keeps freed memory.
const sanitized = Boolean(process.env.SANITIZED);
const system = '"m1":1,"c1":1,"k1":1000,"m2":0.1,"b":0.01,"f":5';

/** `entry` between head and tail as often as fits into `size` bytes; blanks fill the rest. */
function filled(head, entry, tail, size = record) {
  const bytes = Buffer.alloc(size, " ");
  const ends = Buffer.byteLength(head) + Buffer.byteLength(tail);
  const length = Buffer.byteLength(entry) * Math.floor((size - ends) / Buffer.byteLength(entry));
  const from = bytes.write(head);
  bytes.fill(entry, from, from + length);
  bytes.write(tail, from + length);
  return bytes;
}

const identify = (body) => ({path: "/v1/identify", body, type: "application/json"});
const table = (body) => ({path: "/v1/identify?preset=fig20&b=0.015", body, type: "text/csv"});
const sweep = (body) => ({path: "/v1/sweep", body, type: "application/json"});
const list = (entry) => identify(filled('{"q":[', `${entry},`, "0]}"));
const column = (entry) => identify(filled(`{${system},"record":{"time_s":[`, `${entry},`, "0]}}"));

/** `count` numbers that increase. */
const increasing = (count) => Array.from({length: count}, (_, k) => k).join();
const repeated = (entry, count) => `${`${entry},`.repeat(count - 1)}${entry}`;

/** A list of impacts with few digits, for a short answer: the oscillator rests and jumps. */
function impacts(count) {
  const columns = `"tau":[${increasing(count)}],"x":[${repeated(0, count)}]`;
  const jumps = repeated("1,-1", count / 2);
  return Buffer.from(
    `{${system},"R":0.6,"fields":["verdict"],"impacts":{${columns},"x_dot_before":[${jumps}],"x_dot_after":[${repeated(0, count)}]}}`,
  );
}

/** A record at 1 kHz whose motion, 20 impacts in 1.4 s, is repeated: too long for any deadline of this test. */
function samples(count) {
  const displacement = [];
  const acceleration = [];
  for (let k = 0; k < 1400; ++k) {
    const side = Math.floor(k / 70) % 2 ? 1 : -1;
    const sine = Math.sin((2 * Math.PI * k) / 200);
    const noise = ((k * 7919) % 1399) / 1399 - 0.5;
    displacement.push(Math.round(10000 * sine + side * ((k % 70) / 70 - 0.5) * 2000 + 4 * noise));
    acceleration.push((-9.87 * sine - (k % 70 < 2 ? side * 60 : 0) + 0.05 * noise).toFixed(2));
  }
  const times = count / 1400;
  return Buffer.from(
    `{${system},"record":{"time_ms":[${increasing(count)}],"displacement_um":[${repeated(displacement, times)}],"acceleration":[${repeated(acceleration, times)}]}}`,
  );
}

const names = Array.from({length: 999}, (_, k) => `"${k}${"n".repeat(60000)}":0`);
const axes =
  '{"base":{"preset":"fig20"},"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":1}]';
/** Hostile bodies by name: made when used, since all of them together have a gigabyte. */
const kinds = {
  "numbers of an unknown field": () => list("0"),
  "numbers of a column": () => column("0"),
  "nulls of a column": () => identify(filled('{"impacts":{"tau":[', "null,", "0]}}")),
  "numbers and truths": () => column("0,true"),
  "arrays in a column": () => column("[]"),
  "numbers in an array in a column": () => column(`[${repeated(0, 999)}]`),
  "empty objects": () => list("{}"),
  "objects with an empty name": () => list('{"":0}'),
  "deep nesting": () => identify(filled("", "[", "")),
  "empty strings": () => list('""'),
  "a long string": () => identify(filled('{"q":"', "q", '"}')),
  "many strings": () => list(`"${"\\u00e9".repeat(150000)}"`),
  "long names": () => identify(filled(`{${names.join()}`, " ", "}")),
  "names twice": () => identify(filled("{", '"b":0.01,', '"b":0.02}')),
  "a long number": () => identify(filled('{"q":', "1", "}")),
  "numbers of 1000 digits": () => list("1".repeat(1000)),
  "numbers of the list of times": () =>
    identify(filled('{"impact_times_s":[', "0,", "0]}", 2 << 20)),
  "a list of impacts": () => identify(impacts(500000)),
  "more impacts": () => identify(impacts(1900000)),
  "a record": () => identify(samples(2660000)),
  "ones in a table": () => table(filled("t,x\n", "1,1\n", "")),
  "a table of 1000 columns": () =>
    table(filled(`${repeated("c", 1000)}\n`, `${repeated("1", 1000)}\n`, "")),
  "a table of one long line": () => table(filled("time_s,displacement_m\n", "1", "\n")),
  "a table of short lines": () => table(filled("", "a\n", "")),
  "a table of separators": () => table(filled("time_s,displacement_m\n0,0\n", ",", "\n")),
  "a table in UTF-16": () =>
    table(Buffer.from(filled("\ufefft,x\n", "1,1\n", "", record / 2).toString(), "utf16le")),
  "a table in Latin-1": () => table(Buffer.alloc(record, 0xe9)),
  "starts of a sweep": () => sweep(filled(`${axes},"starts":[`, '{"x0":0},', "{}]}", plan)),
  "starts with all digits": () =>
    sweep(
      filled(
        `${axes},"starts":[`,
        '{"x0":-0.00123456789012345,"y_dot0":-0.0123456},',
        "{}]}",
        plan,
      ),
    ),
  "empty starts": () => sweep(filled(`${axes},"starts":[`, "{},", "{}]}", plan)),
  "values of a sweep": () =>
    sweep(filled('{"axes":[{"parameter":"b","values":[', "1,", "1]}]}", plan)),
  windows: () => ({
    ...sweep(filled('{"windows":[', "[0,1],", "[0,1]]}", payload)),
    path: "/v1/simulate",
  }),
};

async function answered(url, {path, body, type}, name) {
  const headers = {"Content-Type": type};
  const answer = await fetch(url + path, {method: "POST", headers, body}).catch(({cause}) => {
    // Refused, and closed some seconds later, before a busy client had read that.
    assert.match(cause.code, /^(EPIPE|ECONNRESET|UND_ERR_SOCKET)$/, name);
  });
  if (!answer) return;
  // A sweep would take longer than this test; 503: others are read.
  if (answer.status === 200) await answer.body.cancel();
  else await answer.arrayBuffer();
  assert.ok(answer.status < 500 || answer.status === 503, `${name}: ${answer.status}`);
}

/** The peak of a fresh server that receives these kinds of bodies at once, MB. */
async function peak(t, names, threads) {
  const one = await serviceFor(t, ["--compute-threads", String(threads), "--deadline", "1"]);
  const bodies = names.map((name) => kinds[name]());
  await Promise.all(bodies.map((body, k) => answered(one.url, body, names[k])));
  assert.equal((await fetch(`${one.url}/readyz`)).status, 200);
  const most = await memory(one.pid, "VmHWM");
  t.diagnostic(`${most.toFixed(0)} MB: ${[...new Set(names)].join("; ")}`);
  return most;
}

const threads = [1, 2, 8];

test("two bodies at once, whatever they contain, take at most 400 MB", async (t) => {
  const pairs = [
    ["nulls of a column", "a table in UTF-16"],
    ["a table in Latin-1", "ones in a table"],
    ["a list of impacts", "numbers of a column"],
    ["a record", "a record"],
  ];
  for (const [k, names] of pairs.entries()) {
    const most = await peak(t, names, threads[k % 3]);
    if (!sanitized) assert.ok(most < 400, `${names}: ${most} MB`);
  }
});

test("eight bodies at once, whatever they contain, take at most 700 MB", async (t) => {
  const all = Object.keys(kinds);
  const groups = [];
  for (let k = 0; k < all.length; k += 8) groups.push(all.slice(k, k + 8));
  for (const [k, names] of groups.entries()) {
    const most = await peak(t, names, threads[k % 3]);
    if (!sanitized) assert.ok(most < 700, `${names}: ${most} MB`);
  }
});

const running = (url) => metric(url, "vines_compute_running");

test("a large body waits without a slot, until its deadline, its client leaves or the server stops", async () => {
  const one = await startService(["--compute-threads", "2", "--deadline", "1"]);
  const send = (options = {}) =>
    fetch(`${one.url}/v1/identify`, {method: "POST", body: samples(700000), ...options});
  const first = send();
  await until(async () => (await running(one.url)) === 1);
  const client = new AbortController();
  const left = send({signal: client.signal}).catch((error) => error.name);
  const second = send();
  // The other slot is free for small requests.
  assert.equal((await fetch(`${one.url}/v1/simulate?preset=fig3&tau_end=10`)).status, 200);
  client.abort();
  assert.equal(await left, "AbortError");
  assert.equal((await first).status, 413);
  assert.ok([413, 503].includes((await second).status));
  const third = send();
  await until(async () => (await running(one.url)) === 1);
  const fourth = send();
  const ended = one.stop();
  assert.ok([413, 503].includes((await third).status));
  await fourth.catch(() => {});
  assert.equal(await ended, 0);
});

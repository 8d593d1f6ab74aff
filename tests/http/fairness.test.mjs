// One client with many connections leaves their share to the others. The clients here are those
// that a trusted proxy names.
import assert from "node:assert/strict";
import {mkdtemp, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";
import {startService} from "../service.mjs";
import {
  connect,
  connectAll,
  get,
  memory,
  metric,
  post,
  send,
  serviceFor,
  statuses,
  textOf,
  until,
} from "./raw.mjs";

const from = (address) => `X-Forwarded-For: 198.51.100.7, ${address}\r\n`;
const run = '{"tau_end": 20000, "include": ["exponents"]}';
const streamed = '{"tau_end": 200000, "include": ["impacts"], "max_impacts": 200000}';
const windows = [0, 1, 2, 3, 4, 5, 6, 7].map((start) => [start, 9e6]);
/** A run of some seconds. */
const long = JSON.stringify({tau_end: 1e7, max_impacts: 2e6, include: ["exponents"], windows});
const trust = ["--trust-proxy", "127.0.0.1"];
const other = {headers: {"X-Forwarded-For": "192.0.2.2"}};

const small = '{"tau_end": 20}';

/** A service, and the connections of one client that sends the same request again and again. */
async function withGreedy(t, args, connections, body, header = from("192.0.2.1")) {
  const one = await startService(args);
  const requests = post("/v1/simulate", body, header).repeat(20);
  const sockets = await connectAll(one.url, connections, () => requests);
  t.after(async () => {
    for (const {socket} of sockets) socket.destroy();
    await one.stop();
  });
  await until(() => sockets.some(({text}) => statuses(text()).length > 0));
  return one;
}

/** A service with one slot, and the connections of clients with a long run each. */
async function withLongRuns(t, args, clients) {
  const one = await startService([...trust, ...args]);
  const sockets = await connectAll(one.url, clients, (i) =>
    post("/v1/simulate", long, from(`192.0.2.${10 + i}`)),
  );
  t.after(async () => {
    for (const {socket} of sockets) socket.destroy();
    await one.stop();
  });
  await until(async () => (await metric(one.url, "vines_compute_queue_depth")) === clients - 1);
  return {one, sockets};
}

test("requests of another client are all answered while one client fills the queue", async (t) => {
  const one = await withGreedy(t, [...trust, "--compute-queue", "8"], 60, run);
  for (let i = 0; i < 5; ++i) {
    await textOf(await send(one.url, "/v1/simulate", run, other));
  }
});

test("requests and a sweep of others are answered while long runs of one client have all slots", async (t) => {
  const one = await startService([...trust, "--compute-threads", "2", "--deadline", "600"]);
  const requests = post("/v1/simulate", long, from("192.0.2.1"));
  const sockets = await connectAll(one.url, 20, () => requests);
  t.after(async () => {
    for (const {socket} of sockets) socket.destroy();
    await one.stop();
  });
  const metrics = async () => (await fetch(`${one.url}/metrics`)).text();
  await until(async () => /^vines_compute_queue_depth 18$/m.test(await metrics()));
  await textOf(await send(one.url, "/v1/simulate", run, other));
  const sweep = {axes: [{parameter: "b", from: 0.01, to: 0.03, count: 20}], cycles: 10};
  assert.match(await textOf(await send(one.url, "/v1/sweep", sweep, other)), /"points":20\}/);
  assert.ok(sockets.every(({text}) => statuses(text()).length === 0));
});

test("so are they while many clients have long runs", async (t) => {
  const {one, sockets} = await withLongRuns(t, ["--compute-threads", "1", "--deadline", "600"], 24);
  await textOf(await send(one.url, "/v1/simulate", run, other));
  assert.ok(sockets.every(({text}) => statuses(text()).length === 0));
});

test("so are they, however many, while it has more streams than there are threads", async (t) => {
  const one = await withGreedy(t, [...trust, "--threads", "8"], 40, streamed);
  for (let i = 0; i < 100; ++i) {
    await textOf(await send(one.url, "/v1/simulate", small, other));
  }
});

test("a request begins within 10 s while as many clients as there are threads have long runs", async (t) => {
  const {one, sockets} = await withLongRuns(t, ["--threads", "4", "--compute-threads", "1"], 4);
  await textOf(await send(one.url, "/v1/simulate", run, other));
  await until(() => sockets.some(({text}) => statuses(text()).length > 0));
  const {status} = JSON.parse(
    sockets
      .find(({text}) => text())
      .text()
      .split("\r\n\r\n")[1],
  );
  assert.equal(status.reason, "deadline");
});

test("pipelined health checks of many connections of a client take turns with the other clients", async (t) => {
  const one = await serviceFor(t);
  const count = (text) => Number(/route="\/livez"[^}]*} (\d+)/.exec(text)?.[1] ?? 0);
  const answered = async () => count(await (await fetch(`${one.url}/metrics`)).text());
  const sockets = [];
  for (let i = 0; i < 200; ++i) {
    sockets.push(await connect(one.url, {localAddress: "127.0.0.2"}));
    sockets[i].socket.write(get("/livez").repeat(2000));
  }
  t.after(() => {
    for (const {socket} of sockets) socket.destroy();
  });
  while ((await answered()) < 20000);
  // 17 answers to each connection are 3400; a worker that answers can be late.
  const within = [];
  for (let i = 0; i < 10; ++i) within.push(-(await answered()) + (await answered()));
  assert.ok(Math.min(...within) < 1500, `${within} answers within one`);
});

test("few requests follow one sweep, so that threads remain for others; it passes to one that remains", async (t) => {
  const one = await serviceFor(t, [...trust, "--threads", "32", "--sweeps", "4"]);
  const sweep = {
    axes: [{parameter: "b", from: 0.01, to: 0.03, count: 500}],
    cycles: 100000,
    transient_cycles: 10,
  };
  const begun = [];
  t.after(() => {
    for (const {leave} of begun) leave.abort();
  });
  const follow = async (client) => {
    const leave = new AbortController();
    const headers = {"X-Forwarded-For": client};
    const answer = await send(one.url, "/v1/sweep", sweep, {headers, signal: leave.signal});
    begun.push({leave, answer});
    return answer.status;
  };
  const most = async (client) => {
    let count = 0;
    while ((await follow(client)) === 200) ++count;
    return count;
  };
  // Half of the threads follow: half of these of one client, which begins one more, a quarter of
  // the next one, and one of each other.
  const counts = [];
  for (const i of [1, 2, 3, 4, 5, 6, 7]) counts.push(await most(`192.0.2.${i}`));
  assert.deepEqual(counts, [9, 4, 1, 1, 1, 1, 0]);
  await textOf(await send(one.url, "/v1/simulate", small, other));
  // The client of the first request may begin another sweep once it has left this one.
  begun[0].leave.abort();
  sweep.cycles += 1;
  const again = () => follow("192.0.2.1");
  await until(async () => (await again()) === 200);
});

test("a long run with a large body does not hold up other runs with large bodies", async (t) => {
  const one = await startService([...trust, "--compute-threads", "2", "--deadline", "600"]);
  const {socket, text} = await connect(one.url);
  t.after(async () => {
    socket.destroy();
    await one.stop();
  });
  socket.write(post("/v1/simulate", long + " ".repeat(300000), from("192.0.2.1")));
  await until(async () => (await metric(one.url, "vines_compute_running")) === 1);
  await textOf(await send(one.url, "/v1/simulate", run + " ".repeat(300000), other));
  assert.equal(text().length, 0);
});

test("many runs with large series wait for their turn in little memory", async (t) => {
  const one = await startService([...trust, "--memory-limit", "25000000"]);
  const system = {m1: 2, f0: 8, damping_ratio: 0.01, m2: 0.04, b: 0.02, R: 0.5, f: 8, F: 0.0005};
  const series = {tau_end: 15700, samples_per_cycle: 100, max_points: 2.5e5, include: ["series"]};
  const request = JSON.stringify({...system, ...series});
  const sockets = await connectAll(one.url, 40, () =>
    post("/v1/simulate", request, `${from("192.0.2.1")}Accept-Encoding: gzip\r\n`).repeat(4),
  );
  t.after(async () => {
    for (const {socket} of sockets) socket.destroy();
    await one.stop();
  });
  const answered = () => sockets.filter(({text}) => text()).length;
  await until(() => answered() > 8); // 40 runs with all of their points would have 900 MB
  const peak = await memory(one.pid, "VmHWM");
  assert.ok(peak < 300, `${peak} MB`);
});

test("uploads that dribble are cut off while another waits for memory", async (t) => {
  const one = await serviceFor(t, [...trust, "--memory-limit", "136000000"]);
  for (const address of ["192.0.2.1", "192.0.2.3", "192.0.2.4"]) {
    const {socket} = await connect(one.url);
    socket.write(
      `POST /v1/identify HTTP/1.1\r\nHost: x\r\n${from(address)}Content-Length: 30000000\r\n\r\n`,
    );
    socket.write(Buffer.alloc(17 << 20, " "));
    const dribble = setInterval(() => socket.write(Buffer.alloc(70000, " ")), 4000);
    t.after(() => {
      clearInterval(dribble);
      socket.destroy();
    });
  }
  await until(async () => (await metric(one.url, "vines_http_held_bytes")) > 70e6);
  const record = `{"preset": "fig20", ${" ".repeat(30 << 20)}"record": {}}`;
  const answer = await send(one.url, "/v1/identify", record, other);
  assert.equal(answer.status, 422, await answer.text()); // read, once it found memory
});

test("many small bodies that are not complete leave memory to others", async (t) => {
  const one = await serviceFor(t, [...trust, "--memory-limit", "20000000"]);
  const sockets = await connectAll(one.url, 400, (i) => {
    const head = `POST /v1/identify HTTP/1.1\r\nHost: x\r\n${from(`192.0.2.${10 + (i % 4)}`)}`;
    return `${head}Content-Length: 65400\r\n\r\n${" ".repeat(60000)}`;
  });
  t.after(() => {
    for (const {socket} of sockets) socket.destroy();
  });
  let most = 0;
  await until(async () => {
    most = Math.max(most, await metric(one.url, "vines_http_held_bytes"));
    return sockets.some(({text}) => text()); // the time of one is over
  });
  assert.ok(most > 8e6 && most < 20e6, `${most} bytes`);
  await textOf(await send(one.url, "/v1/simulate", '{"tau_end": 1000}', other));
});

test("an API key is a client, wherever its requests come from; the log names it, not its secret", async (t) => {
  const keys = join(await mkdtemp(join(tmpdir(), "vines-")), "keys");
  const greedy = "the-key-of-a-greedy-client";
  const modest = "the-key-of-a-modest-client";
  await writeFile(keys, `${greedy}\n${modest}\n`);
  const one = await withGreedy(
    t,
    ["--compute-queue", "8", "--api-key-file", keys],
    60,
    run,
    `Authorization: Bearer ${greedy}\r\n`,
  );
  const headers = {Authorization: `Bearer ${modest}`};
  await textOf(await send(one.url, "/v1/simulate", run, {headers}));
  // printf %s KEY | sha256sum | cut -c1-8
  await until(() => one.log().includes('"key":"53525422"'));
  assert.ok(!one.log().includes(greedy) && !one.log().includes(modest));
});

test("one client has a limited number of connections; beyond it its own idle ones are closed", async (t) => {
  const one = await startService(["--client-connections", "3"]);
  const other = await connect(one.url, {localAddress: "127.0.0.2"});
  const own = [];
  t.after(async () => {
    for (const {socket} of [other, ...own]) socket.destroy();
    await one.stop();
  });
  let ended = 0;
  for (let i = 0; i < 4; ++i) {
    const connection = await connect(one.url);
    connection.ended.then(() => ++ended);
    connection.socket.write(get("/livez"));
    own.push(connection);
    await until(() => statuses(connection.text()).length === 1);
  }
  await until(() => ended === 1);
  other.socket.write(get("/livez"));
  await until(() => statuses(other.text()).length === 1);
  assert.equal(ended, 1);
});

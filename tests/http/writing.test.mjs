// Clients that do not read their answers take nothing from others for longer than a few seconds.
import assert from "node:assert/strict";
import {test} from "node:test";
import {startService} from "../service.mjs";
import {connect, connectAll, get, memory, post, send, serviceFor, statuses, until} from "./raw.mjs";

// Time within which others get what such a client holds, ms.
const soon = 5000;

/** A client that sends a request and reads only the beginning of its answer. */
async function unread(url, path, body, address) {
  const connection = await connect(url);
  connection.socket.once("data", () => connection.socket.pause());
  connection.socket.write(post(path, JSON.stringify(body), `X-Forwarded-For: ${address}\r\n`));
  await until(() => connection.text().length > 0);
  return connection;
}

/** True once the answer is 200; reads all of it. */
async function isAnswered(url, path, body) {
  const answer = await send(url, path, body);
  await answer.arrayBuffer();
  return answer.status === 200;
}

const small = {damping: "closed_form", tau_end: 20};
// 8 MB.
const large = {damping: "closed_form", tau_end: 2000, max_points: 1e5, samples_per_cycle: 200};
// A stream of 50 MB.
const streamed = {damping: "closed_form", tau_end: 2e5, include: ["impacts"], max_impacts: 2e5};
const sweep = {
  axes: [{parameter: "b", from: 0.005, to: 0.03, count: 3000}],
  section: "impact",
  cycles: 400,
  base: {damping: "closed_form"},
};

/** A service and addresses that do not read: {url, accepted: the number of answers 200}. */
async function serviceWith(t, args, count, path, body, addresses = 2) {
  const one = await startService(["--trust-proxy", "127.0.0.1", ...args]);
  const sockets = [];
  t.after(async () => {
    for (const socket of sockets) socket.destroy();
    await one.stop();
  });
  let accepted = 0;
  for (let i = 0; i < count; ++i) {
    const {socket, text} = await unread(one.url, path, body, `192.0.2.${1 + (i % addresses)}`);
    sockets.push(socket);
    if (statuses(text())[0] === 200) ++accepted;
  }
  return {url: one.url, accepted};
}

test("streams that are not read give their threads to others", async (t) => {
  // One address alone gets half of the threads.
  const {url, accepted} = await serviceWith(t, ["--threads", "4"], 4, "/v1/simulate", streamed, 4);
  assert.equal(accepted, 4);
  assert.equal((await fetch(`${url}/livez`)).status, 200);
  await until(() => isAnswered(url, "/v1/simulate", small), soon);
});

test("finished answers that are not read occupy no thread", async (t) => {
  const {url, accepted} = await serviceWith(t, ["--threads", "4"], 8, "/v1/simulate", large);
  assert.equal(accepted, 8);
  assert.ok(await isAnswered(url, "/v1/simulate", small));
});

test("neither do pipelined small ones", async (t) => {
  const one = await startService(["--threads", "4"]);
  const held = await connectAll(one.url, 12);
  t.after(async () => {
    for (const {socket} of held) socket.destroy();
    await one.stop();
  });
  for (const {socket} of held) {
    socket.pause();
    socket.write(get("/v1/parameters").repeat(200));
  }
  await until(() => isAnswered(one.url, "/v1/simulate", small), soon);
});

test("answers that are not read give their memory to others", async (t) => {
  const args = ["--memory-limit", "24000000"];
  const {url, accepted} = await serviceWith(t, args, 4, "/v1/simulate", large);
  assert.equal(accepted, 4); // each waits for the memory of those before it
  await until(() => isAnswered(url, "/v1/simulate", large), soon);
});

test("a client that holds nothing waits for the memory of others", async (t) => {
  // 32 MB, of which a client keeps all; the text of such a list is made while it waits.
  const larger = {...large, tau_end: 8000, max_points: 4e5};
  const args = ["--memory-limit", "36000000"];
  const {url, accepted} = await serviceWith(t, args, 1, "/v1/simulate", larger);
  assert.equal(accepted, 1);
  assert.ok(await isAnswered(url, "/v1/simulate", larger));
});

test("the points of a sweep with long sections count as memory that it holds", async (t) => {
  const long = {...sweep, section_points: 100000, cycles: 50000}; // 40 MB
  const args = ["--memory-limit", "110000000", "--sweeps", "20"];
  const {url, accepted} = await serviceWith(t, args, 4, "/v1/sweep", long, 4);
  assert.equal(accepted, 1); // of half the limit
  assert.ok(await isAnswered(url, "/v1/simulate", small));
});

test("tables of sweeps that find no memory take none", async (t) => {
  const {url, pid} = await serviceFor(t);
  const axes = [{...sweep.axes[0], count: 1e5}]; // a table for which 122 MB are reserved
  const table = JSON.stringify({axes, cycles: 1, transient_cycles: 0, format: "cbor"});
  const sockets = await connectAll(url, 20, () => post("/v1/sweep", table).repeat(5));
  t.after(() => {
    for (const {socket} of sockets) socket.destroy();
  });
  await until(() => sockets.flatMap(({text}) => statuses(text())).length > 70);
  assert.ok((await memory(pid, "VmHWM")) < 400);
});

test("an answer counts for the client that the proxy states", async (t) => {
  const args = ["--memory-limit", "40000000"];
  const {accepted} = await serviceWith(t, args, 3, "/v1/simulate", large, 1);
  assert.equal(accepted, 2);
});

test("sweeps that are not read give their places to others", async (t) => {
  const {url, accepted} = await serviceWith(t, ["--sweeps", "4"], 4, "/v1/sweep", sweep);
  assert.equal(accepted, 4);
  await until(async () => {
    const answer = await send(url, "/v1/sweep", {...sweep, cycles: 40});
    await answer.body.cancel();
    return answer.status === 200;
  }, soon);
});

test("a client that reads slowly but steadily gets all of its answer", async (t) => {
  const one = await serviceFor(t, ["--threads", "4"]);
  const {socket, text, ended} = await connect(one.url);
  socket.write(post("/v1/simulate", JSON.stringify(large), "Connection: close\r\n"));
  socket.on("data", () => {
    socket.pause();
    setTimeout(() => socket.resume(), 2);
  });
  await ended;
  const [head, body] = text().split("\r\n\r\n");
  assert.equal(body.length, Number(/Content-Length: (\d+)/.exec(head)[1]));
});

test("memory of answers that nobody reads returns to the system once their clients have left", async (t) => {
  const one = await serviceFor(t);
  const before = await memory(one.pid);
  const body = JSON.stringify({...large, tau_end: 1000});
  const sockets = await connectAll(one.url, 60, () => post("/v1/simulate", body));
  for (const {socket} of sockets) socket.pause();
  await until(async () => (await memory(one.pid)) > before + 80);
  for (const {socket} of sockets) socket.destroy();
  if (!process.env.SANITIZED) await until(async () => (await memory(one.pid)) < before + 40);
});

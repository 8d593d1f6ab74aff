// Slow, careless and hostile clients do not affect the others. Over raw sockets.
// LONG=1: durations and numbers of clients that an operator would try once.
import assert from "node:assert/strict";
import {execFileSync, spawn} from "node:child_process";
import {once} from "node:events";
import {chmod, copyFile, mkdir, mkdtemp, rename, rm, symlink, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {program, startService} from "../service.mjs";
import {
  computed,
  connect,
  connectAll,
  endless,
  exchange,
  get,
  linesOf,
  memory,
  metric,
  post,
  send,
  serviceFor,
  sleep,
  statuses,
  textOf,
  until,
} from "./raw.mjs";

const long = Boolean(process.env.LONG);
// A program with sanitizers is several times slower and keeps freed memory for a while.
const slower = process.env.SANITIZED ? 6 : 1;
const watched = process.env.SANITIZED ? 300 : 0; // MB

const service = await startService();
after(() => service.stop());

const simulation = (body, more) => post("/v1/simulate", body, more);
const small = '{"tau_end": 20, "include": ["impacts"]}';
// One of the longest possible runs: one or two seconds.
const longest = JSON.stringify({
  b: 0.03,
  tau_end: 1e7,
  max_impacts: 2000000,
  include: ["regime", "exponents"],
});

/** Duration of a request to /livez, ms. */
async function health(url = service.url) {
  const began = performance.now();
  await textOf(await fetch(`${url}/livez`));
  return performance.now() - began;
}

const running = (url) => metric(url, "vines_compute_running");
const queued = (url) => metric(url, "vines_compute_queue_depth");

test("pipelined requests are answered in order", async () => {
  const paths = Array.from({length: 50}, (_, i) =>
    i % 3 ? "/version" : `/v1/simulate?tau_end=${i + 1}`,
  );
  const last = get("/healthz", "Connection: close\r\n");
  const text = await exchange(service.url, paths.map((path) => get(path)).join("") + last);
  assert.deepEqual(statuses(text), Array(51).fill(200));
  const ends = [...text.matchAll(/"tau_end":(\d+)/g)].map((found) => Number(found[1]));
  assert.deepEqual(
    [...new Set(ends)],
    [1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 34, 37, 40, 43, 46, 49],
  );
});

test("bursts of pipelined small and large requests are all answered", async () => {
  const burst = async (path, n) => {
    const {socket, text, ended} = await connect(service.url);
    for (let i = 0; i < n; ++i) socket.write(get(path));
    socket.write(get(path, "Connection: close\r\n"));
    await ended;
    assert.deepEqual(statuses(text()), Array(n + 1).fill(200), path);
  };
  await Promise.all(Array.from({length: 16}, () => burst("/livez", 200)));
  await Promise.all(Array.from({length: 16}, () => burst("/v1/presets", 5)));
});

test("a request can arrive byte by byte, and another one after it in the same packet", async () => {
  const {socket, text, ended} = await connect(service.url);
  for (const byte of simulation(small)) {
    socket.write(byte);
    await sleep(0);
  }
  socket.write(simulation(small) + get("/healthz", "Connection: close\r\n"));
  await ended;
  assert.deepEqual(statuses(text()), [200, 200, 200]);
});

test("a client that closes its sending side still gets its answer", async () => {
  const {socket, text, ended} = await connect(service.url, {allowHalfOpen: true});
  socket.end(simulation('{"tau_end": 50000, "include": ["impacts"]}'));
  await ended;
  assert.deepEqual(statuses(text()), [200]);
  assert.match(text(), /\}\n?$/);
  const none = await connect(service.url, {allowHalfOpen: true});
  none.socket.end("GET / HTTP/1.1\r\nHo");
  assert.equal(await none.ended, "");
});

test("an ambiguous or malformed head is refused", async () => {
  const cases = [
    ["GET / HTTP/1.1\r\n\r\n", 400],
    ["GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400],
    ["GET / HTTP/1.1\nHost: localhost\n\n", 400],
    ["GET / HTTP/1.1\r\nHost: localhost\r\nX: a\nContent-Length: 3\r\n\r\n", 400],
    ["GET / HTTP/1.1\r\nHost : localhost\r\n\r\n", 400],
    ["GET / HTTP/1.1\r\nHost: localhost\r\n folded: 1\r\n\r\n", 400],
    ["GET / HTTP/1.1\r\nHost: localhost\r\nno colon\r\n\r\n", 400],
    ["GET / HTTP/1.1\r\nHost: localhost\r\nX: \0\r\n\r\n", 400],
    ["GET  / HTTP/1.1\r\nHost: localhost\r\n\r\n", 400],
    ["GET /\tx HTTP/1.1\r\nHost: localhost\r\n\r\n", 400],
    ["GET x HTTP/1.1\r\nHost: localhost\r\n\r\n", 400],
    [get("/metrics#x"), 400],
    [get("/v1/simulate?b=0.02#x"), 400],
    [get("http:///metrics"), 400],
    [get("http://?b=0.02"), 400],
    ["GET / HTTP/2.0\r\nHost: localhost\r\n\r\n", 505],
    ["GET / HTTP/1.10\r\nHost: localhost\r\n\r\n", 400],
    ["garbage\r\n\r\n", 400],
    [`GET /${"a".repeat(8300)} HTTP/1.1\r\nHost: localhost\r\n\r\n`, 414],
    [get("/", `X: ${"a".repeat(17000)}\r\n`), 431],
    [get("/", "X: a\r\n".repeat(200)), 431],
    [get("/", "Range: items=1\r\n"), 416],
    [get("/", "Expect: a miracle\r\n"), 417],
    [get("/", "Expect: 100-continue\r\nExpect: a miracle\r\n"), 417],
    [get("/", "Expect: 100-continue, a miracle\r\n"), 417],
    ...[
      "local host",
      "localhost/x",
      "localhost:evil",
      "a@localhost",
      "[::1",
      "[::1]x",
      "a:1:2",
    ].map((host) => [get("/").replace("localhost", host), 400]),
    ["GET http://a@localhost/ HTTP/1.1\r\nHost: localhost\r\n\r\n", 400],
    [simulation(small, "Content-Type: Multipart/Form-Data\r\n"), 415],
    ["BREW / HTTP/1.1\r\nHost: localhost\r\n\r\n", 405],
    [`${get("/", "Content-Length: 3\r\n")}abc`, 400],
    [simulation(small, "Content-Length: 3\r\n"), 400],
    [simulation(small).replace(/Length: \d+/, "Length: +3"), 400],
    [simulation(small).replace(/Length: \d+/, "Length: 3, 3"), 400],
    [simulation(small).replace(/Length: \d+/, "Length: 99999999999999999999"), 400],
    [simulation(small, "Transfer-Encoding: chunked\r\n"), 400],
    [simulation(small).replace(/Content-Length: \d+/, "Transfer-Encoding: chunked"), 411],
    [simulation(small).replace(/Content-Length: \d+/, "Transfer-Encoding : chunked"), 400],
    ["\r\n\r\nGET / HTTP/1.1\r\nHost: localhost\r\n\r\n", 400],
  ];
  for (const [bytes, status] of cases) {
    const text = await exchange(service.url, bytes);
    assert.deepEqual(statuses(text), [status], JSON.stringify(bytes.slice(0, 80)));
    assert.match(text, /^Connection: close\r$/im);
    assert.match(text, /^X-Content-Type-Options: nosniff\r$/im);
    const date = Date.parse(
      /^Date: (\w{3}, \d\d \w{3} \d{4} \d\d:\d\d:\d\d GMT)\r$/m.exec(text)[1],
    );
    assert.ok(Math.abs(date - Date.now()) < 60000);
    assert.equal(JSON.parse(text.slice(text.indexOf("\r\n\r\n"))).status, status);
  }
});

/** Requests followed by bytes that must never be read as the next request. */
const inner = "GET /v1/presets HTTP/1.1\r\nHost: localhost\r\n\r\n";
const withBody = (method, more = "") => {
  return (pad) => {
    const length = `Content-Length: ${pad + inner.length}\r\n`;
    return get("/healthz", more + length).replace("GET", method) + "x".repeat(pad) + inner;
  };
};
const shapes = {
  "a GET with a body": withBody("GET"),
  "a HEAD with a body": withBody("HEAD"),
  "a long target": (pad) => get(`/${"a".repeat(4096 + pad)}`) + inner,
  "a range": withBody("GET", "Range: items=1\r\n"),
  "an unknown method": withBody("BREW"),
  "chunks after a blank": (pad) => {
    const more = `Transfer-Encoding : chunked\r\nX: ${"x".repeat(pad)}\r\n`;
    const head = get("/v1/simulate", more).replace("GET", "POST");
    return `${head}0\r\n\r\n${inner}`;
  },
};

test("bytes after a refused request are not read as a request, at any offset", async () => {
  const step = long ? 1 : 8;
  for (const [name, bytes] of Object.entries(shapes))
    for (let pad = 4096 - 40 - 80; pad <= 4096 + 40; pad += step) {
      const text = await exchange(service.url, bytes(pad));
      assert.ok(statuses(text)[0] >= 400, `${name}, ${pad}: ${text.slice(0, 60)}`);
      assert.equal(statuses(text).length, 1, `${name}, ${pad}`);
    }
});

/** Starts the shipped proxy in front of the services, until the end of the test; resolves to its URL. */
async function startProxy(t, replicas) {
  const port = 20000 + Math.floor(Math.random() * 12000); // below those that clients get
  const environment = {VINES_BIND: `127.0.0.1:${port}`};
  replicas.forEach(({url}, i) => {
    environment[`VINES_${i + 1}`] = new URL(url).host;
  });
  const config = new URL("../../deploy/haproxy.cfg", import.meta.url).pathname;
  const env = {...process.env, ...environment};
  const child = spawn("haproxy", ["-db", "-f", config], {env, stdio: "ignore"});
  process.once("exit", () => child.kill("SIGKILL"));
  t.after(() => child.kill("SIGKILL"));
  const url = `http://127.0.0.1:${port}`;
  await until(async () => (await fetch(`${url}/readyz`).catch(() => null))?.status === 200);
  return url;
}

test("neither are they behind the proxy, where another client would get the answer", async (t) => {
  const proxy = await startProxy(t, await Promise.all([1, 2, 3].map(() => serviceFor(t))));
  const step = long ? 1 : 20;
  const health = async () => (await fetch(`${proxy}/healthz`)).text();
  for (const [name, bytes] of Object.entries(shapes))
    for (let pad = 4096 - 40 - 80; pad <= 4096 + 40; pad += step) {
      const hostile = exchange(proxy, bytes(pad), 300);
      const [text, ...others] = await Promise.all([hostile, health(), health(), health()]);
      // After a long target the bytes are this client's own next request.
      if (name !== "a long target") assert.doesNotMatch(text, /"fig3"/, `${name}, ${pad}`);
      for (const other of others) assert.deepEqual(JSON.parse(other), {status: "ok"});
    }
});

test("the proxy does not pass on /metrics, however the path is written", async (t) => {
  const proxy = await startProxy(t, [service, service, service]);
  const {host} = new URL(proxy);
  for (const target of [
    "/metrics",
    "/metrics?a=b",
    `http://${host}/metrics`,
    "/%6detrics",
    "/x/../metrics",
  ])
    for (const method of ["GET", "HEAD"]) {
      const request = `${method} ${target} HTTP/1.1\r\nHost: ${host}\r\nConnection: close\r\n\r\n`;
      const text = await exchange(proxy, request);
      assert.match(text, /^HTTP\/1\.1 404 /, target);
      assert.doesNotMatch(text, /vines_/, target);
    }
  assert.match(await (await fetch(`${service.url}/metrics`)).text(), /^vines_build_info/m);
});

test("100 Continue is sent only if the body would be accepted", async () => {
  const expect = (length, path = "/v1/simulate") =>
    `POST ${path} HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: ${length}\r\n\r\n`;
  assert.match(await exchange(service.url, expect(1 << 21)), /^HTTP\/1\.1 413 /);
  assert.match(await exchange(service.url, expect(10, "/nothing")), /^HTTP\/1\.1 404 /);
  const {socket, text} = await connect(service.url);
  socket.write(expect(small.length));
  await until(() => text() === "HTTP/1.1 100 Continue\r\n\r\n");
  socket.write(small);
  await until(() => statuses(text()).length === 1);
  assert.deepEqual(statuses(text()), [200]);
  socket.destroy();
});

test("a target in absolute form and HTTP/1.0 are supported", async () => {
  const absolute =
    "GET http://localhost:1/version HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  assert.deepEqual(statuses(await exchange(service.url, absolute)), [200]);
  const old = await exchange(service.url, "GET /version HTTP/1.0\r\n\r\n");
  assert.deepEqual(statuses(old), [200]);
  const sweep = '{"axes": [{"parameter": "b", "values": [0.02, 0.03]}], "cycles": 10}';
  const streamed = await exchange(
    service.url,
    `POST /v1/sweep HTTP/1.0\r\nContent-Length: ${sweep.length}\r\n\r\n${sweep}`,
  );
  assert.doesNotMatch(streamed, /chunked/i);
  const kept = `POST /v1/sweep HTTP/1.0\r\nConnection: keep-alive\r\nContent-Length: ${sweep.length}\r\n\r\n`;
  assert.match(await exchange(service.url, kept + sweep), /^Connection: close\r$/im);
  const twice = get("/version", "Connection: keep-alive\r\nConnection: close\r\n");
  assert.match(await exchange(service.url, `\r\n${twice}`), /^Connection: close\r$/im);
  const lines = linesOf(streamed.slice(streamed.indexOf("\r\n\r\n")));
  assert.equal(lines.at(-1).type, "done");
});

test("requests to another host name, or from a page of another site, are refused", async (t) => {
  const to = (host, more = "") =>
    `GET /version HTTP/1.1\r\nHost: ${host}\r\nConnection: close\r\n${more}\r\n`;
  const status = async (bytes, url = service.url) => statuses(await exchange(url, bytes))[0];
  for (const host of [
    "localhost",
    "LocalHost:80",
    "127.0.0.1:8080",
    "a.localhost",
    "vines",
    "[::1]:9",
    "localhost.",
    "",
    "localhost:",
  ])
    assert.equal(await status(to(host)), 200, host);
  for (const host of [
    "evil.example",
    "localhost.evil.example",
    "192.0.2.1",
    "127.0.0.1.evil.example",
    "[::2]",
  ])
    assert.equal(await status(to(host)), 421, host);
  const long = await exchange(service.url, to(`${"e".repeat(8000)}.example`));
  assert.deepEqual(statuses(long), [421]);
  assert.ok(long.length < 1500, "a long name is shortened");
  const from = (headers) => simulation(small, `${headers}Connection: close\r\n`);
  assert.equal(await status(from("Origin: http://localhost\r\n")), 200);
  assert.equal(await status(from("Sec-Fetch-Site: same-origin\r\n")), 200);
  for (const headers of [
    "Origin: https://evil.example\r\nContent-Type: text/plain\r\n",
    "Origin: null\r\nContent-Type: text/plain\r\n",
    "Sec-Fetch-Site: cross-site\r\n",
    "Sec-Fetch-Site: same-site\r\n",
  ])
    assert.equal(await status(from(headers)), 403, headers);
  const cross = "Sec-Fetch-Site: cross-site\r\n";
  assert.equal(await status(to("localhost", `${cross}Sec-Fetch-Mode: no-cors\r\n`)), 403);
  const link = `${cross}Sec-Fetch-Mode: navigate\r\n`;
  assert.equal(await status(to("localhost", link)), 200);
  assert.equal(await status(to("localhost", `${link}Sec-Fetch-Dest: document\r\n`)), 200);
  const page = (more) => to("localhost", more).replace("/version", "/");
  for (const frame of ["iframe", "frame", "embed", "object"]) {
    const framed = `${link}Sec-Fetch-Dest: ${frame}\r\n`;
    assert.equal(await status(to("localhost", framed)), 403, frame);
    const shown = await exchange(service.url, page(framed));
    assert.deepEqual(statuses(shown), [200]);
    assert.match(shown, /frame-ancestors 'none'\r$/m, "the browser does not show it");
  }
  const open = await serviceFor(t, ["--host", "0.0.0.0", "--allow-host", "vines.example.org"]);
  const local = open.url.replace("0.0.0.0", "127.0.0.1");
  for (const [host, expected] of [
    ["192.0.2.1:8080", 200],
    ["VINES.example.org", 200],
    ["other.example.org", 421],
  ])
    assert.equal(await status(to(host), local), expected, host);
});

test("an IPv6 address is written in brackets", async (t) => {
  const six = await startService(["--host", "::1"]).catch(() => null);
  if (!six) return t.skip("this machine has no IPv6");
  t.after(() => six.stop());
  assert.match(six.url, /^http:\/\/\[::1\]:\d+$/);
  assert.equal((await fetch(`${six.url}/version`)).status, 200);
});

test("clients that send half a head, half a body or nothing delay no other client", async (t) => {
  const one = await serviceFor(t, ["--threads", "4"]);
  const halves = [
    "",
    "GET /version HT",
    "GET /version HTTP/1.1\r\nHost: x\r\nX-",
    simulation(small).slice(0, -3),
  ];
  const kept = await connectAll(one.url, long ? 2000 : 600, (i) => halves[i % halves.length]);
  for (let i = 0; i < 20; ++i) await health(one.url);
  await textOf(await send(one.url, "/v1/simulate", small));
  // The server refuses or closes each of them in time.
  if (long) await Promise.all(kept.map(({ended}) => ended));
  for (const {socket} of kept) socket.destroy();
});

// A connection for each request: fetch can open a second one, for which the first, idle one is closed.
const separate = "Connection: close\r\n";
async function serves(url) {
  for (let i = 0; i < 5; ++i)
    assert.deepEqual(statuses(await exchange(url, get("/livez", separate))), [200]);
  assert.deepEqual(statuses(await exchange(url, simulation(small, separate))), [200]);
}

test("beyond the maximum number of connections idle ones are closed", async (t) => {
  const one = await serviceFor(t, ["--connections", "50"]);
  const idle = await connectAll(one.url, 200);
  await serves(one.url);
  for (const {socket} of idle) socket.destroy();
});

test("without free file descriptors idle connections are closed, too", async (t) => {
  const one = await serviceFor(t);
  execFileSync("prlimit", [`--pid=${one.pid}`, "--nofile=40:40"]);
  const idle = await connectAll(one.url, 100);
  await serves(one.url);
  for (const {socket} of idle) socket.destroy();
});

test("where all connections have requests at work, one makes place between two answers", async (t) => {
  const one = await serviceFor(t, ["--connections", "8", "--threads", "32"]);
  const many = simulation('{"tau_end": 20000, "include": ["exponents"]}').repeat(1000);
  const busy = await connectAll(one.url, 8, () => many);
  t.after(() => {
    for (const {socket} of busy) socket.destroy();
  });
  await until(() => busy.every(({text}) => statuses(text()).length > 0));
  const others = ["127.0.0.2", "127.0.0.3", "127.0.0.4"];
  for (const localAddress of others) {
    for (let answered = false, attempt = 1; !answered; ++attempt) {
      const began = performance.now();
      const other = await connect(one.url, {localAddress});
      busy.push(...(await connectAll(one.url, 8, () => many))); // want the places of others
      other.socket.write(get("/livez", separate));
      await other.ended;
      answered = statuses(other.text())[0] === 200;
      // One that has sent nothing for a second gives them its place.
      assert.ok(answered || (performance.now() - began > 1000 && attempt < 10));
    }
  }
  for (const {text} of busy) assert.ok(statuses(text()).length < 1000);
});

test("a flood of connections closes its own, not those of other clients", async (t) => {
  const one = await serviceFor(t, ["--connections", "100"]);
  const body = small.padEnd(10000);
  const [begun, rest] = [simulation(body).slice(0, -5000), body.slice(-5000)];
  const upload = await connect(one.url, {localAddress: "127.0.0.2"});
  upload.socket.write(begun);
  let closed = 0;
  const flood = await connectAll(one.url, 150, () => "G");
  for (const {ended} of flood) ended.then(() => ++closed);
  await until(() => closed >= 50); // the server has accepted all of them
  upload.socket.write(rest);
  await until(() => statuses(upload.text()).length === 1);
  assert.deepEqual(statuses(upload.text()), [200], "an upload that began before");
  upload.socket.destroy();
  for (let i = 0; i < 20; ++i) {
    const text = await exchange(one.url, get("/livez", "Connection: close\r\n"));
    assert.deepEqual(statuses(text), [200], `call ${i}`);
  }
  for (const {socket} of flood) socket.destroy();
  const single = await serviceFor(t, ["--connections", "1"]);
  for (let i = 0; i < 5; ++i) {
    const {socket, text} = await connect(single.url); // closes the idle connection before it
    socket.write(get("/livez"));
    await until(() => statuses(text()).length === 1);
    assert.deepEqual(statuses(text()), [200]);
  }
});

test("the idle timeout starts at the end of an answer", {skip: !long}, async () => {
  const {socket, text} = await connect(service.url);
  const body = '{"axes":[{"parameter":"b","from":0.02,"to":0.03,"count":150}],"cycles":1000000}';
  socket.write(`${post("/v1/sweep", body)}GET /ver`);
  await until(() => /"type":"done"/.test(text()));
  await sleep(500);
  socket.write("sion HTTP/1.1\r\nHost: localhost\r\n\r\n");
  await until(() => statuses(text()).length === 2);
  assert.deepEqual(statuses(text()), [200, 200]);
  socket.destroy();
});

test("an endless head uses no memory", async () => {
  const before = await memory(service.pid);
  const piece = "a".repeat(1 << 20);
  for (const begin of ["GET / HTTP/1.1\r\nX: ", "GET /", ""]) {
    const {socket, text} = await connect(service.url);
    socket.write(begin);
    for (let i = 0; i < 64 && !socket.destroyed; ++i) {
      if (!socket.write(piece))
        await Promise.race([new Promise((r) => socket.once("drain", r)), sleep(100)]);
    }
    await until(() => statuses(text()).length === 1 || socket.destroyed);
    socket.destroy();
  }
  const {socket, text} = await connect(service.url);
  socket.write("GET / HTTP/1.1\r\n");
  for (let i = 0; i < 2000 && !socket.destroyed; ++i) socket.write("a: b\r\n".repeat(1000));
  await until(() => statuses(text()).length === 1 || socket.destroyed);
  socket.destroy();
  assert.ok((await memory(service.pid)) - before < 64 + watched);
});

test("a run ends when its client leaves, whether it is running or queued", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  const gone = await connectAll(one.url, 6, () => simulation(longest));
  await until(async () => (await queued(one.url)) === 5);
  const began = await computed(one.pid);
  for (const {socket} of gone) socket.destroy();
  await textOf(await send(one.url, "/v1/simulate", small));
  const seconds = (await computed(one.pid)) - began;
  assert.ok(seconds < 1 * slower, `${seconds} s, about ten if all runs were completed`);
});

test("a run ends when its client leaves, also with HTTP/1.0 or after the client closed its sending side", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  for (const version of ["1.0", "1.1"]) {
    const request = simulation(endless).replace("HTTP/1.1", `HTTP/${version}`);
    const {socket} = await connect(one.url);
    socket.write(request);
    await until(async () => (await running(one.url)) === 1);
    socket.destroy();
    await until(async () => (await running(one.url)) === 0);
    const half = await connect(one.url, {allowHalfOpen: true});
    half.socket.end(request);
    await until(() => half.text().length > 0);
    half.socket.destroy();
    await until(async () => (await running(one.url)) === 0);
  }
});

test("a client that has closed its sending side gets the same bytes, also after it was probed", async () => {
  const run = '{"tau_end": 3000000, "max_impacts": 2000000, "include": ["regime"]}';
  const request = simulation(run, "X-Request-ID: half\r\n");
  for (const version of ["1.0", "1.1"]) {
    const bytes = request.replace("HTTP/1.1", `HTTP/${version}`);
    const {socket, text, ended} = await connect(service.url, {allowHalfOpen: true});
    socket.end(bytes);
    const probe = (await once(socket, "data")).toString();
    assert.equal(probe, "HTTP/1.1 ".slice(0, probe.length), "it was probed");
    await ended;
    const whole = await exchange(
      service.url,
      bytes.replace("\r\n", "\r\nConnection: close\r\n"),
      60000,
    );
    const head = (answer) =>
      answer
        .slice(0, answer.indexOf("\r\n\r\n"))
        .replace(/^(Date|Server-Timing|Connection|Keep-Alive): .*\r\n/gm, "");
    const body = (answer) => answer.slice(answer.indexOf("\r\n\r\n"));
    assert.equal(head(text()), head(whole));
    assert.equal(body(text()), body(whole));
  }
});

test("requests that wait for a compute slot get it in the order of arrival", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1", "--compute-queue", "30"]);
  // While this run has the slot, the depth of the queue tells exactly which requests wait.
  const first = new AbortController();
  const {signal} = first;
  const left = send(one.url, "/v1/simulate", endless, {signal}).catch(({name}) => name);
  await until(async () => (await running(one.url)) === 1);
  const body = '{"damping": "closed_form", "tau_end": 300000, "include": ["regime"]}';
  const order = [];
  const all = [];
  for (let i = 0; i < 16; ++i) {
    const answered = send(one.url, "/v1/simulate", body).then(textOf);
    all.push(answered.then(() => order.push(i)));
    // A request that finds no slot tries to compute before it enters the queue.
    await until(async () => (await queued(one.url)) > i);
  }
  first.abort();
  assert.equal(await left, "AbortError");
  await Promise.all(all);
  const late = order.map((i, position) => Math.abs(i - position));
  assert.ok(Math.max(...late) <= 2, `ended in the order ${order}`);
});

test("a stop under load loses no request; each connection closes after an answer", async () => {
  const one = await startService();
  const body = '{"tau_end": 2000, "include": ["regime"]}';
  let stopping = false;
  const lost = [];
  let served = 0;
  const client = async () => {
    for (;;) {
      const {socket, text, ended} = await connect(one.url).catch(() => ({}));
      if (!socket) return; // the server no longer listens
      for (let n = 1; ; ++n) {
        if (!socket.writable || /^Connection: close\r$/im.test(text())) break;
        socket.write(simulation(body));
        await until(() => statuses(text()).length === n || socket.destroyed);
        if (statuses(text()).length < n) {
          lost.push(text().slice(-200));
          break;
        }
        ++served;
      }
      await Promise.race([ended, sleep(1000)]);
      socket.destroy();
      if (stopping) return;
    }
  };
  const clients = Array.from({length: 16}, client);
  await until(() => served > 50);
  stopping = true;
  assert.equal(await one.stop(), 0);
  await Promise.all(clients);
  assert.deepEqual(lost, []);
});

test("an incomplete request at a stop is answered with 503 while its client still sends", async () => {
  const one = await startService();
  const parts = [simulation(small).slice(0, -3), "GET /version HTTP/1.1\r\nHost: x\r\nX-"];
  const halves = await connectAll(one.url, 2, (i) => parts[i]);
  const idle = await connect(one.url);
  await health(one.url); // the halves were read before this answer
  const ended = one.stop();
  for (const {socket, text} of halves) {
    await until(() => statuses(text()).length === 1);
    socket.write("more");
    assert.deepEqual(statuses(text()), [503]);
    assert.match(text(), /^Retry-After: 1\r$/m);
    assert.match(text(), /^Connection: close\r$/m);
    assert.equal(JSON.parse(text().slice(text().indexOf("\r\n\r\n"))).lacking, "stopping");
    socket.end();
  }
  assert.equal(await idle.ended, "");
  assert.equal(await ended, 0);
});

/** A service, and a client that requests a large answer and does not read it. */
async function heldByItsClient(t) {
  const one = await startService();
  const {socket, text} = await connect(one.url);
  t.after(() => socket.destroy());
  const large =
    '{"damping": "closed_form", "tau_end": 8000, "max_points": 300000, "samples_per_cycle": 200}';
  socket.once("data", () => socket.pause());
  socket.write(simulation(large, "X-Request-ID: unread\r\n"));
  await until(() => text().length > 0);
  return one;
}

/** Checks the last two lines of the log: the unanswered request and the end. */
async function assertUnanswered(log) {
  await until(() => log().endsWith("\n") && log().includes("unanswered requests"));
  const [request, last] = linesOf(log()).slice(-2);
  assert.deepEqual(
    [request.level, request.method, request.path, request.request_id],
    ["warning", "POST", "/v1/simulate", "unread"],
  );
  assert.match(request.what, /ended before the answer was sent/);
  assert.equal(last.level, "warning");
  assert.equal(last.what, "stopped; unanswered requests: 1");
}

test("a stop forced by a second signal logs the unanswered requests", async (t) => {
  const {stop, log} = await heldByItsClient(t);
  const ended = stop();
  await until(() => log().includes('"what":"stopping"'));
  stop();
  assert.equal(await ended, 128 + 15);
  await assertUnanswered(log);
});

test("so does a stop forced by its time limit, with exit code 3", {skip: !long}, async (t) => {
  const {stop, log} = await heldByItsClient(t);
  assert.equal(await stop(), 3);
  await assertUnanswered(log);
});

test("a second signal ends the service at once", async () => {
  const one = await startService(["--drain", "30"]);
  await health(one.url);
  let code;
  one.stop().then((value) => (code = value));
  await until(async () => (await fetch(`${one.url}/readyz`)).status === 503);
  await health(one.url);
  process.kill(one.pid, "SIGTERM");
  await until(() => code !== undefined); // well before the end of the drain
  assert.equal(code, 128 + 15);
});

test("at a stop computations that take too long end with the results so far", {
  skip: !long,
}, async () => {
  const one = await startService(["--compute-threads", "1", "--compute-queue", "30"]);
  const answers = Array.from({length: 20}, async () => {
    const answer = await send(one.url, "/v1/simulate", longest);
    return (await answer.json()).status.reason;
  });
  await until(async () => (await queued(one.url)) === 19);
  const began = performance.now();
  const ended = one.stop();
  const reasons = await Promise.all(answers);
  assert.ok(reasons.includes("deadline") && reasons.some((r) => r !== "deadline"), reasons);
  assert.equal(await ended, 0);
  assert.ok(performance.now() - began < 15000);
});

const listed = (count, make) => Array.from({length: count}, (_, i) => make(i)).join(",");

test("the time to read a body is proportional to its size, and its faults are reported briefly", async () => {
  const sweep = (starts) => `{"axes":[{"parameter":"b","values":[0.02]}],"starts":[${starts}]}`;
  const bodies = [
    ["/v1/simulate", `{"q":[${listed(200000, () => "{}")}]}`],
    ["/v1/simulate", `{"q":[${listed(50000, () => '{"a":{"b":{}}}')}]}`],
    ["/v1/simulate", `{${listed(90000, (i) => `"k${i}":1`)}}`],
    ["/v1/simulate", `{"q":[${listed(90, () => `{${listed(900, (i) => `"k${i}":1`)}}`)}]}`],
    ["/v1/simulate", `{"include":[${listed(80000, (i) => `"x${i}"`)}]}`],
    ["/v1/simulate", `{"preset":"${"q".repeat(900000)}"}`],
    ["/v1/simulate", `{"${"q".repeat(900000)}":1}`],
    ["/v1/simulate", `{"${"q".repeat(400000)}":1,"${"q".repeat(400000)}":1}`],
    ["/v1/simulate", `{"b":"${"q".repeat(900000)}`],
    ["/v1/sweep", sweep(listed(10000, () => '{"x0":"bad"}'))],
    ["/v1/sweep", sweep(listed(10000, (i) => `{"q${i}":1}`))],
    ["/v1/sweep", `{"axes":[{"parameter":"b","values":[${listed(100000, () => '"x"')}]}]}`],
  ];
  for (const [path, body] of bodies) {
    const began = await computed(service.pid);
    const answer = await send(service.url, path, body);
    const text = await answer.text();
    const what = `${path} ${body.slice(0, 40)}`;
    assert.ok(answer.status === 400 || answer.status === 422, what);
    assert.ok((await computed(service.pid)) - began < 1.5 * slower, what);
    assert.ok(text.length < 20000, `${what}: an answer of ${text.length} bytes`);
    for (const {value} of JSON.parse(text).errors ?? [])
      assert.ok(String(value).length < 250, what);
  }
  const query = `${service.url}/v1/simulate?${"q".repeat(5000)}=1`;
  const {detail, errors} = await (await fetch(query)).json();
  assert.ok(detail.length < 300 && errors[0].pointer.length < 250);
});

test("reading a large body stops when its client leaves", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  const body = `{"q":[${"0,".repeat(15_000_000)}0]}`;
  let reader;
  do {
    // until one is seen while it is read
    reader = await connect(one.url);
    reader.socket.write(post("/v1/identify", body));
    await until(async () => reader.text() || (await running(one.url)) === 1);
  } while (reader.text());
  const began = await computed(one.pid);
  reader.socket.destroy();
  await until(async () => (await running(one.url)) === 0);
  assert.ok((await computed(one.pid)) - began < 1 * slower);
});

test("the memory for requests is limited over all clients", async (t) => {
  const one = await serviceFor(t, ["--memory-limit", "40000000", "--connections", "500"]);
  const before = await memory(one.pid);
  const record = Buffer.alloc(15000000, "1,2\n");
  const head = `POST /v1/identify HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\nContent-Length: ${record.length + 1}\r\n\r\n`;
  const half = Buffer.concat([Buffer.from(head), record]);
  const halves = await connectAll(one.url, 12, () => half);
  const slow = [];
  const refused = () => halves.filter(({text}) => statuses(text())[0] === 503).length;
  await until(() => refused() >= 8);
  assert.ok((await memory(one.pid)) - before < 120 + watched);
  await health(one.url);
  for (const {socket} of halves) socket.destroy();
  await until(async () => (await metric(one.url, "vines_http_held_bytes")) < 1e6);
  // A large body no longer counts once it is answered, even if more bytes follow it.
  for (let i = 0; i < 6; ++i) {
    const connection = await connect(one.url);
    connection.socket.write(Buffer.concat([half, Buffer.from("xG")]));
    await until(() => statuses(connection.text()).length === 1);
    assert.equal(statuses(connection.text())[0], 422);
    slow.push(connection);
  }
  assert.ok((await memory(one.pid)) - before < 120 + watched);
  for (const {socket} of slow) socket.destroy();
});

test("the memory for unread answers is limited; a client that holds more than is left gets no more", async (t) => {
  const one = await serviceFor(t, ["--memory-limit", "60000000"]);
  // Answers of 8 MB: two of each of two clients are held, a third one of the first is refused.
  const large =
    '{"tau_end": 2000, "max_points": 100000, "samples_per_cycle": 200, "include": ["series"]}';
  const slow = [];
  for (const client of [1, 2, 1, 2, 1, 3]) {
    const connection = await connect(one.url, {localAddress: `127.0.0.${client}`});
    // At the first bytes: later, on a busy machine, a whole answer may have been read.
    connection.socket.once("data", () => connection.socket.pause());
    connection.socket.write(simulation(large));
    await until(() => connection.text().length > 0);
    slow.push(connection);
  }
  const first = slow.map(({text}) => Number(/^HTTP\/1\.1 (\d+)/.exec(text())[1]));
  assert.deepEqual(first, [200, 200, 200, 200, 503, 200]);
  assert.equal((await send(one.url, "/v1/simulate", small)).status, 200, "a small answer");
  for (const {socket} of slow) socket.destroy();
  await until(async () => {
    const answer = await send(one.url, "/v1/simulate", large);
    // Read to the end: a stop waits for clients that are still reading.
    await answer.arrayBuffer();
    return answer.status === 200;
  });
});

test("a sweep pauses while its client does not read, and then continues", async (t) => {
  const one = await serviceFor(t);
  const body = JSON.stringify({
    axes: [{parameter: "b", from: 0.005, to: 0.03, count: 3000}],
    section: "impact",
    cycles: 400,
    base: {damping: "closed_form"},
  });
  const whole = await textOf(await send(one.url, "/v1/sweep", body));
  const {socket, text, ended} = await connect(one.url);
  const before = await memory(one.pid);
  socket.pause();
  socket.write(post("/v1/sweep", body, separate));
  // A paused sweep holds no compute slot, poll after poll.
  let paused = 0;
  await until(async () => {
    const holdsSlots = (await running(one.url)) > 0;
    const runs = (await metric(one.url, "vines_sweeps_running")) === 1;
    paused = runs && !holdsSlots ? paused + 1 : 0;
    return paused === 20;
  });
  assert.ok((await memory(one.pid)) - before < 15 + watched, "its lines are not kept");
  assert.equal((await send(one.url, "/v1/simulate", small)).status, 200);
  socket.resume();
  await ended;
  const points = (lines) => lines.match(/^\{"type":"point".*$/gm).length;
  assert.ok(whole.length > 2e7);
  assert.equal(points(text().replace(/\r\n[0-9a-f]+\r\n/g, "")), points(whole));
  assert.match(text(), /"type":"done"/);
});

test("a sweep that takes too long ends with its points so far; the rest can be requested", async (t) => {
  const one = await serviceFor(t, ["--sweep-deadline", String(2 * slower)]);
  const body = {axes: [{parameter: "b", from: 0.02, to: 0.04, count: 5000}], cycles: 20000};
  const last = linesOf(await textOf(await send(one.url, "/v1/sweep", body))).at(-1);
  assert.equal(last.type, "error");
  assert.equal(last.status, 503);
  assert.match(last.detail, /request the missing indices again/);
  assert.ok(last.points > 0 && last.points < 5000);
});

test("an answer that the client has already is not computed again", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  const url = `${one.url}/v1/simulate?b=0.03&tau_end=3000000&max_impacts=2000000&include=regime`;
  const first = await fetch(url);
  await first.text();
  const tag = first.headers.get("etag");
  const began = await computed(one.pid);
  const again = await fetch(url, {headers: {"If-None-Match": tag}});
  assert.equal(again.status, 304);
  assert.equal(again.headers.get("etag"), tag);
  assert.ok((await computed(one.pid)) - began < 0.1 * slower, "no computation");
  await textOf(await fetch(`${url}&G=0.021`, {headers: {"If-None-Match": tag}}));
  const manifold = await fetch(`${service.url}/v1/manifold`);
  await manifold.text();
  const known = await fetch(`${service.url}/v1/manifold`, {
    headers: {"If-None-Match": manifold.headers.get("etag")},
  });
  assert.equal(known.status, 304);
  assert.equal(known.headers.get("content-length"), null);
  assert.doesNotMatch(known.headers.get("server-timing"), /solve/);
});

/** The address that a started service prints. */
const urlOf = (child) =>
  new Promise((resolve) => child.stdout.once("data", (data) => resolve(/http:\S+/.exec(data)[0])));

test("a log that is not read blocks no request, and reports the dropped lines", async () => {
  const child = spawn(program, ["serve", "--port", "0"], {stdio: ["ignore", "pipe", "pipe"]});
  const url = await urlOf(child);
  const path = `/v1/simulate?${"b".repeat(300)}`;
  for (let i = 0; i < 40; ++i)
    await Promise.all(
      Array.from({length: 50}, () => fetch(url + path).then((answer) => answer.text())),
    );
  let log = "";
  child.stderr.on("data", (data) => {
    log += data;
  });
  let more = 0;
  await until(async () => {
    ++more;
    await (await fetch(`${url}/version`)).text();
    // A line of /version that is not dropped: the log has space for all lines from here on.
    return /"lines":\d+/.test(log) && log.includes('"path":"/version"');
  });
  child.kill("SIGTERM");
  await new Promise((resolve) => child.on("exit", resolve));
  const lines = linesOf(log);
  const gaps = lines.filter(({what}) => what === "lines were dropped");
  const dropped = gaps.reduce((sum, gap) => sum + gap.lines, 0);
  assert.ok(dropped > 0);
  assert.equal(lines.filter(({path}) => path).length + dropped, 2000 + more);
});

const isRoot = process.getuid() === 0;
test("the service works with fewer threads if the system allows no more", {
  skip: !isRoot,
}, async () => {
  // The limit does not apply to root.
  const folder = await mkdtemp(join(tmpdir(), "vines-limit-"));
  await chmod(folder, 0o755);
  const copy = join(folder, "vines");
  await copyFile(program, copy);
  const command = `ulimit -u 12; exec "${copy}" serve --port 0 --compute-threads 8`;
  const as = ["--reuid=65533", "--regid=65533", "--clear-groups", "bash", "-c", command];
  const child = spawn("setpriv", as, {stdio: ["ignore", "pipe", "ignore"], cwd: "/"});
  const url = await urlOf(child);
  const body = {axes: [{parameter: "b", from: 0.02, to: 0.03, count: 200}], cycles: 500};
  const ends = await Promise.all(
    Array.from({length: 3}, async () => {
      const text = await textOf(await send(url, "/v1/sweep", body));
      return linesOf(text).at(-1).type;
    }),
  );
  assert.ok(ends.includes("done") && ends.every((type) => type === "done" || type === "error"));
  assert.equal((await send(url, "/v1/simulate", small)).status, 200);
  child.kill("SIGTERM");
  assert.equal(await new Promise((resolve) => child.on("exit", resolve)), 0);
  await rm(folder, {recursive: true});
});

test("--web-dir serves only files of its folder", async (t) => {
  const folder = await mkdtemp(join(tmpdir(), "vines-web-"));
  await writeFile(join(folder, "index.html"), "<title>here</title>");
  await writeFile(join(folder, "own.js"), "1;");
  await symlink("/etc/hostname", join(folder, "link.js"));
  execFileSync("mkfifo", [join(folder, "pipe.js")]);
  await mkdir(join(folder, "tab"));
  await writeFile(join(folder, "tab", "plot.js"), "2;");
  const outside = await mkdtemp(join(tmpdir(), "vines-outside-"));
  await writeFile(join(outside, "plot.js"), "outside;");
  const way = join(outside, "way"); // the folder itself can be given by a link
  await symlink(folder, way);
  const one = await startService(["--web-dir", way]);
  t.after(async () => {
    await one.stop();
    await rm(folder, {recursive: true});
    await rm(outside, {recursive: true});
  });
  const status = async (path) => (await fetch(one.url + path)).status;
  assert.equal(await status("/"), 200);
  assert.equal(await status("/docs"), 200, "the compiled page");
  assert.equal(await status("/own.js"), 200);
  assert.equal(await status("/tab/plot.js"), 200);
  assert.equal(await status("/link.js"), 404);
  assert.equal(await status("/pipe.js"), 404);
  await rm(join(folder, "own.js"));
  await symlink("/etc/hostname", join(folder, "own.js"));
  assert.equal(await status("/own.js"), 404);
  await rename(join(folder, "tab"), join(folder, "kept"));
  await symlink(outside, join(folder, "tab"));
  assert.equal(await status("/tab/plot.js"), 404, "a link in place of a folder");
  await rm(join(folder, "tab"));
  await rename(join(folder, "kept"), join(folder, "tab"));
  assert.equal(await status("/tab/plot.js"), 200);
});

test("a request has an id, in its answer, its problem document and the log, and reports its durations", async (t) => {
  const {url, log, stop} = await serviceFor(t, ["--log-format", "json"]);
  const named = async (headers, body = small) => {
    const answer = await send(url, "/v1/simulate", body, {headers});
    return {answer, id: answer.headers.get("x-request-id"), json: await answer.json()};
  };
  assert.equal((await named({"X-Request-ID": "run-17.b"})).id, "run-17.b");
  const trace = "4bf92f3577b34da6a3ce929d0e0e4736";
  assert.equal((await named({traceparent: `00-${trace}-00f067aa0ba902b7-01`})).id, trace);
  assert.equal((await named({traceparent: `01-${trace}-00f067aa0ba902b7-01-more`})).id, trace);
  for (const bad of [
    `ff-${trace}-00f067aa0ba902b7-01`,
    `0g-${trace}-00f067aa0ba902b7-01`,
    `00-${trace}-00f067aa0ba902bg-01`,
    `00-${trace}-0000000000000000-01`,
    `00-${trace}-00f067aa0ba902b7-0x`,
    `00-${trace}-00f067aa0ba902b7-01-more`,
    `00-${trace}-00f067aa0ba902b7`,
    `01-${trace}-00f067aa0ba902b7-01more`,
    `00-${"0".repeat(32)}-00f067aa0ba902b7-01`,
  ])
    assert.match((await named({traceparent: bad})).id, /^[0-9a-f]{16}$/, bad);
  for (const bad of ["", "a b", '"', "x".repeat(65)])
    assert.match((await named({"X-Request-ID": bad})).id, /^[0-9a-f]{16}$/);
  const {answer} = await named({});
  const timing = answer.headers.get("server-timing");
  assert.match(timing, /^queue;dur=[\d.]+, parse;dur=[\d.]+, solve;dur=[\d.]+, encode;dur=[\d.]+$/);
  const wrong = await named({"X-Request-ID": "mine"}, '{"b": -1}');
  assert.equal(wrong.json.request_id, "mine");
  await health(url);
  await until(() => /"request_id":"mine"/.test(log()));
  await stop();
  const lines = linesOf(log());
  assert.match(lines[0].what, /^vines \S+ listens on 127\.0\.0\.1:\d+$/);
  assert.deepEqual(
    lines.slice(-2).map(({what}) => what),
    ["stopping", "stopped"],
  );
  assert.ok(!lines.some(({path}) => path === "/livez"), "a successful probe is not logged");
  const line = lines.find(({request_id}) => request_id === "run-17.b");
  assert.deepEqual(
    [line.level, line.method, line.path, line.status, line.client],
    ["info", "POST", "/v1/simulate", 200, "127.0.0.1"],
  );
  for (const part of ["ms", "queue_ms", "parse_ms", "solve_ms", "encode_ms", "bytes"])
    assert.ok(line[part] >= 0, part);
  assert.equal(lines.find(({request_id}) => request_id === "mine").level, "warning");
});

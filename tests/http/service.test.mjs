// The running service, over real sockets: routes, sweeps, limits, options.
import assert from "node:assert/strict";
import {execFile} from "node:child_process";
import {mkdtemp, readFile, rm, writeFile} from "node:fs/promises";
import {request as httpRequest} from "node:http";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {gunzipSync} from "node:zlib";
import {program, startService} from "../service.mjs";
import {
  computed,
  connect,
  exchange,
  linesOf,
  metric,
  send,
  serviceFor,
  textOf,
  until,
} from "./raw.mjs";

const service = await startService();
const {port} = new URL(service.url);
after(() => service.stop());

const post = (body, headers = {}) => send(service.url, "/v1/simulate", body, {headers});

/** Sends raw bytes; returns everything received until the server closes or the time is over. */
const raw = (text, milliseconds) => exchange(service.url, text, milliseconds);

/** Runs the program to its end: [exit code, its output]. */
const run = (args, env = {}) =>
  new Promise((resolve) => {
    const options = {env: {...process.env, ...env}, maxBuffer: 1 << 28};
    execFile(program, args, options, (failed, out, errors) =>
      resolve([failed?.code ?? 0, out + errors]),
    );
  });

const getJson = async (path) => (await fetch(`${service.url}${path}`)).json();

const problem = async (response, status) => {
  assert.equal(response.status, status);
  assert.equal(response.headers.get("content-type"), "application/problem+json");
  const document = await response.json();
  assert.equal(document.status, status);
  return document;
};

test("curl's default content type is read as JSON, at any size", async () => {
  const padded = `{"b":0.022,"damping":"closed_form","tau_end":1709}${" ".repeat(20000)}`;
  const response = await post(padded, {"Content-Type": "application/x-www-form-urlencoded"});
  assert.equal(response.status, 200);
  assert.equal(response.headers.get("content-type"), "application/json");
  assert.ok(Math.abs((await response.json()).impacts.tau[0] - 18.141025487377) < 1e-11);
});

test("GET accepts the same fields in its query and has an ETag", async () => {
  const url = `${service.url}/v1/simulate?b=0.022&damping=closed_form&tau_end=100&include=impacts`;
  const first = await fetch(url);
  const body = await first.text();
  const fields = '{"b":0.022,"damping":"closed_form","tau_end":100,"include":["impacts"]}';
  const posted = await post(fields);
  assert.equal(body, await posted.text());
  const again = await fetch(url, {headers: {"If-None-Match": first.headers.get("etag")}});
  assert.equal(again.status, 304);
  const repeated = await post(fields, {"If-None-Match": first.headers.get("etag")});
  assert.equal(repeated.status, 200, "a POST is never answered with 304");
  assert.equal(await repeated.text(), body);
});

test("a query's value starts after its first = and is decoded", async () => {
  for (const query of ["b=0.02=0.03", "b=0.02;tau_end=5", "damping=zz=closed_form", "b=", "=1"])
    await problem(await fetch(`${service.url}/v1/simulate?${query}`), 422);
  const decoded = await getJson("/v1/simulate?b=%30.02&include=impacts%2Cexponents&tau_end=50");
  assert.equal(decoded.parameters.b, 0.02);
});

test("presets, parameters, health and version answer", async () => {
  assert.ok((await getJson("/v1/presets")).presets.length > 20);
  assert.ok((await getJson("/v1/parameters")).fields.some((f) => f.name === "Omega"));
  assert.equal((await fetch(`${service.url}/healthz`)).status, 200);
  assert.match((await getJson("/version")).version, /^\d+\.\d+\.\d+$/);
});

test("a measurement can be sent as CSV with its fields in the query, and can be larger than other bodies", async (t) => {
  const line = (k) => {
    const wave = Math.sin(k * 0.0256);
    const x = (1e-3 * wave).toExponential(7);
    return `${(k / 2048).toFixed(6)},${x},${(-2.75 * wave).toExponential(5)}\n`;
  };
  const csv = (n) =>
    `time_s,displacement_m,acceleration_m_s2\n${Array.from({length: n}, (_, k) => line(k)).join("")}`;
  const headers = {"Content-Type": "text/csv"};
  const identify = (body, query = "preset=fig15", url = service.url) =>
    send(url, `/v1/identify?${query}`, body, {headers});
  const quiet = await problem(await identify(csv(60000)), 422); // 2 MB
  assert.match(quiet.detail, /no impacts found in the record/);
  const noNumber = await problem(await identify(csv(200).replace("0.000488", "oops")), 422);
  assert.equal(noNumber.detail, 'line 3, column time_s: "oops" is not a number');
  headers["Content-Type"] = "Text/CSV ; header=present";
  assert.deepEqual(
    (await problem(await identify(csv(200).replace("0.000488", "oops")), 422)).detail,
    noNumber.detail,
  );
  const unknown = await problem(await identify(csv(200), "preset=fig15&q=1"), 422);
  assert.equal(unknown.errors[0].pointer, "/q");
  const small = await serviceFor(t, ["--record-limit", "10000", "--payload-limit", "10000"]);
  await problem(await identify(csv(2000), "preset=fig15", small.url), 413);
});

test("the manifold is a separate route, by GET and POST", async () => {
  const got = await getJson("/v1/manifold?b=0.015&points=10");
  const posted = await send(service.url, "/v1/manifold", {b: 0.015, points: 10});
  assert.deepEqual(got, await posted.json());
  assert.equal(got.manifold.stable.C.length, 10);
  await problem(await fetch(`${service.url}/v1/manifold?R_plus=0.5&R_minus=0.6`), 422);
  await problem(await fetch(`${service.url}/v1/manifold?tau_end=3`), 422);
});

const sweep = {
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 30}],
  cycles: 60,
};
const longSweep = {...sweep, axes: [{...sweep.axes[0], count: 20000}], cycles: 2000};
const postSweep = (request, options = {}, url = service.url) =>
  send(url, "/v1/sweep", request, options);

test("a sweep is a stream of lines: start, points, progress, done; missing points can be requested alone", async () => {
  const response = await postSweep(sweep);
  assert.equal(response.headers.get("content-type"), "application/x-ndjson");
  const lines = linesOf(await response.text());
  assert.equal(lines[0].type, "start");
  assert.equal(lines[0].points, 30);
  assert.deepEqual(lines.at(-1), {type: "done", points: 30});
  // The ball at rest in the middle is not met.
  assert.match(lines.at(-2).message, /the motion depends on the start: at \d+ of 15 points/);
  const pointsOf = (list) => list.filter((l) => l.type === "point");
  const points = pointsOf(lines).sort((a, b) => a.index - b.index);
  const indices = points.map((p) => p.index);
  assert.deepEqual(indices, [...Array(30).keys()]);
  assert.ok(lines.some((l) => l.type === "progress" && l.done === 30 && l.of === 30));
  const missing = pointsOf(linesOf(await textOf(await postSweep({...sweep, indices: [3, 17]}))));
  for (const point of missing) assert.deepEqual(point, points[point.index]);
  assert.equal(missing.length, 2);
  const outside = {...sweep, axes: [{parameter: "b", from: -1, to: 0.03, count: 3}]};
  const faults = await problem(await postSweep(outside), 422);
  assert.equal(faults.errors[0].pointer, "/axes/0");
});

test("points arrive while the sweep runs, and it stops when its client leaves", async (t) => {
  const one = await serviceFor(t, ["--sweeps", "1"]);
  const leaving = new AbortController();
  const reader = (await postSweep(longSweep, {signal: leaving.signal}, one.url)).body.getReader();
  for (let text = ""; !text.includes('"point"'); )
    text += new TextDecoder().decode((await reader.read()).value);
  assert.equal((await postSweep(sweep, {}, one.url)).status, 503); // the limit is one sweep
  leaving.abort();
  // The abandoned sweep would take minutes; tests/bench measures how soon it ends.
  let next;
  await until(async () => {
    next = await postSweep(sweep, {}, one.url);
    return next.status !== 503;
  });
  assert.equal(linesOf(await next.text()).at(-1).type, "done");
});

test("equal small sweeps at once are computed once, for all clients, even if the first one leaves", async () => {
  const one = await startService(["--sweeps", "1"]);
  const shared = {
    ...sweep,
    axes: [{...sweep.axes[0], count: 300}],
    cycles: 1000,
    section: "impact",
    section_points: 60,
  };
  const leaving = new AbortController();
  const first = (await postSweep(shared, {signal: leaving.signal}, one.url)).body.getReader();
  // The others get what is there piece by piece, with lines of progress between.
  for (let text = ""; text.length < 2e5; )
    text += new TextDecoder().decode((await first.read()).value);
  const others = await Promise.all(Array.from({length: 29}, () => postSweep(shared, {}, one.url)));
  assert.equal((await postSweep({...shared, cycles: 999}, {}, one.url)).status, 503);
  leaving.abort();
  const answers = await Promise.all(
    others.map(async (each) => (await each.text()).trim().split("\n")),
  );
  const points = answers.map((lines) => lines.filter((line) => line.startsWith('{"type":"point"')));
  assert.equal(points[0].length, 300);
  for (const each of points) assert.equal(each.join("\n"), points[0].join("\n"));
  for (const lines of answers) assert.equal(JSON.parse(lines.at(-1)).type, "done");
  // Counts the runs of a further sweep, once it has been counted.
  const total = async () => {
    const text = await (await fetch(`${one.url}/metrics`)).text();
    return Number(/^vines_sweep_runs_total (\d+)/m.exec(text)[1]);
  };
  await until(async () => (await total()) > 0);
  const once = await total();
  await (await postSweep(shared, {}, one.url)).text();
  await until(async () => (await total()) > once);
  assert.equal(await total(), 2 * once);
  await one.stop();
});

test("the last line of a design is its result, after the progress", async () => {
  const base = {m1: 2, f0: 8, damping_ratio: 0.01};
  const search = {b_count: 2, f_count: 2, R: 0.2, starts: "one", cycles: 20, transient_cycles: 0};
  const request = {base, m2: 0.04, f: [7.9, 8.1], acceleration: 5, ...search};
  const lines = linesOf(await textOf(await send(service.url, "/v1/design", request)));
  assert.equal(lines.at(-1).type, "done");
  assert.ok(lines.at(-1).complete);
});

test("a sweep takes 201 x 201 starts", async () => {
  const values = Array.from({length: 201}, (_, k) => (k - 100.123456789) * 2.7e-5);
  const starts = values.flatMap((x0) => values.map((y_dot0) => ({x0, y_dot0, y0: 0})));
  const axes = [{parameter: "b", values: [0.0065]}];
  const answer = await postSweep({axes, starts, indices: [0, 40400], cycles: 10});
  const lines = linesOf(await textOf(answer));
  assert.equal(lines[0].points, 40401);
  const computed = lines.filter(({type}) => type === "point").map(({start}) => start);
  assert.deepEqual(new Set(computed), new Set([0, 40400]));
});

test("a simulation is answered during a sweep's point when one thread computes both", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  const leaving = new AbortController();
  // One run of several seconds, which writes its line at its end.
  const request = {
    base: {b: 0.008, max_impacts: 2000000},
    axes: [{parameter: "R", values: [0.6]}],
    starts: [{}, {x0: 0.001}],
    indices: [0],
    cycles: 1000000,
    transient_cycles: 1000000,
  };
  const reader = (await postSweep(request, {signal: leaving.signal}, one.url)).body.getReader();
  let text = "";
  const reading = (async () => {
    let part = await reader.read();
    while (!part.done) {
      text += new TextDecoder().decode(part.value);
      part = await reader.read();
    }
  })().catch(() => {});
  const reports = async (count) => {
    const enough = text.split('"progress"').length + count;
    await until(() => text.split('"progress"').length >= enough || text.includes('"point"'));
  };
  await reports(1);
  const answer = await (await fetch(`${one.url}/v1/simulate?tau_end=200&include=exponents`)).json();
  assert.equal(answer.status.reason, "tau_end");
  await reports(2); // the simulation did not wait for the point's end
  assert.doesNotMatch(text, /"point"/);
  leaving.abort();
  await reading;
});

test("a stopping service reports it in a sweep's stream and on /readyz, and accepts requests until the drain is over", async () => {
  const draining = await startService(["--drain", "4"]);
  const response = postSweep(longSweep, {}, draining.url);
  const reader = (await response).body.getReader();
  await reader.read();
  assert.equal((await fetch(`${draining.url}/readyz`)).status, 200);
  const ended = draining.stop();
  let text = "";
  let part = await reader.read();
  while (!part.done) {
    text += new TextDecoder().decode(part.value);
    part = await reader.read();
  }
  const last = JSON.parse(text.trim().split("\n").at(-1));
  assert.equal(last.type, "error");
  assert.match(last.detail, /request the missing indices again/);
  assert.equal((await fetch(`${draining.url}/readyz`)).status, 503);
  assert.equal((await fetch(`${draining.url}/livez`)).status, 200);
  assert.equal((await fetch(`${draining.url}/v1/simulate?tau_end=10`)).status, 200);
  assert.equal(await ended, 0);
});

test("the report on the paper is written to any folder; a folder that cannot be created is an error", async () => {
  const folder = await mkdtemp(join(tmpdir(), "vines-report-"));
  const [code, table] = await run(["reproduce", "--output", join(folder, "new")]);
  assert.equal(code, 0);
  assert.doesNotMatch(table, /OUT OF BAND/);
  const report = await readFile(join(folder, "new", "report.md"), "utf8");
  for (const [, picture] of report.matchAll(/\]\(([^)]+\.svg)\)/g))
    assert.match(await readFile(join(folder, "new", picture), "utf8"), /^<svg /);
  const figures = Array.from({length: 12}, (_, i) => `Fig. ${i + 3}`);
  for (const item of ["Table 1", "Table 2", "Table 3", ...figures])
    assert.ok(table.includes(`| ${item}`), item);
  assert.equal((await run(["reproduce", "--output", "/proc/nowhere"]))[0], 1);
  await rm(folder, {recursive: true});
});

test("the OpenAPI document names every route and every field", async () => {
  const document = await (await fetch(`${service.url}/v1/openapi.json`)).json();
  assert.deepEqual(JSON.parse((await run(["openapi"]))[1]), document);
  for (const [path, methods] of Object.entries(document.paths)) {
    for (const method of Object.keys(methods)) {
      const body = method === "post" ? "{}" : undefined;
      const answer = await fetch(`${service.url}${path}`, {method: method.toUpperCase(), body});
      await answer.text();
      const {status} = answer;
      const hasRequired = ["sweep", "basins", "continue", "design", "identify"].includes(
        path.split("/").at(-1),
      );
      assert.ok(status === 200 || (hasRequired && status === 422), `${method} ${path}: ${status}`);
    }
  }
  const {fields, form_fields: form} = await getJson("/v1/parameters");
  const {properties} = document.components.schemas.SimulateRequest;
  const names = [...fields, ...form].map((f) => f.name);
  assert.deepEqual(Object.keys(properties), names);
  for (const [reference] of JSON.stringify(document).matchAll(/#\/components\/schemas\/(\w+)/g))
    assert.ok(reference.split("/").at(-1) in document.components.schemas);
});

test("errors are problem documents with field, value and range", async () => {
  const document = await problem(await post('{"b":-1,"Omega":1000}'), 422);
  assert.deepEqual(
    document.errors.map((e) => [e.pointer, e.value, e.range]),
    [
      ["/b", -1, [1e-9, 1000]],
      ["/Omega", 1000, [0.001, 100]],
    ],
  );
  await problem(await post("{"), 400);
  await problem(await fetch(`${service.url}/nothing`), 404);
  await problem(await fetch(`${service.url}/v1/simulate?b=x`), 422);
  await problem(await send(service.url, "/v1/simulate?b=1", "{}"), 400);
  const wrong = await fetch(`${service.url}/v1/presets`, {method: "DELETE"});
  assert.equal(wrong.headers.get("allow"), "GET, HEAD");
  await problem(wrong, 405);
});

test("unacceptable bodies are refused before they are read", async () => {
  await problem(await post("x".repeat((1 << 20) + 1)), 413);
  const head = "POST /v1/simulate HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  assert.match(await raw(`${head}2\r\n{}\r\n0\r\n\r\n`), /^HTTP\/1.1 411/);
  await problem(await post("{}", {"Content-Encoding": "gzip"}), 415);
  await problem(await post("{}", {"Content-Type": "multipart/form-data; boundary=x"}), 415);
  await problem(await fetch(`${service.url}/v1/presets`, {headers: {Range: "bytes=0-1,0-1"}}), 416);
});

test("a request's length must be one number", async () => {
  const head = "POST /v1/simulate HTTP/1.1\r\nHost: x\r\n";
  for (const lengths of ["Content-Length: 2\r\nContent-Length: 30", "Content-Length: abc"])
    assert.match(await raw(`${head}${lengths}\r\n\r\n{}`), /^HTTP\/1.1 400/, lengths);
});

test("an unread body is not read as the next request", async () => {
  const smuggled = "GET /version HTTP/1.1\r\nHost: x\r\n\r\n";
  const answer = await raw(
    `POST /nothing HTTP/1.1\r\nHost: x\r\nContent-Length: ${smuggled.length}\r\n\r\n${smuggled}`,
  );
  assert.equal(answer.match(/HTTP\/1\.1 /g).length, 1);
});

test("malformed requests get an answer and do not harm the service", async () => {
  for (const text of [
    "nonsense\r\n\r\n",
    "GET\r\n\r\n",
    `GET /${"a".repeat(20000)} HTTP/1.1\r\n\r\n`,
    "\0\0\0\r\n\r\n",
    `GET / HTTP/1.1\r\n${"A: b\r\n".repeat(2000)}\r\n`,
  ])
    await raw(text, 300);
  await problem(await post(`${"[".repeat(100000)}`), 400);
  assert.equal((await fetch(`${service.url}/healthz`)).status, 200);
});

/** The headers and bytes of an answer, which fetch would uncompress. */
const received = (path, coding, body) =>
  new Promise((resolve) => {
    const options = {method: body ? "POST" : "GET", headers: {"Accept-Encoding": coding}};
    const request = httpRequest(service.url + path, options, async (response) => {
      const pieces = [];
      for await (const piece of response) pieces.push(piece);
      resolve({headers: response.headers, bytes: Buffer.concat(pieces)});
    });
    request.end(body);
  });

test("an answer with very many impacts is streamed, with the same bytes", async () => {
  const body = '{"b":0.015,"tau_end":1e6,"max_impacts":40000,"include":["impacts"]}';
  const file = join(await mkdtemp(join(tmpdir(), "vines-")), "request.json");
  await writeFile(file, body);
  const [, whole] = await run(["simulate", file]);
  for (const coding of ["identity", "br, gzip"]) {
    const {headers, bytes} = await received("/v1/simulate", coding, body);
    assert.equal(headers["transfer-encoding"], "chunked");
    assert.match(headers.vary, /Accept\b.*Accept-Encoding|Accept-Encoding.*Accept\b/);
    assert.equal(headers["content-encoding"], coding === "identity" ? undefined : "gzip");
    const text = coding === "identity" ? bytes : gunzipSync(bytes);
    assert.ok(text.length > 8e6);
    assert.ok(text.equals(Buffer.from(whole)));
  }
  const query = "b=0.015&tau_end=1e6&max_impacts=40000&include=impacts";
  const got = await fetch(`${service.url}/v1/simulate?${query}`);
  assert.equal(got.headers.get("etag"), null);
  assert.equal(got.headers.get("cache-control"), "no-store");
  assert.equal(await got.text(), whole);
});

test("a streamed answer ends when its client leaves", async (t) => {
  const streaming = await serviceFor(t, ["--answer-limit", "2000000000"]);
  const body = '{"b":0.015,"tau_end":1e7,"max_impacts":2000000,"include":["impacts"]}';
  const leave = new AbortController();
  const response = await send(streaming.url, "/v1/simulate", body, {signal: leave.signal});
  await response.body.getReader().read();
  const before = await computed(streaming.pid);
  leave.abort();
  await until(async () => (await metric(streaming.url, "vines_http_requests_in_flight")) === 0);
  assert.ok((await computed(streaming.pid)) < before + 1.5);
});

test("large answers are compressed by gzip on request, small ones are not", async () => {
  const {headers, bytes} = await received("/v1/simulate", "br, gzip");
  assert.equal(headers["content-encoding"], "gzip");
  assert.ok(JSON.parse(gunzipSync(bytes)).series.tau.length > 1000);
  // Longer than one piece of the compression (1 MiB).
  const long = "/v1/simulate?include=series&tau_end=20000&max_points=100000";
  const plain = await received(long, "identity");
  assert.ok(gunzipSync((await received(long, "br, gzip")).bytes).equals(plain.bytes));
  assert.equal((await received("/version", "br, gzip")).headers["content-encoding"], undefined);
});

test("four hundred simultaneous clients are all answered", async () => {
  const text = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
  const all = await Promise.all(Array.from({length: 400}, () => raw(text)));
  assert.equal(all.filter((a) => a.startsWith("HTTP/1.1 200")).length, 400);
});

// Several seconds of computing: longer than the deadlines below.
const long = JSON.stringify({
  b: 0.003,
  R: 1,
  tau_end: 1e7,
  max_impacts: 2000000,
  include: ["exponents", "regime"],
});

test("the queue for computing is limited: beyond it 503 with Retry-After", async (t) => {
  // The first request computes until the deadline, the second waits, the others are refused.
  const small = await serviceFor(t, [
    "--compute-threads",
    "1",
    "--compute-queue",
    "1",
    "--deadline",
    "2",
  ]);
  const answers = await Promise.all(
    Array.from({length: 6}, () => send(small.url, "/v1/simulate", long)),
  );
  const refused = answers.filter((a) => a.status === 503);
  assert.ok(refused.length >= 3, `${refused.length} refused`);
  assert.equal(refused[0].headers.get("retry-after"), "1");
});

test("a request that computes too long ends with the results so far", async (t) => {
  const hasty = await serviceFor(t, ["--deadline", "0.5"]);
  const response = await send(hasty.url, "/v1/simulate", long);
  const answer = await response.json();
  assert.equal(answer.status.reason, "deadline");
  assert.ok(answer.status.tau > 0 && answer.status.tau < 1e7);
  assert.ok((await computed(hasty.pid)) < 2);
});

test("an identification that takes too long reports the stage it reached", async (t) => {
  // Every sample is in the neighbourhood of every other: the work is quadratic in their number.
  const sample = (k) => `${k * 1e-9},${Math.sin(k)}`;
  const record = ["time_s,a", ...Array.from({length: 50000}, (_, k) => sample(k))].join("\n");
  const hasty = await serviceFor(t, ["--deadline", "0.5"]);
  const headers = {"Content-Type": "text/csv"};
  const response = await send(hasty.url, "/v1/identify?preset=fig15", record, {headers});
  assert.equal(response.status, 413);
  assert.match(
    (await response.json()).detail,
    /stopped while looking for spikes \(a record of 50000/,
  );
  assert.ok((await computed(hasty.pid)) < 2);
});

test("the deadline and the answer limit hold for the largest possible request, in time and memory", async (t) => {
  const hasty = await serviceFor(t, ["--deadline", "1", "--answer-limit", "50000000"]);
  const {fields} = await getJson("/v1/parameters");
  const include = fields.find((f) => f.name === "include").choices;
  const lists = {max_points: 1e6, max_impacts: 2e6};
  const request = {b: 0.003, tau_end: 1e7, ...lists, include};
  const response = await send(hasty.url, "/v1/simulate", request);
  const text = await response.text();
  const seconds = await computed(hasty.pid);
  assert.ok(seconds < 4, `${seconds} s`);
  assert.ok(text.length <= 50000000, `${text.length} bytes`);
  const answer = JSON.parse(text);
  assert.equal(answer.status.reason, "deadline");
  assert.ok(
    answer.warnings.some((w) => /max_points is \d+ instead of 1000000/.test(w)),
    answer.warnings.join("\n"),
  );
  for (const part of include)
    assert.ok(answer[part] !== null || answer.warnings.some((w) => w.includes(part)), part);
  const status = await readFile(`/proc/${hasty.pid}/status`, "utf8");
  const peak = Number(status.match(/VmHWM:\s+(\d+)/)[1]) / 1024;
  assert.ok(peak < 1000, `${peak} MB`);
});

test("an answer beyond the server's limit is thinned, or refused with both sizes if it cannot be thinned", async (t) => {
  const small = await serviceFor(t, [], {VINES_ANSWER_LIMIT: "300000"});
  const get = (path) => fetch(`${small.url}${path}`);
  const text = await (await get("/v1/simulate?b=0.003&include=series,impacts")).text();
  assert.ok(text.length <= 300000, `${text.length} bytes`);
  assert.ok(JSON.parse(text).warnings.some((w) => /limit of 300000 bytes/.test(w)));
  const {detail} = await problem(await get("/v1/manifold?points=100000"), 413);
  assert.match(detail, /has \d+ bytes, more than this server's limit of 300000/);
  assert.equal((await get("/v1/manifold?points=1000")).status, 200);
});

test("SIGTERM ends the service with 0 without waiting for an idle connection; SIGUSR1 and SIGALRM do not end it", async () => {
  const other = await startService();
  const {socket: idle} = await connect(other.url);
  idle.write("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
  await new Promise((resolve) => idle.once("data", resolve));
  for (const ignored of ["SIGUSR1", "SIGUSR2", "SIGALRM"]) process.kill(other.pid, ignored);
  const started = Date.now();
  assert.equal(await other.stop(), 0);
  assert.ok(Date.now() - started < 30000, "half the time limit of an idle connection");
  idle.destroy();
});

test("a flag overrides the environment, which overrides the default; invalid values are refused", async () => {
  const fromEnvironment = await startService([], {VINES_PORT: "0"}, false);
  assert.notEqual(new URL(fromEnvironment.url).port, "8080");
  await fromEnvironment.stop();
  const [code, text] = await run(["serve", "--port", port]); // taken
  assert.equal(code, 2);
  assert.match(text, new RegExp(`^vines: port ${port} is taken; use --port, .*\n$`));
  for (const nowhere of ["999.1.1.1", "192.0.2.7"])
    assert.deepEqual(await run(["serve", "--port", "0", "--host", nowhere]), [
      2,
      `vines: cannot listen on ${nowhere}; use --host with an address of this machine\n`,
    ]);
  const bad = [
    [["serve", "--port", "99999"], {}, /--port.*99999/],
    [["serve", "--deadline", "nan"], {}, /--deadline.*nan/],
    [["serve", "--threads", "0"], {}, /--threads.*0/],
    [["serve", "--nothing"], {}, /--nothing.*vines serve --help/],
    [["serve"], {VINES_PORT: "x"}, /--port.*x/],
    [["nothing"], {}, /subcommand.*vines --help/],
  ];
  for (const [args, environment, message] of bad) {
    const [code, text] = await run(args, environment);
    assert.equal(code, 2, text);
    assert.match(text, message);
    assert.match(text, /^vines: [^\n]*\n$/, "one line");
  }
  assert.equal((await run(["--version"]))[0], 0);
  assert.match((await run(["serve", "--help"]))[1], /VINES_PORT/);
});

test("healthcheck distinguishes a running service from a missing one", async () => {
  assert.equal((await run(["healthcheck", "--port", port]))[0], 0);
  assert.equal((await run(["healthcheck", "--port", "1"]))[0], 1);
});

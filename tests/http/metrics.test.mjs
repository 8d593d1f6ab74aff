// The service's metrics, as Prometheus reads them.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {existsSync} from "node:fs";
import {test} from "node:test";
import {endless, exchange, send, serviceFor, until} from "./raw.mjs";

const fetched = new URL("../../build/tools/promtool", import.meta.url).pathname;
const promtool = existsSync(fetched) ? fetched : "promtool"; // of scripts/setup, or Debian's

/** The samples by name and labels, as written. */
async function metrics(url) {
  const text = await (await fetch(`${url}/metrics`)).text();
  const lines = text.split("\n").filter((line) => line && !line.startsWith("#"));
  return new Map(
    lines.map((line) => {
      const at = line.lastIndexOf(" ");
      return [line.slice(0, at), Number(line.slice(at + 1))];
    }),
  );
}

test("requests are counted by route, method and status, durations by route; promtool finds no fault", async (t) => {
  const service = await serviceFor(t);
  const {url} = service;
  const answers = [
    await fetch(`${url}/v1/simulate?b=0.022&include=regime`),
    await fetch(`${url}/v1/simulate?b=0.022&include=regime`),
    await fetch(`${url}/v1/simulate?b=-1`),
    await fetch(`${url}/index.php`),
    await fetch(`${url}/`),
  ];
  for (const answer of answers) await answer.arrayBuffer();
  await exchange(url, "BREW /v1/simulate HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const second = "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\nGARBAGE\r\n\r\n";
  await exchange(url, second);
  // An answer is counted after it has been sent.
  await until(async () => {
    const counted = /^vines_http_requests_total.*route="(?!\/metrics)/;
    const counts = [...(await metrics(url))].filter(([name]) => counted.test(name));
    return counts.reduce((sum, [, count]) => sum + count, 0) === 8;
  });
  const answer = await fetch(`${url}/metrics`);
  assert.equal(answer.headers.get("content-type"), "text/plain; version=0.0.4; charset=utf-8");
  const {status, stdout, stderr} = spawnSync(promtool, ["check", "metrics"], {
    input: await answer.text(),
    encoding: "utf8",
  });
  assert.equal(status, 0, stdout + stderr);
  assert.equal(stdout + stderr, "");
  const all = await metrics(url);
  const requests = (route, method, code) =>
    all.get(`vines_http_requests_total{code="${code}",method="${method}",route="${route}"}`);
  assert.equal(requests("/v1/simulate", "GET", 200), 2);
  assert.equal(requests("/v1/simulate", "GET", 422), 1);
  assert.equal(requests("none", "GET", 404), 1);
  assert.equal(requests("none", "other", 405), 1, "a client's words create no series");
  assert.equal(requests("none", "other", 400), 1, "also after another request on its connection");
  assert.equal(requests("page", "GET", 200), 1);
  assert.equal(
    all.get('vines_http_request_duration_seconds_count{route="/v1/simulate"}'),
    3,
    "all statuses",
  );
  assert.equal(all.get("vines_compute_queue_seconds_count"), 3);
  assert.ok(all.get("vines_http_sent_bytes_total") > 2000);
  const {version, commit, compiler} = await (await fetch(`${url}/version`)).json();
  const build = `{version="${version}",commit="${commit}",compiler="${compiler}"}`;
  assert.equal(all.get(`vines_build_info${build}`), 1);
});

test("impacts, sweeps, their runs and the outcome of each sweep are counted", async (t) => {
  const service = await serviceFor(t);
  const {url} = service;
  const fields = {b: 0.022, damping: "closed_form", tau_end: 1709, include: ["impacts"]};
  const {impacts} = await (await send(url, "/v1/simulate", fields)).json();
  await until(async () => (await metrics(url)).get("vines_impacts_total") === impacts.tau.length);
  const axes = [{parameter: "b", from: 0.01, to: 0.02, count: 7}];
  const lines = await (await send(url, "/v1/sweep", {axes, transient_cycles: 50})).text();
  assert.match(lines, /"type":"done"/);
  const long = {axes: [{...axes[0], count: 20000}], cycles: 5000};
  const leaving = new AbortController();
  const stream = await send(url, "/v1/sweep", long, {signal: leaving.signal});
  await stream.body.getReader().read();
  assert.equal((await metrics(url)).get("vines_sweeps_running"), 1);
  leaving.abort();
  const ended = async (end) => (await metrics(url)).get(`vines_sweeps_total{end="${end}"}`);
  await until(async () => (await ended("client_left")) === 1);
  assert.equal(await ended("complete"), 1);
  assert.equal(await ended("failed"), 0, "present from the start");
  await until(async () => (await metrics(url)).get("vines_sweeps_running") === 0);
  const all = await metrics(url);
  assert.ok(all.get("vines_sweep_runs_total") >= 7);
  assert.ok(all.get("vines_impacts_total") > impacts.tau.length);
});

test("a client that leaves the queue is not counted as refused", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1"]);
  const leaving = new AbortController();
  const {signal} = leaving;
  const requested = [1, 2, 3].map(() =>
    send(one.url, "/v1/simulate", endless, {signal}).catch(() => {}),
  );
  await until(async () => (await metrics(one.url)).get("vines_compute_queue_depth") === 2);
  leaving.abort();
  await Promise.all(requested);
  await until(async () => (await metrics(one.url)).get("vines_http_requests_in_flight") === 0);
  const all = await metrics(one.url);
  assert.equal(all.get('vines_http_unavailable_total{reason="computing"}'), 0);
  for (const name of all.keys()) assert.doesNotMatch(name, /code="503"/);
});

test("waiting, running and refused requests are shown as they occur", async (t) => {
  const one = await serviceFor(t, ["--compute-threads", "1", "--compute-queue", "1"]);
  const leaving = new AbortController();
  const load = (name) => metrics(one.url).then((all) => all.get(name));
  const {signal} = leaving;
  const begin = () => send(one.url, "/v1/simulate", endless, {signal}).catch(() => {});
  const running = [begin()];
  await until(async () => (await load("vines_compute_running")) === 1);
  running.push(begin());
  await until(async () => (await load("vines_compute_queue_depth")) === 1);
  const refused = await send(one.url, "/v1/simulate", {b: 0.022});
  assert.equal(refused.status, 503);
  assert.equal((await refused.json()).lacking, "computing");
  // An answer is counted after it has been sent.
  const lacking = 'vines_http_unavailable_total{reason="computing"}';
  await until(async () => (await load(lacking)) === 1);
  await until(async () => (await load("vines_http_requests_in_flight")) === 2);
  assert.ok((await load("vines_http_connections")) >= 3);
  leaving.abort();
  await Promise.all(running);
  await until(async () => (await load("vines_compute_running")) === 0);
  await until(async () => (await load("vines_http_requests_in_flight")) === 0);
});

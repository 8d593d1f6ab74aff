// Access control: API keys, and pages of other origins.
import assert from "node:assert/strict";
import {execFileSync, spawnSync} from "node:child_process";
import {mkdtemp, rm, symlink, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {program, startService} from "../service.mjs";
import {exchange, get, send, serviceFor, until} from "./raw.mjs";

const folder = await mkdtemp(join(tmpdir(), "vines-keys-"));
after(() => rm(folder, {recursive: true}));

const keyFile = async (text) => {
  const path = join(folder, "keys");
  await writeFile(path, text);
  return path;
};
/** Runs a service that does not start, to its end. */
const serve = (...args) =>
  spawnSync(program, ["serve", ...args], {encoding: "utf8", timeout: 60000, killSignal: "SIGKILL"});

const cors = ["--cors-origin", "https://lab.example.org"];
const keys = ["first-key-0123456789", "second.key~with+all/of=them=="];

test("with --api-key-file everything except health and the page requires one of its keys", async (t) => {
  const service = await serviceFor(t, [
    "--api-key-file",
    await keyFile(`# of the laboratory\n\n${keys[0]}\r\n  ${keys[1]}  \n`),
  ]);
  const status = async (path, authorization, options = {}) => {
    const headers = authorization === undefined ? {} : {Authorization: authorization};
    const answer = await fetch(service.url + path, {headers, ...options});
    await answer.arrayBuffer();
    return answer.status;
  };
  for (const path of ["/", "/docs", "/livez", "/readyz", "/healthz", "/version"])
    assert.equal(await status(path), 200, path);
  const protectedPaths = [
    "/v1/simulate?include=regime",
    "/v1/manifold",
    "/v1/presets",
    "/v1/parameters",
    "/v1/openapi.json",
    "/metrics",
  ];
  for (const path of protectedPaths) {
    assert.equal(await status(path), 401, path);
    assert.equal(await status(path, `Bearer ${keys[0]}`), 200, path);
    assert.equal(await status(path, `bearer  ${keys[1]}`), 200, path);
  }
  const wrong = [
    "Bearer",
    "Bearer ",
    `Basic ${keys[0]}`,
    keys[0],
    `Bearer ${keys[0]}x`,
    `Bearer ${keys[0].slice(0, -1)}`,
    "Bearer # of the laboratory",
    `Bearer ${keys[0]}, Bearer ${keys[1]}`,
  ];
  const both = `Authorization: Bearer ${keys[0]}\r\nAuthorization: Bearer x\r\n`;
  const twice = await exchange(service.url, get("/v1/presets", both));
  assert.match(twice, /^HTTP\/1.1 401/, "two headers are no valid key");
  for (const shown of wrong) assert.equal(await status("/v1/presets", shown), 401, shown);
  const post = {method: "POST", body: "{}"};
  for (const path of [
    "/v1/simulate",
    "/v1/sweep",
    "/v1/basins",
    "/v1/continue",
    "/v1/identify",
    "/v1/manifold",
  ])
    assert.equal(await status(path, undefined, post), 401, path);
  const refused = await fetch(`${service.url}/v1/presets`);
  assert.equal(refused.headers.get("www-authenticate"), 'Bearer realm="vines"');
  assert.match((await refused.json()).detail, /Authorization: Bearer KEY/);
});

test("SIGHUP reloads the keys, unless the file has none, and does not end the service", async (t) => {
  const service = await serviceFor(t, ["--api-key-file", await keyFile(keys[0])]);
  const accepts = async (key) =>
    (await fetch(`${service.url}/metrics`, {headers: {Authorization: `Bearer ${key}`}})).ok;
  const reload = async (text) => {
    await keyFile(text);
    process.kill(service.pid, "SIGHUP");
  };
  await reload(keys[1]);
  await until(() => accepts(keys[1]));
  assert.equal(await accepts(keys[0]), false);
  await reload("short");
  await reload(`${keys[0]}\n${keys[1]}`);
  await until(() => accepts(keys[0]));
  assert.equal(await accepts(keys[1]), true);
});

test("the server does not start with a key file that has no valid key", async () => {
  const cases = [
    ["", /keys contains no key/],
    ["# only words\n", /contains no key/],
    ["long-enough-0123456\nshort\n", /keys, line 2: a key must have 16 or more characters/],
    ["a key with blanks in it\n", /line 1/],
  ];
  for (const [text, message] of cases) {
    const path = await keyFile(text);
    const {status, stderr} = serve("--port", "0", "--api-key-file", path);
    assert.equal(status, 2, text);
    assert.match(stderr, message);
    assert.doesNotMatch(stderr, /short|blanks in it/, "the message does not show a key");
  }
});

test("a key file that is missing, not a regular file or far too large is refused at once in one line", async () => {
  const at = (name) => join(folder, name);
  execFileSync("mkfifo", [at("pipe")]);
  await writeFile(at("large"), `${keys[0]}\n`.repeat(100000));
  const cases = [
    [at("none"), /cannot read .*none: No such file/],
    [at("pipe"), /pipe: not a regular file/], // no process writes to it
    ["/dev/zero", /zero: not a regular file/],
    [folder, /not a regular file/],
    [at("large"), /large: it has more than 1048576 bytes/],
  ];
  for (const [path, message] of cases) {
    const {status, stderr} = serve("--port", "0", "--api-key-file", path);
    assert.equal(status, 2, path);
    assert.match(stderr, message);
    assert.match(stderr, /^vines: .*\n$/, "one line");
  }
  await symlink(at("keys"), at("way"));
  await keyFile(`${keys[0]}\n`);
  const linked = await startService(["--api-key-file", at("way")]); // as with a mounted secret
  assert.equal(await linked.stop(), 0);
});

test("a page of an allowed origin may use the service and read its headers; others may not", async (t) => {
  const service = await serviceFor(t, cors);
  const ask = (origin, more = "", method = "GET") => {
    const headers = `Origin: ${origin}\r\nSec-Fetch-Site: cross-site\r\nConnection: close\r\n`;
    return exchange(service.url, get("/v1/manifold", headers + more).replace("GET", method));
  };
  const allowed = await ask("https://lab.example.org");
  assert.match(allowed, /^HTTP\/1.1 200/);
  assert.match(allowed, /^Access-Control-Allow-Origin: https:\/\/lab\.example\.org\r$/m);
  assert.match(allowed, /^Access-Control-Expose-Headers: .*X-Request-ID/m);
  assert.match(allowed, /^Vary: Origin\r$/m);
  const tag = /^ETag: (.*)\r$/m.exec(allowed)[1];
  const known = await ask("https://lab.example.org", `If-None-Match: ${tag}\r\n`);
  assert.match(known, /^HTTP\/1.1 304(.|\s)*^Access-Control-Allow-Origin: https/m);
  const asked =
    "Access-Control-Request-Method: POST\r\nAccess-Control-Request-Headers: content-type\r\n";
  const preflight = (origin) => ask(origin, asked, "OPTIONS");
  const leave = await preflight("https://lab.example.org");
  assert.match(leave, /^HTTP\/1.1 200/);
  assert.match(leave, /^Access-Control-Allow-Methods: GET, HEAD, POST\r$/m);
  assert.match(leave, /^Access-Control-Allow-Headers: Authorization, Content-Type/m);
  for (const other of ["https://lab.example.org.evil.net", "http://lab.example.org", "null"])
    for (const request of [await ask(other), await preflight(other)]) {
      assert.match(request, /^HTTP\/1.1 403/, other);
      assert.doesNotMatch(request, /Access-Control/);
    }
});

test("a preflight with a body is refused, like every request with a body that is not a POST", async (t) => {
  const service = await serviceFor(t, cors);
  const headers = "Origin: https://lab.example.org\r\nAccess-Control-Request-Method: POST\r\n";
  const head = get("/v1/simulate", `${headers}Content-Length: 999999999999\r\n`);
  assert.match(await exchange(service.url, head.replace("GET", "OPTIONS")), /^HTTP\/1.1 400/);
});

test("a refusal for lack of memory carries the CORS headers, too", async (t) => {
  const service = await serviceFor(t, [...cors, "--memory-limit", "1"]);
  const answer = await fetch(`${service.url}/v1/simulate?preset=fig3&tau_end=3000`, {
    headers: {Origin: "https://lab.example.org"},
  });
  assert.equal(answer.status, 503);
  assert.equal((await answer.json()).lacking, "memory");
  assert.equal(answer.headers.get("access-control-allow-origin"), "https://lab.example.org");
});

test("--cors-origin * lets every page use the service", async (t) => {
  const service = await serviceFor(t, ["--cors-origin", "*"]);
  const headers = {Origin: "https://any.example.net"};
  const answer = await send(service.url, "/v1/manifold", "{}", {headers});
  assert.equal(answer.status, 200);
  assert.equal(answer.headers.get("access-control-allow-origin"), "https://any.example.net");
});

test("an origin is a scheme, a host and optionally a port; any other value is refused", () => {
  // The missing key file ends the program after the check of its flags.
  const start = (flag, origin) => serve("--api-key-file", "/nowhere", flag, origin);
  for (const flag of ["--cors-origin", "--embed-origin"]) {
    for (const origin of [
      "lab.example.org",
      "ftp://lab.example.org",
      "http://",
      "http://:",
      "http://:80",
      "http://a:",
      "http://a:b",
      "http://a:0",
      "http://a:65536",
      "http://a:8x",
      "http://a/",
      "http://a..b",
      "http://-a.b",
      "http://a-",
      "http://a_b",
      "http://a;b",
      "http://1.2.3.256",
      "http://1.2.3",
      "http://::1",
      "http://[::1",
      "http://[1.2.3.4]",
      "http://[::g]",
      "http://[::1]80",
      "http://]::[",
      "http://user@a",
    ]) {
      const {status, stderr} = start(flag, origin);
      assert.equal(status, 2, origin);
      assert.ok(stderr.includes(`${origin} is not an origin such as https:`), stderr);
    }
    for (const origin of [
      "https://lab.example.org",
      "https://Lab-1.example.org.",
      "http://localhost:1",
      "https://xn--bcher-kva.example:65535",
      "http://127.0.0.1:8080",
      "http://[::1]",
      "http://[2001:db8::7]:8443",
    ])
      assert.doesNotMatch(start(flag, origin).stderr, /not an origin/, origin);
  }
});

test("a preflight of an allowed origin needs no key", async (t) => {
  const service = await serviceFor(t, [...cors, "--api-key-file", await keyFile(`${keys[0]}\n`)]);
  const from = {Origin: "https://lab.example.org"};
  const leave = await fetch(`${service.url}/v1/simulate`, {
    method: "OPTIONS",
    headers: {...from, "Access-Control-Request-Method": "POST"},
  });
  assert.equal(leave.status, 200);
  const none = await fetch(`${service.url}/v1/manifold`, {headers: from});
  assert.equal(none.status, 401);
  assert.equal(
    none.headers.get("access-control-allow-origin"),
    from.Origin,
    "the page can read the 401",
  );
});

// The OpenAPI document agrees with real requests and responses, to the last key.
import assert from "node:assert/strict";
import {mkdtemp, readFile, rm, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath, pathToFileURL} from "node:url";
import {
  basins,
  continuations,
  everything,
  simulations,
  sweeps,
  withForce,
} from "../docs/answers.mjs";
import {identifications, requests} from "../golden/requests.mjs";
import {connect, exchange, until} from "../http/raw.mjs";
import {measured} from "../record.mjs";
import {startService} from "../service.mjs";
import {ask, Document, parsed, require} from "./document.mjs";

let service;
let document;
let unended;
before(async () => {
  service = await startService();
  document = await Document.of(service.url);
  // Left incomplete; the last test reads its 408.
  unended = await connect(service.url);
  unended.socket.write("GET /v1/simulate HTTP/1.1\r\n");
});
after(() => service.stop());

/** The path of a request target. */
const pathOf = (target) => target.split("?")[0];

/** Sends a request and checks the response against the document. */
async function checked(target, request = {}, name = target) {
  const method = request.method ?? (request.body === undefined ? "GET" : "POST");
  const answer = await ask(service.url, target, request);
  document.check(answer, pathOf(target), method, name);
  return answer;
}

test("the document passes the recommended lint rules", async () => {
  const {lintFromString, loadConfig} = require("@redocly/openapi-core");
  const configPath = fileURLToPath(new URL("redocly.yaml", import.meta.url));
  const config = await loadConfig({configPath});
  const lint = async (json) => {
    const problems = await lintFromString({source: JSON.stringify(json), config});
    return problems.map((p) => `${p.ruleId}: ${p.message} ${p.location[0]?.pointer}`);
  };
  assert.deepEqual(await lint(document.json), []);
  assert.notDeepEqual(await lint({...document.json, servers: [], paths: {}}), []);
});

// --- Example requests and responses

/** The example requests of an operation: [name, target, request]. */
function exampleRequests(path, method, operation) {
  if (method === "post")
    return Object.entries(operation.requestBody.content["application/json"].examples).map(
      ([name, {value}]) => [name, path, {body: value}],
    );
  const given = operation.parameters.filter((parameter) => "example" in parameter);
  const query = new URLSearchParams(given.map(({name, example}) => [name, String(example)]));
  return [["query", given.length ? `${path}?${query}` : path, {}]];
}

/** Asserts equality up to 1e-9 of each number, ignoring version, commit and provenance. */
function assertAlike(shown, got, at = "") {
  if (typeof shown === "number" && typeof got === "number")
    return assert.ok(Math.abs(shown - got) <= 1e-9 * Math.max(1, Math.abs(shown)), `${at}: ${got}`);
  if (shown === null || typeof shown !== "object") return assert.equal(got, shown, at);
  assert.deepEqual(Object.keys(got), Object.keys(shown), at);
  for (const [name, value] of Object.entries(shown))
    if (!["version", "commit", "provenance"].includes(name))
      assertAlike(value, got[name], `${at}.${name}`);
}

test("every example request gets a response that matches the document and its example", async () => {
  const shown = new Set();
  for (const [path, methods] of Object.entries(document.json.paths))
    for (const [method, operation] of Object.entries(methods)) {
      const examples = exampleRequests(path, method, operation);
      assert.ok(examples.length > 0, `${method} ${path}`);
      for (const [name, target, request] of examples) {
        const answer = await checked(target, request, `${operation.operationId}: ${name}`);
        assert.equal(answer.status, 200, answer.text);
        const {schema, example} = Object.values(operation.responses[200].content)[0];
        // The example response belongs to the first POST example.
        if (!example || method === "get" || name !== examples[0][0]) continue;
        const lines = answer.text
          .trim()
          .split("\n")
          .map((line) => JSON.parse(line));
        // A document of one line has neither type nor index: it is found by undefined.
        assertAlike(
          example,
          lines.find(({type, index}) => type === example.type && index === example.index),
        );
        shown.add(schema.$ref.split("/").at(-1));
      }
    }
  assert.deepEqual([...shown].sort(), [
    "BasinsLine",
    "ContinueLine",
    "DesignLine",
    "Identification",
    "Manifold",
    "Simulation",
    "SweepLine",
  ]);
});

test("every example response matches its schema", () => {
  const responses = Object.values(document.json.paths).flatMap((methods) =>
    Object.values(methods).flatMap((operation) => Object.values(operation.responses)),
  );
  let count = 0;
  for (const response of [...responses, ...Object.values(document.json.components.responses)])
    for (const {schema, example} of Object.values(response.content ?? {}))
      if (example) {
        document.holds(schema.$ref.split("/").at(-1), example);
        ++count;
      }
  // Guards against a loop that finds nothing.
  assert.ok(count >= 25, `${count} examples`);
});

// --- Responses to real requests

test("responses to many requests match the document", async () => {
  const simulate = async (body) =>
    JSON.parse((await ask(service.url, "/v1/simulate", {body})).text);
  const measurements = await identifications(simulate);
  for (const {name, path, body, type} of [...requests, ...measurements]) {
    if (!document.json.paths[pathOf(path)]) continue;
    await checked(path, {body, type}, name);
  }
  for (const body of simulations) await checked("/v1/simulate", {body});
  for (const body of sweeps) await checked("/v1/sweep", {body});
  for (const body of basins) await checked("/v1/basins", {body});
  for (const body of continuations) await checked("/v1/continue", {body});
  const upright = {base: {b: 0.015, damping: "closed_form"}, parameter: "gravity"};
  await checked("/v1/continue", {body: {...upright, from: 0, to: 1e-4}});
});

test("a design after an impulse is a valid request, and one number stands for a range", () => {
  const base = {m1: 2, f0: 8, damping_ratio: 0.01, m2: 0.04};
  document.holds("DesignRequest", {base, initial_velocity: 0.5});
  document.holds("DesignRequest", {base, f: 8, acceleration: 5, b: 0.05});
});

test("every preset with all parts included matches the document", async () => {
  const {presets} = JSON.parse((await checked("/v1/presets")).text);
  assert.ok(presets.length >= 37, `${presets.length} presets`);
  // A perturbation needs the forces of the paper alone.
  const laws = ["forcing", "inclination", "mu", "gravity", "friction"];
  for (const {name, parameters} of presets) {
    const body = {preset: name, include: everything, windows: [[10, 100]], max_points: 256};
    if (!laws.some((law) => law in parameters)) body.perturbation = {size: 1e-8};
    assert.equal((await checked("/v1/simulate", {body}, name)).status, 200);
  }
});

test("responses to records match the document", async () => {
  const csv = await measured(service.url, "fig20", 6);
  const target = "/v1/identify?preset=fig20&b=0.015";
  for (const [query, body] of [
    ["&include=motion,direct_exponents", csv],
    ["", withForce(csv)],
  ])
    for (const type of ["text/csv", "text/plain"])
      assert.equal((await checked(target + query, {body, type})).status, 200);
});

test("an interrupted sweep matches the document, including its last line", async () => {
  const stopped = await startService();
  const body = {axes: [{parameter: "b", from: 0.008, to: 0.03, count: 50000}]};
  const options = {method: "POST", body: JSON.stringify(body)};
  const {status, headers, body: stream} = await fetch(`${stopped.url}/v1/sweep`, options);
  let text = "";
  let ended;
  for await (const piece of stream.pipeThrough(new TextDecoderStream())) {
    text += piece;
    if (text.includes('"point"') && text.includes('"progress"')) ended ??= stopped.stop();
  }
  assert.ok(ended, "no progress was reported");
  assert.equal(await ended, 0);
  document.check({status, headers, text}, "/v1/sweep", "POST");
  const types = new Set(
    text
      .trim()
      .split("\n")
      .map((line) => JSON.parse(line).type),
  );
  assert.deepEqual([...types].sort(), ["error", "point", "progress", "start"]);
});

test("a request with the current ETag gets 304", async () => {
  for (const target of ["/v1/presets", "/version", "/v1/simulate?preset=fig11&include=energy"]) {
    const tag = (await checked(target)).headers.get("etag");
    const again = await checked(target, {headers: {"If-None-Match": tag}});
    assert.equal(again.status, 304);
  }
});

// --- Problem documents

const head = (line, ...headers) => [line, "Host: localhost", ...headers, "", ""].join("\r\n");
const get = "GET /v1/simulate HTTP/1.1";
const post = "POST /v1/simulate HTTP/1.1";

/** For each status, the bytes of a request that gets it. */
const refused = {
  400: `${head(post, "Content-Length: 1", "Connection: close")}{`,
  403: head(get, "Sec-Fetch-Site: cross-site"),
  404: head("GET /v1/nothing HTTP/1.1"),
  405: head("DELETE /v1/simulate HTTP/1.1"),
  406: head(get, "Accept: image/png", "Connection: close"),
  411: head(post),
  413: head(post, "Content-Length: 99999999"),
  414: head(`GET /${"a".repeat(9000)} HTTP/1.1`),
  415: head(post, "Content-Length: 1", "Content-Encoding: gzip"),
  416: head(get, "Range: bytes=0-1"),
  417: head(post, "Content-Length: 1", "Expect: wonders"),
  421: "GET /v1/simulate HTTP/1.1\r\nHost: example.com\r\n\r\n",
  422: head("GET /v1/simulate?b=-1 HTTP/1.1", "Connection: close"),
  431: head(get, `X-A: ${"a".repeat(20000)}`),
  505: head("GET /v1/simulate HTTP/2.0"),
};

test("each refusal is a problem that matches the document", async () => {
  for (const [status, bytes] of Object.entries(refused)) {
    const answer = parsed(await exchange(service.url, bytes));
    assert.equal(answer.status, Number(status), answer.text);
    document.check(answer, "/v1/simulate", "POST", status);
    assert.equal(JSON.parse(answer.text).status, Number(status));
  }
});

test("a request without the required key gets a problem that matches the document", async (t) => {
  const folder = await mkdtemp(join(tmpdir(), "vines-keys-"));
  t.after(() => rm(folder, {recursive: true}));
  await writeFile(join(folder, "keys"), "a-key-of-the-tests\n");
  const closed = await startService(["--api-key-file", join(folder, "keys")]);
  t.after(() => closed.stop());
  const answer = await ask(closed.url, "/v1/presets");
  assert.equal(answer.status, 401);
  document.check(answer, "/v1/presets", "GET");
});

/** Starts a server with flags, expects 503 for the request, and returns `lacking` of the answer. */
async function lackingOf(flags, path, body) {
  const small = await startService(flags);
  const answer = await ask(small.url, path, {body});
  await small.stop();
  assert.equal(answer.status, 503, answer.text);
  document.check(answer, path, "POST", flags.join(" "));
  return JSON.parse(answer.text).lacking;
}

test("a 503 names the lacking resource and matches the document", async () => {
  const axes = [{parameter: "b", values: [0.01]}];
  assert.equal(await lackingOf(["--sweeps", "0"], "/v1/sweep", {axes}), "sweeps");
  const large = " ".repeat(100000);
  assert.equal(await lackingOf(["--memory-limit", "1"], "/v1/simulate", large), "memory");
});

test("/readyz of a stopping server matches the document", async () => {
  const draining = await startService(["--drain", "30"]);
  process.kill(draining.pid, "SIGTERM");
  let answer;
  await until(async () => {
    answer = await ask(draining.url, "/readyz");
    return answer.status === 503;
  });
  document.check(answer, "/readyz", "GET");
  assert.equal(JSON.parse(answer.text).lacking, "stopping");
  await draining.stop();
});

// --- Changed responses, which must not match

/** Calls visit(object, path) for each object in a value; in lists for the first entry only. */
function eachObject(value, visit, path = "") {
  if (Array.isArray(value)) return eachObject(value[0], visit, `${path}[0]`);
  if (value === null || typeof value !== "object") return;
  visit(value, path);
  for (const [name, inner] of Object.entries(value)) eachObject(inner, visit, `${path}.${name}`);
}

/**
 * Fails if a schema accepts a changed response: an additional key in any object, or a string in
 * place of any number. Returns the count of numbers.
 */
function assertRejectsChanges(schema, answer) {
  document.holds(schema, answer);
  let changes = 0;
  eachObject(answer, (object, path) => {
    if (/\.(origin|symbols)$|\.request\b/.test(path)) return;
    object.unknown = 1;
    assert.ok(document.faults(schema, answer), `${schema}: an additional key in ${path}`);
    delete object.unknown;
    for (const [name, value] of Object.entries(object)) {
      // The start of a sweep's point can be a number or a name: a string is valid.
      if (name === "start") continue;
      const isColumn = Array.isArray(value) && typeof value[0] === "number";
      if (typeof value !== "number" && !isColumn) continue;
      object[name] = isColumn ? ["1", ...value.slice(1)] : "1";
      assert.ok(document.faults(schema, answer), `${schema}: a string as ${path}.${name}`);
      object[name] = value;
      ++changes;
    }
  });
  document.holds(schema, answer);
  return changes;
}

test("a changed or empty response does not match the document", async () => {
  const body = {...simulations[1], max_points: 256};
  const run = JSON.parse((await checked("/v1/simulate", {body})).text);
  assert.ok(assertRejectsChanges("Simulation", run) > 100);
  for (const [part, key] of [
    ["impacts", "tau"],
    ["status", "reason"],
    ["regime", "z"],
    ["parameters", "derived"],
    ["exponents", "window"],
  ]) {
    const {[key]: value, ...rest} = run[part];
    assert.ok(document.faults("Simulation", {...run, [part]: rest}), `${part} without ${key}`);
  }
  for (const schema of [
    "Simulation",
    "Manifold",
    "Identification",
    "SweepLine",
    "Problem",
    "Version",
  ])
    assert.ok(document.faults(schema, {}), schema);
  const manifold = (await checked("/v1/manifold", {body: {points: 5}})).text;
  assert.ok(assertRejectsChanges("Manifold", JSON.parse(manifold)) > 20);
  const {example} =
    document.json.paths["/v1/identify"].post.responses[200].content["application/json"];
  assert.ok(assertRejectsChanges("Identification", structuredClone(example)) > 40);
});

test("a changed line of a sweep does not match the document", async () => {
  const changed = new Set();
  for (const body of sweeps) {
    const {text} = await checked("/v1/sweep", {body});
    for (const line of text
      .trim()
      .split("\n")
      .map((l) => JSON.parse(l))) {
      const kind = line.reduce ? "reduced" : line.type;
      if (changed.has(kind)) continue;
      changed.add(kind);
      assertRejectsChanges("SweepLine", line);
    }
  }
  assert.ok(changed.has("reduced") && changed.has("point") && changed.has("start"));
});

// --- A client generated from the document

/** The compiler's diagnostics for each program, compiled with types generated from the document. */
async function compiled(programs) {
  const {default: generateTypes, astToString} = await import(
    pathToFileURL(require.resolve("openapi-typescript").replace(/cjs$/, "mjs"))
  );
  const ts = require("typescript");
  const folder = await mkdtemp(join(tmpdir(), "vines-client-"));
  await writeFile(join(folder, "vines.ts"), astToString(await generateTypes(document.json)));
  const files = programs.map((_, k) => join(folder, `program${k}.ts`));
  await Promise.all(files.map((file, k) => writeFile(file, programs[k])));
  const program = ts.createProgram(files, {
    noEmit: true,
    strict: true,
    target: ts.ScriptTarget.ES2022,
    lib: ["lib.es2022.d.ts"],
    module: ts.ModuleKind.ESNext,
    moduleResolution: ts.ModuleResolutionKind.Bundler,
    types: [],
  });
  const found = files.map((file) => ts.getPreEmitDiagnostics(program, program.getSourceFile(file)));
  await rm(folder, {recursive: true});
  return found.map((list) => list.map((d) => ts.flattenDiagnosticMessageText(d.messageText, "\n")));
}

test("a TypeScript client generated from the document reads responses without a cast", async () => {
  const program = await readFile(new URL("client.ts", import.meta.url), "utf8");
  const [right, wrong] = await compiled([
    program,
    program.replace("impacts?.tau", "impacts?.taus"),
  ]);
  assert.deepEqual(right, []);
  assert.notDeepEqual(wrong, []);
});

test("an incomplete request gets a problem that matches the document", async () => {
  const answer = parsed(await unended.ended);
  assert.equal(answer.status, 408);
  document.check(answer, "/v1/simulate", "GET");
});

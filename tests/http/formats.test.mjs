// Answers and sweeps as CSV, CBOR or NumPy arrays, and the selection of fields.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {after, test} from "node:test";
import {startService} from "../service.mjs";
import {computed, linesOf, send, serviceFor} from "./raw.mjs";

const service = await startService();
after(() => service.stop());

const get = (query, accept, headers = {}) =>
  fetch(`${service.url}/v1/simulate?b=0.022&damping=closed_form&tau_end=1709&${query}`, {
    headers: {...headers, ...(accept ? {Accept: accept} : {})},
  });
const json = async (query) => (await get(query)).json();

/** Runs Python code on bytes from stdin; returns the JSON that it prints. */
const python = (code, bytes, args = []) =>
  JSON.parse(
    execFileSync("/usr/bin/python3", ["-c", code, ...args], {
      input: Buffer.from(bytes),
      maxBuffer: 1 << 28,
      encoding: "utf8",
    }),
  );

const everything =
  "include=series,impacts,exponents,eigenvalues,matrices,section,energy,regime,manifold";

test("as CSV an answer is one table, with the numbers of the JSON", async () => {
  const {impacts} = await json("include=impacts");
  const answer = await get("format=csv&fields=impacts");
  assert.equal(answer.headers.get("content-type"), "text/csv");
  assert.match(answer.headers.get("vary"), /^Accept\b/);
  const [head, ...rows] = (await answer.text()).trimEnd().split("\n");
  assert.deepEqual(head.split(","), Object.keys(impacts));
  assert.equal(rows.length, impacts.tau.length);
  const cells = rows.map((row) => row.split(","));
  for (const [k, name] of Object.keys(impacts).entries())
    assert.deepEqual(
      cells.map((row) => JSON.parse(row[k])),
      impacts[name],
      name,
    );
  const thin = await get("fields=impacts.tau,impacts.side", "text/csv");
  assert.match(await thin.text(), /^tau,side\n18\.14\d+,-?1\n/);
});

test("as CSV each component of a vector or matrix is a column, and null is an empty cell", async () => {
  const {matrices, eigenvalues} = await json("include=matrices,eigenvalues");
  const table = await (await get("format=csv&fields=matrices.tau,matrices.T")).text();
  const [head, first] = table.split("\n").map((line) => line.split(","));
  const names = [1, 2, 3, 4].flatMap((i) => [1, 2, 3, 4].map((j) => `T${i}${j}`));
  assert.deepEqual(head, ["tau", ...names]);
  assert.deepEqual(first.map(Number), [matrices.tau[0], ...matrices.T[0].flat()]);
  const moduli = (await (await get("format=csv&fields=eigenvalues")).text()).split("\n");
  assert.match(moduli[0], /^tau,J1,J2,J3,J4,M1/);
  const J = moduli[1].split(",").slice(1, 5);
  assert.deepEqual(
    J.map((cell) => (cell === "" ? null : Number(cell))),
    eigenvalues.J[0],
  );
  const {exponents} = await json("include=exponents&exponents=raw_product");
  const history = exponents.raw_product.history;
  assert.ok(history.lambda4.includes(null), "the product has lost them to rounding");
  const csv = await get("format=csv&exponents=raw_product&fields=exponents.raw_product.history");
  const rows = (await csv.text()).trimEnd().split("\n").slice(1);
  const k = Object.keys(history).indexOf("lambda4");
  assert.deepEqual(
    rows.map((row) => row.split(",")[k] === ""),
    history.lambda4.map((value) => value === null),
  );
});

test("an answer with several tables, or none, cannot be CSV: the problem lists them", async () => {
  for (const [query, range] of [
    ["include=series,impacts&format=csv", ["series", "impacts", "sticking"]],
    ["fields=status&format=csv", []],
    ["fields=matrices&format=csv", []],
  ]) {
    const answer = await get(query);
    assert.equal(answer.status, 422, query);
    const {errors} = await answer.json();
    assert.equal(errors[0].pointer, "/fields");
    assert.deepEqual(errors[0].range, range);
    assert.match(errors[0].detail, /CSV is one table/);
  }
});

test("as CBOR the lists are typed arrays, and everything else equals the JSON", async () => {
  const answer = await get(`${everything}&format=cbor`);
  assert.equal(answer.headers.get("content-type"), "application/cbor");
  const bytes = await answer.arrayBuffer();
  const code = `
import sys, json, cbor2, struct, math
def typed(decoder, tag):
    code = {86: "d", 78: "i"}[tag.tag]
    size = struct.calcsize(code)
    numbers = struct.unpack("<%d%s" % (len(tag.value) // size, code), tag.value)
    return [None if isinstance(n, float) and math.isnan(n) else n for n in numbers]
json.dump(cbor2.loads(sys.stdin.buffer.read(), tag_hook=typed), sys.stdout)`;
  const {provenance, ...decoded} = python(code, bytes);
  const {provenance: sealed, ...whole} = await json(everything);
  assert.deepEqual(decoded, whole);
  assert.equal(provenance.sha256, sealed.sha256);
  assert.equal(provenance.commit, sealed.commit);
  assert.ok(bytes.byteLength < 0.6 * JSON.stringify(whole).length);
});

test("as npz each list is an array for numpy.load, and the rest is one JSON entry", async () => {
  const answer = await get(`${everything}&format=npz`);
  assert.equal(answer.headers.get("content-type"), "application/x-npz");
  const code = `
import sys, io, json, zipfile, numpy
bytes = sys.stdin.buffer.read()
assert zipfile.ZipFile(io.BytesIO(bytes)).testzip() is None
arrays = numpy.load(io.BytesIO(bytes))
def plain(value):
    if isinstance(value, list): return [plain(v) for v in value]
    return None if isinstance(value, float) and value != value else value
told = {n: {"type": arrays[n].dtype.str, "values": plain(arrays[n].tolist())} for n in arrays.files if n != "answer.json"}
json.dump({"arrays": told, "rest": json.loads(arrays["answer.json"])}, sys.stdout)`;
  const {arrays, rest} = python(code, await answer.arrayBuffer());
  const whole = await json(everything);
  assert.deepEqual(arrays["impacts.tau"], {type: "<f8", values: whole.impacts.tau});
  assert.deepEqual(arrays["impacts.side"], {type: "<i4", values: whole.impacts.side});
  assert.deepEqual(arrays["impacts.grazing"], {type: "|b1", values: whole.impacts.grazing});
  assert.deepEqual(arrays["matrices.T"].values, whole.matrices.T);
  assert.deepEqual(arrays["eigenvalues.J"].values, whole.eigenvalues.J);
  const {lambda4} = whole.exponents.raw_product.history;
  assert.deepEqual(arrays["exponents.raw_product.history.lambda4"].values, lambda4);
  assert.deepEqual(arrays["exponents.qr.status"].values, whole.exponents.qr.status);
  assert.deepEqual(rest.regime.type, whole.regime.type);
  assert.deepEqual(rest.parameters, whole.parameters);
  assert.equal(rest.impacts.tau, undefined, "each list once");
  const twice = await (await get(`${everything}&format=npz`)).arrayBuffer();
  const again = await (await get(`${everything}&format=npz`)).arrayBuffer();
  assert.deepEqual(Buffer.from(twice), Buffer.from(again), "no timestamp in it");
});

test("Accept selects the format; the refusal of unknown formats lists the known ones", async () => {
  const type = async (accept) => {
    const answer = await get("fields=impacts", accept);
    await answer.arrayBuffer();
    return answer.status === 200 ? answer.headers.get("content-type") : answer.status;
  };
  assert.equal(await type("*/*"), "application/json");
  assert.equal(await type("text/csv"), "text/csv");
  assert.equal(await type("text/*"), "text/csv");
  assert.equal(await type("application/*"), "application/json");
  assert.equal(await type("application/cbor, application/json;q=0.9"), "application/cbor");
  assert.equal(await type("application/json;q=0.1, APPLICATION/CBOR;q=.2"), "application/cbor");
  assert.equal(await type("application/json;q=0, */*;q=0.1"), "text/csv");
  assert.equal(
    await type("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"),
    "application/json",
  );
  for (const none of ["image/png", "text/csv;q=0", "text/html, application/xml"])
    assert.equal(await type(none), 406, none);
  const refused = await get("fields=impacts", "image/png");
  assert.match(
    (await refused.json()).detail,
    /application\/json, text\/csv, application\/cbor, application\/x-npz/,
  );
  const named = await get("fields=impacts&format=json", "image/png");
  assert.equal(named.status, 200, "the field format overrides Accept");
});

test("fields select parts, nothing else is computed, and unknown names give warnings", async () => {
  const thin = await json("fields=impacts.tau,regime.z,exponents.qr.final");
  assert.deepEqual(Object.keys(thin), [
    "version",
    "status",
    "warnings",
    "impacts",
    "exponents",
    "regime",
    "provenance",
  ]);
  const whole = await json("include=impacts,regime,exponents");
  assert.deepEqual(thin.impacts, {tau: whole.impacts.tau});
  assert.deepEqual(thin.regime, {z: whole.regime.z});
  assert.deepEqual(thin.exponents, {qr: {final: whole.exponents.qr.final}});
  assert.deepEqual(thin.warnings, whole.warnings);
  const lost = await json("fields=impacts.tau,impacts.tao,nothing");
  assert.deepEqual(lost.warnings.slice(-2), [
    "fields: there is no impacts.tao in this answer",
    "fields: there is no nothing in this answer",
  ]);
  const windows = await json("windows=100,500;500,900&fields=windows.verdict");
  assert.deepEqual(Object.keys(windows.windows[0]), ["verdict"]);
  assert.equal(windows.windows.length, 2);
});

test("a POST has format and fields in its body; the manifold and an identification support them, too", async () => {
  const headers = {"Content-Type": "application/json"};
  const post = (path, body) => send(service.url, path, body, {headers});
  const run = await post("/v1/simulate", {b: 0.022, fields: ["impacts.tau"], format: "csv"});
  assert.match(await run.text(), /^tau\n18/);
  const manifold = await fetch(`${service.url}/v1/manifold?fields=manifold.fold`);
  assert.deepEqual(Object.keys((await manifold.json()).manifold), ["fold"]);
  const {impacts} = await (await post("/v1/simulate", {b: 0.022, tau_end: 1709})).json();
  const listed = {impacts, b: 0.022, fields: ["verdict", "restitution"]};
  const identified = await (await post("/v1/identify", listed)).json();
  assert.deepEqual(Object.keys(identified), [
    "version",
    "restitution",
    "verdict",
    "warnings",
    "provenance",
  ]);
  for (const [body, pointer] of [
    [{format: "xml"}, "/format"],
    [{fields: [1]}, "/fields/0"],
    [{fields: [""]}, "/fields/0"],
    [{fields: {}}, "/fields"],
  ]) {
    const refused = await post("/v1/simulate", body);
    assert.equal(refused.status, 422);
    assert.equal((await refused.json()).errors[0].pointer, pointer);
  }
});

test("fields are limited in number and in work", async () => {
  const post = (fields) => send(service.url, "/v1/simulate", fields);
  const windows = Array.from({length: 1000}, (_, k) => [k, k + 1]);
  const began = await computed(service.pid);
  for (const [fields, pointer] of [
    [Array.from({length: 60000}, (_, k) => `windows.${k}`), null],
    [Array.from({length: 2000}, (_, k) => `windows.${k}`), "/fields"],
    [[`windows.${"a.".repeat(50000)}`], "/fields/0"],
    ["a,".repeat(100000), "/fields"],
  ]) {
    const answer = await post({preset: "fig3", windows, fields});
    if (pointer === null) {
      assert.equal(answer.status, 400); // too many texts
      continue;
    }
    assert.equal(answer.status, 422);
    assert.equal((await answer.json()).errors[0].pointer, pointer);
  }
  assert.ok((await computed(service.pid)) - began < 3);
  const most = Array.from({length: 1000}, (_, k) => `windows.${k}`);
  const answer = await post({preset: "fig3", windows, fields: most});
  assert.equal(answer.status, 200);
  assert.equal((await answer.json()).warnings.length >= 1000, true);
});

test("invalid UTF-8 is refused, and shortened texts stay valid UTF-8", async () => {
  const answer = await fetch(`${service.url}/v1/simulate?fields=%ff`);
  assert.equal(answer.status, 400);
  assert.match((await answer.json()).detail, /not in UTF-8/);
  const ask = (fields, format) =>
    send(service.url, "/v1/simulate", {preset: "fig3", tau_end: 50, fields, format});
  for (const format of ["json", "cbor", "npz"]) {
    const answer = await ask([`a${"\u00e9".repeat(99)}`], format);
    assert.equal(answer.status, 200, format);
    await answer.arrayBuffer();
  }
  const {errors} = await (await ask([`a${"\u00e9".repeat(150)}`], "json")).json();
  assert.match(errors[0].value, /^a\u00e9+\.\.\.$/);
});

test("touches are computed if fields name them", async () => {
  const system = {G: 0, lambda: 0, x0: 0.02, y0: 0, b: 0.02, tau_end: 30, fields: ["touches"]};
  const answer = await send(service.url, "/v1/simulate", system);
  assert.ok((await answer.json()).touches.tau.length > 0);
});

test("the ETag depends on format and fields, too", async () => {
  const first = await get("fields=impacts.tau&format=csv");
  const tag = first.headers.get("etag");
  const again = (query) =>
    fetch(`${service.url}/v1/simulate?b=0.022&damping=closed_form&tau_end=1709&${query}`, {
      headers: {"If-None-Match": tag},
    });
  const known = await again("fields=impacts.tau&format=csv");
  assert.equal(known.status, 304);
  assert.match(known.headers.get("vary"), /Accept\b/);
  const weak = await fetch(first.url, {headers: {"If-None-Match": `"x", ${tag.slice(2)}`}});
  assert.equal(weak.status, 304, "a client need not repeat the W/");
  const any = await get("format=csv", undefined, {"If-None-Match": "*"});
  assert.equal(any.status, 422, "a refused request is never answered with 304");
  assert.equal((await again("fields=impacts.tau&format=cbor")).status, 200);
  assert.equal((await again("fields=impacts.side&format=csv")).status, 200);
});

test("fields and formats also work for answers with more impacts than are kept in memory", async () => {
  const many = "b=0.003&tau_end=60000&max_impacts=60000";
  const ask = (rest) => fetch(`${service.url}/v1/simulate?${many}&${rest}`);
  const {impacts} = await (await ask("fields=impacts.tau")).json();
  assert.ok(impacts.tau.length > 32768, `${impacts.tau.length}`);
  assert.deepEqual(Object.keys(impacts), ["tau"]);
  const csv = await (await ask("fields=impacts.tau&format=csv")).text();
  assert.deepEqual(csv.trimEnd().split("\n").slice(1).map(Number), impacts.tau);
});

const swept = {
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 5}],
  cycles: 50,
};
const sweep = (fields, headers = {}, at = service) =>
  send(at.url, "/v1/sweep", {...swept, ...fields}, {headers});
/** The start and the points of a sweep as lines, in the order of the index. */
const sweepLines = async (fields) => {
  const lines = linesOf(await (await sweep(fields)).text());
  const points = lines.filter(({type}) => type === "point").sort((a, b) => a.index - b.index);
  const warning = lines.find(({type}) => type === "warning")?.message;
  return {start: lines[0], points, warning};
};

test("a sweep as CSV is a table in the order of the index", async () => {
  const answer = await sweep({format: "csv"});
  assert.equal(answer.headers.get("content-type"), "text/csv");
  const [names, ...rows] = (await answer.text())
    .trimEnd()
    .split("\n")
    .map((row) => row.split(","));
  const {points} = await sweepLines({});
  for (const name of ["index", "b", "regime", "periodic", "x_max", "impacts"])
    assert.deepEqual(
      rows.map((row) => row[names.indexOf(name)]),
      points.map((point) => String(point[name])),
      name,
    );
});

test("a sweep as npz and CBOR is a table with the values of its lines", async () => {
  const code = `
import sys, io, json, numpy, cbor2, struct
size = int(sys.argv[1])
bytes = sys.stdin.buffer.read()
arrays = numpy.load(io.BytesIO(bytes[:size]))
def plain(values): return [None if isinstance(v, float) and v != v else v for v in values]
def typed(decoder, tag):
    code = {86: "d", 78: "i"}[tag.tag]
    return list(struct.unpack("<%d%s" % (len(tag.value) // struct.calcsize(code), code), tag.value))
npz = {n.removeprefix("points."): [arrays[n].dtype.kind, plain(arrays[n].tolist())] for n in arrays.files if n.startswith("points.")}
cbor = cbor2.loads(bytes[size:], tag_hook=typed)
cbor["points"] = {name: plain(values) for name, values in cbor["points"].items()}
json.dump({"npz": npz, "cbor": cbor, "rest": json.loads(arrays["answer.json"])}, sys.stdout)`;
  const answers = [await sweep({format: "npz"}), await sweep({}, {Accept: "application/cbor"})];
  assert.deepEqual(
    answers.map(({headers}) => headers.get("content-type")),
    ["application/x-npz", "application/cbor"],
  );
  const [npzBytes, cborBytes] = await Promise.all(answers.map((answer) => answer.arrayBuffer()));
  const bytes = Buffer.concat([Buffer.from(npzBytes), Buffer.from(cborBytes)]);
  const {npz, cbor, rest} = python(code, bytes, [String(npzBytes.byteLength)]);
  const {start, points, warning} = await sweepLines({});
  const column = (name) => npz[name][1];
  assert.deepEqual(
    column("index"),
    points.map(({index}) => index),
  );
  const asCell = (value) => (typeof value === "boolean" ? Number(value) : (value ?? null));
  for (const name of ["b", "regime", "periodic", "period_cycles", "symmetric", "x_max", "impacts"])
    assert.deepEqual(
      column(name),
      points.map((point) => asCell(point[name])),
      name,
    );
  assert.deepEqual(
    column("lambda2"),
    points.map(({lambda}) => lambda[1]),
  );
  assert.deepEqual(
    column("second_start.regime"),
    points.map(({second_start: second}) => second?.regime ?? ""),
  );
  for (const [name, [, values]] of Object.entries(npz))
    assert.deepEqual(cbor.points[name], values, name);
  const kinds = Object.fromEntries(Object.entries(npz).map(([name, [kind]]) => [name, kind]));
  const {index, regime, error, impacts, symmetric} = kinds;
  assert.deepEqual([index, regime, error, impacts, symmetric], ["i", "U", "U", "f", "f"]);
  const {points: _, ...others} = cbor;
  assert.deepEqual(others, rest);
  const {type, of, points: count, ...same} = start;
  if (warning) same.warnings.push(warning);
  assert.deepEqual(rest, same);
});

test("Accept selects the format of a sweep; lines answer a request for JSON, too", async () => {
  const type = async (accept, fields = {}) => {
    const answer = await sweep({cycles: 1, ...fields}, accept ? {Accept: accept} : {});
    await answer.arrayBuffer();
    return answer.status === 200 ? answer.headers.get("content-type") : answer.status;
  };
  const lines = "application/x-ndjson";
  for (const accept of ["", "*/*", "application/json", lines, "text/csv;q=0.5, application/json"])
    assert.equal(await type(accept), lines, accept);
  assert.equal(await type("text/csv"), "text/csv");
  assert.equal(await type("text/csv", {format: "ndjson"}), lines);
  assert.equal(await type("image/png"), 406);
  const unknown = await (await sweep({format: "json"})).json();
  assert.deepEqual(unknown.errors[0].range, ["ndjson", "csv", "cbor", "npz"]);
});

test("a sweep that ends early as a table has a broken connection; one that is too large is refused", async (t) => {
  const limited = await serviceFor(t, ["--sweep-deadline", "0.3", "--answer-limit", "1500000"]);
  for (const format of ["csv", "cbor", "npz"]) {
    const received = async () => (await sweep({format, cycles: 1e6}, {}, limited)).arrayBuffer();
    await assert.rejects(received, TypeError, format);
  }
  const axes = [{parameter: "b", from: 0.008, to: 0.03, count: 5000}];
  const large = await (await sweep({format: "npz", axes}, {}, limited)).json();
  assert.equal(large.status, 413);
  assert.match(
    large.detail,
    /^a table of 5000 points as npz has about \d+ bytes, more than 1500000/,
  );
});

// Requests given as flags, without a service or a JSON file.
import assert from "node:assert/strict";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {startService} from "../service.mjs";
import {parsed, run} from "./run.mjs";

const folder = mkdtempSync(join(tmpdir(), "vines-requests-"));
let service;
before(async () => {
  service = await startService();
});
after(async () => {
  await service.stop();
  rmSync(folder, {recursive: true});
});
const at = (name) => join(folder, name);

/** Output of a command that must succeed. */
async function outputOf(args, options) {
  const {code, out, errors} = await run(args, options);
  assert.equal(code, 0, `${args.join(" ")}: ${errors}`);
  return out;
}

/** Problem document of a command that must refuse its request. */
async function refused(args, options) {
  const {code, out, errors} = await run(args, options);
  assert.deepEqual({code, out}, {code: 2, out: ""}, args.join(" "));
  return JSON.parse(errors);
}

/** An answer without its provenance. */
const content = (text) => {
  const {provenance, ...rest} = JSON.parse(text);
  return {request: provenance.request, ...rest};
};

test("fields as flags give the same request as JSON", async () => {
  const fields = {preset: "fig3", b: 0.02, tau_end: 100, include: ["impacts", "regime"]};
  const json = content(await outputOf(["simulate"], {input: JSON.stringify(fields)}));
  const each = Object.entries(fields).flatMap(([name, value]) => ["-p", `${name}=${value}`]);
  assert.deepEqual(content(await outputOf(["simulate", ...each])), json);
  const query = "preset=fig3&b=2e-2&tau_end=100&include=impacts%2Cregime";
  assert.deepEqual(content(await outputOf(["simulate", "-q", query])), json);
  const both = ["-q", "preset=fig3&include=impacts,regime", "-p", "b=.02", "-p", "tau_end=100"];
  assert.deepEqual(content(await outputOf(["simulate", ...both])), json);
  const answer = await fetch(`${service.url}/v1/simulate?${query}`);
  assert.deepEqual(content(await answer.text()), json);
});

test("fields as flags override those of a file, member by member", async () => {
  const file = at("request.json");
  writeFileSync(file, JSON.stringify({b: 0.02, tau_end: 50, include: ["impacts"]}));
  const over = JSON.parse(await outputOf(["simulate", file, "-p", "b=0.015"]));
  assert.equal(over.parameters.b, 0.015);
  assert.equal(over.parameters.tau_end, 50);
  const piped = await outputOf(["simulate", "-", "-p", "b=0.015"], {input: readFileSync(file)});
  assert.deepEqual(content(piped), content(JSON.stringify(over)));
});

test("stdin is not read if fields are given as flags", async () => {
  const args = ["simulate", "-p", "b=0.02", "-p", "tau_end=10"];
  assert.equal((await run(args, {input: "not JSON"})).code, 0);
});

test("an error in a flag names the field or shows the syntax", async () => {
  for (const [args, detail] of [
    [["simulate", "-p", "b"], /-p b: not NAME=VALUE, as in -p b=0.02/],
    [["simulate", "-p", "=3"], /not NAME=VALUE/],
    [["simulate", "-p", "b=1", "-p", "b=2"], /"b" comes twice/],
    [["simulate", "-p", "dampin=closed_form"], /did you mean damping\?/],
    [["simulate", "-p", "b=wide"], /b|number/],
    [["sweep", "-a", "b=0.01:0.02"], /--axis b=0.01:0.02: not NAME=FROM:TO:COUNT/],
    [["sweep", "-a", "b=0.01:0.02:3", "-p", "dampin=x"], /did you mean damping\?/],
    [["sweep", "-a", "b=0.01:0.02:3", "-p", "cycels=5"], /did you mean cycles\?/],
    [["sweep", "-a", "b=0.01:x:3"], /number/],
    [["sweep", "-p", "cycles=5"], /axes|required/],
    [["sweep", "-p", "axes=x", "-a", "b=0.01:0.02:3"], /axes and --axis exclude each other/],
    [["sweep", "-p", 'base={"preset":"fig3"}', "-p", "b=0.02"], /base and b exclude each other/],
    [["sweep", "-a", "b=0.01", "-p", 'starts=[{"y0":0,"y0":1}]'], /^starts: .*"y0" comes twice/],
    [["sweep", "-a", "b=0.01", "-p", "starts=[{"], /^starts: .*not valid JSON/],
    [["presets", "fig33"], /no preset has the name fig33; did you mean fig3\?/],
    [["parameters", "windo"], /no field has the name windo; did you mean window\?/],
  ])
    assert.match((await refused(args)).detail, detail, args.join(" "));
});

test("a sweep as flags equals its JSON: axes, its own fields, those of its base", async () => {
  const json = {
    axes: [
      {parameter: "b", from: 0.01, to: 0.03, count: 3},
      {parameter: "R", values: [0.6, 0.7]},
    ],
    base: {preset: "fig3"},
    cycles: 20,
    starts: [{y0: 0}, {y0: 0.01}],
  };
  const flags = ["-a", "b=0.01:0.03:3", "--axis", "R=0.6,0.7", "-p", "preset=fig3"];
  flags.push("-q", "cycles=20", "-p", 'starts=[{"y0":0},{"y0":0.01}]');
  const points = (text) => parsed(text).slice(1);
  const expected = points(await outputOf(["sweep"], {input: JSON.stringify(json)}));
  assert.equal(expected.length, 13);
  assert.deepEqual(points(await outputOf(["sweep", ...flags])), expected);
  const log = parsed(await outputOf(["sweep", "-a", "b=0.01:0.04:3:log", "-p", "cycles=5"]));
  assert.deepEqual(
    log.slice(1, 4).map((point) => point.b),
    [0.01, 0.02, 0.04],
  );
});

test("an answer has the format that --format says", async () => {
  const impacts = ["simulate", "-p", "preset=fig11", "-p", "tau_end=60"];
  const csv = await outputOf([
    ...impacts,
    "-p",
    "fields=impacts.tau,impacts.side",
    "--format",
    "csv",
  ]);
  const {tau, side} = JSON.parse(await outputOf(impacts)).impacts;
  assert.deepEqual(csv.trim().split("\n"), ["tau,side", ...tau.map((t, n) => `${t},${side[n]}`)]);
  for (const [format, first] of [
    ["npz", "PK"],
    ["cbor", "\ufffd"], // a map; invalid as UTF-8 text
  ])
    assert.ok((await outputOf([...impacts, "--format", format])).startsWith(first), format);
  const manifold = JSON.parse(await outputOf(["manifold", "-p", "b=0.015"]));
  const over = await (await fetch(`${service.url}/v1/manifold?b=0.015`)).json();
  assert.deepEqual(manifold, over);
  assert.equal((await run([...impacts, "--format", "yaml"])).code, 2);
});

test("a sweep as CSV has a row for each point and a column for each number", async () => {
  const flags = ["sweep", "-a", "b=0.008:0.03:5", "-p", "cycles=50"];
  const points = parsed(await outputOf(flags)).filter(({type}) => type === "point");
  const rows = (await outputOf([...flags, "--format", "csv"])).trim().split("\n");
  const [names, ...cells] = rows.map((row) => row.split(","));
  assert.equal(new Set(names).size, names.length);
  const cell = (row, name) => cells[row][names.indexOf(name)];
  points.forEach((point, row) => {
    assert.equal(cell(row, "index"), String(point.index));
    assert.equal(Number(cell(row, "b")), point.b);
    assert.equal(cell(row, "regime"), point.regime);
    assert.equal(cell(row, "periodic"), String(point.periodic));
    assert.equal(cell(row, "second_start.regime"), point.second_start?.regime ?? "");
    point.lambda.forEach((value, k) => {
      assert.equal(cell(row, `lambda${k + 1}`), value === null ? "" : String(value));
    });
  });
  assert.equal(cells.length, points.length);
  const resumed = await refused([...flags, "-o", at("table.csv"), "--resume"]);
  assert.match(resumed.detail, /--resume needs --format ndjson/);
});

test("the extension of the output selects the format, unless the request does", async () => {
  const first = async (args, name) => {
    const {code, errors} = await run([...args, "-o", at(name)]);
    assert.equal(code, 0, errors);
    const begins = readFileSync(at(name), "latin1").slice(0, 2);
    return begins.charCodeAt(0) >> 5 === 5 ? "a map in CBOR" : begins;
  };
  const simulated = ["simulate", "-p", "tau_end=60", "-p", "fields=impacts"];
  const swept = ["sweep", "-a", "b=0.01,0.02", "-p", "cycles=5"];
  for (const [name, ofRun, ofSweep = ofRun] of [
    ["x.csv", "ta", "in"],
    ["x.npz", "PK"],
    ["x.cbor", "a map in CBOR"],
    ["x.json", '{"'],
  ]) {
    assert.equal(await first(simulated, name), ofRun, name);
    assert.equal(await first(swept, `sweep-${name}`), ofSweep, name);
  }
  assert.equal(await first([...simulated, "-p", "format=json"], "x.csv"), '{"');
  assert.equal(await first([...swept, "--format", "ndjson"], "lines.npz"), '{"');
});

test("identify accepts fields as flags, which override those of its JSON", async () => {
  const csv = await outputOf(["example", "record"]);
  assert.equal(csv.split("\n")[0], "time_s,displacement_m,acceleration_m_s2");
  writeFileSync(at("record.csv"), csv);
  const flags = ["-p", "preset=fig20", "-p", "b=0.015", "-p", "fields=restitution,verdict"];
  const identified = content(await outputOf(["identify", at("record.csv"), ...flags]));
  assert.equal(identified.verdict, "chaotic");
  // Within three standard errors of the values that the record was computed with.
  for (const {R, standard_error: error} of [
    identified.restitution.plus,
    identified.restitution.minus,
  ])
    assert.ok(Math.abs(R - 0.85) < 3 * error, `${R} +- ${error}`);
  const [time_s, displacement_m, acceleration_m_s2] = [0, 1, 2].map((k) =>
    csv
      .trim()
      .split("\n")
      .slice(1)
      .map((line) => Number(line.split(",")[k])),
  );
  const record = {time_s, displacement_m, acceleration_m_s2};
  const input = JSON.stringify({record, preset: "fig15", b: 0.02});
  const over = content(await outputOf(["identify", "-", ...flags], {input}));
  assert.deepEqual(over.restitution, identified.restitution);
});

test("presets and parameters print the service's lists", async () => {
  for (const what of ["presets", "parameters"]) {
    const json = await outputOf([what, "--format", "json"]);
    assert.equal(json, await (await fetch(`${service.url}/v1/${what}`)).text());
  }
  const presets = JSON.parse(await outputOf(["presets", "--format", "json"])).presets.map(
    ({name}) => name,
  );
  const listed = (await outputOf(["presets"])).trim().split("\n");
  assert.deepEqual(
    listed.map((line) => line.split(" ")[0]),
    presets,
  );
  assert.match(
    await outputOf(["presets", "fig3"]),
    /\n {2}b = 0.022\n(.*\n)*vines simulate -p preset/,
  );
  const {fields} = JSON.parse(await outputOf(["parameters", "--format", "json"]));
  const all = await outputOf(["parameters"]);
  assert.match(all, / {2}y_dot0 +m per unit of tau velocity of the ball at tau = 0\n/);
  assert.match(all, / {2}base_acceleration_column choice /);
  for (const name of ["box", "b_count", "second_from"])
    assert.match(await outputOf(["parameters", name]), new RegExp(`^ {2}${name} `, "m"));
  for (const {name, description} of fields)
    assert.ok(
      all.split("\n").some((line) => line.startsWith(`  ${name} `) && line.endsWith(description)),
      name,
    );
  assert.match(
    await outputOf(["parameters", "b"]),
    /half-width(.*\n)* {4}default {2}.*\n {4}range {4}\[/,
  );
});

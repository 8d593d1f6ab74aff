// The subcommands as used in a terminal and by a batch system.
import assert from "node:assert/strict";
import {execFileSync, spawn} from "node:child_process";
import {readFileSync} from "node:fs";
import {appendFile, mkdtemp, readFile, rm, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {contentHash} from "../content_hash.mjs";
import {measured} from "../record.mjs";
import {program, startService} from "../service.mjs";
import {hasComputed, parsed, run} from "./run.mjs";

let folder;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), "vines-cli-"));
});
after(() => rm(folder, {recursive: true}));
const at = (name) => join(folder, name);

const simulated = async (fields) => (await run(["simulate"], {input: JSON.stringify(fields)})).out;
const verify = async (answer, args = []) => run(["verify", ...args], {input: answer});

test("an answer contains its provenance, and verify reproduces it", async () => {
  const fields = {preset: "fig3", tau_end: 400, fields: ["impacts", "regime.z"]};
  const answer = await simulated(fields);
  const {provenance} = JSON.parse(answer);
  assert.equal(provenance.route, "/v1/simulate");
  assert.deepEqual(provenance.request, fields);
  assert.equal(contentHash(JSON.parse(answer)), provenance.sha256);
  const same = await verify(answer);
  assert.equal(same.code, 0, same.errors);
  assert.match(same.out, /sha256: matches\nrecomputed: the same values\n/);
  const changed = await verify(answer.replace(/"z":[\d.]+/, '"z":9'));
  assert.equal(changed.code, 1);
  assert.match(changed.out, /the answer was modified\nrecomputed: \/regime\/z: 9 became /);
  const cutOff = await verify(answer.replace(/"reason":"\w+"/, '"reason":"deadline"'));
  assert.equal(cutOff.code, 1);
  assert.match(cutOff.out, /the answer was modified\nnot decided/);
  // A recomputed hash does not hide the change.
  const forged = answer.replace(/"z":[\d.]+/, '"z":9');
  const hash = contentHash(JSON.parse(forged));
  const again = await verify(forged.replace(provenance.sha256, hash));
  assert.equal(again.code, 1);
  assert.match(again.out, /sha256: matches\nrecomputed: \/regime\/z: 9 became /);
});

/** The text with another spelling of each number and string: 0.15 as 150e-3, "a" as "\u0061". */
const respelled = (text) =>
  text.replace(/"(?:[^"\\]|\\.)*"|-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g, (token) => {
    if (token[0] === '"') {
      const units = JSON.parse(token).split("");
      return `"${units.map((u) => `\\u${u.charCodeAt(0).toString(16).padStart(4, "0")}`).join("")}"`;
    }
    const [, sign, whole, decimals = "", exponent] = token.match(/^(-?)(\d+)\.?(\d*)e?(.*)$/);
    const digits = `${whole}${decimals}0`.replace(/^0+(?=\d)/, "");
    return `${sign}${digits}e${Number(exponent) - decimals.length - 1}`;
  });
const pythonDump = `
import json, sys
json.dump(json.load(sys.stdin), sys.stdout, ensure_ascii=True, indent=3, sort_keys=True)`;
/** The same JSON as other programs write it. */
const rewritten = (text) => {
  const through = (command, args) =>
    execFileSync(command, args, {input: text, encoding: "utf8", maxBuffer: 1e9});
  return {
    jq: through("jq", ["."]),
    "jq, sorted": through("jq", ["-cS", "."]),
    "jq, sorted on several lines": through("jq", ["-S", "."]),
    respelled: respelled(text),
    ...(text.trim().includes("\n")
      ? {}
      : {
          JavaScript: JSON.stringify(JSON.parse(text)),
          Python: through("/usr/bin/python3", ["-c", pythonDump]),
        }),
  };
};

test("verify accepts an answer in any spelling, but not with another digit", async () => {
  const include = ["series", "impacts", "exponents", "matrices", "section", "energy", "regime"];
  const answer = await simulated({
    preset: "fig3",
    tau_end: 60,
    windows: [
      [10, 40],
      [20, 60],
    ],
    include,
    // A warning quotes the name that does not exist.
    fields: [...include, "windows", 'gr\u00f6\u00dfe \ud83d\udca1"\\'],
  });
  assert.equal(contentHash(JSON.parse(answer)), JSON.parse(answer).provenance.sha256);
  for (const [how, text] of Object.entries(rewritten(answer))) {
    const {code, out, errors} = await verify(text);
    assert.equal(code, 0, `${how}: ${out}${errors}`);
    assert.match(out, /^sha256: matches\nrecomputed: the same values$/m, how);
  }
  const digits = [...answer.matchAll(/"(?:[^"\\]|\\.)*"|\d\.\d*\d(?=[,\]])/g)].filter(
    ([token]) => token[0] !== '"',
  );
  for (const {0: number, index} of [digits[0], digits[digits.length >> 1], digits.at(-1)]) {
    const other = number.slice(0, -1) + ((Number(number.at(-1)) + 5) % 10);
    const altered = answer.slice(0, index) + other + answer.slice(index + number.length);
    for (const text of [altered, rewritten(altered)["jq, sorted"]]) {
      const {code, out} = await verify(text);
      assert.equal(code, 1, out);
      assert.match(out, /^sha256: the answer was modified\nrecomputed: \S+: /m);
    }
  }
});

test("verify also compares the provenance and reports another build's commit", async () => {
  const answer = await simulated({preset: "fig3", tau_end: 40, include: ["regime"]});
  const altered = (alter) => {
    const fields = JSON.parse(answer);
    alter(fields.provenance);
    const at = answer.lastIndexOf(',"provenance":');
    return verify(`${answer.slice(0, at)},"provenance":${JSON.stringify(fields.provenance)}}\n`);
  };
  const cases = [
    [(p) => Object.assign(p, {extra: 1}), /^provenance: \/extra is missing$/m],
    [
      (p) => Object.assign(p, {answer_limit: 1e9}),
      /^provenance: \/answer_limit: 1000000000 became null/m,
    ],
    [(p) => Object.assign(p, {commit: 7}), /^provenance: \/commit: 7 became "/m],
    [(p) => delete p.commit, /^provenance: \/commit is new$/m],
    [(p) => Object.assign(p.request, {b: 0.019}), /^recomputed: \/parameters/m],
  ];
  for (const [alter, message] of cases) {
    const {code, out, errors} = await altered(alter);
    assert.equal(code, 1, out + errors);
    assert.match(out, message);
    assert.match(out, /^sha256: matches$/m, "the hash does not cover the provenance");
  }
  const other = await altered((p) => Object.assign(p, {commit: "another"}));
  assert.equal(other.code, 0, other.out + other.errors);
  assert.match(other.out, /^answered by \S+ \(another\), .*\ncommit: not this program's/);
  assert.doesNotMatch((await verify(answer)).out, /^commit|^provenance/m);
});

test("verify reports malformed, repeated and modified answers without an exception", async () => {
  const answer = await simulated({tau_end: 40, include: ["regime"]});
  const whole = (alter) => {
    const fields = JSON.parse(answer);
    alter(fields);
    return `${JSON.stringify(fields)}\n`;
  };
  const cases = [
    ["two answers", answer + answer, 2, /must be one JSON answer/],
    ["malformed JSON", answer.replace('{"', '{"a":[,"'), 2, /must be one JSON answer/],
    ["a second brace", `${answer}}`, 2, /must be one JSON answer/],
    ["text after the answer", `${answer}and more`, 2, /must be one JSON answer/],
    [
      "a repeated key in the provenance",
      answer.replace('"provenance":{', '"provenance":{"route":"/x",'),
      2,
      /the name \\"route\\" comes twice/,
    ],
    [
      "version is a number",
      whole((a) => Object.assign(a, {version: 7})),
      1,
      /the answer was modified/,
    ],
    [
      "status is a list",
      whole((a) => Object.assign(a, {status: []})),
      1,
      /the answer was modified/,
    ],
    [
      "status.reason is a number",
      whole((a) => Object.assign(a.status, {reason: 7})),
      1,
      /the answer was modified/,
    ],
    [
      "deep lists in the answer",
      `{"a":${"[".repeat(100000)}${"]".repeat(100000)},${answer.slice(1)}`,
      2,
      /nested deeper than 16 levels/,
    ],
    [
      "brackets and quotes in a text",
      `{"a":[[["]\\"["]]],${answer.slice(1)}`,
      1,
      /recomputed: \/a is missing/,
    ],
    [
      "deep lists in the request",
      answer.replace('"request":{', `"request":{"b":${"[".repeat(100000)}${"]".repeat(100000)},`),
      2,
      /nested deeper than 16 levels/,
    ],
  ];
  for (const [what, text, code, message] of cases) {
    const result = await verify(text);
    assert.equal(result.code, code, `${what}: ${result.out}${result.errors}`);
    assert.match(result.out + result.errors, message, what);
    assert.doesNotMatch(result.errors, /exception/, what);
  }
});

test("control characters of a file appear as escapes and cannot forge a line", async () => {
  const forged = "a\nsha256: matches\r\u001b]52;c;aGk=\u0007\u007f\u009b2J";
  const name = JSON.stringify(forged).slice(1, -1);
  const inert = (text) => {
    assert.doesNotMatch(text.replaceAll("\n", ""), /\p{Control}/u);
    assert.doesNotMatch(text, /^sha256: matches/m);
  };
  const answer = await simulated({tau_end: 40, include: ["regime"]});
  const {out, errors} = await verify(`{"${name}":1,${answer.slice(1)}`);
  inert(out + errors);
  assert.ok(out.includes("recomputed: /a\\u000asha256: matches"), out);
  const version = await verify(answer.replace(/"version":"[^"]*"/, `"version":"${name}"`));
  inert(version.out + version.errors);
  await writeFile(at(forged), `{"${name}":1}\n{"type":"${name}"}\n`);
  for (const command of ["merge", "verify", "simulate"]) {
    const {code, errors} = await run([command, at(forged)]);
    assert.ok(code === 1 || code === 2, errors);
    inert(errors);
  }
});

test("verify reproduces the service's answers: runs, manifolds, identifications, sweeps", async () => {
  const service = await startService(["--answer-limit", "300000"]);
  const post = async (path, body, type = "application/json") =>
    (
      await fetch(service.url + path, {method: "POST", headers: {"Content-Type": type}, body})
    ).text();
  const many = {b: 0.003, tau_end: 60000, include: ["impacts"]};
  for (const [path, fields] of [
    ["/v1/simulate", many], // thinned to the limit
    ["/v1/simulate", {preset: "fig11", include: ["matrices"], fields: "matrices.T"}],
    ["/v1/manifold", {b: 0.015}],
  ]) {
    const {code, out, errors} = await verify(await post(path, JSON.stringify(fields)));
    assert.equal(code, 0, out + errors);
  }
  const record = await measured(service.url, "fig20", 3);
  const file = at("verify.csv");
  await writeFile(file, record);
  const identified = await post("/v1/identify?preset=fig20", record, "text/csv");
  const same = await verify(identified, ["--record", file]);
  assert.equal(same.code, 0, same.out + same.errors);
  assert.equal((await verify(identified)).code, 2, "the record is not in the answer");
  await writeFile(file, record.replace(/^.*\n.*\n/, ""));
  assert.match((await verify(identified, ["--record", file])).out, /not the file that was sent/);
  const swept = await post("/v1/sweep", sweep);
  const points = await verify(swept);
  assert.equal(points.code, 0, points.out + points.errors);
  assert.match(points.out, /40 of 40 points are the same/);
  for (const [how, text] of Object.entries(rewritten(swept))) {
    const {code, out, errors} = await verify(text);
    assert.equal(code, 0, `${how}: ${out}${errors}`);
    assert.match(out, /40 of 40 points are the same/, how);
  }
  const changed = await verify(
    swept.replace(/("index":7,.*"z":)[\d.]+/, (_, prefix) => `${prefix}9`),
  );
  assert.equal(changed.code, 1);
  assert.match(changed.out, /39 of 40 points are the same\npoint 7: \/z: 9 became /);
  const start = await verify(swept.replace(/"cycles":\d+/, '"cycles":1'));
  assert.equal(start.code, 1);
  assert.match(start.out, /40 of 40 points are the same\nstart: \/cycles: 1\.0 became 10400\.0/);
  await service.stop();
});

test("verify reports a run ended by a time limit, and a text that is not an answer", async () => {
  const limited = await startService(["--deadline", "0.2"]);
  const body = '{"b":0.0005,"R":1,"tau_end":1e7,"max_impacts":2000000,"include":["regime"]}';
  const answer = await fetch(`${limited.url}/v1/simulate`, {method: "POST", body});
  const late = await verify(await answer.text());
  assert.equal(late.code, 3);
  assert.match(late.out, /not decided: a time limit/);
  await limited.stop();
  for (const invalid of [
    "",
    "{}",
    "[1]",
    '{"provenance":1}',
    '{"a":1,"provenance":{"route":"/x"}}',
  ])
    assert.equal((await verify(invalid)).code, 2, invalid);
});

const sweep = JSON.stringify({
  base: {damping: "closed_form"},
  axes: [{parameter: "b", from: 0.008, to: 0.03, count: 40}],
  cycles: 60,
  section: "impact",
  section_points: 5,
});
// A sweep that a test can interrupt before it ends, on any machine.
const longSweep = JSON.stringify({...JSON.parse(sweep), cycles: 100000});
const countLines = async (name) =>
  (await readFile(at(name), "utf8").catch(() => "")).split("\n").length - 1;

test("simulate returns the same bytes as the service, from a file or stdin to a file or stdout", async () => {
  const service = await startService();
  const body = '{"b":0.015,"tau_end":100,"include":["impacts"]}';
  const answer = await (await fetch(`${service.url}/v1/simulate`, {method: "POST", body})).text();
  await service.stop();
  assert.deepEqual(await run(["simulate"], {input: body}), {code: 0, out: answer, errors: ""});
  await writeFile(at("request.json"), body);
  assert.equal((await run(["simulate", at("request.json"), "-o", at("answer.json")])).code, 0);
  assert.equal(await readFile(at("answer.json"), "utf8"), answer);
});

/**
 * Peak memory of a simulation in MB, and the length of its answer in bytes. The memory is read with
 * each piece of output, while the process still exists.
 */
const peakOf = (request) =>
  new Promise((resolve) => {
    const child = spawn(program, ["simulate"]);
    let megabytes = 0;
    let bytes = 0;
    child.stdout.on("data", (piece) => {
      bytes += piece.length;
      try {
        const status = readFileSync(`/proc/${child.pid}/status`, "utf8");
        megabytes = Number(status.match(/VmHWM:\s+(\d+)/)[1]) / 1024;
      } catch {
        // The process has ended.
      }
    });
    child.on("close", () => resolve({megabytes, bytes}));
    child.stdin.end(JSON.stringify(request));
  });

test("the memory of a run with exponents does not grow with its impacts", async () => {
  const peak = async (max_impacts) =>
    (await peakOf({b: 0.015, tau_end: 1e7, max_impacts, include: ["exponents"]})).megabytes;
  const [half, whole] = [await peak(250000), await peak(500000)];
  // 4 MB of tolerance for the allocator.
  assert.ok(half > 1 && whole < half + 4, `${half} and ${whole} MB`);
});

test("the memory of an answer does not grow with the impacts that it lists", async () => {
  const peak = (max_impacts) => peakOf({b: 0.015, tau_end: 1e7, max_impacts, include: ["impacts"]});
  const [half, whole] = [await peak(250000), await peak(500000)];
  assert.ok(whole.bytes > 1e8, `${whole.bytes} bytes`);
  assert.ok(
    half.megabytes > 1 && whole.megabytes < half.megabytes + 20,
    `${half.megabytes} and ${whole.megabytes} MB`,
  );
});

test("identify accepts a CSV file with its fields as a query, or the service's JSON", async () => {
  const request = '{"preset":"fig20","include":["impacts","exponents"],"exponents":["qr"]}';
  const simulated = JSON.parse((await run(["simulate"], {input: request})).out);
  const {code, out} = await run(["identify"], {
    input: JSON.stringify({preset: "fig20", impacts: simulated.impacts, exponents: ["qr"]}),
  });
  assert.equal(code, 0);
  const lambda = (answer) => answer.exponents.qr.final[0];
  assert.ok(Math.abs(lambda(JSON.parse(out)) - lambda(simulated)) < 1e-9);
  await writeFile(at("record.csv"), "time_s,x_m,a\n0,1,2\n0.001,1,x\n");
  const refused = await run(["identify", at("record.csv"), "-q", "preset=fig20&b=0.015"]);
  assert.equal(refused.code, 2);
  assert.equal(JSON.parse(refused.errors).detail, 'line 3, column a: "x" is not a number');
});

test("identify decodes its query the way the service decodes a URL's", async () => {
  const input = "time_s,the x,a\n0,1,2\n0.001,1,3\n";
  const problemOf = async (column) => {
    const query = `preset=fig20&displacement_column=${column}`;
    return JSON.parse((await run(["identify", "-q", query], {input})).errors);
  };
  const {errors} = await problemOf("no%20x+%2Cor%3D&");
  assert.equal(errors[0].pointer, "/displacement_column");
  assert.equal(errors[0].value, "no x ,or=");
  // The column is found, and the record is too short.
  for (const column of ["the x", "the%20x", "the+x", "%74he%20x"])
    assert.match((await problemOf(column)).detail, /^the record has 2 samples/);
  assert.equal((await problemOf("50%zz%2")).errors[0].value, "50%zz%2");
});

test("a sweep warns if the motion depends on the start; a default set of starts reports worst and best", async () => {
  const platform = {
    base: {m1: 12, f0: 14, damping_ratio: 0.006, mass_ratio: 0.01, F: 0.0004, R: 0.4, b: 0.03},
    axes: [{parameter: "f", from: 13.8, to: 14.2, count: 3}],
    cycles: 100,
  };
  const single = await run(["sweep"], {input: JSON.stringify(platform)});
  assert.equal(single.code, 0);
  assert.match(single.errors, /^vines: the motion depends on the start: at 2 of 3 points/);
  const both = await run(["sweep"], {
    input: JSON.stringify({...platform, starts: "default set", reduce: "max over f"}),
  });
  assert.deepEqual({code: both.code, errors: both.errors}, {code: 0, errors: ""});
  const [start, line, done] = parsed(both.out);
  assert.equal(start.parameters.origin.f, "swept: the first of its axis");
  assert.ok(line.worst.x_peak > line.best.x_peak);
  assert.deepEqual(done, {type: "done", points: 1});
});

test("an invalid request gives a problem document on stderr and exit code 2, a missing file exit code 1", async () => {
  const faults = [
    ["simulate", '{"b":-1}'],
    ["sweep", '{"axes":[{"parameter":"q","values":[1]}]}'],
    ["simulate", "{"],
  ];
  for (const [command, input] of faults) {
    const {code, out, errors} = await run([command], {input});
    assert.equal(code, 2);
    assert.equal(out, "");
    assert.ok(JSON.parse(errors).status >= 400);
  }
  assert.equal((await run(["simulate", at("nowhere.json")])).code, 1);
  assert.equal((await run(["sweep", "-o", "/proc/nowhere/x"], {input: sweep})).code, 1);
});

test("an invalid shard is refused with the text or the variable that is wrong, and the valid range", async () => {
  const slurm = (id, more = {}) => ({
    SLURM_ARRAY_TASK_ID: id,
    SLURM_ARRAY_TASK_MIN: "10",
    SLURM_ARRAY_TASK_COUNT: "4",
    ...more,
  });
  const form = (text) => `a shard is i/N with 0 <= i < N, not ${text}`;
  const variable = (name, text, range) => `${name} is ${text}, not a whole number from ${range}`;
  const index = (text) => variable("SLURM_ARRAY_TASK_ID", text, "10 to 13");
  for (const [shard, env, detail] of [
    ["3", {}, form("3")],
    ["3/", {}, form("3/")],
    ["a/4", {}, form("a/4")],
    ["4/4", {}, form("4/4")],
    ["-1/4", {}, form("-1/4")],
    ["1/4x", {}, form("1/4x")],
    ["auto", slurm("abc"), index("abc")],
    ["auto", slurm("9"), index("9")],
    ["auto", slurm("14"), index("14")],
    ["auto", slurm("99999999999999999999"), index("99999999999999999999")],
    [
      "auto",
      slurm("11", {SLURM_ARRAY_TASK_MIN: "1O"}),
      variable("SLURM_ARRAY_TASK_MIN", "1O", "0 to 10000000"),
    ],
    [
      "auto",
      slurm("11", {SLURM_ARRAY_TASK_COUNT: "0"}),
      variable("SLURM_ARRAY_TASK_COUNT", "0", "1 to 10000000"),
    ],
    [
      "auto",
      slurm("11", {SLURM_ARRAY_TASK_COUNT: ""}),
      "--shard auto in a Slurm array needs SLURM_ARRAY_TASK_COUNT or --shards",
    ],
    [
      "auto",
      {JOB_COMPLETION_INDEX: "3", VINES_SHARDS: "3"},
      variable("JOB_COMPLETION_INDEX", "3", "0 to 2"),
    ],
    ["auto", {JOB_COMPLETION_INDEX: "2"}, "--shard auto with JOB_COMPLETION_INDEX needs --shards"],
    [
      "auto",
      {},
      "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or " +
        "JOB_COMPLETION_INDEX and --shards, in the environment",
    ],
  ]) {
    const {code, out, errors} = await run(["sweep", "--shard", shard], {input: sweep, env});
    assert.deepEqual({code, out}, {code: 2, out: ""}, detail);
    assert.equal(JSON.parse(errors).detail, detail);
  }
});

test("an interrupted simulation writes its answer up to that time, with exit code 130", async () => {
  const {code, out} = await run(["simulate"], {
    input: '{"b":0.003,"R":1,"tau_end":1e7,"max_impacts":2000000,"include":["exponents"]}',
    signal: "SIGINT",
    until: hasComputed(0.3),
  });
  assert.equal(code, 130);
  assert.equal(JSON.parse(out).status.reason, "interrupted");
});

test("an interrupted identification reports its stage, with exit code 130", async () => {
  const sample = (k) => `${k * 1e-9},${Math.sin(k)}`;
  const {code, out, errors} = await run(["identify", "-q", "preset=fig15"], {
    input: ["time_s,a", ...Array.from({length: 200000}, (_, k) => sample(k))].join("\n"),
    signal: "SIGINT",
    until: hasComputed(1.5),
  });
  assert.equal(code, 130);
  assert.equal(out, "");
  assert.match(errors, /^vines: the identification was stopped while looking for spikes/);
});

test("a sweep's file has its points in order, the same as on stdout and for any number of threads", async () => {
  assert.equal((await run(["sweep", "-o", at("whole.ndjson")], {input: sweep})).code, 0);
  const whole = await readFile(at("whole.ndjson"), "utf8");
  assert.equal((await run(["sweep", "--threads", "1"], {input: sweep})).out, whole);
  assert.equal((await run(["sweep", "--threads", "5"], {input: sweep})).out, whole);
  const types = parsed(whole).map((line) => line.type);
  assert.deepEqual(types, ["start", ...Array(40).fill("point"), "done"]);
  const indices = parsed(whole).map((line) => line.index);
  assert.deepEqual(indices.slice(1, -1), [...Array(40).keys()]);
});

// This test and the next read whole.ndjson, which the test above writes.
test("merged shards equal the whole sweep byte for byte; a missing point is reported", async () => {
  const whole = await readFile(at("whole.ndjson"), "utf8");
  const slurm = {
    SLURM_ARRAY_TASK_ID: "11",
    SLURM_ARRAY_TASK_MIN: "10",
    SLURM_ARRAY_TASK_COUNT: "3",
  };
  const kubernetes = {JOB_COMPLETION_INDEX: "2", VINES_SHARDS: "3"};
  const shards = [
    {shard: "0/3", env: {}},
    {shard: "auto", env: slurm},
    {shard: "auto", env: kubernetes},
  ];
  const parts = shards.map((_, i) => at(`part${i}`));
  for (const [i, {shard, env}] of shards.entries()) {
    const {code} = await run(["sweep", "--shard", shard, "-o", parts[i]], {input: sweep, env});
    assert.equal(code, 0);
  }
  assert.equal((await run(["merge", ...parts])).out, whole);
  assert.equal((await run(["merge", ...parts, "-o", at("merged")])).code, 0);
  assert.equal(await readFile(at("merged"), "utf8"), whole);
  const missing = await run(["merge", parts[0], parts[2]]);
  assert.equal(missing.code, 3);
  assert.match(missing.errors, /13 of 40 points are missing, the first is 1:/);
  await run(["sweep", "-o", at("other")], {input: sweep.replace("60", "61")});
  const mixed = await run(["merge", parts[0], at("other")]);
  assert.equal(mixed.code, 1);
  assert.match(mixed.errors, /another sweep/);
});

test("an existing file is not overwritten; --resume completes one that was cut anywhere", async () => {
  const whole = await readFile(at("whole.ndjson"), "utf8");
  assert.equal((await run(["sweep", "-o", at("whole.ndjson")], {input: sweep})).code, 1);
  const resume = (name, input) => run(["sweep", "--resume", "-o", at(name)], {input});
  const nowhere = await run(["sweep", "--resume"], {input: sweep});
  assert.equal(nowhere.code, 2);
  assert.match(nowhere.errors, /--resume needs an output file/);
  const n = whole.length;
  for (const cut of [0, 10, whole.indexOf("\n") + 1, Math.floor(n / 2), n - 3, n]) {
    await writeFile(at("cut"), whole.slice(0, cut));
    assert.equal((await resume("cut", sweep)).code, 0, `cut at ${cut}`);
    assert.equal(await readFile(at("cut"), "utf8"), whole);
  }
  await appendFile(at("cut"), "nonsense\n");
  assert.match((await resume("cut", sweep)).errors, /line 43: not a line of a sweep/);
  assert.equal((await resume("whole.ndjson", sweep.replace("60", "61"))).code, 1);
});

test("basins are verified, and completed from lines of any runs: one that was cut, or all shards in one file", async () => {
  const input = JSON.stringify({
    base: {damping: "closed_form", b: 0.0065, y0: 0},
    box: {x0: [-0.003, 0.003], y_dot0: [-0.02, 0.02]},
    axis: {parameter: "R", values: [0.55, 0.6]},
    count: 200,
    pairs: 50,
  });
  const basins = (name, ...more) => run(["basins", "-o", at(name), ...more], {input});
  const whole = (await run(["basins"], {input})).out;
  const lines = whole.trim().split("\n");
  assert.equal((await verify(whole)).code, 0);
  const altered = await verify(whole.replace(/"boundary_entropy":\{"value":/, "$&9"));
  assert.equal(altered.code, 1);
  assert.match(altered.out, /400 of 400 points are the same\ndone: \/basins\/0\/boundary_entropy/);
  assert.equal((await basins("basins.ndjson")).code, 0);
  assert.equal(await readFile(at("basins.ndjson"), "utf8"), whole);
  assert.match((await basins("basins.ndjson")).errors, /--resume completes it/);
  for (const cut of [[0], [0, 150], [0, 40, 300, 401]]) {
    const kept = cut.length === 1 ? [lines[0]] : lines.slice(...cut.slice(0, 2));
    const more = cut.length > 2 ? lines.slice(...cut.slice(2)) : [];
    await writeFile(at("cut.ndjson"), `${[...kept, ...more].join("\n")}\n`);
    assert.equal((await basins("cut.ndjson", "--resume")).code, 0);
    assert.equal(await readFile(at("cut.ndjson"), "utf8"), whole);
  }
  const shards = await Promise.all(
    [0, 1].map(async (k) => {
      await basins(`shard${k}`, "--shard", `${k}/2`);
      return (await readFile(at(`shard${k}`), "utf8")).split("\n");
    }),
  );
  assert.match((await run(["merge", at("shard0"), at("shard1")])).errors, /vines basins --resume/);
  const points = shards.flat().filter((line) => line.includes('"point"'));
  await writeFile(at("shards"), `${[lines[0], ...points].join("\n")}\n`);
  assert.equal((await basins("shards", "--resume")).code, 0);
  assert.equal(await readFile(at("shards"), "utf8"), whole);
  const forged = lines
    .slice(0, 20)
    .map((line) => line.replace(/"p1-[0-9a-f]{8}"/, '"p1-00000000"'));
  await writeFile(at("forged"), `${forged.join("\n")}\n`);
  assert.match(
    (await basins("forged", "--resume", "--threads", "1")).errors,
    /line 2: this is not what/,
  );
});

test("a killed sweep loses only unfinished points, and an interrupted one ends with exit code 130", async () => {
  const killed = await run(["sweep", "-o", at("killed")], {
    input: longSweep,
    signal: "SIGKILL",
    until: async () => (await countLines("killed")) > 4,
  });
  assert.equal(killed.code, null);
  const linesBefore = await countLines("killed");
  assert.ok(linesBefore > 4);
  const interrupted = await run(["sweep", "--resume", "-o", at("killed")], {
    input: longSweep,
    signal: "SIGINT",
    until: async () => (await countLines("killed")) > linesBefore + 3,
  });
  assert.equal(interrupted.code, 130);
  assert.match(interrupted.errors, /--resume completes the file/);
  assert.ok((await countLines("killed")) > linesBefore + 3);
});

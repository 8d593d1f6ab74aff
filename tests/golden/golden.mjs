// Records the program's answers, one file per request, to compare two builds:
//   node tests/golden/golden.mjs record FOLDER     of the program in the variable VINES
//   node tests/golden/golden.mjs compare BEFORE AFTER
// compare counts answers that are equal byte for byte and those that are equal as JSON. For each of
// the others it reports the largest |a - b| of two numbers, divided by the largest magnitude in the
// array of a, or by |a| outside arrays; it then exits with 1.
// Version, commit and hashes are masked; a sweep's points are sorted, its progress is removed.
import {execFileSync, spawn} from "node:child_process";
import {mkdir, mkdtemp, readdir, readFile, rm, stat, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";
import {program, startService} from "../service.mjs";
import {commands, identifications, requests} from "./requests.mjs";

const nameOf = (name) => name.replace(/[^A-Za-z0-9.]+/g, "_").slice(0, 100);
/** The text without version (a RegExp), commit and hashes. */
const masked = (text, version) =>
  text.replace(version, "VERSION").replace(/"(commit|sha256)":( ?)"[^"]*"/g, '"$1":$2"BUILD"');

/** The lines of a sweep in the order of their indices. */
const ordered = (text) => {
  const lines = text
    .trimEnd()
    .split("\n")
    .filter((line) => !line.startsWith('{"type":"progress"'));
  const index = (line) =>
    Number(line.match(/^{"type":"(?:point|sample)","index":(\d+)/)?.[1] ?? -1);
  const points = lines.filter((line) => index(line) >= 0).sort((a, b) => index(a) - index(b));
  const others = lines.filter((line) => index(line) < 0);
  return `${[...others.slice(0, 1), ...points, ...others.slice(1)].join("\n")}\n`;
};

const asText = (body) => (typeof body === "string" ? body : JSON.stringify(body));

async function answerOf(url, {path, body, type}) {
  // Problem documents contain the request id, which the service would otherwise generate.
  const headers = {"Content-Type": type ?? "application/json", "X-Request-ID": "same"};
  const options = body === undefined ? {headers} : {method: "POST", body: asText(body), headers};
  const response = await fetch(url + path, options);
  const text = await response.text();
  const kind = response.headers.get("content-type");
  return `${response.status} ${kind}\n${kind.includes("ndjson") ? ordered(text) : text}`;
}

/** Contents of a file, or of all files of a folder, with their names. */
async function contents(folder, name) {
  const path = join(folder, name);
  if (!(await stat(path)).isDirectory()) return `--- ${name}\n${await readFile(path, "utf8")}`;
  const parts = [];
  for (const inside of (await readdir(path)).sort())
    parts.push(await contents(folder, join(name, inside)));
  return parts.join("");
}

async function outcomeOf({args, input, environment, files = []}) {
  const folder = await mkdtemp(join(tmpdir(), "vines-golden-"));
  const options = {cwd: folder, env: {...process.env, ...environment}};
  const child = spawn(resolve(program), args, options);
  let out = "";
  let errors = "";
  child.stdout.on("data", (data) => (out += data));
  child.stderr.on("data", (data) => (errors += data));
  child.stdin.on("error", () => {});
  child.stdin.end(input === undefined ? "" : asText(input));
  const code = await new Promise((resolve) => child.on("close", resolve));
  const written = await Promise.all(files.map((name) => contents(folder, name)));
  await rm(folder, {recursive: true});
  return `exit ${code}\n--- stdout\n${out}--- stderr\n${errors}${written.join("")}`;
}

async function record(folder) {
  await mkdir(folder, {recursive: true});
  const number = execFileSync(program, ["--version"], {encoding: "utf8"}).trim();
  const version = new RegExp(`\\b${number.replaceAll(".", "\\.")}\\b`, "g");
  let count = 0;
  const keep = async (name, text) => {
    ++count;
    await writeFile(join(folder, nameOf(name)), masked(text, version));
  };
  const service = await startService(["--deadline", "600"]);
  const small = await startService(["--answer-limit", "2000000"]);
  const simulate = async (fields) => {
    const body = JSON.stringify(fields);
    return (await fetch(`${service.url}/v1/simulate`, {method: "POST", body})).json();
  };
  for (const request of [...requests, ...(await identifications(simulate))])
    await keep(request.name, await answerOf(request.limited ? small.url : service.url, request));
  await Promise.all([service.stop(), small.stop()]);
  for (const command of commands) await keep(command.name, await outcomeOf(command));
  console.log(`${count} answers in ${folder}`);
}

/** The lines of an answer, parsed where a line begins an object or array. */
const valuesIn = (text) => {
  const values = [];
  for (const line of text.split("\n"))
    if (/^[{[]/.test(line)) values.push(JSON.parse(line));
    else values.push(line);
  return values;
};
const largestOf = (list) =>
  list.reduce((most, x) => (typeof x === "number" ? Math.max(most, Math.abs(x)) : most), 0);
/** Difference of two values relative to `size`; Infinity if other values than numbers differ. */
const differenceOf = (one, other, size) => {
  if (one === other) return 0;
  if (typeof one === "number" && typeof other === "number")
    return Math.abs(one - other) / (size || Math.abs(one));
  if (!one || !other || typeof one !== "object" || typeof other !== "object") return Infinity;
  const names = Object.keys(one);
  if (String(names) !== String(Object.keys(other))) return Infinity;
  const largest = Array.isArray(one) ? largestOf(one) : 0;
  return names.reduce(
    (most, name) => Math.max(most, differenceOf(one[name], other[name], largest)),
    0,
  );
};
const parsedDifference = (one, other) => {
  try {
    return differenceOf(valuesIn(one), valuesIn(other), 0);
  } catch {
    return Infinity;
  }
};

async function compare(before, after) {
  const names = [...new Set([...(await readdir(before)), ...(await readdir(after))])].sort();
  const read = (folder, name) => readFile(join(folder, name), "utf8").catch(() => undefined);
  let notIdentical = 0;
  let equalAsJson = 0;
  for (const name of names) {
    const [one, other] = await Promise.all([read(before, name), read(after, name)]);
    if (one === other) continue;
    ++notIdentical;
    if (one === undefined || other === undefined) {
      console.log(`${name}: only in ${one === undefined ? after : before}`);
      continue;
    }
    const difference = parsedDifference(one, other);
    if (difference === 0) {
      ++equalAsJson;
      continue;
    }
    let at = 0;
    while (one[at] === other[at]) ++at;
    const around = (text) => JSON.stringify(text.slice(Math.max(0, at - 60), at + 100));
    const [was, is] = [one, other].map(around);
    console.log(`${name}: differs by ${difference}, at character ${at}\n  - ${was}\n  + ${is}`);
  }
  console.log(`${names.length - notIdentical} of ${names.length} answers are equal, byte for byte`);
  if (equalAsJson > 0) console.log(`${equalAsJson} more are equal as JSON`);
  process.exitCode = notIdentical > equalAsJson ? 1 : 0;
}

const [what, ...folders] = process.argv.slice(2);
if (what === "record" && folders.length === 1) await record(folders[0]);
else if (what === "compare" && folders.length === 2) await compare(...folders);
else {
  console.error("golden: record FOLDER, or compare BEFORE AFTER");
  process.exitCode = 2;
}

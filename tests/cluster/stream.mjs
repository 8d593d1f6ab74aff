// stream.mjs FRONT REQUEST WHOLE SIGNAL PROCESS...: runs a sweep through the port FRONT and requests missing
// points until the sweep is complete.
//
// REQUEST and WHOLE are files: the sweep, and its lines from the command line. With a
// SIGNAL (may be empty) the streaming replica receives it after 20 points; the PROCESSes are
// those of the replicas one, two and three. Exit code 1 if a point is missing, duplicate or
// different; without a signal also if points do not arrive while they are computed.
import fs from "node:fs";
import http from "node:http";

const [front, file, whole, signal, ...processes] = process.argv.slice(2);
const replicas = ["one", "two", "three"];
const request = JSON.parse(fs.readFileSync(file));
const expected = new Map(
  fs
    .readFileSync(whole, "utf8")
    .split("\n")
    .filter((line) => line.startsWith('{"type":"point"'))
    .map((line) => [JSON.parse(line).index, line]),
);
const points = new Map();
let twice = 0;

/** Handles one line of an answer; `own` is the state of that answer. */
function take(line, own, breakAfter) {
  const {type, index} = JSON.parse(line);
  if (type === "done" || type === "error") own.end = type;
  if (type !== "point") return;
  own.first ??= performance.now() - own.from;
  if (points.has(index)) ++twice;
  points.set(index, line);
  if (++own.points === breakAfter)
    process.kill(Number(processes[replicas.indexOf(own.by)]), signal);
}

/** Requests some points, or all; resolves when the answer ends or is cut off. */
const ask = (indices, breakAfter) =>
  new Promise((resolve, reject) => {
    const body = JSON.stringify(indices ? {...request, indices} : request);
    const headers = {"Content-Length": body.length};
    const own = {from: performance.now(), points: 0, reads: 0, end: "cut off"};
    const to = {port: front, host: "127.0.0.1", path: "/v1/sweep", method: "POST", headers};
    const asked = http.request({...to, agent: false}, (answer) => {
      if (answer.statusCode !== 200) return reject(new Error(String(answer.statusCode)));
      own.by = answer.headers["x-replica"];
      let rest = "";
      answer.setEncoding("utf8");
      answer.on("data", (part) => {
        ++own.reads;
        const lines = (rest + part).split("\n");
        rest = lines.pop();
        for (const line of lines) take(line, own, breakAfter);
      });
      answer.on("error", () => {});
      answer.on("close", () => resolve({...own, ms: performance.now() - own.from}));
    });
    asked.on("error", reject).end(body);
  });

const first = await ask(null, signal ? 20 : 0);
const report = [`${first.points} points from ${first.by}, ${first.end}`];
while (points.size < expected.size && report.length < 5) {
  const missing = [...expected.keys()].filter((index) => !points.has(index));
  const own = await ask(missing, 0);
  report.push(`${own.points} from ${own.by}, ${own.end}`);
}

const same =
  points.size === expected.size &&
  [...expected].every(([index, line]) => points.get(index) === line);
const broken = report.length > 1 && first.points < expected.size;
const early = first.first < first.ms / 3 && first.reads > 5 && first.end === "done";
const when =
  `; first point after ${first.first?.toFixed(0)} ms, end after ${first.ms.toFixed(0)} ms, ` +
  `in ${first.reads} reads`;
console.log(
  `${report.join("; ")}; ${points.size} of ${expected.size} points, ${twice} twice, ` +
    `each equal to the CLI's line: ${same}${signal ? "" : when}`,
);
process.exit(same && twice === 0 && (signal ? broken : early) ? 0 : 1);

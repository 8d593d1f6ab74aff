// load.mjs FRONT ORIGIN CLIENTS KILLS: runs CLIENTS that send requests to the port FRONT without a pause
// until SIGTERM, while KILLS of the replicas behind it are killed.
//
// An answer counts if it equals, byte for byte, the earlier answer of the replica at the port ORIGIN. An answer
// that has begun when its replica is killed is cut off, which no proxy can repair: it is requested again and
// counted. Exit code 1 if a request is lost, or if more than two answers per kill are cut off.
import http from "node:http";

const [front, origin, clients, kills] = process.argv.slice(2).map(Number);

const ask = (port, body, agent) =>
  new Promise((resolve, reject) => {
    const headers = {"Content-Length": body.length};
    const to = {port, host: "127.0.0.1", path: "/v1/simulate", method: "POST", agent, headers};
    const request = http.request(to, (answer) => {
      let text = "";
      answer.setEncoding("utf8");
      answer.on("data", (part) => (text += part));
      answer.on("error", () => {});
      answer.on("close", () => {
        const {statusCode: status, headers, complete: whole} = answer;
        resolve({status, by: headers["x-replica"], text, whole});
      });
    });
    request.on("error", reject).end(body);
  });

const bodies = Array.from({length: 40}, (_, i) =>
  JSON.stringify({
    b: 0.01 + i * 0.0005,
    damping: "closed_form",
    tau_end: 400 + 20 * i,
    include: i % 4 ? ["impacts"] : ["series", "impacts", "exponents"],
    max_points: 300,
  }),
);
const expected = [];
for (const body of bodies) {
  const {status, text} = await ask(origin, body);
  if (status !== 200 || JSON.parse(text).status.reason !== "tau_end") throw new Error(text);
  expected.push(text);
}

const agent = new http.Agent({keepAlive: true});
const times = [];
const lost = [];
const by = {};
let running = true;
let next = 0;
let bytes = 0;
let cut = 0;

async function askOnce(i) {
  let answer = await ask(front, bodies[i], agent);
  if (!answer.whole) {
    ++cut;
    answer = await ask(front, bodies[i], agent);
  }
  const {status, by: name, text} = answer;
  if (status !== 200 || text !== expected[i]) lost.push(`${status} ${text.slice(0, 200)}`);
  by[name] = (by[name] ?? 0) + 1;
  bytes += text.length;
}
async function client() {
  while (running) {
    const from = performance.now();
    await askOnce(next++ % bodies.length).catch((error) => lost.push(String(error)));
    times.push(performance.now() - from);
  }
}

process.on("SIGTERM", () => (running = false));
console.log("running");
await Promise.all(Array.from({length: clients}, client));
agent.destroy();

times.sort((a, b) => a - b);
const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(1);
const names = Object.entries(by).map((entry) => entry.join(" "));
if (lost.length > 0) console.log(lost.slice(0, 5).join("\n"));
console.log(
  `${lost.length} of ${times.length} requests lost, ${cut} cut off by a kill, ` +
    `${(bytes / 1e6).toFixed(0)} MB; ms: median ${at(0.5)}, 99 % ${at(0.99)}, ` +
    `longest ${at(1)}; by replica ${names.join(", ")}`,
);
process.exit(lost.length > 0 || cut > 2 * kills ? 1 : 0);

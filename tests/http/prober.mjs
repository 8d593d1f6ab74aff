// Requests /livez every 10 ms, each time on a new connection, and prints the duration of each in
// ms. A separate process: one that also generates load would measure its own waiting.
// Usage: node prober.mjs URL MS
import net from "node:net";
import {sleep} from "./raw.mjs";

const [url, ms] = process.argv.slice(2);
const {hostname, port} = new URL(url);
const request = "GET /livez HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

/** Time until the complete answer, ms. */
const probe = () =>
  new Promise((resolve, reject) => {
    const began = performance.now();
    let text = "";
    const socket = net.connect({host: hostname, port: Number(port), noDelay: true});
    socket.on("connect", () => socket.write(request));
    socket.on("error", reject);
    socket.on("close", () => reject(new Error(`no whole answer: ${text}`)));
    socket.on("data", (data) => {
      text += data;
      if (!text.endsWith('"ok"}\n')) return;
      resolve(performance.now() - began);
      socket.destroy();
    });
  });

const times = [];
const until = performance.now() + Number(ms);
while (performance.now() < until) {
  times.push(await probe());
  await sleep(10);
}
process.stdout.write(JSON.stringify(times));

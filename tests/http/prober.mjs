// Requests /livez 10 ms after each response, on new connections, for DURATION ms; prints a JSON
// array of the response times in ms. It is a separate process because a load generator would delay
// its own probes.
// Usage: node prober.mjs URL DURATION
import net from "node:net";
import {get, sleep} from "./raw.mjs";

const [url, ms] = process.argv.slice(2);
const {hostname, port} = new URL(url);
const request = get("/livez", "Connection: close\r\n");

/** Time until the response is complete, ms. */
const probe = () =>
  new Promise((resolve, reject) => {
    const began = performance.now();
    let text = "";
    const socket = net.connect({host: hostname, port: Number(port), noDelay: true});
    socket.on("connect", () => socket.write(request));
    socket.on("error", reject);
    socket.on("close", () => reject(new Error(`incomplete response: ${text}`)));
    socket.on("data", (data) => {
      text += data;
      if (!text.endsWith('"ok"}\n')) return; // the end of the body of /livez
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

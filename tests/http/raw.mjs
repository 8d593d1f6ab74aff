// Raw bytes to a service and back.
import net from "node:net";

/** An open connection: {socket, text(): the bytes received so far, ended: a promise of its end}. */
export async function connect(url, options = {}) {
  const {hostname, port} = new URL(url);
  const host = hostname.replace(/^\[|\]$/g, "");
  const socket = net.connect({port: Number(port), host, ...options});
  let text = "";
  socket.on("data", (data) => {
    text += data.toString("latin1");
  });
  socket.on("error", () => {});
  const ended = new Promise((resolve) => {
    socket.on("close", () => resolve(text));
    socket.on("end", () => resolve(text));
  });
  await new Promise((resolve, reject) => {
    socket.once("connect", resolve);
    socket.once("error", reject);
  });
  return {socket, text: () => text, ended};
}

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Waits until condition() holds; throws after `ms`. */
export async function until(condition, ms = 20000) {
  const began = performance.now();
  while (!(await condition())) {
    if (performance.now() - began > ms) throw new Error(`not within ${ms} ms: ${condition}`);
    await sleep(5);
  }
}

/** The status codes of the answers in a text, without interim ones (1xx). */
export const statuses = (text) =>
  [...text.matchAll(/^HTTP\/1\.1 ([2-5]\d\d) /gm)].map((found) => Number(found[1]));

/** Sends bytes and returns everything received until the server closes or `ms` are over. */
export async function exchange(url, bytes, ms = 20000) {
  const connection = await connect(url);
  connection.socket.write(bytes);
  const late = setTimeout(() => connection.socket.destroy(), ms);
  const text = await connection.ended;
  clearTimeout(late);
  connection.socket.destroy();
  return text;
}

/** Memory of a process in MB: current, or with VmHWM its peak. */
export async function memory(pid, what = "VmRSS") {
  const {readFile} = await import("node:fs/promises");
  const status = await readFile(`/proc/${pid}/status`, "utf8");
  return Number(new RegExp(`${what}:\\s+(\\d+)`).exec(status)[1]) / 1024;
}

/** CPU time of a process, s. */
export async function computed(pid) {
  const {readFile} = await import("node:fs/promises");
  const fields = (await readFile(`/proc/${pid}/stat`, "utf8")).split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

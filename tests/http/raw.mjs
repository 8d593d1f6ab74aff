// A service for one test, and raw bytes to it and back.
import assert from "node:assert/strict";
import {readFile} from "node:fs/promises";
import net from "node:net";
import {startService} from "../service.mjs";

/** A service that stops at the end of the test. */
export async function serviceFor(t, flags, environment) {
  const service = await startService(flags, environment);
  t.after(() => service.stop());
  return service;
}

/** Requests as bytes. more: further headers, each with its line end. */
export const get = (path, more = "") => `GET ${path} HTTP/1.1\r\nHost: localhost\r\n${more}\r\n`;
export const post = (path, body, more = "") =>
  `POST ${path} HTTP/1.1\r\nHost: localhost\r\nContent-Length: ${body.length}\r\n${more}\r\n${body}`;

/** A simulation that runs until its deadline, half a minute, or until its client leaves. */
export const endless = JSON.stringify({
  b: 0.03,
  tau_end: 1e7,
  max_impacts: 2000000,
  include: ["regime", "exponents"],
  windows: Array.from({length: 900}, (_, i) => [i, 1e7]),
});

/** A POST by fetch. body: a text, or a value that is sent as JSON. */
export const send = (url, path, body, options = {}) =>
  fetch(url + path, {
    method: "POST",
    body: typeof body === "string" ? body : JSON.stringify(body),
    ...options,
  });

/** Reads an answer to its end; its status must be 200. */
export async function textOf(answer) {
  const text = await answer.text();
  assert.equal(answer.status, 200, text.slice(0, 1000));
  return text;
}

/** The values of a text with one JSON value per line. */
export const linesOf = (text) =>
  text
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));

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

/** `count` connections, each of which has sent bytesOf(its index). */
export const connectAll = (url, count, bytesOf = () => "") =>
  Promise.all(
    Array.from({length: count}, async (_, i) => {
      const connection = await connect(url);
      connection.socket.write(bytesOf(i));
      return connection;
    }),
  );

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Time that a very busy machine does not need, ms.
const hanging = 600000;

/** Waits until condition() holds; throws after `ms`. */
export async function until(condition, ms = hanging) {
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
export async function exchange(url, bytes, ms = hanging) {
  const connection = await connect(url);
  connection.socket.write(bytes);
  const late = setTimeout(() => connection.socket.destroy(), ms);
  const text = await connection.ended;
  clearTimeout(late);
  connection.socket.destroy();
  return text;
}

/** The current value of a metric without labels. */
export async function metric(url, name) {
  const text = await (await fetch(`${url}/metrics`)).text();
  return Number(new RegExp(`^${name} (\\S+)`, "m").exec(text)[1]);
}

/** Memory of a process in MB: current, or with VmHWM its peak. */
export async function memory(pid, what = "VmRSS") {
  const status = await readFile(`/proc/${pid}/status`, "utf8");
  return Number(new RegExp(`${what}:\\s+(\\d+)`).exec(status)[1]) / 1024;
}

/** CPU time of a process, s. */
export async function computed(pid) {
  const fields = (await readFile(`/proc/${pid}/stat`, "utf8")).split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

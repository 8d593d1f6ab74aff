// Examples of an operation: a curl command, and a button that sends the request.
import {asCurl, hasKey, post, sendRequest} from "../shared/api.js";
import {button, copy, element} from "../shared/dom.js";
import {count} from "../shared/numbers.js";

const longest = 1 << 20; // characters of a response that is shown completely
const maxLines = 60;
const maxCharacters = 6000;

/** A request as curl command, without buffering for streams. flags: further ones. */
export const commandOf = (request, flags = "") =>
  asCurl(request, (request.streams ? "-sN" : "-s") + flags);

/** Indented JSON with innermost lists on one line. */
export const pretty = (value) =>
  JSON.stringify(value, null, 2).replace(/\[[^[\]{}]*\]/g, (list) => list.replace(/\s+/g, " "));

/** Reads until the body ends or exceeds longest: {text, complete: the body ended}. */
async function read(response) {
  const reader = response.body?.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  while (reader && text.length <= longest) {
    const {done, value} = await reader.read();
    if (done) return {text, complete: true};
    text += value;
  }
  reader?.cancel().catch(() => {}); // the rest is not needed
  return {text, complete: !reader};
}

/** Sends a request: {ok, status, text}, summary and beginning of the response, JSON indented. */
async function send({path, type, body}, signal) {
  const began = performance.now();
  const response = await (body
    ? post(path, JSON.stringify(body), signal, type)
    : sendRequest(path, {signal}));
  const {text, complete} = await read(response);
  const took = Math.round(performance.now() - began);
  const isJson = /[/+]json\b/.test(response.headers.get("Content-Type") ?? "");
  const shown = isJson && complete && text ? pretty(JSON.parse(text)) : text;
  const lines = shown.trimEnd().split("\n");
  const first = lines.slice(0, maxLines).join("\n");
  const cut = lines.length > maxLines || first.length > maxCharacters;
  const status = [`${response.status} ${response.statusText}`.trim(), `${took} ms`];
  const size = `${(text.length / 1000).toFixed(1)} kB`;
  status.push(complete ? size : `more than ${size}, truncated`);
  if (cut) status.push(complete ? `beginning of ${count(lines.length, "line")}` : "beginning");
  const beginning = first.slice(0, maxCharacters) + (cut ? " …" : "");
  return {ok: response.ok, status: status.join(" · "), text: beginning};
}

/** A "Try it" button, which shows the response in the example. */
function trial(request, status, answer) {
  let running = null;
  const start = button("Try it", async () => {
    if (running) return running.abort();
    running = new AbortController();
    start.textContent = "Stop";
    status.textContent = "…";
    const {signal} = running;
    const got = await send(request, signal).catch((error) => ({
      status: signal.aborted ? "stopped" : error.message,
      text: "",
    }));
    status.className = got.ok ? "message" : "message fault";
    status.textContent = got.status;
    Object.assign(answer, {textContent: got.text, hidden: !got.text});
    writeCommands();
    start.textContent = "Try it";
    running = null;
  });
  return start;
}

const examples = () => document.querySelectorAll(".example");
const requestOf = (view) => JSON.parse(view.dataset.request);

/** Writes the commands for this service, with a key if the service required one. */
function writeCommands() {
  for (const view of examples()) {
    const request = requestOf(view);
    const key = hasKey() && !request.keyless ? ' -H "Authorization: Bearer $KEY"' : "";
    view.querySelector("code").textContent = commandOf(request, key);
  }
}

function addActions(view) {
  const request = requestOf(view);
  const said = element("span", {className: "note", role: "status"});
  const copyCommand = () =>
    copy(view.querySelector("code").textContent, (text) => {
      said.textContent = text === "copied" ? text : "the browser does not allow copying";
    });
  const shown = [".message", ".answer"].map((name) => view.querySelector(name));
  const start = request.file ? "" : trial(request, ...shown);
  view.querySelector(".actions").append(button("Copy curl", copyCommand), start, said);
}

export function startExamples() {
  writeCommands();
  for (const view of examples()) addActions(view);
}

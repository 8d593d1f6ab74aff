// Sends an example request from the page and shows the beginning of the response.
import {sendRequest} from "../shared/api.js";
import {element} from "../shared/dom.js";
import {count} from "../shared/numbers.js";

const mostRead = 1 << 20; // bytes of a response
const mostLines = 60;
const mostText = 6000; // characters

/** Indented JSON with lists of numbers in one line. */
export const pretty = (value) =>
  JSON.stringify(value, null, 2).replace(/\[[^[\]{}]*\]/g, (list) => list.replace(/\s+/g, " "));

/** Reads at most mostRead bytes: {text, bytes, whole: whether that is everything}. */
async function read(response) {
  const reader = response.body?.getReader();
  const decoder = new TextDecoder();
  let text = "";
  let bytes = 0;
  while (reader && bytes < mostRead) {
    const {done, value} = await reader.read();
    if (done) return {text, bytes, whole: true};
    bytes += value.length;
    text += decoder.decode(value, {stream: true});
  }
  reader?.cancel().catch(() => {}); // the rest is not needed
  return {text, bytes, whole: !reader};
}

/** The first lines of a text, and the number of all lines. */
function beginning(text) {
  const lines = text.trimEnd().split("\n");
  const first = lines.slice(0, mostLines).join("\n");
  const cut = lines.length > mostLines || first.length > mostText;
  return {first: first.slice(0, mostText) + (cut ? " …" : ""), cut, lines: lines.length};
}

function readable(text, response, whole) {
  const isJson = /[/+]json\b/.test(response.headers.get("Content-Type") ?? "");
  return isJson && whole && text ? pretty(JSON.parse(text)) : text;
}

const size = (bytes) => (bytes < 1000 ? `${bytes} bytes` : `${(bytes / 1000).toFixed(1)} kB`);

/** Sends a request; {ok, status, text}: summary of the response and its first lines. */
async function attempt({path, type, body}, signal) {
  const began = performance.now();
  const sent = body && {
    method: "POST",
    headers: {"Content-Type": type},
    body: JSON.stringify(body),
  };
  const response = await sendRequest(path, {...sent, signal});
  const {text, bytes, whole} = await read(response);
  const took = Math.round(performance.now() - began);
  const {first, cut, lines} = beginning(readable(text, response, whole));
  const status = [`${response.status} ${response.statusText}`.trim(), `${took} ms`];
  status.push(whole ? size(bytes) : `more than ${size(bytes)}, truncated`);
  if (cut) status.push(`the first of ${count(lines, "line")}`);
  return {ok: response.ok, status: status.join(" · "), text: first};
}

/** Adds a "Try it" button to an example's actions; returns the nodes that show the response. */
export function tryIt(request, actions) {
  const button = element("button", {type: "button", textContent: "Try it"});
  const status = element("p", {className: "message", role: "status"});
  const shown = element("pre", {className: "answer", tabIndex: 0, hidden: true});
  shown.setAttribute("role", "group");
  shown.setAttribute("aria-label", "Response");
  const show = ({ok, status: words, text}) => {
    status.className = ok ? "message" : "message fault";
    status.textContent = words;
    shown.textContent = text;
    shown.hidden = !text;
  };
  let running = null;
  button.addEventListener("click", async () => {
    if (running) return running.abort();
    running = new AbortController();
    button.textContent = "Stop";
    status.textContent = "…";
    const {signal} = running;
    await attempt(request, signal)
      .catch((error) => ({status: signal.aborted ? "stopped" : error.message, text: ""}))
      .then(show);
    button.textContent = "Try it";
    running = null;
  });
  actions.append(button);
  return [status, shown];
}

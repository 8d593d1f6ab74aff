// Sends an example request from the page and shows the beginning of the response.
import {sendRequest} from "../shared/api.js";
import {element} from "../shared/dom.js";
import {count} from "../shared/numbers.js";

const maxBytes = 1 << 20; // of a response that is shown completely
const maxLines = 60;
const maxCharacters = 6000;

/** Indented JSON with innermost lists on one line. */
export const pretty = (value) =>
  JSON.stringify(value, null, 2).replace(/\[[^[\]{}]*\]/g, (list) => list.replace(/\s+/g, " "));

/** Reads until the body ends or exceeds maxBytes: {text, bytes, complete: the body ended}. */
async function read(response) {
  const reader = response.body?.getReader();
  const decoder = new TextDecoder();
  let text = "";
  let bytes = 0;
  while (reader && bytes <= maxBytes) {
    const {done, value} = await reader.read();
    if (done) return {text, bytes, complete: true};
    bytes += value.length;
    text += decoder.decode(value, {stream: true});
  }
  reader?.cancel().catch(() => {}); // the rest is not needed
  return {text, bytes, complete: !reader};
}

/** The first lines of a text, and the number of lines in the text. */
function beginning(text) {
  const lines = text.trimEnd().split("\n");
  const first = lines.slice(0, maxLines).join("\n");
  const cut = lines.length > maxLines || first.length > maxCharacters;
  return {first: first.slice(0, maxCharacters) + (cut ? " …" : ""), cut, lines: lines.length};
}

/** Indents complete JSON; other text is unchanged. */
function readable(text, response, complete) {
  const isJson = /[/+]json\b/.test(response.headers.get("Content-Type") ?? "");
  return isJson && complete && text ? pretty(JSON.parse(text)) : text;
}

const size = (bytes) => (bytes < 1000 ? `${bytes} bytes` : `${(bytes / 1000).toFixed(1)} kB`);

/**
 * Sends a request, by GET if `body` is undefined. Resolves to {ok, status, text}: summary of the
 * response and its first lines.
 */
async function send({path, type, body}, signal) {
  const began = performance.now();
  const options = body && {
    method: "POST",
    headers: {"Content-Type": type},
    body: JSON.stringify(body),
  };
  const response = await sendRequest(path, {...options, signal});
  const {text, bytes, complete} = await read(response);
  const took = Math.round(performance.now() - began);
  const {first, cut, lines} = beginning(readable(text, response, complete));
  const status = [`${response.status} ${response.statusText}`.trim(), `${took} ms`];
  status.push(complete ? size(bytes) : `more than ${size(bytes)}, truncated`);
  if (cut) status.push(complete ? `beginning of ${count(lines, "line")}` : "beginning");
  return {ok: response.ok, status: status.join(" · "), text: first};
}

/**
 * Adds a "Try it" button to an example's actions; returns the nodes that show the response.
 * answered: called after each response.
 */
export function tryIt(request, actions, answered) {
  const button = element("button", {type: "button", textContent: "Try it"});
  const status = element("p", {className: "message", role: "status"});
  const responseText = element("pre", {className: "answer", tabIndex: 0, hidden: true});
  responseText.setAttribute("role", "group");
  responseText.setAttribute("aria-label", "Response");
  const show = ({ok, status: words, text}) => {
    status.className = ok ? "message" : "message fault";
    status.textContent = words;
    responseText.textContent = text;
    responseText.hidden = !text;
  };
  let running = null;
  button.addEventListener("click", async () => {
    if (running) return running.abort();
    running = new AbortController();
    button.textContent = "Stop";
    status.textContent = "…";
    const {signal} = running;
    await send(request, signal)
      .catch((error) => ({status: signal.aborted ? "stopped" : error.message, text: ""}))
      .then(show)
      .then(answered);
    button.textContent = "Try it";
    running = null;
  });
  actions.append(button);
  return [status, responseText];
}

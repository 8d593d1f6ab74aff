// Calls to the service. Routes are relative to the page, so they also work below a path prefix.
import {$} from "./dom.js";

/** A problem document (RFC 9457). errors: {pointer, value, range, detail} per invalid field. */
class Problem extends Error {
  constructor({detail, title, status, errors = []}) {
    super(detail ?? title);
    Object.assign(this, {status, errors});
  }
}

/** A temporary failure: the same request can succeed later. */
export class TemporaryError extends Error {}

async function read(response) {
  const noJson = {title: `the server answered ${response.status} without JSON`};
  const body = await response.json().catch(() => null);
  if (!response.ok) throw new Problem({status: response.status, ...(body ?? noJson)});
  if (body === null) throw new TemporaryError("the response was cut off");
  return body;
}

// The key is kept until the browser tab is closed or, without permission to store, the page left.
const keyName = "vines-api-key";
const store = storeOfTab();

function storeOfTab() {
  try {
    return sessionStorage;
  } catch {
    const kept = new Map();
    return {getItem: (name) => kept.get(name) ?? null, setItem: kept.set.bind(kept)};
  }
}

const currentKey = () => store.getItem(keyName);

export const hasKey = () => currentKey() !== null;

/**
 * Prompts for a key after a 401 response, in one dialog for all waiting requests. Resolves to
 * whether one was entered.
 */
async function askForKey() {
  const dialog = $("key");
  $("key-rejected").hidden = !hasKey();
  dialog.returnValue = "";
  dialog.showModal();
  await new Promise((resolve) => dialog.addEventListener("close", resolve, {once: true}));
  const entered = dialog.returnValue !== ""; // the form was valid
  if (entered) store.setItem(keyName, $("key-text").value.trim());
  return entered;
}

/** Sends a request and returns its response. Asks for an API key while the service answers 401. */
export async function sendRequest(path, options = {}) {
  let sent = null; // the first response can be preloaded, without a key
  for (;;) {
    const response = await fetchWithKey(path, options);
    // A key typed for another request in the meantime is tried before asking again.
    const isFinal = response.status !== 401 || (currentKey() === sent && !(await askForKey()));
    if (isFinal) return response;
    sent = currentKey();
  }
}

/** Throws TemporaryError without a response, also if `options.signal` aborts the request. */
async function fetchWithKey(path, options) {
  const key = hasKey() && {Authorization: `Bearer ${currentKey()}`};
  try {
    return await fetch(path, {...options, headers: {...options.headers, ...key}});
  } catch {
    throw new TemporaryError("the server does not answer");
  }
}

export const get = async (path) => read(await sendRequest(path));

export const post = (path, body, signal, type = "application/json") =>
  sendRequest(path, {method: "POST", headers: {"Content-Type": type}, body, signal});

const postingJson = (path) => async (fields, signal) =>
  read(await post(path, JSON.stringify(fields), signal));

export const simulate = postingJson("v1/simulate");

/** Identifies parameters from a record: `query` holds the fields, `record` is a CSV file. */
export const identify = async (query, record, signal) =>
  read(await post(`v1/identify?${query}`, record, signal, "text/csv"));

export const identifyJson = postingJson("v1/identify");

/** Posts a request and yields its jsonLines. Throws what a line of type "error" reports. */
export async function* linesOf(path, request, signal) {
  const response = await post(path, JSON.stringify(request), signal);
  if (!response.ok) await read(response);
  for await (const line of jsonLines(response.body)) {
    if (line.value.type === "error") throw new Problem(line.value);
    yield line;
  }
}

const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;
export const absoluteUrl = (path) => new URL(path, location.href.split("?")[0]).href;

/** A curl command that posts `body` as JSON, or the file of a name; a GET without both. */
export function asCurl({path, body, file, type}, flags = "-s") {
  const url = absoluteUrl(path);
  if (body) return `curl ${flags} ${url} -d ${quoted(JSON.stringify(body))}`;
  if (!file) return `curl ${flags} ${quoted(url)}`;
  const address = path.includes("?") ? quoted(url) : url;
  return `curl ${flags} ${address} -H 'Content-Type: ${type}' --data-binary ${quoted(`@${file}`)}`;
}

/** Yields {text, value} of each complete line. Throws TemporaryError if the stream breaks. */
async function* jsonLines(stream) {
  const reader = stream.pipeThrough(new TextDecoderStream()).getReader();
  let partial = "";
  try {
    for (;;) {
      const {done, value = ""} = await reader.read().catch(() => {
        throw new TemporaryError("the response was cut off");
      });
      const texts = `${partial}${value}`.split("\n");
      partial = texts.pop();
      for (const text of texts) if (text) yield {text, value: JSON.parse(text)};
      if (done) return; // a last line without a line end is incomplete and dropped
    }
  } finally {
    reader.cancel().catch(() => {});
  }
}

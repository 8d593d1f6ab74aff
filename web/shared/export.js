// Saving files, copying texts, and a request in forms to be pasted elsewhere.

import {absoluteUrl, asCurl} from "./api.js";
import {element} from "./dom.js";

/** Saves a blob under a file name. */
export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Copies a text and reports it; without permission to copy, shows the text. */
export async function copy(text, say) {
  try {
    await navigator.clipboard.writeText(text);
    say("copied");
  } catch {
    say(text);
  }
}

/** A Python program for the request that needs only the standard library. */
const asPython = (path, fields) => `import json, urllib.request

request = json.loads(${JSON.stringify(JSON.stringify(fields))})
url = ${JSON.stringify(absoluteUrl(path))}
body = json.dumps(request).encode()
head = {"Content-Type": "application/json"}
with urllib.request.urlopen(urllib.request.Request(url, body, head)) as answer:
    result = json.load(answer)
print(result["exponents"].get("qr", {}).get("final"), result["regime"]["type"])
`;

/** A frame for another page, of a site that the service allows to embed it. */
function asFrame() {
  const address = new URL(location.href);
  address.searchParams.set("embed", "1");
  address.hash = "";
  return `<iframe src="${address}" width="800" height="600" allow="autoplay"></iframe>`;
}

/** Functions that return the text, by form. request() returns the fields of the request. */
export const formsOf = (path, request) => ({
  link: () => location.href,
  embed: asFrame,
  curl: () => asCurl({path, body: request()}),
  Python: () => asPython(path, {...request(), include: ["impacts", "exponents", "regime"]}),
  JSON: () => JSON.stringify(request(), null, 2),
});

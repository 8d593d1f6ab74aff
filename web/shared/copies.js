// A request in the forms one pastes elsewhere.
import {asCurl, whole} from "./api.js";

/** A request as a Python program that needs nothing but Python. */
const asPython = (path, fields) => `import json, urllib.request

request = json.loads(${JSON.stringify(JSON.stringify(fields))})
url = ${JSON.stringify(whole(path))}
body = json.dumps(request).encode()
head = {"Content-Type": "application/json"}
with urllib.request.urlopen(urllib.request.Request(url, body, head)) as answer:
    result = json.load(answer)
print(result["exponents"].get("qr", {}).get("final"), result["regime"]["type"])
`;

/** forms by name: each a function that makes the text. request(): the fields of a route. */
export const formsOf = (path, request) => ({
  link: () => location.href,
  curl: () => asCurl(path, request()),
  Python: () => asPython(path, {...request(), include: ["impacts", "exponents", "regime"]}),
  JSON: () => JSON.stringify(request(), null, 2),
});

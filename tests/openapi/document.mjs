// The OpenAPI document of a running service, and the validation of responses against it.
import assert from "node:assert/strict";
import {createRequire} from "node:module";

export const require = createRequire(new URL("../../web/package.json", import.meta.url));
const Ajv = require("ajv/dist/2020").default;

export class Document {
  constructor(json) {
    this.json = json;
    // Not strict: the document as a whole is not a schema, it only contains schemas.
    this.ajv = new Ajv({strict: false}).addSchema(json, "document");
  }

  static async of(url) {
    return new Document(await (await fetch(`${url}/v1/openapi.json`)).json());
  }

  /** The value to which a reference points; any other value itself. */
  resolved(value) {
    if (!value?.$ref) return value;
    const path = value.$ref.slice(2).split("/");
    return path.reduce((at, name) => at[name], this.json);
  }

  /** Why a value does not match a schema of the components; empty if it does. */
  faults(name, value) {
    const valid = this.ajv.getSchema(`document#/components/schemas/${name}`);
    return valid(value) ? "" : this.ajv.errorsText(valid.errors);
  }

  holds(name, value, what) {
    assert.equal(this.faults(name, value), "", what);
  }

  /** Fails unless the document describes the response of this operation: status, headers, body. */
  check(answer, path, method, what = `${method} ${path}`) {
    const operation = this.json.paths[path][method.toLowerCase()];
    const response = this.resolved(operation.responses[answer.status]);
    assert.ok(response, `${what}: ${answer.status} is in the document`);
    for (const name of Object.keys(response.headers ?? {}))
      assert.ok(answer.headers.has(name), `${what}: ${name}`);
    if (answer.status === 304) return;
    const type = answer.headers.get("content-type");
    assert.ok(type in response.content, `${what}: ${type}`);
    const {schema} = response.content[type];
    if (!schema.$ref) return;
    const name = schema.$ref.split("/").at(-1);
    const texts = type.includes("ndjson") ? answer.text.trim().split("\n") : [answer.text];
    for (const text of texts) this.holds(name, JSON.parse(text), `${what}: ${text.slice(0, 200)}`);
  }
}

/** Sends a request and returns {status, headers, text} of the response. */
export async function ask(url, path, {body, type = "application/json", method, headers = {}} = {}) {
  const text = body === undefined || typeof body === "string" ? body : JSON.stringify(body);
  const post = {method: "POST", body: text, headers: {"Content-Type": type, ...headers}};
  const response = await fetch(url + path, text === undefined ? {method, headers} : post);
  return {status: response.status, headers: response.headers, text: await response.text()};
}

/** {status, headers, text} of a response read from a socket. */
export function parsed(bytes) {
  const [head, ...rest] = bytes.split("\r\n\r\n");
  const [line, ...lines] = head.split("\r\n");
  const headers = new Headers(lines.map((l) => [l.split(": ")[0], l.slice(l.indexOf(": ") + 2)]));
  return {status: Number(line.split(" ")[1]), headers, text: rest.join("\r\n\r\n")};
}

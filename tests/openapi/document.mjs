// The OpenAPI document of a running service, and answers held against it.
import assert from "node:assert/strict";
import {createRequire} from "node:module";

export const require = createRequire(new URL("../../web/package.json", import.meta.url));
const Ajv = require("ajv/dist/2020").default;

export class Document {
  constructor(json) {
    this.json = json;
    // An OpenAPI document is no schema, but holds some.
    this.ajv = new Ajv({strict: false}).addSchema(json, "document");
  }

  static async of(url) {
    return new Document(await (await fetch(`${url}/v1/openapi.json`)).json());
  }

  /** What a reference stands for. */
  resolved(value) {
    if (!value?.$ref) return value;
    const path = value.$ref.slice(2).split("/");
    return path.reduce((at, name) => at[name], this.json);
  }

  /** Why a value is none of a schema among the components; empty: it is one. */
  faults(name, value) {
    const valid = this.ajv.getSchema(`document#/components/schemas/${name}`);
    return valid(value) ? "" : this.ajv.errorsText(valid.errors);
  }

  holds(name, value, what) {
    assert.equal(this.faults(name, value), "", what);
  }

  /** Fails unless an answer is one that the document has for this operation. */
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

/** {status, headers, text} of an answer. */
export async function ask(url, path, {body, type = "application/json", method, headers = {}} = {}) {
  const text = body === undefined || typeof body === "string" ? body : JSON.stringify(body);
  const post = {method: "POST", body: text, headers: {"Content-Type": type, ...headers}};
  const response = await fetch(url + path, text === undefined ? {method, headers} : post);
  return {status: response.status, headers: response.headers, text: await response.text()};
}

/** The same of what came over a socket. */
export function parsed(bytes) {
  const [head, ...rest] = bytes.split("\r\n\r\n");
  const [line, ...lines] = head.split("\r\n");
  const headers = new Headers(lines.map((l) => [l.split(": ")[0], l.slice(l.indexOf(": ") + 2)]));
  return {status: Number(line.split(" ")[1]), headers, text: rest.join("\r\n\r\n")};
}

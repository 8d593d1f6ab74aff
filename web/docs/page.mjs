// The page /docs, made from the OpenAPI document at build time.
import {count} from "../shared/numbers.js";
import {commandOf, pretty} from "./example.js";
import * as doc from "./schema.mjs";
import {fieldTable, fold, html, schemaView, typeWords} from "./schema.mjs";

// Address of the service in the examples until example.js replaces it.
globalThis.location = {href: "http://127.0.0.1:8080/docs"};

const link = (place, text) => html`<a href="#${place}">${text}</a>`;

/** Version, server and key. docs.js fills in the address and the commit. */
function about() {
  const {info, servers, components} = doc.root;
  const [{url, description}] = servers;
  const {description: key} = components.securitySchemes.api_key;
  return Object.entries({
    Version: info.version,
    Commit: html`<span id="docs-commit">unknown</span>`,
    Server: html`<code id="docs-address">${url}</code>, ${description}`,
    Key: html`${key}: <code>Authorization: Bearer KEY</code>`,
  }).map(([name, words]) => html`<dt>${name}</dt><dd>${words}</dd>`);
}

/** The end of a fold; a link to its id opens it, as the id is inside. */
const inFold = (id, content) => html`<div id="${id}">${content}</div></details>`;

const operationsView = () =>
  doc.tags().map(({name, description, operations}) => {
    const id = `docs-tag-${name}`;
    const title = html`<h2 id="${id}">${name} <small>${description}</small></h2>`;
    return html`<section aria-labelledby="${id}">${title}${operations.map(operationView)}</section>`;
  });

/** The schemas, each with its description and its fields. */
const schemasView = () =>
  doc.schemas().map(([name, schema]) => {
    const id = doc.schemaPlace(name);
    const {properties, description} = doc.resolved(schema);
    const fields = properties ? count(Object.keys(properties).length, "field") : "one of several";
    const said = description ? html`<p>${description}</p>` : "";
    const title = html`<summary><h3>${name} <small>${fields}</small></h3></summary>`;
    return [html`<details>${title}`, inFold(id, [said, schemaView(schema, id)])];
  });

function contents() {
  const entry = (path, operations) => {
    const own = operations.filter((operation) => operation.path === path);
    const links = own.map(({operationId, method}) => [link(operationId, method), " "]);
    return html`<li><code>${path}</code> ${links}</li>`;
  };
  const names = doc.schemas().map(([name]) => html`<li>${link(doc.schemaPlace(name), name)}</li>`);
  return [
    doc.tags().map(({name, operations}) => {
      const paths = [...new Set(operations.map(({path}) => path))];
      return html`<h2>${name}</h2><ul>${paths.map((path) => entry(path, operations))}</ul>`;
    }),
    html`<h2>schemas</h2>`,
    fold(count(names.length, "schema"), html`<ul>${names}</ul>`),
  ];
}

/** Fills the {{names}} of a template. file: the OpenAPI document. */
export function docsPage(template, file) {
  doc.load(file);
  const {title, version, summary, description} = doc.root.info;
  const parts = {
    version: `${title} ${version}`,
    contents: contents(),
    summary,
    description,
    about: about(),
    operations: operationsView(),
    schemas: schemasView(),
  };
  return template.replace(/\{\{(\w+)\}\}/g, (_, name) => html`${parts[name]}`);
}

// One operation: examples, request and responses.
const titled = (title, nodes) => (nodes.length ? [html`<h4>${title}</h4>`, nodes] : []);

/** Parameters, in a table for each part of the request. */
const parametersView = ({operationId, parameters}) =>
  ["Query", "Header"].flatMap((title) => {
    const fields = parameters.filter((parameter) => parameter.in === title.toLowerCase());
    return fields.length ? [fieldTable(fields, operationId, title)] : [];
  });

/** Media types with their schemas. open: fields are visible; otherwise folded, with the example. */
const contentView = (content = {}, open = false) =>
  Object.entries(content).flatMap(([type, {schema = {}, example}]) => {
    const description = schema.description ? `: ${schema.description}` : "";
    const nodes = [html`<p><code>${type}</code> ${typeWords(schema)}${description}</p>`];
    if (schema.$ref && open) nodes.push(schemaView(schema, null));
    if (!open && example !== undefined)
      nodes.push(fold("Example", html`<pre><code>${pretty(example)}</code></pre>`));
    return nodes;
  });

/** Responses; those that are no success in a fold. */
function answersView({responses}) {
  const all = Object.entries(responses);
  const isSuccess = ([status]) => status.startsWith("2");
  const others = all.filter((one) => !isSuccess(one));
  const view = ([status, answer]) => {
    const {description, content, headers = {}} = doc.resolved(answer);
    const fields = Object.entries(headers).map(([name, one]) => ({name, ...doc.resolved(one)}));
    const folded = fields.length ? fold("Headers", fieldTable(fields, null)) : [];
    return [html`<p><code>${status}</code> ${description}</p>`, contentView(content), folded];
  };
  const title = html`Other statuses <small>${others.map(([status]) => status).join(" ")}</small>`;
  return [all.filter(isSuccess).map(view), others.length ? fold(title, others.map(view)) : []];
}

/** A query of the parameters with examples. */
function exampleQuery(parameters) {
  const written = parameters
    .filter((parameter) => parameter.in === "query" && "example" in parameter)
    .map(({name, example}) => `${name}=${[example].flat().map(encodeURIComponent).join()}`);
  return written.length ? `?${written.join("&")}` : "";
}

/** Requests {path, body, file, type, summary, streams, keyless}; a page cannot send a file. */
function requestsOf({method, path, parameters, requestBody, security, responses}) {
  const common = {
    path: path.slice(1),
    streams: "application/x-ndjson" in (responses[200].content ?? {}),
    keyless: security?.length === 0,
  };
  if (method === "GET") return [{...common, path: common.path + exampleQuery(parameters)}];
  return Object.entries(requestBody.content).flatMap(([type, {examples}]) =>
    examples
      ? Object.values(examples).map(({summary, value}) => ({...common, type, summary, body: value}))
      : [{...common, type, file: "FILE", summary: `a file of ${type}`}],
  );
}

/** An example; example.js adds the buttons. */
function exampleView({summary, ...request}) {
  const said = summary ? html`<p>${summary}</p>` : "";
  const command = html`<pre><code>${commandOf(request)}</code></pre><p class="actions"></p>`;
  const status = html`<p class="message" role="status"></p>`;
  const answer = html`<pre class="answer" tabindex="0" role="group" aria-label="Response" hidden></pre>`;
  return [
    html`<div class="example" data-request="${JSON.stringify(request)}">${said}${command}`,
    html`${status}${answer}</div>`,
  ];
}

function inside(operation) {
  const {description, requestBody = {}, security} = operation;
  const keyless = security?.length === 0 ? " No key is needed." : "";
  return [
    html`<p>${description + keyless}</p>`,
    titled("Examples", requestsOf(operation).map(exampleView)),
    titled("Request", [...parametersView(operation), ...contentView(requestBody.content, true)]),
    titled("Responses", answersView(operation)),
  ];
}

function operationView(operation) {
  const {operationId, method, path, summary} = operation;
  const verb = html`<span class="method ${method.toLowerCase()}">${method}</span>`;
  const title = html`<h3>${verb} <code>${path}</code> <small>${summary}</small></h3>`;
  const begin = html`<details class="operation"><summary>${title}</summary>`;
  return [begin, inFold(operationId, inside(operation))];
}

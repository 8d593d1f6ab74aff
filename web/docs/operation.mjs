// One operation: examples, request and responses.
import {nameOf, resolved, responsePlace} from "./document.mjs";
import {commandOf, pretty} from "./example.js";
import {copyFold, fold, html} from "./markup.mjs";
import {fieldsFold, fieldTable, schemaView, typeWords} from "./schema.mjs";

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
    if (schema.$ref)
      nodes.push(open ? schemaView(schema, null) : fieldsFold("Fields", schema.$ref));
    if (!open && example !== undefined)
      nodes.push(fold("Example", html`<pre><code>${pretty(example)}</code></pre>`));
    return nodes;
  });

const statusWords = (status, answer) => [
  html`<code>${status}</code> `,
  resolved(answer).description,
];

export function answerView(answer) {
  const {content, headers = {}} = resolved(answer);
  const fields = Object.entries(headers).map(([name, header]) => ({name, ...resolved(header)}));
  return [contentView(content), fields.length ? fold("Headers", fieldTable(fields, null)) : []];
}

/** Responses; those that are no success are folded to a line each. Operations share components. */
function answersView({responses}) {
  const all = Object.entries(responses);
  const isSuccess = ([status]) => status.startsWith("2");
  const others = all.filter((one) => !isSuccess(one));
  const statuses = others.map(([status]) => status).join(" ");
  const success = ([status, answer]) => [
    html`<p>${statusWords(status, answer)}</p>`,
    answerView(answer),
  ];
  const folded = ([status, answer]) => {
    const words = statusWords(status, answer);
    if (answer.$ref) return copyFold(words, responsePlace(nameOf(answer.$ref)));
    return fold(words, answerView(answer));
  };
  const title = html`Other statuses <small>${statuses}</small>`;
  const rest = others.length ? fold(title, others.map(folded)) : [];
  return [all.filter(isSuccess).map(success), rest];
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
  return html`<div class="example" data-request="${JSON.stringify(request)}">${said}${command}</div>`;
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

export function operationView(operation) {
  const {operationId, method, path, summary} = operation;
  const verb = html`<span class="method ${method.toLowerCase()}">${method}</span>`;
  const title = html`<h3>${verb} <code>${path}</code> <small>${summary}</small></h3>`;
  const begin = html`<details id="${operationId}" class="operation"><summary>${title}</summary>`;
  return [begin, inside(operation), html`</details>`];
}

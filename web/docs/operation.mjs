// One operation: examples, request and responses.
import {pretty} from "./attempt.js";
import {nameOf, resolved, responsePlace} from "./document.mjs";
import {commandOf} from "./example.js";
import {code, copyFold, element, fold, small} from "./markup.mjs";
import {fieldsFold, fieldTable, schemaView, typeWords} from "./schema.mjs";

const titled = (title, nodes) => (nodes.length ? [element("h4", {}, title), ...nodes] : []);
const places = {query: "Query", header: "Header", path: "Path", cookie: "Cookie"};

/** Parameters, in a table for each part of the request. */
function parametersView({id, parameters}) {
  return Object.entries(places).flatMap(([where, title]) => {
    const fields = parameters.filter((parameter) => parameter.in === where);
    return fields.length ? [fieldTable(fields, id, title)] : [];
  });
}

/** A media type with its schema. open: fields are visible; otherwise folded, with the example. */
function mediaView(type, {schema = {}, example}, open) {
  const description = schema.description ? `: ${schema.description}` : "";
  const nodes = [element("p", {}, code(type), " ", ...typeWords(schema), description)];
  if (open && schema.$ref) nodes.push(...schemaView(schema, null));
  if (!open && schema.$ref) nodes.push(fieldsFold(["Fields"], schema.$ref));
  if (!open && example !== undefined)
    nodes.push(fold(["Example"], [element("pre", {}, code(pretty(example)))]));
  return nodes;
}

const contentView = (content, open) =>
  Object.entries(content ?? {}).flatMap(([type, media]) => mediaView(type, media, open));

function headersView(headers = {}) {
  const fields = Object.entries(headers).map(([name, header]) => ({name, ...resolved(header)}));
  return fields.length ? [fold(["Headers"], [fieldTable(fields, null)])] : [];
}

const statusWords = (status, {description}) => [code(status), " ", description];
export const answerView = ({content, headers}) => [
  ...contentView(content),
  ...headersView(headers),
];

/** Other statuses, each folded to a line. Operations share them: components, which are on the page once. */
function refusalsView(answers) {
  if (!answers.length) return [];
  const views = answers.map(([status, answer]) => {
    const words = statusWords(status, resolved(answer));
    return answer.$ref
      ? copyFold(words, responsePlace(nameOf(answer.$ref)))
      : fold(words, answerView(answer));
  });
  const statuses = answers.map(([status]) => status).join(" ");
  return [fold(["Other statuses ", small(statuses)], views)];
}

function answersView({responses}) {
  const all = Object.entries(responses);
  const isAnswer = ([status]) => status.startsWith("2");
  return [
    ...all
      .filter(isAnswer)
      .map(([status, answer]) => [status, resolved(answer)])
      .flatMap(([status, answer]) => [
        element("p", {}, ...statusWords(status, answer)),
        ...answerView(answer),
      ]),
    ...refusalsView(all.filter((one) => !isAnswer(one))),
  ];
}

/** A query of the parameters with examples. */
function exampleQuery(parameters) {
  const given = parameters.filter(
    (parameter) => parameter.in === "query" && "example" in parameter,
  );
  const written = given.map(
    ({name, example}) => `${name}=${[example].flat().map(encodeURIComponent).join()}`,
  );
  return written.length ? `?${written.join("&")}` : "";
}

/**
 * Requests {path, body, file, type, summary, streams, keyless}; those with a file cannot be sent
 * from the page.
 */
function requestsOf({method, path, parameters, body, security, responses}) {
  const common = {
    path: path.slice(1),
    streams: Object.keys(responses[200]?.content ?? {}).includes("application/x-ndjson"),
    keyless: security?.length === 0,
  };
  if (method === "GET") return [{...common, path: common.path + exampleQuery(parameters)}];
  return Object.entries(body).flatMap(([type, {examples, example}]) => {
    const given = Object.values(examples ?? (example ? [{value: example}] : []));
    if (!given.length) return [{...common, type, file: "FILE", summary: `a file of ${type}`}];
    return given.map(({summary, value}) => ({...common, type, summary, body: value}));
  });
}

/** An example; example.js adds the buttons. */
function exampleView({summary, ...request}) {
  const said = summary ? [element("p", {}, summary)] : [];
  const command = element("pre", {}, code(commandOf(request)));
  const actions = element("p", {class: "actions"});
  const attributes = {class: "example", "data-request": JSON.stringify(request)};
  return element("div", attributes, ...said, command, actions);
}

function inside(operation) {
  const {description = "", body, security} = operation;
  const keyless = security?.length === 0 ? " No key is needed." : "";
  return [
    element("p", {}, description + keyless),
    ...titled("Examples", requestsOf(operation).map(exampleView)),
    ...titled("Request", [...parametersView(operation), ...contentView(body, true)]),
    ...titled("Responses", answersView(operation)),
  ];
}

export function operationView(operation) {
  const {id, method, path, summary = ""} = operation;
  const verb = element("span", {class: `method ${method.toLowerCase()}`}, method);
  const title = element("h3", {}, verb, " ", code(path), " ", small(summary));
  return fold([title], inside(operation), {id, class: "operation"});
}

// One operation: examples, request and responses.
import {element} from "../shared/dom.js";
import {pretty} from "./attempt.js";
import {resolved} from "./document.js";
import {examplesView} from "./example.js";
import {fold} from "./fold.js";
import {code, fieldTable, schemaView, typeWords} from "./schema.js";

const titled = (title, nodes) =>
  nodes.length ? [element("h4", {textContent: title}), ...nodes] : [];
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
  const fields = () => schemaView(schema, null);
  if (open && schema.$ref) nodes.push(...fields());
  if (!open && schema.$ref) nodes.push(fold(["Fields"], fields));
  if (!open && example !== undefined)
    nodes.push(fold(["Example"], () => [element("pre", {}, code(pretty(example)))]));
  return nodes;
}

const contentView = (content, open) =>
  Object.entries(content ?? {}).flatMap(([type, media]) => mediaView(type, media, open));

function headersView(headers = {}) {
  const fields = Object.entries(headers).map(([name, header]) => ({name, ...resolved(header)}));
  return fields.length ? [fold(["Headers"], () => [fieldTable(fields, null)])] : [];
}

const statusWords = (status, {description}) => [code(status), " ", description];
const answerView = ({content, headers}) => [...contentView(content), ...headersView(headers)];

/** Other statuses, each folded to a line. */
function refusalsView(answers) {
  if (!answers.length) return [];
  const make = () =>
    answers.map(([status, answer]) => fold(statusWords(status, answer), () => answerView(answer)));
  const statuses = answers.map(([status]) => status).join(" ");
  return [fold(["Other statuses ", element("small", {textContent: statuses})], make)];
}

function answersView({responses}) {
  const all = Object.entries(responses).map(([status, answer]) => [status, resolved(answer)]);
  const isAnswer = ([status]) => status.startsWith("2");
  return [
    ...all
      .filter(isAnswer)
      .flatMap(([status, answer]) => [
        element("p", {}, ...statusWords(status, answer)),
        ...answerView(answer),
      ]),
    ...refusalsView(all.filter((one) => !isAnswer(one))),
  ];
}

function inside(operation) {
  const {description = "", body, security} = operation;
  const keyless = security?.length === 0 ? " No key is needed." : "";
  return [
    element("p", {textContent: description + keyless}),
    ...titled("Examples", examplesView(operation)),
    ...titled("Request", [...parametersView(operation), ...contentView(body, true)]),
    ...titled("Responses", answersView(operation)),
  ];
}

export function operationView(operation) {
  const {id, method, path, summary = ""} = operation;
  const verb = element("span", {className: `method ${method.toLowerCase()}`, textContent: method});
  const title = element("h3", {}, verb, " ", code(path), " ", element("small", {}, summary));
  const view = fold([title], () => inside(operation), id);
  view.id = id;
  view.className = "operation";
  return view;
}

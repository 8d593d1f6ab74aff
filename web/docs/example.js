// Examples of an operation: a curl command that can be copied, and a button that sends the request.
import {asCurl, getAsCurl, sendFileAsCurl} from "../shared/api.js";
import {element} from "../shared/dom.js";
import {copy} from "../shared/export.js";
import {hasKey} from "../shared/key.js";
import {tryIt} from "./attempt.js";

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

/** Requests {path, body, file, type, summary}; those with a file cannot be sent from the page. */
function requestsOf({method, path, parameters, body}) {
  const at = path.slice(1);
  if (method === "GET") return [{path: at + exampleQuery(parameters)}];
  return Object.entries(body).flatMap(([type, {examples, example}]) => {
    const given = Object.values(examples ?? (example ? [{value: example}] : []));
    if (!given.length) return [{path: at, type, file: "FILE", summary: `a file of ${type}`}];
    return given.map(({summary, value}) => ({path: at, type, summary, body: value}));
  });
}

/** curl flags: a key if this server required one, and no buffering for streams. */
function flags({security, responses}) {
  const streams = Object.keys(responses[200]?.content ?? {}).includes("application/x-ndjson");
  const key = hasKey() && security?.length !== 0 ? ' -H "Authorization: Bearer $KEY"' : "";
  return (streams ? "-sN" : "-s") + key;
}

function commandOf(operation, {path, body, file, type}) {
  if (file) return sendFileAsCurl(path, type, file, flags(operation));
  return body ? asCurl(path, body, flags(operation)) : getAsCurl(path, flags(operation));
}

function exampleView(operation, request) {
  const line = element("code", {textContent: commandOf(operation, request)});
  const said = element("span", {className: "note", role: "status"});
  const copied = element("button", {type: "button", textContent: "Copy curl"});
  copied.addEventListener("click", () => {
    copy(line.textContent, (text) => {
      said.textContent = text === "copied" ? text : "the browser does not allow copying";
    });
  });
  const view = element("div", {className: "example"});
  if (request.summary) view.append(element("p", {textContent: request.summary}));
  const actions = element("p", {className: "actions"}, copied);
  view.append(element("pre", {}, line), actions);
  if (!request.file) view.append(...tryIt(request, actions));
  actions.append(said);
  return view;
}

export const examplesView = (operation) =>
  requestsOf(operation).map((request) => exampleView(operation, request));

// An operation's examples: a line for a terminal each, which is copied, or sent from here.
import {asCurl, getAsCurl, sendFileAsCurl} from "../shared/api.js";
import {element} from "../shared/dom.js";
import {hasKey} from "../shared/key.js";
import {copy} from "../shared/take_away.js";
import {tryIt} from "./attempt.js";

/** The query of those parameters that have an example. */
function exampleQuery(parameters) {
  const given = parameters.filter(
    (parameter) => parameter.in === "query" && "example" in parameter,
  );
  const written = given.map(
    ({name, example}) => `${name}=${[example].flat().map(encodeURIComponent).join()}`,
  );
  return written.length ? `?${written.join("&")}` : "";
}

/** {path, body, file, type, summary}: each a request; one of a file cannot be sent from here. */
function requestsOf({method, path, parameters, body}) {
  const at = path.slice(1);
  if (method === "GET") return [{path: at + exampleQuery(parameters)}];
  return Object.entries(body).flatMap(([type, {examples, example}]) => {
    const given = Object.values(examples ?? (example ? [{value: example}] : []));
    if (!given.length) return [{path: at, type, file: "FILE", summary: `a file of ${type}`}];
    return given.map(({summary, value}) => ({path: at, type, summary, body: value}));
  });
}

/** The flags of curl: a key where this server has asked for one, and lines as they come. */
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
      said.textContent = text === "copied" ? text : "the browser does not let it be copied";
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

/** All examples of an operation. */
export const examplesView = (operation) =>
  requestsOf(operation).map((request) => exampleView(operation, request));

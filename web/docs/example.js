// Examples of an operation: a curl command that can be copied, and a button that sends the request.
import {asCurl, getAsCurl, sendFileAsCurl} from "../shared/api.js";
import {button, element} from "../shared/dom.js";
import {copy} from "../shared/export.js";
import {hasKey} from "../shared/key.js";
import {tryIt} from "./attempt.js";

/** A request as curl command, without buffering for streams. flags: further ones. */
export function commandOf({path, body, file, type, streams}, flags = "") {
  const all = (streams ? "-sN" : "-s") + flags;
  if (file) return sendFileAsCurl(path, type, file, all);
  return body ? asCurl(path, body, all) : getAsCurl(path, all);
}

const examples = () => document.querySelectorAll(".example");
const requestOf = (view) => JSON.parse(view.dataset.request);

/** Writes the commands for this service, with a key if the service required one. */
function writeCommands() {
  for (const view of examples()) {
    const request = requestOf(view);
    const key = hasKey() && !request.keyless ? ' -H "Authorization: Bearer $KEY"' : "";
    view.querySelector("code").textContent = commandOf(request, key);
  }
}

/** Adds the buttons of an example. */
function addActions(view) {
  const request = requestOf(view);
  const said = element("span", {className: "note", role: "status"});
  const copyCommand = () =>
    copy(view.querySelector("code").textContent, (text) => {
      said.textContent = text === "copied" ? text : "the browser does not allow copying";
    });
  const actions = view.querySelector(".actions");
  actions.append(button("Copy curl", copyCommand));
  if (!request.file) view.append(...tryIt(request, actions, writeCommands));
  actions.append(said);
}

export function startExamples() {
  writeCommands();
  for (const view of examples()) addActions(view);
}

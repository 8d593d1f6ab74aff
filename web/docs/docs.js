// The page /docs, made by the build (page.mjs): what depends on the service or on the visitor.
import {absoluteUrl, get} from "../shared/api.js";
import {$, element, sayIn, setTexts} from "../shared/dom.js";
import {startExamples} from "./example.js";

const setAll = (open) => {
  for (const view of document.querySelectorAll("main section > details")) view.open = open;
};

async function start() {
  $("docs-unfold").onclick = () => setAll(true);
  $("docs-fold").onclick = () => setAll(false);
  setTexts({"docs-address": absoluteUrl("./")});
  startExamples();
  $("docs-contents").open = matchMedia("(width >= 62rem)").matches;
  const {commit, compiler} = await get("version");
  const known = commit ? element("code", {}, commit) : "unknown";
  $("docs-commit").replaceChildren(known, `, ${compiler}`);
  $("docs-message").dataset.done = 1;
}

const say = sayIn("docs-message");
start().catch(({message}) => say(`The version of the server cannot be loaded: ${message}.`, true));

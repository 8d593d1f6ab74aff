// The documentation page of the HTTP interface. The build makes its HTML (page.mjs); this script
// adds what depends on the service or on the visitor.
import {absoluteUrl, get} from "../shared/api.js";
import {$, element, sayIn, setTexts} from "../shared/dom.js";
import {startExamples} from "./example.js";
import {startFinder} from "./finder.js";

/** Opens and focuses the element whose id is the fragment `hash` ("#id"), and scrolls to it. */
function reveal(hash) {
  const found = $(hash.slice(1));
  if (!found) return;
  for (let at = found.closest("details"); at; at = at.parentElement.closest("details"))
    at.open = true;
  const focused = found.tagName === "DETAILS" ? found.firstChild : found;
  if (focused === found) found.tabIndex = -1;
  focused.focus({preventScroll: true});
  found.scrollIntoView({block: focused === found ? "center" : "start"});
}

/** Fills a fold with a copy of the fields of a schema or of the content of a template. */
function fill(fold) {
  const source = $(fold.dataset.copy);
  const copy = (source.content ?? source.lastElementChild).cloneNode(true);
  for (const node of copy.querySelectorAll("[id]")) node.removeAttribute("id");
  fold.append(...copy.childNodes);
  delete fold.dataset.copy;
}

const setAll = (open) => {
  for (const view of document.querySelectorAll("main section > details")) view.open = open;
};

function listen() {
  $("docs-unfold").onclick = () => setAll(true);
  $("docs-fold").onclick = () => setAll(false);
  addEventListener("hashchange", () => reveal(location.hash));
  // A click on the current hash fires no hashchange event.
  document.addEventListener("click", ({target}) => {
    const {hash} = target.closest("a[href^='#']") ?? {};
    if (hash && hash === location.hash) reveal(hash);
  });
  // The event does not bubble.
  document.addEventListener("toggle", ({target}) => target.dataset.copy && fill(target), true);
}

/** Resolves when the browser has gone to the address's fragment itself, which takes the focus away. */
const loaded = new Promise((resolve) => addEventListener("load", resolve));

async function start() {
  listen();
  setTexts({"docs-address": absoluteUrl("./")});
  startExamples();
  startFinder();
  $("docs-contents").open = matchMedia("(min-width: 1001px)").matches;
  await loaded;
  reveal(location.hash);
  const {commit, compiler} = await get("version");
  const known = commit ? element("code", {}, commit) : "unknown";
  $("docs-commit").replaceChildren(known, `, ${compiler}`);
  $("docs-message").dataset.done = 1;
}

const say = sayIn("docs-message");
start().catch(({message}) => say(`The version of the server cannot be loaded: ${message}.`, true));

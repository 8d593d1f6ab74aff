// The documentation page of the HTTP interface. The build makes its HTML (page.mjs); this script
// adds what depends on the service or on the visitor.
import {absoluteUrl, get} from "../shared/api.js";
import {$, element} from "../shared/dom.js";
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
  $("docs-unfold").addEventListener("click", () => setAll(true));
  $("docs-fold").addEventListener("click", () => setAll(false));
  addEventListener("hashchange", () => reveal(location.hash));
  // A click on the current hash fires no hashchange event.
  document.addEventListener("click", ({target}) => {
    const {hash} = target.closest("a[href^='#']") ?? {};
    if (hash && hash === location.hash) reveal(hash);
  });
  // The event does not bubble.
  document.addEventListener("toggle", ({target}) => target.dataset.copy && fill(target), true);
}

/** Addresses of the server; the document can give a relative one. */
function showAddresses() {
  for (const node of document.querySelectorAll("[data-address]")) {
    const {address} = node.dataset;
    node.textContent = address.startsWith("/") ? absoluteUrl(`.${address}`) : address;
  }
}

async function showCommit() {
  const {commit, compiler} = await get("version");
  const known = commit ? element("code", {textContent: commit}) : "unknown";
  $("docs-commit").replaceChildren(known, `, ${compiler}`);
}

/** Resolves when the browser has gone to the address's fragment itself, which takes the focus away. */
const loaded = new Promise((resolve) => addEventListener("load", resolve));

async function start() {
  listen();
  showAddresses();
  startExamples();
  startFinder();
  $("docs-contents").open = matchMedia("(min-width: 1001px)").matches;
  await loaded;
  reveal(location.hash);
  await showCommit();
  $("docs-message").dataset.done = 1;
}

start().catch((error) => {
  $("docs-message").textContent = `The version of the server cannot be loaded: ${error.message}.`;
  $("docs-message").classList.add("fault");
});

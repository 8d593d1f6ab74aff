// The page /docs, made by the build (page.mjs): what depends on the service or on the visitor.
import {absoluteUrl, get} from "../shared/api.js";
import {$, element, sayIn, setTexts} from "../shared/dom.js";
import {count} from "../shared/numbers.js";
import {startExamples} from "./example.js";

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

/** Fills a fold with a copy of the fields of a schema. */
function fill(fold) {
  const copy = $(fold.dataset.copy).lastElementChild.cloneNode(true);
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

// Search for fields by name: table rows with an id such as schema-Energy.without_absorber.rms.
const most = 40; // names listed

/** The operation or object of a field: GET /v1/simulate, or Energy.without_absorber. */
function ownerOf(row) {
  const operation = row.closest(".operation");
  if (operation) {
    const [method, path] = operation.querySelectorAll(".method, h3 code");
    return `${method.textContent}\u00a0${path.textContent}`;
  }
  const names = row.id.slice(0, row.id.lastIndexOf(".")).replace("schema-", "");
  return names.replace(/\/\d+/g, ""); // a digit tells several parts of one field apart
}

/** [name, rows] for names that contain a text: exact matches, then prefixes, then others. */
function find(rows, wanted) {
  const named = Map.groupBy(rows, (row) => row.querySelector("code").textContent);
  const order = [
    (name) => name === wanted,
    (name) => name.startsWith(wanted),
    (name) => name.includes(wanted),
  ];
  const rank = ([name]) => order.findIndex((is) => is(name.toLowerCase()));
  return [...named].filter((one) => rank(one) >= 0).sort((a, b) => rank(a) - rank(b));
}

/** A path with optional line breaks after its points. */
const broken = (path) => path.split(/(?<=\.)/).flatMap((part) => [part, element("wbr")]);

function foundView([name, rows]) {
  const link = (row) => element("a", {href: `#${row.id}`}, ...broken(ownerOf(row)));
  const descriptions = rows.map((row) => row.lastElementChild.textContent);
  return element(
    "li",
    {},
    element("code", {}, name),
    element("p", {className: "note"}, descriptions.find(Boolean) ?? ""),
    element("p", {}, ...rows.flatMap((row) => [link(row), " "])),
  );
}

function startFinder() {
  const rows = document.querySelectorAll("main tr[id]");
  const box = $("docs-filter");
  const list = $("docs-found");
  const look = () => {
    const wanted = box.value.trim().toLowerCase();
    const found = wanted ? find(rows, wanted) : [];
    list.replaceChildren(...found.slice(0, most).map(foundView));
    list.hidden = !found.length;
    $("docs-contents").hidden = Boolean(wanted);
    const listed = found.length > most ? `, ${most} shown` : "";
    $("docs-found-count").textContent = wanted ? count(found.length, "name") + listed : "";
  };
  box.oninput = look;
  look();
}

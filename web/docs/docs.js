// The documentation page of the HTTP interface, generated from the OpenAPI document.
import {absoluteUrl, get} from "../shared/api.js";
import {$, element} from "../shared/dom.js";
import {count} from "../shared/numbers.js";
import {load, operationsByTag, resolved, schemaPlace, schemas} from "./document.js";
import {startFinder} from "./finder.js";
import {fold, reveal} from "./fold.js";
import {operationView} from "./operation.js";
import {code, schemaView} from "./schema.js";

const link = (place, ...children) => element("a", {href: `#${place}`}, ...children);

/** The header that carries a key. */
const keyWords = ({scheme, description}) => [
  `${description}: `,
  code(`Authorization: ${scheme[0].toUpperCase()}${scheme.slice(1)} KEY`),
];

/** Absolute address of a server; the document can give a relative one. */
const address = (url) => (url.startsWith("/") ? absoluteUrl(`.${url}`) : url);

function showHead({info, servers, components}, {commit, compiler}) {
  $("docs-version").textContent = `${info.title} ${info.version}`;
  $("docs-summary").textContent = info.summary ?? "";
  $("docs-description").textContent = info.description ?? "";
  const about = [
    ["Version", [info.version]],
    ["Commit", [commit ? code(commit) : "unknown", `, ${compiler}`]],
    ...servers.map(({url, description}) => ["Server", [code(address(url)), `, ${description}`]]),
    ...Object.values(components.securitySchemes ?? {}).map((one) => ["Key", keyWords(one)]),
  ];
  $("docs-about").append(
    ...about.flatMap(([name, nodes]) => [
      element("dt", {textContent: name}),
      element("dd", {}, ...nodes),
    ]),
  );
  $("docs-head").hidden = false;
}

function showOperations() {
  for (const [{name, description}, operations] of operationsByTag()) {
    const said = element("small", {textContent: description ?? ""});
    const title = element("h2", {id: `docs-tag-${name}`}, name, " ", said);
    const section = element("section", {}, title, ...operations.map(operationView));
    section.setAttribute("aria-labelledby", title.id);
    $("docs-operations").append(section);
  }
}

function showSchemas() {
  for (const [name, schema] of schemas()) {
    const place = schemaPlace(name);
    const {properties, description} = resolved(schema);
    const fields = properties ? count(Object.keys(properties).length, "field") : "one of several";
    const title = element("h3", {}, name, " ", element("small", {textContent: fields}));
    const said = description ? [element("p", {textContent: description})] : [];
    const view = fold([title], () => [...said, ...schemaView(schema, place)], place);
    view.id = place;
    $("docs-schemas").append(view);
  }
  $("docs-schemas").hidden = false;
}

/** Operations grouped by path: [path, operations]. */
const byPath = (operations) =>
  [...new Set(operations.map(({path}) => path))].map((path) => [
    path,
    operations.filter((operation) => operation.path === path),
  ]);

function showContents() {
  const entry = ([path, list]) => {
    const links = list.flatMap(({id, method}) => [link(id, method), " "]);
    return element("li", {}, code(path), " ", ...links);
  };
  for (const [{name}, operations] of operationsByTag())
    $("docs-toc").append(
      element("h2", {textContent: name}),
      element("ul", {}, ...byPath(operations).map(entry)),
    );
  const names = schemas().map(([name]) => element("li", {}, link(schemaPlace(name), name)));
  $("docs-toc").append(
    element("h2", {}, "schemas"),
    fold([count(names.length, "schema")], () => [element("ul", {}, ...names)]),
  );
  $("docs-contents").open = matchMedia("(min-width: 1001px)").matches;
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
}

async function start() {
  const [described, version] = await Promise.all([load(), get("version")]);
  showHead(described, version);
  showOperations();
  showSchemas();
  showContents();
  startFinder();
  listen();
  reveal(location.hash);
  $("docs-message").dataset.done = 1;
}

start().catch((error) => {
  $("docs-message").textContent = `The OpenAPI document cannot be loaded: ${error.message}.`;
  $("docs-message").classList.add("fault");
});

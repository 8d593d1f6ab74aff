// The page /docs, made from the OpenAPI document at build time.
import {count} from "../shared/numbers.js";
import {
  load,
  operationsByTag,
  resolved,
  responsePlace,
  root,
  schemaPlace,
  schemas,
} from "./document.mjs";
import {code, element, fold, html, small} from "./markup.mjs";
import {answerView, operationView} from "./operation.mjs";
import {schemaView} from "./schema.mjs";

// Address of the service in the examples until example.js replaces it.
globalThis.location = {href: "http://127.0.0.1:8080/docs"};

const link = (place, text) => element("a", {href: `#${place}`}, text);
const paragraph = (text = "") => element("p", {}, text);

/** The header that carries a key. */
const keyWords = ({scheme, description}) => [
  `${description}: `,
  code(`Authorization: ${scheme[0].toUpperCase()}${scheme.slice(1)} KEY`),
];

/** Version, server and key. docs.js replaces relative addresses and adds the commit. */
function about() {
  const {info, servers, components} = root;
  const server = ({url, description}) => [
    element("code", {"data-address": url}, url),
    `, ${description}`,
  ];
  const rows = [
    ["Version", [info.version]],
    ["Commit", [element("span", {id: "docs-commit"}, "unknown")]],
    ...servers.map((one) => ["Server", server(one)]),
    ...Object.values(components.securitySchemes ?? {}).map((one) => ["Key", keyWords(one)]),
  ];
  return rows.flatMap(([name, nodes]) => [element("dt", {}, name), element("dd", {}, ...nodes)]);
}

function operationsView() {
  return operationsByTag().map(([{name, description}, operations]) => {
    const id = `docs-tag-${name}`;
    const title = element("h2", {id}, name, " ", small(description ?? ""));
    return element("section", {"aria-labelledby": id}, title, ...operations.map(operationView));
  });
}

/** The schemas, each with its description and, as last element, its fields. */
function schemasView() {
  return schemas().map(([name, schema]) => {
    const id = schemaPlace(name);
    const {properties, description} = resolved(schema);
    const fields = properties ? count(Object.keys(properties).length, "field") : "one of several";
    const title = element("h3", {}, name, " ", small(fields));
    const said = description ? [paragraph(description)] : [];
    return fold([title], [...said, element("div", {}, ...schemaView(schema, id))], {id});
  });
}

/** Content of the responses that operations share. */
const responseTemplates = () =>
  Object.entries(root.components.responses).map(([name, response]) =>
    element("template", {id: responsePlace(name)}, ...answerView(response)),
  );

/** Operations grouped by path: [path, operations]. */
const byPath = (operations) =>
  [...new Set(operations.map(({path}) => path))].map((path) => [
    path,
    operations.filter((operation) => operation.path === path),
  ]);

function contents() {
  const entry = ([path, list]) => {
    const links = list.flatMap(({id, method}) => [link(id, method), " "]);
    return element("li", {}, code(path), " ", ...links);
  };
  const tags = operationsByTag().flatMap(([{name}, operations]) => [
    element("h2", {}, name),
    element("ul", {}, ...byPath(operations).map(entry)),
  ]);
  const names = schemas().map(([name]) => element("li", {}, link(schemaPlace(name), name)));
  return [
    ...tags,
    element("h2", {}, "schemas"),
    fold([count(names.length, "schema")], [element("ul", {}, ...names)]),
  ];
}

/** Fills the {{names}} of a template. file: the OpenAPI document. */
export function docsPage(template, file) {
  load(file);
  const {title, version, summary, description} = root.info;
  const parts = {
    version: [`${title} ${version}`],
    contents: contents(),
    summary: [summary],
    description: [description],
    about: about(),
    operations: [...operationsView(), ...responseTemplates()],
    schemas: schemasView(),
  };
  return Object.entries(parts).reduce(
    (text, [name, nodes]) => text.replace(`{{${name}}}`, () => html(nodes)),
    template,
  );
}

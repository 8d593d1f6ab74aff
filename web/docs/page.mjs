// The page /docs, made from the OpenAPI document at build time.
import {count} from "../shared/numbers.js";
import {load, resolved, responsePlace, root, schemaPlace, schemas, tags} from "./document.mjs";
import {fold, html} from "./markup.mjs";
import {answerView, operationView} from "./operation.mjs";
import {schemaView} from "./schema.mjs";

// Address of the service in the examples until example.js replaces it.
globalThis.location = {href: "http://127.0.0.1:8080/docs"};

const link = (place, text) => html`<a href="#${place}">${text}</a>`;

/** Version, server and key. docs.js fills in the address and the commit. */
function about() {
  const {info, servers, components} = root;
  const [{url, description}] = servers;
  const {description: key} = components.securitySchemes.api_key;
  return Object.entries({
    Version: info.version,
    Commit: html`<span id="docs-commit">unknown</span>`,
    Server: html`<code id="docs-address">${url}</code>, ${description}`,
    Key: html`${key}: <code>Authorization: Bearer KEY</code>`,
  }).map(([name, words]) => html`<dt>${name}</dt><dd>${words}</dd>`);
}

const operationsView = () =>
  tags().map(({name, description, operations}) => {
    const id = `docs-tag-${name}`;
    const title = html`<h2 id="${id}">${name} <small>${description}</small></h2>`;
    return html`<section aria-labelledby="${id}">${title}${operations.map(operationView)}</section>`;
  });

/** The schemas, each with its description and, as last element, its fields. */
const schemasView = () =>
  schemas().map(([name, schema]) => {
    const id = schemaPlace(name);
    const {properties, description} = resolved(schema);
    const fields = properties ? count(Object.keys(properties).length, "field") : "one of several";
    const said = description ? html`<p>${description}</p>` : "";
    const title = html`<summary><h3>${name} <small>${fields}</small></h3></summary>`;
    return html`<details id="${id}">${title}${said}<div>${schemaView(schema, id)}</div></details>`;
  });

/** Content of the responses that operations share. */
const responseTemplates = () =>
  Object.entries(root.components.responses).map(
    ([name, response]) =>
      html`<template id="${responsePlace(name)}">${answerView(response)}</template>`,
  );

function contents() {
  const entry = (path, operations) => {
    const own = operations.filter((operation) => operation.path === path);
    const links = own.map(({operationId, method}) => [link(operationId, method), " "]);
    return html`<li><code>${path}</code> ${links}</li>`;
  };
  const names = schemas().map(([name]) => html`<li>${link(schemaPlace(name), name)}</li>`);
  return [
    tags().map(({name, operations}) => {
      const paths = [...new Set(operations.map(({path}) => path))];
      return html`<h2>${name}</h2><ul>${paths.map((path) => entry(path, operations))}</ul>`;
    }),
    html`<h2>schemas</h2>`,
    fold(count(names.length, "schema"), html`<ul>${names}</ul>`),
  ];
}

/** Fills the {{names}} of a template. file: the OpenAPI document. */
export function docsPage(template, file) {
  load(file);
  const {title, version, summary, description} = root.info;
  const parts = {
    version: `${title} ${version}`,
    contents: contents(),
    summary,
    description,
    about: about(),
    operations: [operationsView(), responseTemplates()],
    schemas: schemasView(),
  };
  return template.replace(/\{\{(\w+)\}\}/g, (_, name) => html`${parts[name]}`);
}

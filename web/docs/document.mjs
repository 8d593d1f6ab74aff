// The OpenAPI document, and the ids of its components on the page.
import {readFileSync} from "node:fs";

export let root;

/** Reads the document that the other functions are about. */
export function load(file) {
  root = JSON.parse(readFileSync(file, "utf8"));
}

/** The target of a $ref, merged with its siblings; any other node unchanged. */
export function resolved(node) {
  if (!node.$ref) return node;
  const {$ref, ...beside} = node;
  const names = $ref.slice(2).split("/");
  const there = names.reduce((inside, name) => inside[name], root);
  return {...resolved(there), ...beside};
}

/** Component name of a $ref. */
export const nameOf = ($ref) => $ref.slice($ref.lastIndexOf("/") + 1);

export const schemas = () => Object.entries(root.components.schemas);
export const schemaPlace = (name) => `schema-${name}`;
export const responsePlace = (name) => `response-${name}`;

/** All operations in document order, with path, method and resolved parameters. */
const operations = () =>
  Object.entries(root.paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, {parameters = [], ...operation}]) => ({
      ...operation,
      path,
      method: method.toUpperCase(),
      parameters: parameters.map(resolved),
    })),
  );

/** {name, description, operations} of each tag. Each operation has one tag. */
export const tags = () =>
  root.tags.map((tag) => ({
    ...tag,
    operations: operations().filter((operation) => operation.tags[0] === tag.name),
  }));

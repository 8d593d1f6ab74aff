// The OpenAPI document and the ids of its parts on the page. An id is an operation or a schema
// followed by field names: schema-Energy.without_absorber.rms.
import {readFileSync} from "node:fs";

export let root;

/** Reads the document that the other functions are about. */
export function load(file) {
  root = JSON.parse(readFileSync(file, "utf8"));
}

const unescaped = (name) => name.replaceAll("~1", "/").replaceAll("~0", "~");

/** The target of a $ref, merged with its siblings; any other node unchanged. */
export function resolved(node) {
  if (!node.$ref) return node;
  const {$ref, ...beside} = node;
  const names = $ref.slice(2).split("/").map(unescaped);
  const there = names.reduce((inside, name) => inside[name], root);
  return {...resolved(there), ...beside};
}

/** Component name of a $ref. */
export const nameOf = ($ref) => $ref.slice($ref.lastIndexOf("/") + 1);

export const schemas = () => Object.entries(root.components.schemas);
export const schemaPlace = (name) => `schema-${name}`;
export const responsePlace = (name) => `response-${name}`;

/**
 * All operations in document order, with path, method, resolved parameters, and their request body
 * by media type.
 */
export const operations = () =>
  Object.entries(root.paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, operation]) => ({
      ...operation,
      path,
      method: method.toUpperCase(),
      id: operation.operationId ?? `${method}${path}`,
      parameters: (operation.parameters ?? []).map(resolved),
      body: resolved(operation.requestBody ?? {}).content ?? {},
    })),
  );

/** [tag, operations] for tags with operations. */
export function operationsByTag() {
  const all = operations();
  const of = (name) => all.filter(({tags}) => tags?.[0] === name);
  const listed = (root.tags ?? []).map((tag) => [tag, of(tag.name)]);
  const rest = all.filter((operation) => !listed.some(([, list]) => list.includes(operation)));
  return [...listed, [{name: "other"}, rest]].filter(([, list]) => list.length);
}

/** The objects and components that a value of a schema can be or contain, one level deep. */
function parts(schema) {
  if (schema.$ref || schema.properties) return [schema];
  const {items, additionalProperties, anyOf = [], oneOf = [], allOf = []} = schema;
  return [items, additionalProperties, ...anyOf, ...oneOf, ...allOf]
    .filter((inner) => typeof inner === "object")
    .flatMap(parts);
}

/**
 * parts() with the id of their fields: null for a component, whose fields have their own ids.
 * place: of the schema, or null; taken: its id is in use already.
 */
export function placedParts(schema, place, taken = false) {
  let n = Number(taken);
  const next = () => (n++ ? `${place}/${n}` : place);
  return parts(schema).map((part) => [part, part.$ref || !place ? null : next()]);
}

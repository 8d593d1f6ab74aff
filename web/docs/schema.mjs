// Schemas as text and as tables of fields, whose ids are like schema-Energy.without_absorber.rms. A
// schema that is part of others is linked.
import {readFileSync} from "node:fs";
import {count} from "../shared/numbers.js";

const json = (value) => html`<code>${JSON.stringify(value)}</code>`;

const joined = (list, word) => list.map((words, i) => [i ? word : "", words]);

function oneType(type, schema, many) {
  const {items = {}, minItems, maxItems, additionalProperties: values} = schema;
  if (type === "array") {
    const number = minItems && minItems === maxItems ? `${minItems} ` : "";
    return [many ? "lists of " : "list of ", number, typeWords(items, true)];
  }
  if (type === "object" && values?.type) return ["names to ", typeWords(values, true)];
  return many && type !== "null" ? `${type}s` : type;
}

/** The possible types of a value as texts and links. many: plural. */
function types(schema, many) {
  const {$ref, anyOf, oneOf, type = "any"} = schema;
  if ($ref) return [html`<a href="#${schemaPlace(nameOf($ref))}">${nameOf($ref)}</a>`];
  if ("const" in schema) return [json(schema.const)];
  if (schema.enum) return schema.enum.map(json);
  const several = anyOf ?? oneOf;
  if (several) return several.map((one) => typeWords(one, many));
  return [type].flat().map((one) => oneType(one, schema, many));
}

export const typeWords = (schema, many = false) => joined(types(schema, many), " or ");

/** A range as texts; none without ends. */
function span(least, most, unit = "") {
  if (least === undefined) return most === undefined ? [] : [`at most ${most}${unit}`];
  return [most === undefined ? `at least ${least}${unit}` : `${least} to ${most}${unit}`];
}

/** Range, number of entries and default. */
function limits(schema) {
  const {minimum, maximum, exclusiveMinimum, minItems, maxItems} = schema;
  return [
    ...span(minimum, maximum),
    ...(exclusiveMinimum === undefined ? [] : [`above ${exclusiveMinimum}`]),
    ...(minItems === maxItems ? [] : span(minItems, maxItems, " entries")),
    ...("default" in schema ? [["default ", json(schema.default)]] : []),
  ];
}

/** Table row of a field {name, schema, required, description}, and one for its content. */
function rows({name, schema, required, description}, place) {
  const at = place && `${place}.${name}`;
  const id = at ? html` id="${at}"` : "";
  const mark = required ? html` <small>required</small>` : "";
  const words = joined([typeWords(schema), ...limits(schema)], ", ");
  const meaning = description ?? resolved(schema).description ?? "";
  const folds = partFolds(schema, at);
  return [
    html`<tr${id}><th scope="row"><code>${name}</code>${mark}</th>`,
    html`<td class="type">${words}</td><td>${meaning}</td></tr>`,
    folds.length ? html`<tr class="inside"><td colspan="3">${folds}</td></tr>` : "",
  ];
}

/** The objects that a value of a schema can be or contain, one level deep. */
function parts(schema) {
  if (schema.properties) return [schema];
  const {items, additionalProperties, anyOf = [], oneOf = []} = schema;
  return [items, additionalProperties, ...anyOf, ...oneOf]
    .filter((inner) => typeof inner === "object")
    .flatMap(parts);
}

/** Folds of a schema's parts; place: its id, null if not searched; n: parts with this id. */
function partFolds(schema, place, n = 0) {
  let placed = n;
  const next = () => place && (placed++ ? `${place}/${placed}` : place);
  return parts(schema).map((part) => {
    const number = count(Object.keys(part.properties).length, "field");
    return fold(html`<small>${number}</small>`, schemaView(part, next()));
  });
}

/** A table of fields. place: id of their parent; null if they are not search targets. */
export const fieldTable = (fields, place, title) => [
  html`<table class="fields">${title ? html`<caption>${title}</caption>` : ""}<thead><tr>`,
  ["field", "type", "meaning"].map((name) => html`<th scope="col">${name}</th>`),
  html`</tr></thead><tbody>${fields.map((field) => rows(field, place))}</tbody></table>`,
];

/** A schema: its fields and alternatives. */
export function schemaView(schema, place) {
  const {properties = {}, required = [], ...rest} = resolved(schema);
  const fields = Object.entries(properties).map(([name, field]) => ({
    name,
    schema: field,
    required: required.includes(name),
  }));
  const others = [html`<p>${typeWords(rest)}</p>`, partFolds(rest, place, 1)];
  if (!fields.length) return others;
  const several = rest.anyOf ?? rest.oneOf;
  return [fieldTable(fields, place), several ? ["and the fields of one of:", others] : ""];
}

// HTML as text: the build has no document.
/** HTML; other texts are escaped where they are inserted. */
class Markup extends String {}

const entities = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"};

function written(node) {
  if (Array.isArray(node)) return node.map(written).join("");
  return node instanceof Markup ? node : String(node).replace(/[&<>"]/g, (c) => entities[c]);
}

/** Tag of templates, whose values are texts, HTML, and lists of both. */
export const html = (raw, ...values) => new Markup(String.raw({raw}, ...values.map(written)));

export const fold = (summary, content) =>
  html`<details><summary>${summary}</summary>${content}</details>`;

// The OpenAPI document, and the ids of its components on the page.
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

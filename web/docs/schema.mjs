// Schemas as text and as tables of fields. The id of a field is its operation or schema followed by
// field names: schema-Energy.without_absorber.rms.
import {count} from "../shared/numbers.js";
import {nameOf, resolved, schemaPlace} from "./document.mjs";
import {copyFold, fold, html} from "./markup.mjs";

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

/** The objects and components that a value of a schema can be or contain, one level deep. */
function parts(schema) {
  if (schema.$ref || schema.properties) return [schema];
  const {items, additionalProperties, anyOf = [], oneOf = [], allOf = []} = schema;
  return [items, additionalProperties, ...anyOf, ...oneOf, ...allOf]
    .filter((inner) => typeof inner === "object")
    .flatMap(parts);
}

/**
 * Folds of the parts of a schema. place: id of the schema, null if its fields are not search
 * targets; n: number of parts whose fields have this id. Components have ids of their own.
 */
function partFolds(schema, place, n = 0) {
  let placed = n;
  const next = () => place && (placed++ ? `${place}/${placed}` : place);
  return parts(schema).map((part) => {
    const fields = Object.keys(resolved(part).properties ?? {}).length;
    const number = html`<small>${fields ? count(fields, "field") : "one of several"}</small>`;
    if (part.$ref) return fieldsFold([nameOf(part.$ref), " ", number], part.$ref);
    return fold(number, schemaView(part, next()));
  });
}

/** A fold of a component's fields. Components can be recursive. */
export const fieldsFold = (summary, $ref) => copyFold(summary, schemaPlace(nameOf($ref)));

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
  const others = partFolds(rest, place, 1);
  if (!fields.length) return [html`<p>${typeWords(rest)}</p>`, others];
  const more = others.length ? html`<p>and the fields of one of:</p>` : "";
  return [fieldTable(fields, place), more, others];
}

// Schemas as text and as tables of fields.
import {count} from "../shared/numbers.js";
import {nameOf, placedParts, resolved, schemaPlace} from "./document.mjs";
import {code, copyFold, element, fold, small} from "./markup.mjs";

const json = (value) => code(JSON.stringify(value));
const paragraph = (...children) => element("p", {}, ...children);

const joined = (list, word) => list.flatMap((nodes, i) => (i ? [word, ...nodes] : nodes));
const alternatives = (list) => joined(list, " or ");

const linkTo = ($ref) => {
  const name = nameOf($ref);
  return element("a", {href: `#${schemaPlace(name)}`}, name);
};

function listWords({items = {}, minItems, maxItems}, many) {
  const number = minItems && minItems === maxItems ? `${minItems} ` : "";
  return [many ? "lists of " : "list of ", number, ...typeWords(items, true)];
}

function oneType(type, schema, many) {
  if (type === "array") return listWords(schema, many);
  const values = schema.additionalProperties;
  if (type === "object" && values?.type) return ["names to ", ...typeWords(values, true)];
  return [many && type !== "null" ? `${type}s` : type];
}

/** A type as texts and links. many: plural. */
export function typeWords(schema, many = false) {
  if (schema.$ref) return [linkTo(schema.$ref)];
  if ("const" in schema) return [json(schema.const)];
  if (schema.enum) return alternatives(schema.enum.map((value) => [json(value)]));
  const several = schema.anyOf ?? schema.oneOf;
  if (several) return alternatives(several.map((one) => typeWords(one, many)));
  return alternatives([schema.type ?? "any"].flat().map((type) => oneType(type, schema, many)));
}

function span(least, most, unit = "") {
  if (least === undefined && most === undefined) return [];
  if (least === undefined) return [`at most ${most}${unit}`];
  return [most === undefined ? `at least ${least}${unit}` : `${least} to ${most}${unit}`];
}

/** Range, number of entries and default. */
function limits(schema) {
  const {minimum, maximum, exclusiveMinimum, minItems, maxItems} = schema;
  const words = span(minimum, maximum).map((text) => [text]);
  if (exclusiveMinimum !== undefined) words.push([`above ${exclusiveMinimum}`]);
  if (minItems !== maxItems) words.push(span(minItems, maxItems, " entries"));
  if ("default" in schema) words.push(["default ", json(schema.default)]);
  return words;
}

const cell = (name, ...children) => element("td", {class: name}, ...children);

/** Table row of a field {name, schema, required, description}, and one for its content. */
function rows({name, schema, required, description}, place) {
  const at = place && `${place}.${name}`;
  const mark = required ? [" ", small("required")] : [];
  const head = element("th", {scope: "row"}, code(name), ...mark);
  const words = [typeWords(schema), ...limits(schema)];
  const meaning = description ?? resolved(schema).description ?? "";
  const type = cell("type", ...joined(words, ", "));
  const row = element("tr", {id: at}, head, type, cell(null, meaning));
  const folds = placedParts(schema, at).map(([part, inside]) => partFold(part, inside));
  if (!folds.length) return [row];
  return [row, element("tr", {class: "inside"}, element("td", {colspan: 3}, ...folds))];
}

function partFold(part, place) {
  const fields = Object.keys(resolved(part).properties ?? {}).length;
  const number = small(fields ? count(fields, "field") : "one of several");
  if (part.$ref) return fieldsFold([nameOf(part.$ref), " ", number], part.$ref);
  return fold([number], schemaView(part, place));
}

/** A fold of a component's fields. Components can be recursive. */
export const fieldsFold = (summary, $ref) => copyFold(summary, schemaPlace(nameOf($ref)));

/** A table of fields. place: id of their parent; null if they are not search targets. */
export function fieldTable(fields, place, title) {
  const heads = ["field", "type", "meaning"].map((name) => element("th", {scope: "col"}, name));
  const body = element("tbody", {}, ...fields.flatMap((field) => rows(field, place)));
  const caption = title ? [element("caption", {}, title)] : [];
  const head = element("thead", {}, element("tr", {}, ...heads));
  return element("table", {class: "fields"}, ...caption, head, body);
}

/** A schema as nodes: its fields and alternatives. */
export function schemaView(schema, place) {
  const {properties, required = [], ...rest} = resolved(schema);
  const fields = Object.entries(properties ?? {}).map(([name, field]) => ({
    name,
    schema: field,
    required: required.includes(name),
  }));
  const nodes = fields.length ? [fieldTable(fields, place)] : [paragraph(...typeWords(rest))];
  const others = placedParts(rest, place, true);
  if (fields.length && others.length) nodes.push(paragraph("and the fields of one of:"));
  return [...nodes, ...others.map(([part, inside]) => partFold(part, inside))];
}

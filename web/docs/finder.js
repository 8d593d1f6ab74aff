// Search for fields by name. Each field is a table row with an id, such as
// schema-Energy.without_absorber.rms or simulate_by_query.b.
import {$, element} from "../shared/dom.js";
import {count} from "../shared/numbers.js";

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

/** Every field of a request or response: {name, place, of, description}. */
const allFields = () =>
  [...document.querySelectorAll("main tr[id]")].map((row) => ({
    name: row.querySelector("code").textContent,
    place: row.id,
    of: ownerOf(row),
    description: row.lastElementChild.textContent,
  }));

/** Sort order: exact matches, then prefixes, then others. */
function rank(name, wanted) {
  if (name === wanted) return 0;
  return name.startsWith(wanted) ? 1 : 2;
}

/** [name, fields] for names that contain a text. */
function find(fields, wanted) {
  const names = new Map();
  for (const field of fields) {
    const name = field.name.toLowerCase();
    if (name.includes(wanted)) names.set(field.name, [...(names.get(field.name) ?? []), field]);
  }
  const ranked = ([name]) => rank(name.toLowerCase(), wanted);
  return [...names].sort((a, b) => ranked(a) - ranked(b));
}

/** A path with optional line breaks after its points. */
const broken = (path) =>
  path.split(/(?<=\.)/).flatMap((part, i) => (i ? [element("wbr"), part] : [part]));

function foundView([name, fields]) {
  const links = fields.map(({place, of}) => element("a", {href: `#${place}`}, ...broken(of)));
  const {description = ""} = fields.find((field) => field.description) ?? {};
  const spaced = links.flatMap((link) => [link, " "]);
  return element(
    "li",
    {},
    element("code", {textContent: name}),
    element("p", {className: "note", textContent: description}),
    element("p", {}, ...spaced),
  );
}

export function startFinder() {
  const fields = allFields();
  const box = $("docs-filter");
  const list = $("docs-found");
  const look = () => {
    const wanted = box.value.trim().toLowerCase();
    const found = wanted ? find(fields, wanted) : [];
    list.replaceChildren(...found.slice(0, most).map(foundView));
    list.hidden = !found.length;
    $("docs-contents").hidden = Boolean(wanted);
    const listed = found.length > most ? `, ${most} shown` : "";
    $("docs-found-count").textContent = wanted ? count(found.length, "name") + listed : "";
  };
  box.addEventListener("input", look);
  look();
}

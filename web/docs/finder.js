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

/** Sort order: exact matches, then prefixes, then others. */
function rank(name, wanted) {
  if (name === wanted) return 0;
  return name.startsWith(wanted) ? 1 : 2;
}

/** [name, rows] for names that contain a text. */
function find(rows, wanted) {
  const found = new Map();
  for (const row of rows) {
    const name = row.querySelector("code").textContent;
    if (name.toLowerCase().includes(wanted)) found.set(name, [...(found.get(name) ?? []), row]);
  }
  const ranked = ([name]) => rank(name.toLowerCase(), wanted);
  return [...found].sort((a, b) => ranked(a) - ranked(b));
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

export function startFinder() {
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

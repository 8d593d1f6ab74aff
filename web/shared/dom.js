// Short forms for creating and changing elements; saving files and copying texts.
import {count} from "./numbers.js";

export const $ = (id) => document.getElementById(id);

/** Counts completed work in a data attribute of a node; tests wait for it. */
export const countUp = (node, what = "done") => {
  node.dataset[what] = Number(node.dataset[what] ?? 0) + 1;
};

/** Lets the browser handle pending events before the work continues. */
export const nextTask = () => new Promise((resolve) => setTimeout(resolve));

export const element = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

/** A button; `more` holds further properties. */
export const button = (textContent, onclick, more) =>
  element("button", {type: "button", textContent, onclick, ...more});

/** Adds several event listeners: {type: listener}. */
export const on = (node, handlers) => {
  for (const [type, f] of Object.entries(handlers)) node.addEventListener(type, f);
};

/** Sets attributes; null and undefined values are skipped. */
export const attributes = (node, all) => {
  for (const [name, value] of Object.entries(all))
    if (value != null) node.setAttribute(name, value);
};

/** Shows or hides elements: {id: whether to show}. */
export const reveal = (shown) => {
  for (const [id, is] of Object.entries(shown)) $(id).hidden = !is;
};

/** Sets the texts of elements: {id: text}. */
export const setTexts = (texts) => {
  for (const [id, text] of Object.entries(texts)) $(id).textContent = text;
};

/** Marks the pressed ones of several toggle buttons. */
export const press = (buttons, is) => {
  for (const one of buttons) attributes(one, {"aria-pressed": is(one)});
};

/** Returns say(text, fault), which shows a message in the element `id`. */
export const sayIn =
  (id) =>
  (text, fault = false) => {
    $(id).textContent = text;
    $(id).classList.toggle("fault", fault);
  };

/** read(file) gets a file that is dropped on a panel or chosen in the input of `zone`. */
export function onFile(panel, zone, read) {
  zone.querySelector("input").onchange = ({target}) => read(target.files[0]);
  const drag = (event) => {
    event.preventDefault();
    zone.classList.toggle("about", event.type === "dragover");
    if (event.type === "drop") read(event.dataTransfer.files[0]);
  };
  for (const type of ["ondragover", "ondragleave", "ondrop"]) panel[type] = drag;
}

/** Selects an entry, or the first if there is no such value. */
export function choose(menu, value) {
  menu.value = value;
  if (menu.selectedIndex < 0) menu.selectedIndex = 0;
}

/** Sets entries, [value, text] or [value] each; keeps the selected one unless `wish` differs. */
export function fillMenu(menu, entries, wish = menu.value) {
  menu.replaceChildren(...entries.map(([value, text = value]) => new Option(text, value)));
  choose(menu, wish);
}

/** A key of a plot: a mark in a colour, and what it stands for. */
export const keyOf = (mark, colour, ...what) => {
  const key = element("span", {className: "key"}, ...what);
  key.dataset.mark = mark;
  key.style.setProperty("--key", `var(--${colour})`);
  return key;
};

/** Shows entries [term, value, remark] as cards in a <dl>. */
export function cards(list, entries) {
  const card = ([term, value, remark]) => {
    const small = element("small", {}, remark ? ` ${remark}` : "");
    const parts = [element("dt", {}, term), element("dd", {}, value, small)];
    return element("div", {className: "box"}, ...parts);
  };
  list.replaceChildren(...entries.map(card));
}

/** Lists remarks in the <details id>, with their number as summary; hides it without any. */
export function showRemarks(id, remarks) {
  const details = $(id);
  details.hidden = !remarks.length;
  details.querySelector("summary").textContent = count(remarks.length, "remark");
  listWarnings(details.querySelector("ul"), remarks);
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {}, w)));

const row = (tag, cells) => element("tr", {}, ...cells.map((cell) => element(tag, {}, cell)));

export const tableOf = (names, rows) => [
  element("thead", {}, row("th", names)),
  element("tbody", {}, ...rows.map((cells) => row("td", cells))),
];

export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Copies a text and reports it; without permission to copy, shows the text. */
export async function copy(text, say) {
  try {
    await navigator.clipboard.writeText(text);
    say("copied");
  } catch {
    say(text);
  }
}

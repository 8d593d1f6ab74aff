// The key that a server asks for, kept as long as the tab is open.
import {element} from "./dom.js";

const name = "vines-api-key";
let asking = null; // one dialog, for all requests that wait for it

export const hasKey = () => sessionStorage.getItem(name) !== null;

/** The headers that show the key. */
export const keyHeaders = () =>
  hasKey() ? {Authorization: `Bearer ${sessionStorage.getItem(name)}`} : {};

/** Whether a key was given, in place of one that is none. */
export function askForKey() {
  asking ??= ask().finally(() => {
    asking = null;
  });
  return asking;
}

async function ask() {
  const input = element("input", {
    type: "password",
    name: "key",
    required: true,
    pattern: "\\s*[A-Za-z0-9._~+\\/=\\-]{16,}\\s*", // as the service takes them
    title: "16 or more letters, digits or -._~+/=",
    autocomplete: "current-password",
  });
  const wrong = hasKey() ? "The server does not know this key. " : "";
  const use = element("button", {}, "Use it");
  const dialog = element(
    "dialog",
    {},
    element("h2", {}, "A key, please"),
    element("p", {}, `${wrong}This server answers only those who have one.`),
    element("form", {method: "dialog"}, element("label", {}, "Key ", input, " ", use)),
  );
  document.body.append(dialog);
  dialog.showModal();
  await new Promise((resolve) => {
    dialog.onclose = resolve;
  });
  dialog.remove();
  const given = input.value.trim();
  if (given) sessionStorage.setItem(name, given);
  return Boolean(given);
}

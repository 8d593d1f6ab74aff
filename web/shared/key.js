// The API key, kept until the browser tab is closed.
import {element} from "./dom.js";

const name = "vines-api-key";
let asking = null; // one dialog for all waiting requests

export const currentKey = () => sessionStorage.getItem(name);

export const hasKey = () => currentKey() !== null;

/** The request headers with the key, if there is one. */
export const keyHeaders = () => (hasKey() ? {Authorization: `Bearer ${currentKey()}`} : {});

/** Asks for a key; resolves to true when one was typed. */
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
    pattern: "\\s*[A-Za-z0-9._~+\\/=\\-]{16,}\\s*", // the format that the service accepts
    title: "16 or more letters, digits or -._~+/=",
    autocomplete: "current-password",
  });
  const wrong = hasKey() ? "The server does not accept this key. " : "";
  const use = element("button", {}, "Use key");
  const dialog = element(
    "dialog",
    {},
    element("h2", {}, "API key"),
    element("p", {}, `${wrong}This server requires an API key.`),
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

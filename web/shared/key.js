// The API key, kept until the browser tab is closed.
import {element} from "./dom.js";

const name = "vines-api-key";
let openPrompt = null; // one dialog for all waiting requests

export const currentKey = () => sessionStorage.getItem(name);

export const hasKey = () => currentKey() !== null;

/** Prompts for a key after a 401 response. Resolves to whether a valid key was entered. */
export function askForKey() {
  openPrompt ??= showDialog().finally(() => {
    openPrompt = null;
  });
  return openPrompt;
}

async function showDialog() {
  const input = element("input", {
    type: "password",
    name: "key",
    required: true,
    pattern: "\\s*[A-Za-z0-9._~+\\/=\\-]{16,}\\s*", // the format that the service accepts
    title: "16 or more letters, digits or -._~+/=",
    autocomplete: "current-password",
  });
  const submit = element("button", {value: "use"}, "Use key");
  const rejection = hasKey() ? "The server does not accept this key. " : "";
  const dialog = element(
    "dialog",
    {},
    element("h2", {}, "API key"),
    element("p", {}, `${rejection}This server requires an API key.`),
    element("form", {method: "dialog"}, element("label", {}, "Key ", input, " ", submit)),
  );
  document.body.append(dialog);
  dialog.showModal();
  await new Promise((resolve) => {
    dialog.onclose = resolve;
  });
  dialog.remove();
  const entered = dialog.returnValue === submit.value; // the form was valid
  if (entered) sessionStorage.setItem(name, input.value.trim());
  return entered;
}

// What one takes away from the page: a file, or a text to paste.
import {element} from "./dom.js";

/** Saves a blob as a file of this name. */
export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Copies a text and says so; where the browser does not let us, says the text itself. */
export async function copy(text, say) {
  try {
    await navigator.clipboard.writeText(text);
    say("copied");
  } catch {
    say(text);
  }
}

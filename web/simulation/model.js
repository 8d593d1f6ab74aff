// What the symbols are: the sketch of the system, drawn into the page so that it takes its colours.
import {$} from "../shared/dom.js";

export async function showModel() {
  const text = await (await fetch($("model-sketch").dataset.src)).text();
  const drawing = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  $("model-sketch").append(document.importNode(drawing, true));
}

// What the symbols are: the sketch of the system, drawn into the page so that it takes its colours.
import {$} from "./dom.js";

export async function showModel() {
  $("model").open = matchMedia("(min-width: 1001px)").matches;
  const text = await (await fetch("system.svg")).text();
  const drawing = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  $("model-sketch").append(document.importNode(drawing, true));
}

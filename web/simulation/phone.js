// What a small screen needs: one plot at a time, and a sheet with all that one turns.
import {$} from "../shared/dom.js";

/** Shows one of the plots. */
function choose(name) {
  $("instrument").dataset.plot = name;
  for (const button of document.querySelectorAll("#switch button"))
    button.setAttribute("aria-pressed", String(button.dataset.plot === name));
}

function unfold(open) {
  $("form").classList.toggle("open", open);
  $("sheet").setAttribute("aria-expanded", String(open));
  $("sheet").textContent = open ? "Fewer ▾" : "All parameters ▴";
}

export function start() {
  for (const button of document.querySelectorAll("#switch button"))
    button.addEventListener("click", () => choose(button.dataset.plot));
  choose("x");
  $("sheet").addEventListener("click", () => unfold(!$("form").classList.contains("open")));
}

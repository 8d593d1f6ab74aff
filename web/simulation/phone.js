// What a small screen needs: one plot at a time, and a sheet with all that one turns.
import {$, attributes, press, write} from "../shared/dom.js";

export function start() {
  const buttons = document.querySelectorAll("#switch button");
  for (const button of buttons)
    button.onclick = () => {
      $("instrument").dataset.plot = button.dataset.plot;
      press(buttons, (b) => b === button);
    };
  buttons[0].click();
  $("sheet").onclick = () => {
    const open = $("form").classList.toggle("open");
    attributes($("sheet"), {"aria-expanded": open});
    write({sheet: `All ${open ? "▾" : "▴"}`});
  };
}

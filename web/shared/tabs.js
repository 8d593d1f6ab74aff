// Tabs: one is chosen, and the arrow keys lead from one to the next.
import {$, attributes, on} from "./dom.js";

const tabs = [...document.querySelectorAll("[role=tab]")];
const name = (tab) => tab.id.replace("tab-", "");

export function select(chosen) {
  for (const tab of tabs) {
    const is = name(tab) === chosen;
    attributes(tab, {"aria-selected": is, tabindex: is ? 0 : -1});
    $(tab.getAttribute("aria-controls")).hidden = !is;
  }
}

const moves = {ArrowRight: (i) => i + 1, ArrowLeft: (i) => i - 1, Home: () => 0, End: () => -1};

export function listen(choose) {
  for (const tab of tabs)
    on(tab, {
      click: () => choose(name(tab)),
      keydown(event) {
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        const next = tabs.at(move(tabs.indexOf(tab)) % tabs.length);
        next.focus();
        next.click();
      },
    });
}

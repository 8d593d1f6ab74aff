// Presets: figures and tables of the paper, some as chips, all in a menu; and the plots that
// correspond to them.
import {$, element, press, setTexts} from "../shared/dom.js";

const chips = document.querySelectorAll("#chips button");

/**
 * choose(name) is called with the name of a preset; "" means user-defined parameters; read(query)
 * with the query of a machine.
 */
export function start(presets, choose, read) {
  const menu = $("preset");
  menu.append(new Option("user-defined parameters", ""));
  for (const {name, source, title} of presets) menu.append(new Option(`${source}: ${title}`, name));
  menu.onchange = () => choose(menu.value);
  for (const chip of chips) {
    const {preset, query} = chip.dataset;
    if (preset) chip.title = menu.querySelector(`[value="${preset}"]`).text;
    chip.onclick = () => (preset ? choose(preset) : read(query));
  }
}

/** Selects the preset, and its chip unless the parameters were changed; own: a user's machine. */
export function markChip(name, changed, own) {
  $("preset").value = name;
  press(chips, ({dataset: {preset}}) => (preset ? preset === name && !changed : own));
}

/** Tags the plots of a preset, and links to one in the details if all of them are there. */
export function markPlots(preset) {
  const name = preset?.name.split("_")[0]; // rows of a table share their plots
  const source = preset?.source.split(",")[0];
  for (const figure of document.querySelectorAll("[data-of]")) {
    const isOf = figure.dataset.of.split(" ").includes(name);
    figure.classList.toggle("about", isOf);
    figure.querySelector(".tag")?.remove();
    if (isOf)
      figure.querySelector("figcaption").append(element("span", {className: "tag"}, source));
  }
  const own = [...document.querySelectorAll("figure.about")];
  const alone = own.length && own.every((figure) => figure.closest("#details"));
  $("to-details").href = alone ? `#${own[0].id}` : "#details";
  setTexts({"to-details": alone ? `${source} is below ▾` : "details ▾"});
}

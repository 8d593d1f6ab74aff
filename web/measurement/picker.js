// Which column of a file is which: chosen from their names, once a file is there. It has its place
// before, so that nothing moves under a pointer.
import {$, element} from "../shared/dom.js";
import {columnsOf} from "./record.js";

const quantities = {
  time: "time",
  displacement: "displacement",
  acceleration: "acceleration",
};
const idOf = (quantity) => `measure-pick-${quantity}`;

/** choose(field, name): a column was chosen. */
export function start(choose) {
  for (const [quantity, text] of Object.entries(quantities)) {
    const select = element("select", {id: idOf(quantity), disabled: true});
    select.addEventListener("change", () => choose(`${quantity}_column`, select.value));
    $("measure-picker").append(element("label", {htmlFor: select.id}, text, select));
  }
}

/** The columns of a file as the fields have them; of one without names there is nothing to choose. */
export function show({names}, fields) {
  const found = columnsOf(names, fields);
  for (const quantity of Object.keys(quantities)) {
    const nothing = new Option(found[quantity] < 0 ? "– none –" : "as named", "");
    const select = $(idOf(quantity));
    select.replaceChildren(nothing, ...names.map((name) => new Option(name)));
    select.selectedIndex = found[quantity] + 1;
    select.disabled = !names.length;
  }
}

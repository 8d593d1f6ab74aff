// Which column of a file is which: chosen from their names, once a file is there. It has its place
// before, so that nothing moves under a pointer.
import {$, element} from "../shared/dom.js";
import {columnsOf} from "./record.js";

const menus = {};

/** choose(field, name): a column was chosen. */
export function start(choose) {
  for (const quantity of ["time", "displacement", "acceleration"]) {
    const select = element("select", {
      id: `measure-pick-${quantity}`,
      disabled: true,
      onchange: () => choose(`${quantity}_column`, select.value),
    });
    menus[quantity] = select;
    $("measure-picker").append(element("label", {}, quantity, select));
  }
}

/** The columns of a file as the fields have them; of one without names there is nothing to choose. */
export function show({names}, fields) {
  const found = columnsOf(names, fields);
  for (const [quantity, select] of Object.entries(menus)) {
    const nothing = new Option(found[quantity] < 0 ? "– none –" : "as named", "");
    select.replaceChildren(nothing, ...names.map((name) => new Option(name)));
    select.selectedIndex = found[quantity] + 1;
    select.disabled = !names.length;
  }
}

// Menus for the columns of a file. They are visible but disabled before a file is chosen, so that
// the layout does not shift.
import {$, element} from "../shared/dom.js";
import {columnsOf} from "./record.js";

const menus = {};

/** choose(field, name) is called when a column is chosen. */
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

/** Shows the columns of a file as selected by the fields; disabled for a file without names. */
export function show({names}, fields) {
  const found = columnsOf(names, fields);
  for (const [quantity, select] of Object.entries(menus)) {
    const nothing = new Option(found[quantity] < 0 ? "– none –" : "by name", "");
    select.replaceChildren(nothing, ...names.map((name) => new Option(name)));
    select.selectedIndex = found[quantity] + 1;
    select.disabled = !names.length;
  }
}

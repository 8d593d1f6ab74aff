// Menus whose entries change.

/** Shows an entry of a menu, the first where it has no such. */
export function choose(menu, value) {
  menu.value = value;
  if (menu.selectedIndex < 0) menu.selectedIndex = 0;
}

/**
 * Other entries, [value, text] each, or the value alone; what was shown stays, as far as it can,
 * unless another is wished for.
 */
export function fillMenu(menu, entries, wish = menu.value) {
  menu.replaceChildren(...entries.map(([value, text = value]) => new Option(text, value)));
  choose(menu, wish);
}

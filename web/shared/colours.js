// Colours by their name in the style sheet; they follow the colour scheme.

const known = new Map();

/** f() is called when the colours change: light or dark scheme, print. */
export function onColours(f) {
  for (const scheme of ["(prefers-color-scheme: dark)", "print"])
    matchMedia(scheme).addEventListener("change", f);
}
onColours(() => known.clear());

export function colour(name) {
  if (!known.has(name)) {
    const style = getComputedStyle(document.documentElement);
    known.set(name, style.getPropertyValue(`--${name}`).trim());
  }
  return known.get(name);
}

/** [red, green, blue], 0 to 255, of #rrggbb. */
export const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));

/** [red, green, blue] of a colour of the style sheet. */
export const rgb = (name) => hex(colour(name));

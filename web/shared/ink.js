// Drawing primitives for a canvas context or an SvgPen.

export function ink(c, name, width = 1, dash = []) {
  c.strokeStyle = c.fillStyle = colour(name);
  c.lineWidth = width;
  c.setLineDash(dash);
}

/** Draws a polyline through points [x, y]. */
export function stroke(c, ...points) {
  c.beginPath();
  for (const [i, [x, y]] of points.entries()) c[i ? "lineTo" : "moveTo"](x, y);
  c.stroke();
}

/** Draws a text, centred by default. */
export function drawText(c, text, x, y, align = "center", baseline = "middle") {
  c.textAlign = align;
  c.textBaseline = baseline;
  c.fillText(text, x, y);
}

export function drawTextUpwards(c, text, x, y) {
  c.save();
  c.translate(x, y);
  c.rotate(-Math.PI / 2);
  drawText(c, text, 0, 0);
  c.restore();
}

// Colours by their name in the style sheet; they follow the colour scheme.
const dark = matchMedia("screen and (prefers-color-scheme: dark)");
const known = new Map();

/** f() is called when the colours change: light or dark scheme, print. */
export function onColours(f) {
  for (const scheme of [dark, matchMedia("print")]) scheme.addEventListener("change", f);
}
onColours(() => known.clear());

export function colour(name) {
  if (!known.has(name)) {
    const style = getComputedStyle(document.documentElement);
    const schemes = style.getPropertyValue(`--${name}`).trim();
    const pair = /light-dark\(\s*([^,]*),\s*([^)]*?)\s*\)/;
    known.set(name, schemes.replace(pair, dark.matches ? "$2" : "$1"));
  }
  return known.get(name);
}

/** [red, green, blue], 0 to 255, of #rrggbb. */
export const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));

/** [red, green, blue] of a colour of the style sheet. */
export const rgb = (name) => hex(colour(name));

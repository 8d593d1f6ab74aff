// Marks for the points of a sweep along one axis, given as places (sweep_view.js).
import {blocks, density, dots, line} from "../shared/marks.js";
import {regimeColour} from "../shared/quantities.js";

/** {x, y} of places; y is null for a failed point or without a value. */
const columnsOf = (places, of) => ({
  x: places.map(({value}) => value),
  y: places.map(({p}) => (p.error ? null : (of(p) ?? null))),
});

export const lineOf = (places, of, colour, more) =>
  line({...columnsOf(places, of), colour, ...more});

/** Dots in the colours tint(point), with bars of the half length error(point). */
export const dotsOf = (places, of, {tint, error, ...more}) =>
  dots({
    ...columnsOf(places, of),
    tints: places.map(({p}) => tint(p)),
    errors: error && places.map(({p}) => error(p)),
    ...more,
  });

/** Density of the values of(p): periodic orbits are a few opaque dots, chaos is a cloud. */
export const sectionOf = (places, {from}, of, colour) =>
  density({
    columns: places.map(({p, low, high}) => ({
      from: from(low),
      to: from(high),
      values: of(p),
    })),
    colour,
  });

/** Stretches of neighbouring places with the same regime on an axis, as rectangles. */
export function regimesOf(places, {from}, more) {
  const list = [];
  for (const {p, low, high} of places) {
    const regime = p.regime ?? null;
    const last = list.at(-1);
    if (last?.regime === regime) last.to = from(high);
    else list.push({regime, from: from(low), to: from(high)});
  }
  const styled = list.map(({regime, ...ends}) => ({
    ...ends,
    colour: regime ? regimeColour(regime) : "nothing",
    text: regime && regime !== "none" ? regime : "",
    hatched: regime === "none",
  }));
  return blocks({list: styled, ...more});
}

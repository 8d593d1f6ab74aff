// Positions of axis labels.

function multiples(step, min, max) {
  const list = [];
  for (let k = Math.ceil(min / step); k * step <= max; ++k) list.push(k * step);
  return list;
}

/**
 * Multiples of 1, 2 or 5 times a power of ten, about `count`. Smaller steps are used where only one
 * label would remain, because one label shows no scale.
 */
export function ticks(min, max, count) {
  const raw = (max - min) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const round = [1, 2, 5, 10].find((m) => m * power >= raw);
  const steps = [round, ...[5, 4, 2, 1, 0.5].filter((m) => m < round)];
  const lists = steps.map((m) => multiples(m * power, min, max));
  return lists.find((list) => list.length > 1) ?? lists[0];
}

/**
 * Labels of a logarithmic axis: powers of ten (every n-th if there are many), with 2 and 5 between
 * them if there are few.
 */
export function logTicks(min, max) {
  const from = Math.floor(Math.log10(min));
  const to = Math.ceil(Math.log10(max));
  const step = Math.ceil((to - from) / 8);
  const factors = to - from < 4 ? [1, 2, 5] : [1];
  const list = [];
  for (let k = from; k <= to; k += step) for (const m of factors) list.push(m * 10 ** k);
  return list.filter((v) => v >= min && v <= max);
}

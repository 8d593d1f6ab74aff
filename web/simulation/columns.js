// Columns of an answer on their way into a plot.

export const mm = (metres) => metres.map((v) => v * 1000);

/** A column in other units. */
export const over = (column, quantity) => column.map(quantity.of);

/** A column of floats times a factor. */
export const scaled = (values, factor) => values.map((v) => v * factor);

/** What a logarithmic axis can show. */
export const positive = (v) => (v > 0 ? v : null);

/** Columns over tau without repeats of tau, as a line over it needs them. */
export function ascending(tau, columns) {
  let last = -Infinity;
  const keep = tau.map((t) => {
    const later = t > last;
    if (later) last = t;
    return later;
  });
  if (keep.every(Boolean)) return [tau, ...columns];
  return [tau, ...columns].map((column) => column.filter((_, i) => keep[i]));
}

/** The same, from the start of the run to its end: plots over tau lie under each other. */
export function overRun(tau, columns, end) {
  const [t, ...rest] = ascending(tau, columns);
  const before = !t.length || t[0] > 0;
  const after = !t.length || t[t.length - 1] < end;
  const padded = (column, first, last) => [
    ...(before ? [first] : []),
    ...column,
    ...(after ? [last] : []),
  ];
  return [padded(t, 0, end), ...rest.map((column) => padded(column, null, null))];
}

/**
 * A range for a logarithmic axis that holds all values and 1; a value that is not positive has no
 * place on it.
 */
export function logRange(columns) {
  let min = 1;
  let max = 1;
  for (const column of columns)
    for (const v of column)
      if (v > 0) {
        min = Math.min(min, v);
        max = Math.max(max, v);
      }
  return [min / 1.6, max * 1.6];
}

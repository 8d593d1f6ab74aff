// Binary search in ascending values.

/** The first index whose value is not before the wanted place; the length if there is none. */
function place(values, isBefore) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (isBefore(values[middle])) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The first index whose value is at least `value`; the length if there is none. */
export const firstFrom = (values, value) => place(values, (v) => v < value);

/** The last index whose value is at most `value`; -1 if there is none. */
export const lastUpTo = (values, value) => place(values, (v) => v <= value) - 1;

/** The index of the value nearest to `value`; 0 without values. */
export function nearest(values, value) {
  const i = firstFrom(values, value);
  return i && !(values[i] - value < value - values[i - 1]) ? i - 1 : i;
}

// Places in ascending values.

/** The first index whose value is not before what is looked for; their number if there is none. */
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

/** The first index whose value is not below a value; their number if there is none. */
export const firstFrom = (values, value) => place(values, (v) => v < value);

/** The last index whose value is not above a value; -1 before the first. */
export const lastUpTo = (values, value) => place(values, (v) => v <= value) - 1;

// The exponents of an estimator as lines of a plot.

/** {series, columns} of a history: the four exponents and, where it has one, its rounding floor. */
export function exponentSeries(history) {
  const series = [1, 2, 3, 4].map((k) => ({
    label: `λ${"₁₂₃₄"[k - 1]}`,
    colour: `c${k}`,
    width: 1.5,
  }));
  const columns = [1, 2, 3, 4].map((k) => history?.[`lambda${k}`]);
  if (history?.rounding_floor) {
    series.push({label: "floor", colour: "soft", dash: [5, 4]});
    columns.push(history.rounding_floor);
  }
  return {series, columns};
}

// Lyapunov exponents of an estimator as lines of a plot.
import {quantile} from "d3-array";
import {line} from "./marks.js";
import {shortTo} from "./numbers.js";

const names = ["lambda1", "lambda2", "lambda3", "lambda4"];
// Lines differ in width and dashes, not only in colour.
const styles = [{width: 2}, {}, {dash: [7, 3]}, {dash: [2, 3]}];

const absent = (status, ended) => (ended && status === "minus_infinity" ? "−∞" : "");

/** Exponents and rounding floor of an estimator as lines. */
export function exponentMarks({history, status = []} = {}, x = history?.tau ?? []) {
  const exponents = styles.map((style, k) =>
    line({
      x,
      y: history?.[names[k]] ?? [],
      colour: `c${k + 1}`,
      width: 1.3,
      ...style,
      label: `λ${"₁₂₃₄"[k]}`,
      text: (v, ended) => (v === null ? absent(status[k], ended) : shortTo(4, v)),
    }),
  );
  const y = history?.rounding_floor;
  const floor = y && line({x, y, label: "rounding floor", colour: "soft", dash: [5, 4]});
  return floor ? [...exponents, floor] : exponents;
}

/** A common range of several histories, for the settled values (the last three quarters). */
export function exponentRange(histories) {
  const late = ({tau, ...columns}) =>
    names.flatMap((name) => columns[name].slice(Math.floor(tau.length / 4)));
  return usualRange(histories.filter(Boolean).flatMap(late));
}

/** The range of 0 and of exponents without outliers. */
export function usualRange(exponents) {
  const [low, high] = [0.01, 0.99].map((share) => quantile([0, ...exponents], share));
  const margin = (high - low || 0.1) * 0.15;
  return [low - margin, high + margin];
}

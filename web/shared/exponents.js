// Lyapunov exponents of an estimator as lines of a plot.
import {lines} from "./marks.js";
import {shortTo} from "./numbers.js";

const names = ["lambda1", "lambda2", "lambda3", "lambda4"];
// Lines differ in width and dashes, not only in colour.
const styles = [{width: 2}, {}, {dash: [7, 3]}, {dash: [2, 3]}];

const absent = (status, ended) => (ended && status === "minus_infinity" ? "−∞" : "");

/** Exponents and rounding floor of an estimator as lines; along(tau, columns): time first. */
export function exponentMarks({history, status = []} = {}, along) {
  const series = styles.map((style, k) => ({
    colour: `c${k + 1}`,
    width: 1.3,
    ...style,
    label: `λ${"₁₂₃₄"[k]}`,
    text: (v, ended) => (v === null ? absent(status[k], ended) : shortTo(4, v)),
  }));
  const columns = names.map((name) => history?.[name] ?? []);
  if (history?.rounding_floor) {
    series.push({label: "rounding floor", colour: "soft", dash: [5, 4]});
    columns.push(history.rounding_floor);
  }
  const [time, ...values] = along(history?.tau ?? [], columns);
  return lines(time, values, series);
}

/** A common range of several histories, for the settled values (the last three quarters). */
export function exponentRange(histories) {
  const late = ({tau, ...columns}) =>
    names.flatMap((name) => columns[name].slice(Math.floor(tau.length / 4)));
  const known = histories.filter(Boolean).flatMap(late);
  const values = [0, ...known].filter((v) => v !== null).sort((a, b) => a - b);
  const low = values[Math.floor(values.length * 0.01)];
  const high = values[Math.ceil(values.length * 0.99) - 1];
  const margin = (high - low || 0.1) * 0.15;
  return [low - margin, high + margin];
}

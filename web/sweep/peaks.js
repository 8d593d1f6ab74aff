// Table of the largest |x| from each start over a whole axis: for a reduction that leaves no axis,
// and for the default set of starts over one axis.
import {$, reveal, tableOf} from "../shared/dom.js";
import {regimeText, startNames, symbolOf, verdicts} from "../shared/quantities.js";
import * as labels from "./axis_labels.js";

const names = {...startNames, free: "without the absorber"};

/** Motions of a point from each start of the default set, and the one without the absorber. */
const motionsOf = (p) => [
  ...(p?.starts ?? []),
  ...(p?.x_free == null ? [] : [{start: "free", x_max: p.x_free}]),
];

const alongAxis = (data) =>
  data.axes[0].values
    .flatMap((where, k) => motionsOf(data.points[data.index(k)]).map((m) => ({...m, where})))
    .filter((m) => m.x_max != null);

/** Motions of a sweep whose only axis is reduced. */
function ofStarts(data) {
  const points = data.points.filter((p) => p && !p.error);
  const nameOf = (p) => (data.starts > 1 ? `start ${p.start + 1}` : "this start");
  const own = points[0]?.starts ? [] : points.map((p) => ({...p, start: nameOf(p)}));
  return [...own, ...motionsOf(points[0])];
}

/** Shows the table if the sweep has peaks. */
export function showPeaks(data) {
  const {reduced, axes, defaultSet, request} = data;
  const bare = reduced && !axes.length;
  const shown = bare || (defaultSet && axes.length === 1 && !reduced);
  reveal({"figure-sweep-peaks": shown});
  if (!shown) return;
  const parameter = reduced ?? axes[0].parameter;
  const which = request.reduce?.startsWith("min") ? "Smallest" : "Largest";
  $("sweep-peaks-title").textContent = `${which} |x| over ${symbolOf(parameter)}, from each start`;
  const peaks = new Map(); // the highest of each start, in descending order
  const motions = bare ? ofStarts(data) : alongAxis(data);
  for (const m of motions.sort((a, b) => (b.x_max ?? -1) - (a.x_max ?? -1)))
    if (!peaks.has(m.start)) peaks.set(m.start, m);
  const head = ["start", "largest |x| (mm)", `at ${labels.label(parameter)}`, "regime", "verdict"];
  const rows = [...peaks.values()].map((m) => [
    names[m.start] ?? m.start,
    m.x_max == null ? "–" : (m.x_max * 1000).toFixed(1),
    m.where == null ? "–" : labels.text(parameter, m.where),
    m.regime ? regimeText(m.regime) : "–",
    verdicts[m.verdict] ?? "–",
  ]);
  $("sweep-peaks").replaceChildren(...tableOf(head, rows));
}

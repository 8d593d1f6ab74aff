// The largest |x| of each motion over a whole axis, as a table: of a reduction that leaves no axis,
// and of the default set over one.
import {$, element} from "../shared/dom.js";
import {regimeText, startNames, symbolOf, verdicts} from "../shared/quantities.js";

const names = {...startNames, free: "without the absorber"};

/** The highest (or lowest) of each start along the axis of a sweep. */
function alongAxis(data) {
  const [axis] = data.axes;
  const peaks = new Map();
  let free = null;
  axis.values.forEach((where, k) => {
    const p = data.at(k);
    if (p?.x_free != null && !(free?.x_max >= p.x_free))
      free = {start: "free", x_max: p.x_free, where};
    for (const m of p?.starts ?? [])
      if (m.x_max != null && !(peaks.get(m.start)?.x_max >= m.x_max))
        peaks.set(m.start, {...m, where});
  });
  return [...peaks.values(), ...(free ? [free] : [])];
}

/** Of a sweep that is reduced to nothing but its starts. */
function ofStarts(data) {
  const points = data.points.filter((p) => p && !p.error);
  const free = points[0]?.x_free;
  const nameOf = (p) => (data.starts > 1 ? `start ${p.start + 1}` : "this start");
  const motions = points[0]?.starts ?? points.map((p) => ({...p, start: nameOf(p)}));
  return [...motions, ...(free == null ? [] : [{start: "free", x_max: free}])];
}

const row = (tag, texts) =>
  element("tr", {}, ...texts.map((textContent) => element(tag, {textContent})));

/** A motion in words. */
const cellsOf = (m, numberOf) => [
  names[m.start] ?? m.start,
  m.x_max == null ? "–" : (m.x_max * 1000).toFixed(1),
  m.where == null ? "–" : numberOf(m.where),
  m.regime ? regimeText(m.regime) : "–",
  verdicts[m.verdict] ?? "–",
];

/** Shows the peaks, where a sweep has them. naming: of its axes. */
export function showPeaks(data, naming) {
  const parameter = data.reduced ?? data.axes[0]?.parameter;
  const bare = data.reduced && !data.axes.length;
  const overOne = data.defaultSet && data.axes.length === 1 && !data.reduced;
  $("figure-sweep-peaks").hidden = !bare && !overOne;
  if (!bare && !overOne) return;
  const least = data.request.reduce?.startsWith("min");
  $("sweep-peaks-title").textContent =
    `${least ? "Smallest" : "Largest"} |x| over ${symbolOf(parameter)}, from each start`;
  const place = `at ${naming.label(parameter)}`;
  const head = row("th", ["start", "largest |x| (mm)", place, "regime", "verdict"]);
  const motions = bare ? ofStarts(data) : alongAxis(data);
  motions.sort((a, b) => (b.x_max ?? -1) - (a.x_max ?? -1));
  $("sweep-peaks").replaceChildren(
    element("thead", {}, head),
    element(
      "tbody",
      {},
      ...motions.map((m) =>
        row(
          "td",
          cellsOf(m, (v) => naming.text(parameter, v)),
        ),
      ),
    ),
  );
}

// The largest |x| of each motion over a whole axis, as a table: of a reduction that leaves no axis, and of the default set over one.
import {$, element} from "./dom.js";
import {regimes, startNames, symbolOf, verdicts} from "./quantities.js";

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
  const motions =
    points[0]?.starts ??
    points.map((p) => ({...p, start: data.starts > 1 ? `start ${p.start + 1}` : "this start"}));
  return [...motions, ...(free == null ? [] : [{start: "free", x_max: free}])];
}

/** Shows the peaks, where a sweep has them. units(parameter): as in " (m)". */
export function showPeaks(data, units) {
  const parameter = data.reduced ?? data.axes[0]?.parameter;
  const bare = data.reduced && !data.axes.length;
  $("figure-sweep-peaks").hidden =
    !bare && !(data.defaultSet && data.axes.length === 1 && !data.reduced);
  if ($("figure-sweep-peaks").hidden) return;
  const names = {...startNames, free: "without the absorber"};
  const ascending = data.request.reduce?.startsWith("min");
  $("sweep-peaks-title").textContent =
    `${ascending ? "Smallest" : "Largest"} |x| over ${symbolOf(parameter)}, from each start`;
  const regime = (m) =>
    m.regime ? `${m.regime === "none" ? "" : `${m.regime}, `}${regimes[m.regime]}` : "–";
  const place = (m) => (m.where == null ? "–" : String(Number(m.where.toPrecision(6))));
  const cells = (m) => [
    names[m.start] ?? m.start,
    m.x_max == null ? "–" : (m.x_max * 1000).toFixed(1),
    place(m),
    regime(m),
    verdicts[m.verdict] ?? "–",
  ];
  const row = (m) =>
    element("tr", {}, ...cells(m).map((textContent) => element("td", {textContent})));
  const motions = (bare ? ofStarts(data) : alongAxis(data)).sort(
    (a, b) => (b.x_max ?? -1) - (a.x_max ?? -1),
  );
  const head = [
    "start",
    "largest |x| (mm)",
    `at ${symbolOf(parameter)}${units(parameter)}`,
    "regime",
    "verdict",
  ].map((textContent) => element("th", {textContent}));
  $("sweep-peaks").replaceChildren(
    element("thead", {}, element("tr", {}, ...head)),
    element("tbody", {}, ...motions.map(row)),
  );
}

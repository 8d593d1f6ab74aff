// The slow invariant manifold with the half cycles of a run on it.
import {mm, most, over} from "./columns.js";
import {pick, run} from "./run.js";

/**
 * The branches reach far beyond most runs: the plot shows what lies near the run's points, the fold
 * and the free amplitude.
 */
export function manifold() {
  const {points, fold, free_amplitude: free, stable, unstable, asymmetric} = run.more.manifold;
  const {velocity} = run.units;
  const place = ({V, C}) => ({x: over(V, velocity), y: mm(C)});
  const groups = [{...place(points), colour: "after", label: "half cycle", size: 2.2, alpha: 0.6}];
  if (fold)
    groups.push({
      ...place({V: [fold.V], C: [fold.C]}),
      colour: "wall",
      label: "fold",
      size: 8,
      alpha: 1,
    });
  const dash = [5, 4];
  const curves = [
    stable && {...place(stable), colour: "c2", label: "stable"},
    unstable && {...place(unstable), colour: "c3", dash, label: "unstable"},
    asymmetric && {...place(asymmetric), colour: "c4", dash, label: "asymmetric"},
  ];
  for (const [name, curve] of Object.entries({stable, unstable, asymmetric}))
    document.querySelector(`#figure-manifold .key.${name}`).hidden = !curve;
  const reach = (values, ...others) => [0, Math.max(most(values), ...others) * 1.15 || 0.001];
  return {
    groups,
    curves: curves.filter(Boolean),
    levels: free ? [{y: free * 1000, colour: "wall", label: "amplitude without absorber"}] : [],
    extent: place({
      V: reach(points.V, 1.4 * (fold?.V ?? 0)),
      C: reach(points.C, 1.6 * (fold?.C ?? 0), free ?? 0),
    }),
    pick: {...place(points), use: (i, clicked) => pick(points.tau[i], clicked)},
    xLabel: `speed of the free mass, V (${velocity.unit})`,
    yLabel: "amplitude of x, C (mm)",
  };
}

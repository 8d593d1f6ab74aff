// The slow invariant manifold with the half cycles of a run on it.
import {mm, over} from "./columns.js";

/**
 * The branches reach far beyond most runs: the plot shows what lies near the run's points, the fold
 * and the free amplitude. show(tau): called with the half cycle that is pointed at.
 */
export function drawManifold(plot, manifold, {velocity}, show) {
  const {points, fold, free_amplitude: free} = manifold;
  const place = ({V, C}) => ({x: over(V, velocity), y: mm(C)});
  const groups = [{...place(points), colour: "after", size: 2.2, alpha: 0.6}];
  if (fold) groups.push({...place({V: [fold.V], C: [fold.C]}), colour: "wall", size: 8, alpha: 1});
  const branches = [
    {branch: manifold.stable, colour: "c2"},
    {branch: manifold.unstable, colour: "c3", dash: [5, 4]},
    {branch: manifold.asymmetric, colour: "c4", dash: [5, 4]},
  ];
  const curves = branches
    .filter(({branch}) => branch)
    .map(({branch, ...style}) => ({...place(branch), ...style}));
  const most = (values, quantity, ...others) =>
    quantity.of(values.reduce((a, v) => Math.max(a, v), Math.max(...others))) * 1.15 || 1;
  const length = {of: (v) => v * 1000};
  plot.draw({
    groups,
    curves,
    levels: free ? [{y: free * 1000, colour: "wall", label: "amplitude without absorber"}] : [],
    extent: {
      x: [0, most(points.V, velocity, 1.4 * (fold?.V ?? 0))],
      y: [0, most(points.C, length, 1.6 * (fold?.C ?? 0), free ?? 0)],
    },
    pick: {...place(points), use: (i) => show(points.tau[i])},
    xLabel: `speed of the free mass, V (${velocity.unit})`,
    yLabel: "amplitude of x, C (mm)",
  });
}

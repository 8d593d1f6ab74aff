// A long line drawn by the extremes of its blocks: as fast as a short one, and no spike is lost.
import uPlot from "./uPlot.esm.js";

const size = 64; // samples of a block
const exact = uPlot.paths.linear();

/** For the option `paths` of uPlot's series. */
export function envelope(values) {
  const blocks = Math.ceil(values.length / size);
  const low = new Float64Array(blocks).fill(Infinity);
  const high = new Float64Array(blocks).fill(-Infinity);
  values.forEach((v, i) => {
    const k = Math.floor(i / size);
    if (v < low[k]) low[k] = v;
    if (v > high[k]) high[k] = v;
  });
  return (u, series, from, to) => {
    const narrow = to - from >= 2 * size * u.bbox.width; // a block is at most half a pixel wide
    if (!narrow) return exact(u, series, from, to);
    const stroke = new Path2D();
    const t = u.data[0];
    for (let k = Math.floor(from / size); k <= Math.floor(to / size); ++k) {
      const x = u.valToPos(t[Math.min(k * size + size / 2, t.length - 1)], "x", true);
      stroke.lineTo(x, u.valToPos(low[k], "y", true));
      stroke.lineTo(x, u.valToPos(high[k], "y", true));
    }
    return {stroke, fill: null, clip: null, band: null, gaps: null, flags: 1};
  };
}

// The pinned run, compared with the runs that follow. The address holds its query.
import {$, reveal, setTexts} from "../shared/dom.js";
import {motionOf} from "../shared/motion.js";
import {digits, percent} from "../shared/numbers.js";
import * as mainPlots from "./main_plots.js";
import {toQuery} from "./request.js";
import {run} from "./run.js";
import {parameterLine} from "./sliders.js";

let pinned = null; // {query, answer, motion}

/** The query of the pinned run; null without one. */
export const query = () => pinned?.query ?? null;

const resultsOf = ({energy, exponents: {qr}, regime}) => ({
  "rms of x": percent(energy.rms_ratio),
  "λ₁": digits(qr?.final[0], 3),
  z: digits(regime.z, 2),
});

export function compare() {
  if (!pinned?.answer || !run) return setTexts({"pinned-run": ""});
  const [before, now] = [pinned.answer, run.answer].map(resultsOf);
  const changes = Object.keys(now).map((name) => `${name} ${before[name]} → ${now[name]}`);
  const what = parameterLine(pinned.answer.parameters);
  setTexts({"pinned-run": `pinned: ${what}. Pinned → shown: ${changes.join(", ")}`});
}

function keep(other) {
  pinned = other;
  const there = other?.answer ? other : null;
  reveal({swap: there, unpin: there});
  compare();
  mainPlots.pin(there);
}

/** Pins the run of a query, or none; ask(fields) requests a run. */
export async function restore(wanted, ask) {
  if (wanted === query()) return;
  keep(wanted === null ? null : {query: wanted});
  if (wanted === null) return;
  const {preset, ...texts} = Object.fromEntries(new URLSearchParams(wanted));
  try {
    const answer = await ask({...(preset && {preset}), ...texts});
    if (query() === wanted) keep({query: wanted, answer, motion: motionOf(answer)});
  } catch (error) {
    setTexts({"pinned-run": `the pinned run cannot be shown: ${error.message}`});
  }
}

/** changed() is called when another run is pinned or unpinned; show(query) shows a run. */
export function start(changed, show) {
  const shown = () => run && {...run, query: toQuery(run.fields)};
  const set = (other) => {
    keep(other);
    changed();
  };
  $("pin").onclick = () => set(shown());
  $("unpin").onclick = () => set(null);
  $("swap").onclick = () => {
    const other = query();
    keep(shown());
    show(other);
  };
}

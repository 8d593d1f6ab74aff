// A run that is kept beside those that follow, to compare them with it. The address holds its query.
import {get} from "../shared/api.js";
import {$, reveal, write} from "../shared/dom.js";
import {Motion} from "../shared/motion.js";
import * as instrument from "./instrument.js";
import {toQuery} from "./request.js";
import {run} from "./run.js";
import {parameterLine} from "./sliders.js";

let pinned = null; // {query, answer, motion}

/** The query of the run that is pinned, null where there is none. */
export const query = () => pinned?.query ?? null;

function keep(other) {
  pinned = other;
  const there = other?.answer ? other : null;
  reveal({swap: there, unpin: there});
  write({"pinned-run": there ? `pinned: ${parameterLine(there.answer.parameters)}` : ""});
  instrument.pin(there);
}

/** Pins the run of a query, or none; ask: what of it is needed. */
export async function restore(wanted, ask) {
  if (wanted === query()) return;
  keep(wanted === null ? null : {query: wanted});
  if (wanted === null) return;
  const all = new URLSearchParams(wanted);
  for (const [name, list] of Object.entries(ask)) all.set(name, list.join());
  if (!all.get("preset")) all.delete("preset");
  try {
    const answer = await get(`v1/simulate?${all}`);
    if (query() === wanted) keep({query: wanted, answer, motion: new Motion(answer)});
  } catch (error) {
    write({"pinned-run": `the run to compare with: ${error.message}`});
  }
}

/** changed(): another run is pinned, or none; show(query): shows the run of a query. */
export function start(changed, show) {
  const keepShown = () => keep(run && {...run, query: toQuery(run.asked)});
  $("pin").onclick = () => {
    keepShown();
    changed();
  };
  $("unpin").onclick = () => {
    keep(null);
    changed();
  };
  $("swap").onclick = () => {
    const other = query();
    keepShown();
    show(other);
  };
}

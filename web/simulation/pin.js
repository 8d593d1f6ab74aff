// A run that is kept beside those that follow, to compare them with it. The address holds its query.
import {get} from "../shared/api.js";
import {$, write} from "../shared/dom.js";
import {Motion} from "../shared/motion.js";
import {parameterLine} from "./sliders.js";

let pinned = null; // {query, answer, motion}
let compare = () => {};

/** The query of the run that is pinned, null where there is none. */
export const query = () => pinned?.query ?? null;

function keep(run) {
  pinned = run;
  const there = run?.answer ? run : null;
  for (const id of ["swap", "unpin"]) $(id).hidden = !there;
  write("pinned-run", there ? `pinned: ${parameterLine(there.answer.parameters)}` : "");
  compare(there);
}

/** Pins the run of a query, or none; ask: what of it is needed. */
export async function restore(wanted, ask) {
  if (wanted === query()) return;
  keep(wanted === null ? null : {query: wanted});
  if (wanted === null) return;
  const all = new URLSearchParams(wanted);
  for (const [name, list] of Object.entries(ask)) all.set(name, list.join());
  const answer = await get(`v1/simulate?${all}`);
  if (query() === wanted) keep({query: wanted, answer, motion: new Motion(answer)});
}

/**
 * run(): {query, answer, motion} of what is shown; draw: shows a run, or none, beside what is shown;
 * show(query): shows the run of another one;
 * show(): another one is pinned.
 */
export function start(run, draw, show) {
  compare = draw;
  const pin = (other, wanted) => {
    keep(other);
    show(wanted);
  };
  $("pin").onclick = () => pin(run());
  $("unpin").onclick = () => pin(null);
  $("swap").onclick = () => pin(run(), query());
}

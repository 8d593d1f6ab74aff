// A run that is kept beside those that follow, to compare them with it. The address holds its query.
import {get} from "../shared/api.js";
import {$} from "../shared/dom.js";
import {Motion} from "../shared/motion.js";
import {parameterLine} from "./captions.js";

let pinned = null; // {query, answer, motion}
let compare = () => {};

/** The query of the run that is pinned, null where there is none. */
export const query = () => pinned?.query ?? null;

function keep(run) {
  pinned = run;
  for (const id of ["swap", "unpin"]) $(id).hidden = !pinned?.answer;
  $("pinned-run").textContent = pinned?.answer
    ? `pinned: ${parameterLine(pinned.answer.parameters)}`
    : "";
  compare(pinned?.answer ? pinned : null);
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
  const swap = () => {
    const {query: other} = pinned;
    keep(run());
    show(other);
  };
  const pin = (other) => {
    keep(other);
    show();
  };
  $("pin").addEventListener("click", () => pin(run()));
  $("unpin").addEventListener("click", () => pin(null));
  $("swap").addEventListener("click", swap);
}

// A run that is kept beside those that follow, to compare them with it.
import {$} from "../shared/dom.js";
import {parameterLine} from "./captions.js";

let pinned = null;

function tell() {
  for (const id of ["swap", "unpin"]) $(id).hidden = !pinned;
  $("pinned-run").textContent = pinned ? `pinned: ${parameterLine(pinned.answer.parameters)}` : "";
}

/**
 * run(): {asked, answer, motion} of what is shown; compare(run): draws it, or none, beside what is
 * shown; show(asked): shows the run of another request.
 */
export function start(run, compare, show) {
  const keep = (other) => {
    pinned = other;
    tell();
    compare(pinned);
  };
  $("pin").addEventListener("click", () => keep(run()));
  $("unpin").addEventListener("click", () => keep(null));
  $("swap").addEventListener("click", () => {
    const {asked} = pinned;
    keep(run());
    show(asked);
  });
}

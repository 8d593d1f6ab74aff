// Everything else that is known of a run: it is asked for once one unfolds it, and follows the run
// from then on.
import {simulate} from "../shared/api.js";
import {$, countUp, sayIn} from "../shared/dom.js";
import {Job} from "../shared/job.js";
import {detailsOptions, overTime, planes} from "./details_plots.js";
import {accountEnergy, summarise, tabulate} from "./details_summary.js";
import {marksOf} from "./marks.js";
import {showModel} from "./model.js";
import {listParameters} from "./parameters.js";
import {Plots} from "./plots.js";
import {axis, run} from "./run.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime"];

const details = $("details");
const say = sayIn("details-message");
let shown = null; // {asked, answer}
let plots;
let fieldOf;

const job = new Job({
  ask: (asked, signal) => simulate({perturbation: {size: 1e-9}, ...asked, include}, signal),
  show(answer, asked) {
    if (asked !== run.asked) return;
    shown = {asked, answer};
    show();
  },
  fail: (error) => say(error.message),
  busy: (is) => is && say("computing …"),
  later: say,
});

/** Another run is shown, or the same in other units. */
export function follow() {
  if (!details.open || !run) return;
  if (shown?.asked === run.asked) show();
  else job.start(run.asked);
}

function show() {
  const {answer} = shown;
  const {units} = run;
  say("");
  plots ??= new Plots(overTime, planes);
  summarise(answer, units);
  listParameters(answer.parameters, fieldOf);
  tabulate(answer.windows, units);
  accountEnergy(answer.energy, units);
  plots.marks = marksOf(answer);
  for (const [name, options] of Object.entries(detailsOptions(answer))) plots.draw(name, options);
  light();
  countUp(details);
  if (!$("model-sketch").hasChildNodes()) showModel().catch(() => {}); // the equations do without it
}

/** Rings the impact nearest to the cursor. */
function light() {
  if (!details.open || shown?.asked !== run?.asked) return;
  const i = run.motion.impactNear(axis.cursor);
  for (const name of ["portrait", "velocities"]) plots.ring(name, i);
}

export const redraw = () => plots?.refresh();

/** table: the fields of /v1/parameters by name. */
export function start(table) {
  fieldOf = table;
  details.ontoggle = follow;
  $("to-details").onclick = () => {
    details.open = true;
  };
  axis.onCursor(light);
}

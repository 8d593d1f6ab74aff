// The details of a run. They are requested when the section is first opened and then for each new
// run.
import {simulate} from "../shared/api.js";
import {$, countUp, sayIn} from "../shared/dom.js";
import {Job} from "../shared/job.js";
import {detailsOptions} from "./details_plots.js";
import {accountEnergy, listParameters, summarise, tabulate} from "./details_summary.js";
import {commonOptions, PlotGroup} from "./plot_group.js";
import {run} from "./run.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime"];
const perturbation = {size: 1e-9}; // needs a motion in closed form

const details = $("details");
const say = sayIn("details-message");
let plots;
let fieldOf;

const job = new Job({
  ask: (fields, signal) =>
    simulate({...(!run.answer.series && {perturbation}), ...fields, include}, signal),
  show(answer, fields) {
    if (fields !== run.fields) return;
    run.details = answer;
    show();
  },
  fail: (error) => say(error.message),
  busy: (is) => is && say("computing …"),
  later: say,
});

/** Called for a new run or other units. */
export function follow() {
  if (!details.open || !run) return;
  if (run.details) show();
  else job.start(run.fields);
}

function show() {
  const {details: answer, units} = run;
  say("");
  plots ??= new PlotGroup(details);
  summarise(answer, units);
  listParameters(answer.parameters, fieldOf);
  tabulate(answer.windows, units);
  accountEnergy(answer.energy, units);
  plots.common = commonOptions(answer);
  for (const [name, options] of Object.entries(detailsOptions(answer))) plots.draw(name, options);
  countUp(details);
  if (!$("model-sketch").hasChildNodes()) showModel().catch(() => {}); // optional
}

export const redraw = () => plots?.refresh();

/** table: fields of /v1/parameters by name. */
export function start(table) {
  fieldOf = table;
  details.ontoggle = follow;
  $("to-details").onclick = () => {
    details.open = true;
  };
}

/** Shows the drawing of the system in the page's colours. */
async function showModel() {
  const sketch = $("model-sketch");
  sketch.innerHTML = await (await fetch(sketch.dataset.src)).text();
}

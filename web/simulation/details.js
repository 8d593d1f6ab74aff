// Everything else that is known of a run: it is asked for once one unfolds it, and follows the run
// from then on.
import {simulate} from "../shared/api.js";
import {$, countUp, write} from "../shared/dom.js";
import {Job} from "../shared/job.js";
import {detailsOptions, overTime, planes} from "./details_plots.js";
import {accountEnergy, summarise, tabulate} from "./details_summary.js";
import {marksOf} from "./marks.js";
import {showModel} from "./model.js";
import {listParameters} from "./parameters.js";
import {Plots} from "./plots.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime"];

export class Details {
  /** axis: of time; run(): {asked, answer, units} of what is shown; fieldOf: of /v1/parameters. */
  constructor(axis, run, fieldOf) {
    Object.assign(this, {axis, run, fieldOf});
    const say = (text) => write("details-message", text);
    this.job = new Job({
      ask: (asked, signal) => simulate({perturbation: {size: 1e-9}, ...asked, include}, signal),
      show: (answer, asked) => this.show(answer, asked),
      fail: (error) => say(error.message),
      busy: (is) => is && say("computing …"),
      later: say,
    });
    $("details").ontoggle = () => this.follow();
    axis.onCursor(() => this.light());
  }

  /** Another run is shown, or the same in other units. */
  follow() {
    const run = this.run();
    if (!$("details").open || !run) return;
    if (this.shown?.asked === run.asked) this.show(this.shown.answer, run.asked);
    else this.job.start(run.asked);
  }

  show(answer, asked) {
    const {axis} = this;
    const {units, asked: newest} = this.run();
    if (asked !== newest) return;
    this.shown = {answer, asked};
    write("details-message", "");
    this.plots ??= new Plots(axis, overTime, planes, () => this.run().answer.impacts.tau);
    summarise(answer, units);
    listParameters(answer.parameters, this.fieldOf);
    tabulate(answer.windows, units);
    accountEnergy(answer.energy, units);
    this.plots.marks = marksOf(answer, units);
    const all = detailsOptions(answer, units, (tau) => axis.point(tau, "pick"));
    for (const [name, options] of Object.entries(all)) this.plots.draw(name, options);
    this.light();
    countUp($("details"));
    if (!$("model-sketch").hasChildNodes()) showModel().catch(() => {}); // the equations do without it
  }

  /** Rings the impact nearest to the cursor. */
  light() {
    const run = this.run();
    if (!$("details").open || this.shown?.asked !== run?.asked) return;
    const i = run.motion.impactNear(this.axis.cursor);
    for (const name of ["portrait", "velocities"]) this.plots.ring(name, i);
  }
}

// Everything else that is known of a run: it is asked for once one unfolds it, and follows the run
// from then on.
import {simulate} from "../shared/api.js";
import {$, countUp} from "../shared/dom.js";
import {addMenu} from "../shared/figure_menu.js";
import {Job} from "../shared/job.js";
import {operable} from "../shared/operable.js";
import {aboutFigure} from "./captions.js";
import {drawDetails, makePlots, placesOf} from "./details_plots.js";
import {accountEnergy, summarise, tabulate} from "./details_summary.js";
import {marksOf} from "./marks.js";
import {showModel} from "./model.js";
import {listParameters} from "./parameters.js";

const include = ["series", "impacts", "exponents", "eigenvalues", "section", "energy", "regime"];

export class Details {
  /** axis: of time; run(): {asked, answer, units} of what is shown; fields: of /v1/parameters. */
  constructor(axis, run, fields) {
    this.run = run;
    this.axis = axis;
    this.fieldOf = Object.fromEntries(fields.map((f) => [f.name, f]));
    this.plots = null;
    this.job = new Job({
      ask: (asked, signal) => simulate({perturbation: {size: 1e-9}, ...asked, include}, signal),
      show: (answer, asked) => this.show(answer, asked),
      fail: (error) => this.say(error.message),
      busy: (is) => {
        if (is) this.say("computing …");
      },
      later: (text) => this.say(text),
    });
    $("details").addEventListener("toggle", () => this.follow());
    axis.onCursor(() => this.light());
  }

  say(text) {
    $("details-message").textContent = text;
  }

  /** Another run is shown, or the same in other units. */
  follow() {
    const run = this.run();
    if (!$("details").open || !run) return;
    if (this.shown?.asked === run.asked) this.show(this.shown.answer, run.asked);
    else this.job.start(run.asked);
  }

  show(answer, asked) {
    const {units, asked: newest} = this.run();
    if (asked !== newest) return;
    this.shown = {answer, asked};
    this.say("");
    this.plots ??= this.makePlots();
    summarise(answer, units);
    listParameters(answer.parameters, this.fieldOf);
    tabulate(answer.windows, units);
    accountEnergy(answer.energy, units);
    const point = (tau) => this.axis.point(tau, "pick");
    drawDetails(this.plots, answer, marksOf(answer, units), units, point);
    this.places = placesOf(answer.impacts, units);
    this.light();
    countUp($("details"));
    if (!$("model-sketch").hasChildNodes()) showModel().catch(() => {}); // the equations do without it
  }

  /** Rings the impact nearest to the cursor. */
  light() {
    const run = this.run();
    if (!$("details").open || this.shown?.asked !== run?.asked) return;
    const i = run.motion.impactNear(this.axis.cursor);
    for (const [name, {x, y}] of Object.entries(this.places)) this.plots[name].light(x[i], y[i]);
  }

  makePlots() {
    const plots = makePlots(this.axis);
    for (const [name, plot] of Object.entries(plots)) {
      addMenu($(`figure-${name}`), plot, () => aboutFigure(name));
      operable(plot, aboutFigure(name).title, () => this.run().answer.impacts.tau);
    }
    return plots;
  }

  redraw() {
    for (const plot of Object.values(this.plots ?? {})) plot.refresh();
  }
}

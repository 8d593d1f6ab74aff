// The motion that the page reconstructs from impacts equals that of the service up to rounding.
import assert from "node:assert/strict";
import {after, before, test} from "node:test";
import {Motion} from "../../web/shared/motion.js";
import {startService} from "../service.mjs";

let service;
before(async () => {
  service = await startService();
});
after(() => service.stop());

async function answerTo(query) {
  const include = "include=series,impacts&samples_per_cycle=24";
  return (await fetch(`${service.url}/v1/simulate?${query}&${include}`)).json();
}

const cases = {
  "strongly modulated, with sticking": "preset=fig3",
  "periodic, with sticking": "preset=fig11",
  "an experiment in SI": "preset=fig20",
  "dense impacts": "preset=fig14",
  "sticking at each impact": "R=0&b=0.01&tau_end=500",
  "chatter and release in each cycle": "epsilon=0.5&lambda=3&R=0.3&b=0.01&G=0.1&tau_end=500",
  "a heavy absorber": "epsilon=1&lambda=2&b=0.05&R=0.5&tau_end=500",
  "different walls": "R_plus=0.9&R_minus=0.3&tau_end=600",
  "a free decay": "G=0&x0=0.02&tau_end=600",
  "no impact for a long time": "b=0.5&tau_end=3000",
  "undamped resonance": "lambda=0&b=1&tau_end=5000",
  overdamped: "lambda=200&G=0.5&tau_end=300",
  "fast forcing": "Omega=20&G=5&b=0.001&tau_end=100",
  "slow forcing": "Omega=0.01&G=3&tau_end=3000",
};

for (const [name, query] of Object.entries(cases))
  test(`equal at every sample and at the end: ${name}`, async () => {
    const answer = await answerTo(query);
    const {series} = answer;
    const motion = new Motion(answer);
    let worst = 0;
    series.tau.forEach((tau, i) => {
      const state = motion.at(tau);
      for (const part of ["x", "y", "x_dot", "y_dot"])
        worst = Math.max(worst, Math.abs(state[part] - series[part][i]));
    });
    assert.ok(worst < 1e-12, `${worst} m`);
  });

test("a zoomed trace follows the motion, a dense one contains it, and impacts reach the walls", async () => {
  const answer = await answerTo("preset=fig3");
  const motion = new Motion(answer);
  const near = motion.trace(700, 730, 500);
  assert.equal(near.dense, false);
  near.tau.forEach((tau, i) => {
    const {x, y} = motion.at(tau);
    assert.ok(Math.abs(near.x[i] - x) < 1e-12 && Math.abs(near.gap[i] - (y - x)) < 1e-12, `${tau}`);
  });
  const wide = motion.trace(0, motion.end, 300);
  assert.equal(wide.dense, true);
  const {tau, side} = answer.impacts;
  const width = motion.end / 300;
  const within = (line, at, value, slack) => {
    const k = 2 * Math.min(Math.floor(at / width), 299);
    return value >= line[k] - slack && value <= line[k + 1] + slack;
  };
  for (const [i, at] of tau.entries())
    assert.ok(within(wide.gap, at, -side[i] * motion.b, 0), `impact ${i}`);
  // Between two samples x bends by less than a fiftieth of its amplitude, and the end of a column
  // is less than a sample away from the next one.
  const beside = (at) => [at, Math.max(at - motion.cycle / 16, 0), at + motion.cycle / 16];
  for (const [i, at] of answer.series.tau.entries())
    assert.ok(
      beside(at).some((t) => within(wide.x, t, answer.series.x[i], 2e-4)),
      `x at ${at}`,
    );
});

test("an oscillator faster than its forcing is drawn without aliasing", async () => {
  const query = "Omega=0.05&b=0.1&x0=0.002&y0=0.002&tau_end=8000&lambda=0";
  const motion = new Motion(await answerTo(query));
  const {x, dense} = motion.trace(0, motion.end, 600);
  assert.ok(dense);
  const heights = Array.from({length: 600}, (_, k) => x[2 * k + 1] - x[2 * k]);
  const least = Math.min(...heights);
  assert.ok(least > 0.0037, `${least} of 0.004 m between the extremes of a pixel`);
});

test("a trace is empty outside the run", async () => {
  const motion = new Motion(await answerTo("tau_end=100"));
  const {x, tau} = motion.trace(90, 110, 100);
  for (const [i, t] of tau.entries()) assert.equal(Number.isNaN(x[i]), t > 100, `${t}`);
  const wide = motion.trace(0, 1000, 10);
  assert.ok(wide.dense);
  assert.ok(wide.x.slice(0, 2).every(Number.isFinite) && wide.x.slice(4).every(Number.isNaN));
});

// The motion that the page reconstructs from impacts equals that of the service up to rounding.
import assert from "node:assert/strict";
import {after, before, test} from "node:test";
import {loadOf} from "../../web/measurement/record.js";
import {Motion, motionOf} from "../../web/shared/motion.js";
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

/** A chirp of the base through the resonance of a machine. */
function chirp() {
  const time_s = Array.from({length: 2001}, (_, k) => k / 200);
  const acceleration_m_s2 = time_s.map((t) => 2 * Math.sin(2 * Math.PI * (6 + 0.2 * t) * t));
  return {time_s, acceleration_m_s2};
}
const machine = {m1: 2, f0: 8, damping_ratio: 0.01, m2: 0.04, b: 0.02, R: 0.5};
const laws = {
  gravity: {preset: "fig11", gravity: 0.002, tau_end: 300},
  friction: {preset: "fig11", friction: 0.0003, tau_end: 300},
  "a vertical track": {...machine, F: 0.002, f: 8, inclination: 1.5, cycles: 40},
  "a recorded load": {...machine, forcing: chirp()},
};

for (const [name, fields] of Object.entries(laws))
  test(`between the samples the motion is known to 0.1 % of its amplitude: ${name}`, async () => {
    const include = ["series", "impacts", "energy"];
    const answerWith = async (samples) => {
      const body = JSON.stringify({...fields, include, samples_per_cycle: samples});
      return (await fetch(`${service.url}/v1/simulate`, {method: "POST", body})).json();
    };
    const [coarse, fine] = [await answerWith(32), await answerWith(64)];
    const motion = motionOf(coarse);
    const {series} = fine;
    let worst = 0;
    series.tau.forEach((tau, i) => {
      const {x, y} = motion.at(tau);
      const apart = Math.hypot(x - series.x[i], y - x - (series.y[i] - series.x[i]));
      worst = Math.max(worst, apart);
    });
    assert.ok(coarse.impacts.tau.length > 20);
    assert.ok(worst < 1e-3 * coarse.energy.peak, `${worst} m`);
  });

test("under a load of the base the motion is relative to the base", async () => {
  const forcing = {time_s: [0, 1, 2, 3], acceleration_m_s2: [0, 1, 1, 1]};
  const body = JSON.stringify({...machine, forcing, include: ["series", "impacts"]});
  const answer = await (await fetch(`${service.url}/v1/simulate`, {method: "POST", body})).json();
  const {tau, x} = answer.series;
  const omega0 = answer.parameters.derived.omega0;
  // By hand: the acceleration rises to 1 m/s^2 in 1 s, then stays.
  const base = (t) => (t < 1 ? t ** 3 / 6 : 1 / 6 + (t - 1) / 2 + (t - 1) ** 2 / 2);
  const motion = motionOf(answer, forcing);
  tau.forEach((moment, i) => {
    const expected = x[i] - base(moment / omega0);
    assert.ok(Math.abs(motion.at(moment).x - expected) < 1e-9, `${moment}`);
  });
});

test("a recorded load is read in the units of its columns", () => {
  const load = (name) =>
    loadOf({
      names: ["time_ms", name],
      units: [],
      columns: [
        [0, 1],
        [0, 2000],
      ],
    });
  const time_s = [0, 0.001];
  assert.deepEqual(load("base_acceleration (mm/s\u00b2)"), {time_s, acceleration_m_s2: [0, 2]});
  assert.deepEqual(load("acceleration_mm_s2"), {time_s, acceleration_m_s2: [0, 2]});
  assert.deepEqual(load("displacement_um"), {time_s, displacement_m: [0, 0.002]});
  assert.deepEqual(load("force (kN)"), {time_s, force_N: [0, 2000000]});
});

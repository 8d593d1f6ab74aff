// Comparison of vines with general integrators on the same motions, in turn in one run on one core:
// scripts/bench peers. vines is also the reference: tests/core/reference checks its impacts against
// 250-digit arithmetic.
import {spawn, spawnSync} from "node:child_process";
import os from "node:os";
import {createInterface} from "node:readline";

const rounds = 7;
const segments = 2000;
const chatters = 20;
const early = 80; // in tau: until then chaotic runs still agree
const cycle = 2 * Math.PI;
const apart = 1e-3; // in tau: impacts further apart are different ones
const narrow = 0.02; // in tau: closer contacts belong to a chatter

// Table 1 of the paper, damping by the equation of motion.
const [m1, c1, k1, m2] = [3.807, 2.53, 11.68e3, 0.032];
const table1 = {epsilon: m2 / m1, lambda: c1 / (m2 * Math.sqrt(k1 / m1)), G: 0.02, Omega: 1};
const orbits = [
  {name: "b = 15 mm, two impacts per cycle", b: 0.015, R: 0.6},
  {name: "b = 8 mm, three impacts per cycle", b: 0.008, R: 0.6},
  {name: "b = 3 mm, irregular", b: 0.003, R: 0.6},
  {name: "b = 22 mm, irregular", b: 0.022, R: 0.6},
  {name: "b = 34 mm, sparse", b: 0.034, R: 0.6},
  {name: "b = 3 mm, R = .2, a chatter with a stick twice a cycle", b: 0.003, R: 0.2},
];

const built = (name) => [
  new URL(`../../../build/release/tests/peers/${name}`, import.meta.url).pathname,
];
const script = new URL("solve_ivp.py", import.meta.url).pathname;
const programs = {
  vines: built("peer_vines"),
  odeint: built("peer_odeint"),
  sundials: built("peer_sundials"),
  scipy: ["/usr/bin/python3", script], // Debian's Python, which has Debian's SciPy
};
// Tolerances: the loosest powers of ten for which 99 % of the impact times of segments have errors
// below 4e-9 up to b = 22 mm. If the step is limited, the limit alone determines accuracy and time.
// `time_only`: the same motion as the entry above; only its time is measured.
const vines = {program: "vines", tolerance: 0};
const scipy = {program: "scipy", method: "DOP853"};
const peers = [
  {name: "vines", ...vines, method: "motion", forget: true},
  {name: "vines, system seen before", ...vines, method: "motion", time_only: true},
  {name: "vines with exponents", ...vines, method: "exponents", forget: true, time_only: true},
  {name: "odeint dopri5", program: "odeint", method: "dopri5", tolerance: 1e-11},
  {name: "CVODE Adams", program: "sundials", method: "cvode", tolerance: 1e-12},
  {name: "SciPy DOP853", ...scipy, tolerance: 1e-11},
  {name: "SciPy DOP853, max_step .2", ...scipy, tolerance: 1e-8, longest_step: 0.2},
];

/** A program that answers lines one by one. */
class Program {
  constructor([command, ...words]) {
    this.child = spawn(command, words, {stdio: ["pipe", "pipe", "inherit"]});
    this.lines = createInterface({input: this.child.stdout})[Symbol.asyncIterator]();
  }
  async ask(question) {
    this.child.stdin.write(`${JSON.stringify(question)}\n`);
    const {value, done} = await this.lines.next();
    if (done) throw new Error(`${this.child.spawnargs.join(" ")} has ended`);
    return JSON.parse(value);
  }
}
const running = Object.fromEntries(
  Object.entries(programs).map(([name, command]) => [name, new Program(command)]),
);

/** Motion from vines' default start. */
const whole = ({b, R}, tau_end = 1709) => {
  const start = {x_dot: 0, x: 0, y_dot: 0, y: 0.95 * b, side: 0, tau: 0};
  return {...table1, b, R, ...start, tau_end};
};
const follow = ({program, method, tolerance, longest_step = 0}, job) =>
  running[program].ask({method, tolerance, longest_step, ...job});
const reference = {...vines, method: "reference"};

/** Motion of a reference from just after its contact i. */
const onwards = (orbit, {tau, side, states}, i, tau_end) => {
  const [x_dot, x, y_dot, y] = states.slice(4 * i, 4 * i + 4);
  return {
    ...table1,
    b: orbit.b,
    R: orbit.R,
    x_dot,
    x,
    y_dot,
    y,
    side: side[i],
    tau: tau[i],
    tau_end,
  };
};

/**
 * Segments of one forcing cycle, each starting just after a contact, with their contacts. A segment
 * ends before a chatter, if one begins in it.
 */
function segmentsOf(orbit, run) {
  const {tau} = run;
  const found = [];
  for (let i = 1; i < tau.length && found.length < segments; ++i) {
    if (tau[i] - tau[i - 1] < narrow || tau[i + 1] - tau[i] < narrow) continue;
    const end = tau[i] + cycle;
    let last = i; // contact of the segment
    while (tau[last + 1] < end && tau[last + 1] - tau[last] >= narrow) ++last;
    const chatter = tau[last + 1] < end;
    if (tau[last + 1] === undefined) break; // end of the reference
    // Ends before the first contact of a chatter, otherwise shortly after the cycle.
    const until = chatter ? tau[last] - apart : end + 0.1;
    const contacts = tau.slice(i + 1, chatter ? last : last + 1);
    found.push({job: onwards(orbit, run, i, until), tau: contacts, until: Math.min(until, end)});
  }
  return found;
}

/** Results of a peer for the segments. A segment counts up to the first contact that differs. */
async function compare(peer, list) {
  const errors = [];
  const result = {contacts: 0, missed: 0, invented: 0};
  for (const {job, tau, until} of list) {
    const answer = await follow(peer, job);
    result.contacts += tau.length;
    const differs = tau.findIndex((t, i) => !(Math.abs(answer.tau[i] - t) < apart));
    const same = differs < 0 ? tau.length : differs;
    for (let i = 0; i < same; ++i) errors.push(Math.abs(answer.tau[i] - tau[i]));
    const next = answer.tau[same] ?? Number.POSITIVE_INFINITY;
    if (next < Math.min(tau[same] ?? until, until) - apart) ++result.invented;
    else if (differs >= 0) ++result.missed;
  }
  errors.sort((a, b) => a - b);
  return {...result, most: errors.at(-1), usual: errors[Math.floor(0.99 * errors.length)]};
}

/** How a peer continues after the last contact before a chatter: each end, and its frequency. */
async function throughChatters(peer, orbit, run) {
  const ends = {};
  for (const stick of run.sticks.slice(0, chatters)) {
    let i = run.tau.findIndex((t) => t >= stick - 1e-6);
    while (run.tau[i] - run.tau[i - 1] < narrow) --i;
    const {end} = await follow(peer, onwards(orbit, run, i, stick + cycle));
    ends[end] = (ends[end] ?? 0) + 1;
  }
  return Object.entries(ends)
    .map(([end, count]) => `${end === "tau_end" ? "goes on" : end} (${count})`)
    .join(", ");
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const percent = (part) => `${(100 * part).toFixed(0)} %`;

/** ns per contact of runs from the start to tau_end, measured in turn, and their ratio to vines'. */
async function times(orbit, tau_end) {
  const all = peers.map(() => []);
  for (let round = 0; round < rounds; ++round)
    for (const [k, peer] of peers.entries()) {
      const job = {...whole(orbit, tau_end), seconds: 0.1, forget: peer.forget ?? false};
      all[k].push((await follow(peer, job)).nanoseconds);
    }
  return all.map((values) => ({
    middle: median(values),
    spread: (Math.max(...values) - Math.min(...values)) / median(values),
    ratio: median(values.map((value, round) => value / all[0][round])),
  }));
}

const columns = [
  "ns per impact",
  "spread",
  "x vines",
  `to ${early}`,
  "same until",
  "missed",
  "false",
  "99 % within",
  "largest error",
];
const row = (name, cells) =>
  `${name.padEnd(26)}${cells.map((cell, i) => cell.padStart(Math.max(columns[i].length, 8) + 2)).join("")}`;

/** Errors of a peer's run from the start, and of its segments, relative to the reference. */
async function agreement(peer, run, base, list) {
  const parted = base.tau.find((t, i) => !(Math.abs(t - run.tau[i]) < apart));
  const found = await compare(peer, list);
  return [
    `${run.tau.filter((t) => t < early).length}/${base.tau.filter((t) => t < early).length}`,
    parted === undefined ? "the end" : parted.toFixed(0),
    `${found.missed}/${found.contacts}`,
    String(found.invented),
    found.usual.toExponential(0),
    found.most.toExponential(0),
  ];
}

async function measure(orbit) {
  const base = await follow(reference, whole(orbit));
  const runs = [];
  for (const peer of peers) runs.push(await follow(peer, whole(orbit)));
  // Timed until the first of them ends in a chatter.
  const ended = runs.filter((run) => run.end !== "tau_end").map((run) => run.tau.at(-1) - 10);
  const tau_end = Math.floor(Math.min(1709, ...ended));
  const timed = await times(orbit, tau_end);
  const long = await follow(reference, whole(orbit, 80000));
  const list = segmentsOf(orbit, long);
  console.log(`\n${orbit.name}; timed to tau = ${tau_end}, ${list.length} segments`);
  console.log(row("", columns));
  for (const [k, peer] of peers.entries()) {
    const {middle, spread, ratio} = timed[k];
    const cells = [middle.toFixed(0), percent(spread), ratio.toFixed(ratio < 10 ? 1 : 0)];
    if (!peer.time_only) cells.push(...(await agreement(peer, runs[k], base, list)));
    console.log(row(peer.name, cells));
  }
  if (long.sticks.length === 0) return;
  console.log(`  into a chatter, ${Math.min(chatters, long.sticks.length)} times:`);
  for (const peer of peers.filter(({time_only}) => !time_only))
    console.log(`  ${peer.name.padEnd(26)}${await throughChatters(peer, orbit, long)}`);
}

for (const program of Object.values(running)) console.log((await program.ask({})).versions);
console.log(`${os.cpus()[0].model}, ${os.cpus().length} cores`);
const heyoka = spawnSync("apt-cache", ["search", "heyoka"], {encoding: "utf8"}).stdout?.trim();
console.log(
  heyoka
    ? `heyoka: not measured, although available: ${heyoka}`
    : "heyoka: omitted, no Debian package",
);
console.log(`
CPU time per impact from the default start: median of ${rounds} runs in turn, (largest - smallest)/median,
and median of the ratios within a round.
Impacts up to tau = ${early}, and those of vines; the time until which the impacts are the same.
For segments of a cycle from vines' states: missed contacts; false contacts; errors of tau.
`);
for (const {name, tolerance} of peers)
  if (tolerance) console.log(`${name}: rtol = ${tolerance}, atol = ${tolerance} b`);
for (const orbit of orbits) await measure(orbit);
for (const {child} of Object.values(running)) child.stdin.end();

// Exact motion of a run, in closed form between its impacts: any zoom level without a request.
import {max} from "d3-array";
import {clamp, lastUpTo} from "./numbers.js";

// Samples per cycle of the faster of forcing and oscillator; fewer would show aliases.
const samplesPerCycle = 32;

export class Motion {
  /** answer: of /v1/simulate, with impacts. */
  constructor({parameters, impacts, sticking, status}) {
    const {epsilon, Omega, b, derived} = parameters;
    const {zeta, A, phi} = derived;
    Object.assign(this, {parameters, impacts, b, end: status.tau, cycle: (2 * Math.PI) / Omega});
    /** Period of the faster of forcing and oscillator. */
    this.shortest = Math.min(this.cycle, 2 * Math.PI);
    [this.free, this.stuck] = [1, 1 + epsilon].map(
      (mass) => new Flow(1 / mass, (2 * zeta) / mass, (epsilon * A) / mass, Omega),
    );
    this.pieces = [];
    this.begin(phi, sticking);
    this.starts = Float64Array.from(this.pieces, (piece) => piece.tau);
  }

  /** Adds a piece; side: the wall it sticks to, or 0. */
  add(tau, state, y, yDot, side = 0) {
    const flow = side ? this.stuck : this.free;
    this.pieces.push({tau, state, y, y_dot: yDot, side, flow});
  }

  /** Splits the run into pieces {tau, state: [x, x', sin, cos], y, y_dot, side}. */
  begin(phi, {side: stuckTo, tau_start: from, tau_end: to}) {
    const {x0, x_dot0, y0, y_dot0} = this.parameters;
    const {tau, x, x_dot_after: xDot, y_dot_after: yDot, side, phase} = this.impacts;
    this.add(0, [x0, x_dot0, Math.sin(phi), Math.cos(phi)], y0, y_dot0);
    let stick = 0;
    const stickBefore = (moment) => {
      for (; from[stick] < moment; ++stick) this.stick(stuckTo[stick], from[stick], to[stick]);
    };
    for (let i = 0; i < tau.length; ++i) {
      stickBefore(tau[i]);
      const state = [x[i], xDot[i], Math.sin(phase[i]), Math.cos(phase[i])];
      this.add(tau[i], state, x[i] - side[i] * this.b, yDot[i]);
    }
    stickBefore(Infinity);
  }

  /** Adds a sticking phase and the flight after it. */
  stick(side, from, to) {
    const {state, y_dot: yDot} = this.stateOf(this.pieces.at(-1), from);
    const {epsilon} = this.parameters;
    // The remaining relative velocity is lost, as in an impact with R = 0.
    state[1] = (state[1] + epsilon * yDot) / (1 + epsilon);
    this.add(from, state, state[0] - side * this.b, state[1], side);
    if (to >= this.end) return;
    const left = this.stateOf(this.pieces.at(-1), to);
    this.add(to, left.state, left.y, left.y_dot);
  }

  stateOf(piece, tau) {
    const s = tau - piece.tau;
    const state = piece.flow.after(piece.state, s);
    return piece.side
      ? {state, y: state[0] - piece.side * this.b, y_dot: state[1]}
      : {state, y: piece.y + piece.y_dot * s, y_dot: piece.y_dot};
  }

  /** {x, x_dot, x_ddot, y, y_dot, side} at a time of the run; in m and units of tau. */
  at(tau) {
    const piece = this.pieces[Math.max(lastUpTo(this.starts, tau), 0)];
    const {state, y, y_dot} = this.stateOf(piece, tau);
    const [x, x_dot] = state;
    return {x, x_dot, x_ddot: piece.flow.force(state), y, y_dot, side: piece.side};
  }

  /** x of the same oscillator without the absorber, from the same start; in m. */
  withoutAbsorber(tau) {
    return this.free.after(this.pieces[0].state, tau)[0];
  }

  /** The largest |x|. */
  get reach() {
    this.farthest ??= max(this.trace(0, this.end, 400).x, Math.abs) ?? 0;
    return this.farthest;
  }

  /** Index of the last impact up to a time; -1 before the first. */
  impactBefore(tau) {
    return lastUpTo(this.impacts.tau, tau);
  }

  /** x and y - x in m, two points per column: samples or, if `dense`, minimum and maximum. */
  trace(from, to, columns) {
    const width = (to - from) / columns;
    const samples = Math.max(2, Math.ceil((width / this.shortest) * samplesPerCycle));
    const dense = samples > 2;
    // Extremes are placed inside their column: at its edge they would fall into the previous one.
    const within = dense ? 0.5 : 0;
    const place = (_, k) => from + ((k + within) * width) / 2;
    const tau = Float64Array.from({length: 2 * columns}, place);
    const line = () => tau.map(() => NaN); // as outside the run
    const lines = {dense, tau, x: line(), gap: line()};
    if (dense) this.extremes(from, width / samples, samples, lines);
    else
      this.sample(from, width / 2, 2 * columns, (k, x, gap) => {
        lines.x[k] = x;
        lines.gap[k] = gap;
      });
    return lines;
  }

  /** Extremes of each column of `samples` samples, including the impacts, which reach the walls. */
  extremes(from, step, samples, {x, gap}) {
    const widen = (line, k, value) => {
      if (!(value >= line[k])) line[k] = value;
      if (!(value <= line[k + 1])) line[k + 1] = value;
    };
    const columns = x.length / 2;
    this.sample(from, step, samples * columns, (k, value, distance) => {
      const column = 2 * Math.floor(k / samples);
      widen(x, column, value);
      widen(gap, column, distance);
    });
    const {tau, side} = this.impacts;
    const width = samples * step;
    const to = from + columns * width;
    for (let i = this.impactBefore(from) + 1; i < tau.length && tau[i] < to; ++i) {
      const column = 2 * Math.min(Math.floor((tau[i] - from) / width), columns - 1);
      widen(gap, column, -side[i] * this.b);
    }
  }

  /** Calls use(k, x, y - x) for each k = 0 .. count - 1 at from + k step within the run. */
  sample(from, step, count, use) {
    let i = Math.max(lastUpTo(this.starts, from), 0) - 1;
    let next = -Infinity; // end of the current piece
    let piece;
    let map;
    let state;
    for (let k = 0; k < count; ++k) {
      const tau = from + k * step;
      if (tau < 0 || tau > this.end) continue;
      if (tau >= next) {
        while (this.starts[i + 1] <= tau) ++i;
        next = this.starts[i + 1] ?? Infinity;
        piece = this.pieces[i];
        state = piece.flow.after(piece.state, tau - piece.tau);
        map = piece.flow.over(step);
      } else map(state);
      const y = piece.y + piece.y_dot * (tau - piece.tau);
      use(k, state[0], piece.side ? -piece.side * this.b : y - state[0]);
    }
  }
}

// Motion of the oscillator between events, as in the service: x'' = -k x - d x' + f sin(theta),
// theta' = Omega. The solution is a linear map of (x, x', sin theta, cos theta) over a time. Its
// Taylor series covers all damping ratios and resonance without special cases; longer times are
// composed of powers of the map over one step.
const terms = 22; // of the series; 1/22! is below 1e-21

/** The linear map of advance(state), as a function that advances a state in place, but faster. */
function mapOf(advance) {
  const columns = [0, 1, 2, 3].map((k) => advance([0, 1, 2, 3].map((i) => Number(i === k))));
  const [[xx, vx], [xv, vv], [xs, vs, cos, minusSin], [xc, vc]] = columns;
  return (state) => {
    const x = state[0]; // indexing is much faster than destructuring here
    const v = state[1];
    const s = state[2];
    const c = state[3];
    state[0] = xx * x + xv * v + xs * s + xc * c;
    state[1] = vx * x + vv * v + vs * s + vc * c;
    state[2] = s * cos - c * minusSin;
    state[3] = c * cos + s * minusSin;
    return state;
  };
}

class Flow {
  /** Dimensionless stiffness and damping, forcing in m, Omega relative to omega0. */
  constructor(stiffness, damping, forcing, Omega) {
    Object.assign(this, {stiffness, damping, forcing, Omega});
    /** The longest time that one series covers. */
    this.cell = 0.5 / Math.max(1, Math.sqrt(stiffness), damping, Omega);
    this.maps = []; // over cell, 2 cell, 4 cell, ...
  }

  /** x'' in a state. */
  force([x, v, sin]) {
    return this.forcing * sin - this.stiffness * x - this.damping * v;
  }

  /** The state a time 0 <= s <= cell later: the sum of the terms (A s)^n/n! of its series. */
  near(state, s) {
    const {stiffness, damping, forcing, Omega} = this;
    let [x, v, sin, cos] = state; // the n-th term
    const sum = [x, v, sin, cos];
    for (let n = 1; n <= terms; ++n) {
      const h = s / n;
      const force = forcing * sin - stiffness * x - damping * v;
      [x, v, sin, cos] = [h * v, h * force, h * Omega * cos, -h * Omega * sin];
      sum[0] += x;
      sum[1] += v;
      sum[2] += sin;
      sum[3] += cos;
    }
    return sum;
  }

  /** The state any time s >= 0 later. */
  after(state, s) {
    const cells = Math.floor(s / this.cell);
    const now = cells ? [...state] : state;
    for (let k = 0, left = cells; left > 0; ++k, left = Math.floor(left / 2))
      if (left % 2) this.doubled(k)(now);
    return this.near(now, s - cells * this.cell);
  }

  /** The map over any time s >= 0; the last one is cached. */
  over(s) {
    if (this.last?.s !== s) this.last = {s, map: mapOf((state) => this.after(state, s))};
    return this.last.map;
  }

  /** The map over 2^k cells. */
  doubled(k) {
    const half = k && this.doubled(k - 1);
    this.maps[k] ??= mapOf((state) => (half ? half(half(state)) : this.near(state, this.cell)));
    return this.maps[k];
  }
}

/** A motion without a closed form between impacts, as cubics between the samples of its series. */
class SampledMotion extends Motion {
  constructor(given, load) {
    const answer = load ? relativeToBase(given, load) : given;
    super(answer);
    this.knots = knotsOf(answer);
    this.sticking = answer.sticking;
    this.exact = !answer.parameters.forcing; // without the absorber
  }

  at(tau) {
    const {knots} = this;
    const i = clamp(lastUpTo(knots.tau, tau), 0, knots.tau.length - 2);
    const [x, x_dot, x_ddot] = cubic(knots, "x", i, tau);
    const [y, y_dot] = cubic(knots, "y", i, tau);
    const {side, tau_start: from, tau_end: to} = this.sticking;
    const k = lastUpTo(from, tau);
    return {x, x_dot, x_ddot, y, y_dot, side: tau < to[k] ? side[k] : 0};
  }

  withoutAbsorber(tau) {
    if (this.exact) return super.withoutAbsorber(tau);
    return this.without?.at(tau).x ?? null;
  }

  sample(from, step, count, use) {
    for (let k = 0; k < count; ++k) {
      const tau = from + k * step;
      if (tau < 0 || tau > this.end) continue;
      const {x, y} = this.at(tau);
      use(k, x, y - x);
    }
  }
}

/** Returns base(tau): [displacement in m, velocity per unit of tau] under a load, from rest. */
function baseUnder({time_s: t, acceleration_m_s2: a, displacement_m: d}, omega0) {
  const v = [0];
  const x = [0];
  for (let i = 0; a && i + 1 < t.length; ++i) {
    const h = t[i + 1] - t[i];
    v.push(v[i] + (h * (a[i] + a[i + 1])) / 2);
    x.push(x[i] + h * (v[i] + (h * (2 * a[i] + a[i + 1])) / 6));
  }
  return (tau) => {
    const i = Math.max(lastUpTo(t, t[0] + tau / omega0), 0);
    const s = t[0] + tau / omega0 - t[i];
    const inside = i + 1 < t.length;
    const slope = (column) => (inside ? (column[i + 1] - column[i]) / (t[i + 1] - t[i]) : 0);
    if (d) return [d[i] + slope(d) * s, slope(d) / omega0];
    const now = inside ? a[i] : 0;
    const velocity = v[i] + s * (now + (s * slope(a)) / 2);
    return [x[i] + s * (v[i] + s * (now / 2 + (s * slope(a)) / 6)), velocity / omega0];
  };
}

/** An answer whose x and y are relative to the base under a recorded load. */
function relativeToBase(answer, load) {
  if (load.force_N) return answer;
  const base = baseUnder(load, answer.parameters.derived.omega0);
  const relative = (columns) => {
    const moves = columns.tau.map(base);
    const less = ([name, values]) => {
      const found = /^[xy](_dot)?(_before|_after)?$/.exec(name);
      return [name, found ? values.map((v, i) => v - moves[i][found[1] ? 1 : 0]) : values];
    };
    return Object.fromEntries(Object.entries(columns).map(less));
  };
  return {...answer, series: relative(answer.series), impacts: relative(answer.impacts)};
}

/** Columns {tau, x, x_dot, y, y_dot} of the samples and of the impacts, each before and after. */
function knotsOf({series, impacts, parameters: {b}}) {
  const {tau, x, side} = impacts;
  const atImpacts = new Set(tau);
  const names = ["tau", "x", "x_dot", "y", "y_dot"];
  const samples = series.tau.map((_, n) => names.map((name) => series[name][n]));
  const ends = tau.flatMap((t, i) =>
    ["before", "after"].map((when) => {
      const [xDot, yDot] = [impacts[`x_dot_${when}`][i], impacts[`y_dot_${when}`][i]];
      return [t, x[i], xDot, x[i] - side[i] * b, yDot];
    }),
  );
  const knots = [...samples.filter(([t]) => !atImpacts.has(t)), ...ends];
  knots.sort(([t], [other]) => t - other);
  return Object.fromEntries(names.map((name, k) => [name, knots.map((knot) => knot[k])]));
}

/** [value, first, second derivative] at tau of the cubic between knots i and i + 1. */
function cubic(knots, name, i, tau) {
  const [p, q] = [knots[name][i], knots[name][i + 1]];
  const h = knots.tau[i + 1] - knots.tau[i] || 1;
  const [u, v] = [h * knots[`${name}_dot`][i], h * knots[`${name}_dot`][i + 1]];
  const s = (tau - knots.tau[i]) / h;
  const [second, third] = [3 * (q - p) - 2 * u - v, 2 * (p - q) + u + v];
  const value = p + s * (u + s * (second + s * third));
  return [value, (u + s * (2 * second + 3 * s * third)) / h, (2 * second + 6 * s * third) / h ** 2];
}

/** Fields of a system whose motion is drawn from samples. */
const sampledLaws = ["gravity", "inclination", "friction", "mu", "forcing"];
export const isSampled = (fields) => sampledLaws.some((name) => fields[name]);

/** The motion of an answer with impacts, relative to the base under a recorded load of the base. */
export const motionOf = (answer, load) =>
  answer.series ? new SampledMotion(answer, load) : new Motion(answer);

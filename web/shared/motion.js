// The exact motion of a run, made anew from its impacts: the closed form between them takes a few
// operations, so that a plot, however far one zooms, and the machine at any moment need no further
// answer of the service.
import {Flow} from "./flow.js";
import {lastUpTo} from "./search.js";

const samplesPerCycle = 16; // at least, so that no beat shows that is not there

export class Motion {
  /** Of an answer of /v1/simulate with its impacts. */
  constructor({parameters, impacts, sticking, status}) {
    const {epsilon, Omega, b, derived} = parameters;
    const {zeta, A, phi} = derived;
    this.parameters = parameters;
    this.impacts = impacts;
    this.end = status.tau;
    this.cycle = (2 * Math.PI) / Omega;
    this.b = b;
    this.epsilon = epsilon;
    this.free = new Flow(1, 2 * zeta, epsilon * A, Omega);
    const mass = 1 + epsilon;
    this.stuck = new Flow(1 / mass, (2 * zeta) / mass, (epsilon * A) / mass, Omega);
    this.pieces = [];
    this.begin(phi, sticking);
    /** Moments at which the pieces begin. */
    this.starts = Float64Array.from(this.pieces, (piece) => piece.tau);
  }

  /** Pieces {tau, state: [x, x', sin, cos], y, y_dot, side}, side: of the wall it is stuck to. */
  begin(phi, sticking) {
    const {x0, x_dot0, y0, y_dot0} = this.parameters;
    const {tau, x, x_dot_after: xDot, y_dot_after: yDot, side, phase} = this.impacts;
    const start = [x0, x_dot0, Math.sin(phi), Math.cos(phi)];
    this.pieces.push({tau: 0, state: start, y: y0, y_dot: y_dot0, side: 0});
    let stick = 0;
    const stickBefore = (moment) => {
      for (; stick < sticking.side.length && sticking.tau_start[stick] < moment; ++stick)
        this.stick(sticking.side[stick], sticking.tau_start[stick], sticking.tau_end[stick]);
    };
    for (let i = 0; i < tau.length; ++i) {
      stickBefore(tau[i]);
      const state = [x[i], xDot[i], Math.sin(phase[i]), Math.cos(phase[i])];
      const y = x[i] - side[i] * this.b;
      this.pieces.push({tau: tau[i], state, y, y_dot: yDot[i], side: 0});
    }
    stickBefore(Infinity);
  }

  /** A stuck phase, and the flight after it. */
  stick(side, from, to) {
    const {state, y_dot: yDot} = this.stateOf(this.pieces.at(-1), from);
    // What is left of the relative velocity is lost, as in an impact with R = 0.
    state[1] = (state[1] + this.epsilon * yDot) / (1 + this.epsilon);
    const glued = {tau: from, state, y: state[0] - side * this.b, y_dot: state[1], side};
    this.pieces.push(glued);
    if (to < this.end) this.pieces.push({...this.stateOf(glued, to), tau: to, side: 0});
  }

  /** What a piece leads to at a later moment. */
  stateOf(piece, tau) {
    const s = tau - piece.tau;
    if (!piece.side) {
      const state = this.free.after(piece.state, s);
      return {state, y: piece.y + piece.y_dot * s, y_dot: piece.y_dot};
    }
    const state = this.stuck.after(piece.state, s);
    return {state, y: state[0] - piece.side * this.b, y_dot: state[1]};
  }

  /** {x, x_dot, x_ddot, y, y_dot, side} at a moment of the run, m per unit of tau, or of its square. */
  at(tau) {
    const piece = this.pieces[Math.max(lastUpTo(this.starts, tau), 0)];
    const {state, y, y_dot} = this.stateOf(piece, tau);
    const flow = piece.side ? this.stuck : this.free;
    return {x: state[0], x_dot: state[1], x_ddot: flow.force(state), y, y_dot, side: piece.side};
  }

  /** The index of the last impact up to a moment, -1 before the first. */
  impactBefore(tau) {
    return lastUpTo(this.impacts.tau, tau);
  }

  /** The impact nearest to a moment; -1 where there is none. */
  impactNear(tau) {
    const {tau: moments} = this.impacts;
    const i = this.impactBefore(tau);
    const later = i + 1 < moments.length && !(tau - moments[i] <= moments[i + 1] - tau);
    return later ? i + 1 : i;
  }

  /**
   * x and y - x, m, over [from, to] as lines of two points for each of `columns`: the motion itself
   * where a column is short, and else, `dense`, its least and its largest value in the column.
   */
  trace(from, to, columns) {
    const width = (to - from) / columns;
    const samples = Math.max(2, Math.ceil((width / this.cycle) * samplesPerCycle));
    const lines = {
      dense: samples > 2,
      tau: new Float64Array(2 * columns),
      x: new Float64Array(2 * columns),
      gap: new Float64Array(2 * columns),
    };
    const step = width / samples;
    for (let k = 0; k < 2 * columns; ++k) lines.tau[k] = from + (k * width) / 2;
    if (samples === 2) this.sample(from, step, 2 * columns, (k, x, gap) => set(lines, k, x, gap));
    else this.extremes(from, step, samples, lines);
    return lines;
  }

  /** The extremes of each column of so many samples, and of the impacts, which reach the walls. */
  extremes(from, step, samples, {x, gap}) {
    for (const line of [x, gap])
      for (let k = 0; k < line.length; k += 2) {
        line[k] = Infinity;
        line[k + 1] = -Infinity;
      }
    const widen = (line, k, value) => {
      if (value < line[k]) line[k] = value;
      if (value > line[k + 1]) line[k + 1] = value;
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

  /** Calls use(k, x, y - x) for k = 0 .. count - 1 at from + k step; NaN outside of the run. */
  sample(from, step, count, use) {
    let i = Math.max(lastUpTo(this.starts, from), 0);
    let k = 0;
    for (; k < count && from + k * step < 0; ++k) use(k, NaN, NaN);
    while (k < count && from + k * step <= this.end) {
      while (i + 1 < this.starts.length && this.starts[i + 1] <= from + k * step) ++i;
      k = this.samplePiece(i, from, step, k, count, use);
    }
    for (; k < count; ++k) use(k, NaN, NaN);
  }

  /** The samples from the k-th on that lie in piece i; returns the first that does not. */
  samplePiece(i, from, step, k, count, use) {
    const piece = this.pieces[i];
    const until = Math.min(this.starts[i + 1] ?? Infinity, this.end);
    const flow = piece.side ? this.stuck : this.free;
    const state = flow.after(piece.state, from + k * step - piece.tau);
    const map = flow.over(step);
    let n = k;
    do {
      const s = from + n * step - piece.tau;
      const gap = piece.side ? -piece.side * this.b : piece.y + piece.y_dot * s - state[0];
      use(n, state[0], gap);
      map.apply(state);
      ++n;
    } while (n < count && from + n * step < until);
    return n;
  }
}

function set({x, gap}, k, value, distance) {
  x[k] = value;
  gap[k] = distance;
}

// The exact motion of a run, made anew from its impacts: the closed form between them takes a few
// operations, so that a plot, however far one zooms, and the machine at any moment need no further
// answer of the service.
import {Flow} from "./flow.js";
import {lastUpTo} from "./search.js";

// At least, of the faster of forcing and oscillator, so that no beat shows that is not there.
const samplesPerCycle = 16;

export class Motion {
  /** Of an answer of /v1/simulate with its impacts. */
  constructor({parameters, impacts, sticking, status}) {
    const {epsilon, Omega, b, derived} = parameters;
    const {zeta, A, phi} = derived;
    Object.assign(this, {parameters, impacts, b, end: status.tau, cycle: (2 * Math.PI) / Omega});
    /** Of forcing and oscillator the faster one's cycle. */
    this.shortest = Math.min(this.cycle, 2 * Math.PI);
    [this.free, this.stuck] = [1, 1 + epsilon].map(
      (mass) => new Flow(1 / mass, (2 * zeta) / mass, (epsilon * A) / mass, Omega),
    );
    this.pieces = [];
    this.begin(phi, sticking);
    /** Moments at which the pieces begin. */
    this.starts = Float64Array.from(this.pieces, (piece) => piece.tau);
  }

  /** A piece, side: of the wall it is stuck to. */
  add(tau, state, y, yDot, side = 0) {
    const flow = side ? this.stuck : this.free;
    this.pieces.push({tau, state, y, y_dot: yDot, side, flow});
  }

  /** Pieces {tau, state: [x, x', sin, cos], y, y_dot, side}. */
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

  /** A stuck phase, and the flight after it. */
  stick(side, from, to) {
    const {state, y_dot: yDot} = this.stateOf(this.pieces.at(-1), from);
    const {epsilon} = this.parameters;
    // What is left of the relative velocity is lost, as in an impact with R = 0.
    state[1] = (state[1] + epsilon * yDot) / (1 + epsilon);
    this.add(from, state, state[0] - side * this.b, state[1], side);
    if (to >= this.end) return;
    const left = this.stateOf(this.pieces.at(-1), to);
    this.add(to, left.state, left.y, left.y_dot);
  }

  /** What a piece leads to at a later moment. */
  stateOf(piece, tau) {
    const s = tau - piece.tau;
    const state = piece.flow.after(piece.state, s);
    return piece.side
      ? {state, y: state[0] - piece.side * this.b, y_dot: state[1]}
      : {state, y: piece.y + piece.y_dot * s, y_dot: piece.y_dot};
  }

  /** {x, x_dot, x_ddot, y, y_dot, side} at a moment of the run, m per unit of tau, or of its square. */
  at(tau) {
    const piece = this.pieces[Math.max(lastUpTo(this.starts, tau), 0)];
    const {state, y, y_dot} = this.stateOf(piece, tau);
    const [x, x_dot] = state;
    return {x, x_dot, x_ddot: piece.flow.force(state), y, y_dot, side: piece.side};
  }

  /** The largest |x| of the run, as its first trace over all of it has it. */
  get reach() {
    if (!this.farthest) this.trace(0, this.end, 400);
    return this.farthest;
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
    const samples = Math.max(2, Math.ceil((width / this.shortest) * samplesPerCycle));
    const dense = samples > 2;
    // The extremes lie well within their column: on its edge they would fall into the one before.
    const within = dense ? 0.5 : 0;
    const place = (_, k) => from + ((k + within) * width) / 2;
    const tau = Float64Array.from({length: 2 * columns}, place);
    const line = () => tau.map((_, k) => (k % 2 ? -Infinity : Infinity));
    const lines = {dense, tau, x: line(), gap: line()};
    if (dense) {
      this.extremes(from, width / samples, samples, lines);
      for (const line of [lines.x, lines.gap])
        line.forEach((value, k) => {
          if (!Number.isFinite(value)) line[k] = NaN; // beyond the run
        });
    } else
      this.sample(from, width / 2, 2 * columns, (k, x, gap) => {
        lines.x[k] = x;
        lines.gap[k] = gap;
      });
    if (from <= 0 && to >= this.end)
      this.farthest ??= lines.x.reduce((most, x) => Math.max(most, Math.abs(x) || 0), 0);
    return lines;
  }

  /** The extremes of each column of so many samples, and of the impacts, which reach the walls. */
  extremes(from, step, samples, {x, gap}) {
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
    let i = Math.max(lastUpTo(this.starts, from), 0) - 1;
    let next = -Infinity; // the moment at which the piece ends
    let piece;
    let map;
    let state;
    for (let k = 0; k < count; ++k) {
      const tau = from + k * step;
      if (tau < 0 || tau > this.end) {
        use(k, NaN, NaN);
        continue;
      }
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

// The motion between events as the service has it: x'' = -k x - d x' + f sin(theta), theta' =
// Omega, as a linear map of (x, x', sin theta, cos theta) over a time. Its Taylor series serves
// every damping and resonance alike; longer times are made of powers of one step.

const terms = 22; // of the series: 1/22! is below 1e-21

/** The map of a state over time s: rows of x and x', and the turn of the phase. */
class Step {
  constructor(rows, cos, sin) {
    this.rows = rows; // [x from x, x', sin, cos; x' from x, x', sin, cos]
    this.cos = cos;
    this.sin = sin;
  }

  /** Applies the map to state (x, x', sin, cos), in place: thousands of times for a plot. */
  apply(state) {
    const r = this.rows;
    const x = state[0];
    const v = state[1];
    const s = state[2];
    const c = state[3];
    state[0] = r[0] * x + r[1] * v + r[2] * s + r[3] * c;
    state[1] = r[4] * x + r[5] * v + r[6] * s + r[7] * c;
    state[2] = s * this.cos + c * this.sin;
    state[3] = c * this.cos - s * this.sin;
  }

  /** This map, and then `next`. */
  followedBy(next) {
    const rows = new Float64Array(8);
    for (let i = 0; i < 4; ++i) {
      const state = [0, 0, 0, 0];
      state[i] = 1;
      this.apply(state);
      next.apply(state);
      rows[i] = state[0];
      rows[4 + i] = state[1];
    }
    return new Step(
      rows,
      this.cos * next.cos - this.sin * next.sin,
      this.sin * next.cos + this.cos * next.sin,
    );
  }
}

export class Flow {
  /** Dimensionless stiffness and damping, forcing in m, Omega over omega0. */
  constructor(stiffness, damping, forcing, Omega) {
    Object.assign(this, {stiffness, damping, forcing, Omega});
    /** As far as one series reaches. */
    this.cell = 0.5 / Math.max(1, Math.sqrt(stiffness), damping, Omega);
    this.steps = []; // over cell, 2 cell, 4 cell, ...
  }

  /** x'' in a state. */
  force([x, v, sin]) {
    return this.forcing * sin - this.stiffness * x - this.damping * v;
  }

  /** A state a time 0 <= s <= cell later. */
  near(state, s) {
    const {stiffness, damping, forcing, Omega} = this;
    const turn = Omega * s;
    const phase = [state[2] * forcing, state[3] * forcing];
    let [a, b] = [state[0], state[1] * s]; // the last two terms of x
    let x = a + b;
    let v = state[1];
    // f sin(theta + Omega s) by its terms: sin, cos, -sin, -cos, ...
    let forced = s * s;
    for (let n = 2; n < terms; ++n) {
      const sign = (n - 2) & 2 ? -1 : 1;
      const push = sign * phase[n & 1] * forced;
      const next = (push - stiffness * s * s * a - damping * s * (n - 1) * b) / (n * (n - 1));
      x += next;
      v += (n * next) / (s || 1);
      a = b;
      b = next;
      forced *= turn / (n - 1);
    }
    const cos = Math.cos(turn);
    const sin = Math.sin(turn);
    return [x, v, state[2] * cos + state[3] * sin, state[3] * cos - state[2] * sin];
  }

  /** The map over a time 0 <= s <= cell. */
  step(s) {
    const rows = new Float64Array(8);
    for (let i = 0; i < 4; ++i) {
      const state = [0, 0, 0, 0];
      state[i] = 1;
      const [x, v] = this.near(state, s);
      rows[i] = x;
      rows[4 + i] = v;
    }
    return new Step(rows, Math.cos(this.Omega * s), Math.sin(this.Omega * s));
  }

  /** A state any time s >= 0 later. */
  after(state, s) {
    let cells = Math.floor(s / this.cell);
    let now = state;
    if (cells > 0) {
      now = [...state];
      for (let k = 0; cells > 0; ++k, cells = Math.floor(cells / 2))
        if (cells % 2) this.doubled(k).apply(now);
    }
    return this.near(now, s - Math.floor(s / this.cell) * this.cell);
  }

  /** The map over any time s >= 0; of the last one asked for it is kept. */
  over(s) {
    if (this.last?.s !== s) {
      const parts = 2 ** Math.max(0, Math.ceil(Math.log2(s / this.cell)));
      let step = this.step(s / parts);
      for (let n = parts; n > 1; n /= 2) step = step.followedBy(step);
      this.last = {s, step};
    }
    return this.last.step;
  }

  /** The map over 2^k cells. */
  doubled(k) {
    while (this.steps.length <= k) {
      const last = this.steps.at(-1);
      this.steps.push(last ? last.followedBy(last) : this.step(this.cell));
    }
    return this.steps[k];
  }
}

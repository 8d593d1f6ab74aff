// Motion of the oscillator between events, as in the service: x'' = -k x - d x' + f sin(theta),
// theta' = Omega. The solution is a linear map of (x, x', sin theta, cos theta) over a time. Its
// Taylor series covers all damping ratios and resonance without special cases; longer times are
// composed of powers of the map over one step.

const terms = 22; // of the series; 1/22! is below 1e-21

/** The linear map of advance(state), as a function that advances a state in place, but faster. */
function mapOf(advance) {
  const unit = (k) => [0, 1, 2, 3].map((i) => Number(i === k));
  const [[xx, vx], [xv, vv], [xs, vs, cos, minusSin], [xc, vc]] = [0, 1, 2, 3].map((k) =>
    advance(unit(k)),
  );
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

export class Flow {
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
    for (let n = this.maps.length; n <= k; ++n) {
      const half = this.maps[n - 1];
      this.maps.push(mapOf((state) => (half ? half(half(state)) : this.near(state, this.cell))));
    }
    return this.maps[k];
  }
}

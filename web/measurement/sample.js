// A simulated record with two sensors: a displacement, and an acceleration in which each impact is
// a half-sine pulse; the displacement keeps its exact kink. Both have low-level noise with a fixed
// seed.
import {Motion} from "../shared/motion.js";
import {lastUpTo} from "../shared/search.js";

const samplesPerCycle = 245; // about 2 kHz at 8.35 Hz, the forcing of Li et al. (2018)
const maxSamples = 200000;
const settling = 20; // cycles skipped: a recorder is started later than the motion
const pulse = 1 / 150; // duration in cycles

// Linear congruential generator (Numerical Recipes) with values in [-1, 1).
function noiseFrom(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

/**
 * The oscillator of a run as fields of /v1/identify, in kg, N/m, N s/m, Hz and m. A dimensionless
 * system gets m1 = 1 kg and k1 = 1 N/m, hence omega0 = 1 rad/s.
 */
export function oscillatorOf({si, b, epsilon, Omega, derived}) {
  const system = si ?? {m1: 1, k1: 1, m2: epsilon, f: Omega / (2 * Math.PI)};
  const {m1, k1, m2, f} = system;
  const c1 = 2 * derived.zeta * Math.sqrt(k1 * m1); // damping of the simulated motion
  return {m1, k1, c1, m2, f, b};
}

/**
 * The samples of a run as CSV: time_s, displacement_m, acceleration_m_s2. Starts after `settling`
 * cycles if the run is longer than three times that; holds at most maxSamples.
 */
export function recordOfRun(answer) {
  const {parameters, impacts} = answer;
  const omega0 = parameters.derived.omega0 ?? 1; // rad/s
  const motion = new Motion(answer);
  const {cycle} = motion;
  const from = motion.end > 3 * settling * cycle ? settling * cycle : 0;
  const count = Math.min(Math.floor(((motion.end - from) / cycle) * samplesPerCycle), maxSamples);
  const width = pulse * cycle;
  const noise = noiseFrom(1);
  // Amplitudes of uniform noise, in m and m/s^2.
  const [noiseX, noiseA] = [1.3e-4 * parameters.b, 1.2e-3 * parameters.b * omega0 ** 2];
  const lines = ["time_s,displacement_m,acceleration_m_s2"];
  for (let n = 0; n < count; ++n) {
    const tau = from + (n * cycle) / samplesPerCycle;
    const {x, x_ddot: smooth} = motion.at(tau);
    let a = smooth; // without pulses
    for (let i = lastUpTo(impacts.tau, tau + width / 2); i >= 0; --i) {
      const position = (tau - impacts.tau[i]) / width + 0.5; // in the pulse, from 0 to 1
      if (position >= 1) break;
      const jump = impacts.x_dot_after[i] - impacts.x_dot_before[i];
      a += ((jump * Math.PI) / 2 / width) * Math.sin(Math.PI * position);
    }
    const seconds = ((tau - from) / omega0).toFixed(7);
    const measured = (x + noiseX * noise()).toExponential(7);
    lines.push(`${seconds},${measured},${(a * omega0 ** 2 + noiseA * noise()).toExponential(4)}`);
  }
  return `${lines.join("\n")}\n`;
}

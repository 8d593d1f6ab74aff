// Simulated laboratory records of a motion that the service computes: displacement, and
// acceleration with a half-sine pulse for each impact.

/**
 * What the two sensors see.
 * answer: of /v1/simulate, with series and impacts; linear between the samples of the series.
 * moments: of the record, ascending, as {t, tau}: in s, and the same in the service's tau.
 * pulse: how long an impact shows, s.
 * Returns {t, x, a} of each moment, in s, m and m/s^2.
 */
export function sensed({series, impacts, parameters}, moments, pulse) {
  const {omega0} = parameters.derived;
  const phase = (t, n) => (t - impacts.tau[n] / omega0) / pulse + 0.5;
  let i = 1;
  let first = 0;
  return moments.map(({t, tau}) => {
    while (i < series.tau.length - 1 && series.tau[i] <= tau) ++i;
    const share = (tau - series.tau[i - 1]) / (series.tau[i] - series.tau[i - 1]);
    const of = (column) =>
      series[column][i - 1] + share * (series[column][i] - series[column][i - 1]);
    let a = of("x_ddot") * omega0 ** 2;
    while (phase(t, first) >= 1) ++first;
    for (let n = first; phase(t, n) > 0; ++n) {
      const jump = impacts.x_dot_after[n] - impacts.x_dot_before[n];
      const peak = (jump * omega0 * Math.PI) / 2 / pulse;
      a += peak * Math.sin(Math.PI * phase(t, n));
    }
    return {t, x: of("x"), a};
  });
}

/** rows: [t, x, a] */
export const csvOf = (rows) =>
  ["time_s,displacement_m,acceleration_m_s2", ...rows.map((row) => row.join(",")), ""].join("\n");

/** Reproducible numbers in [-1, 1) from a linear congruential generator (Numerical Recipes). */
function noiseFrom(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

/**
 * A measurement of a preset's oscillator as CSV, with a little noise: about 2048 samples a second.
 * seconds: how long it is measured.
 */
export async function measured(url, preset, seconds) {
  const request = {
    preset,
    include: ["series", "impacts"],
    samples_per_cycle: 245,
    cycles: seconds * 8.35, // natural frequency of the presets with SI units, Hz
    max_points: 100000,
  };
  const headers = {"Content-Type": "application/json"};
  const body = JSON.stringify(request);
  const response = await fetch(`${url}/v1/simulate`, {method: "POST", headers, body});
  const answer = await response.json();
  const {omega0} = answer.parameters.derived;
  const moments = answer.series.tau.map((tau) => ({t: tau / omega0, tau}));
  const noise = noiseFrom(1);
  return csvOf(
    sensed(answer, moments, 0.8e-3).map(({t, x, a}) => [
      t.toFixed(7),
      (x + 2e-6 * noise()).toExponential(8),
      (a + 0.05 * noise()).toExponential(5),
    ]),
  );
}

// A measurement of a preset's oscillator as CSV: what /v1/simulate says, sampled, with a little
// noise and each impact as a half sine of the acceleration.
/** Numbers in [-1, 1), the same each time, from a linear congruential generator (Numerical Recipes). */
function noiseFrom(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

/** preset: of the oscillator; seconds: how long it is measured. */
export async function measured(url, preset, seconds) {
  const request = {
    preset,
    include: ["series", "impacts"],
    samples_per_cycle: 245,
    cycles: seconds * 8.35,
    max_points: 100000,
  };
  const headers = {"Content-Type": "application/json"};
  const body = JSON.stringify(request);
  const response = await fetch(`${url}/v1/simulate`, {method: "POST", headers, body});
  const {series, impacts, parameters} = await response.json();
  const {omega0, zeta, A, phi} = parameters.derived;
  const pulse = 0.8e-3 * omega0;
  let first = 0;
  const noise = noiseFrom(1);
  const lines = series.tau.map((tau, k) => {
    const forcing = parameters.epsilon * A * Math.sin(tau + phi);
    let acceleration = -series.x[k] - 2 * zeta * series.x_dot[k] + forcing;
    while (impacts.tau[first] < tau - pulse) ++first;
    for (let i = first; impacts.tau[i] < tau + pulse; ++i) {
      const s = tau - impacts.tau[i];
      const peak = ((impacts.x_dot_after[i] - impacts.x_dot_before[i]) * Math.PI) / 2 / pulse;
      if (Math.abs(s) < pulse / 2) acceleration += peak * Math.cos((Math.PI * s) / pulse);
    }
    return [
      (tau / omega0).toFixed(7),
      (series.x[k] + 2e-6 * noise()).toExponential(8),
      (acceleration * omega0 ** 2 + 0.05 * noise()).toExponential(5),
    ].join(",");
  });
  return ["time_s,displacement_m,acceleration_m_s2", ...lines, ""].join("\n");
}

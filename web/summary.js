// What a run came to, in words and numbers: the cards above the plots, the windows' table and where the energy went.
import {$, element} from "./dom.js";

export const minus = (text) => text.replace("-", "−");
export const digits = (value, n = 4) =>
  value == null
    ? "–"
    : minus(Math.abs(value) < 1e-3 && value !== 0 ? value.toExponential(2) : value.toFixed(n));
export const percent = (value) =>
  value == null ? "–" : `${(value * 100).toFixed(value < 0.1 && value >= 0.0005 ? 1 : 0)} %`;
export const count = (n, noun) => `${n} ${noun}${n === 1 ? "" : "s"}`;
const positives = (estimator) =>
  !estimator || estimator.final[0] == null ? null : estimator.final.filter((v) => v > 0).length;
export const verdicts = {chaotic: "chaotic", regular: "regular", not_decided: "not decided"};

/** An exponent in a word where it has no value. */
const exponent = ({final, status}, k) => (status[k] === "minus_infinity" ? "−∞" : digits(final[k]));

function regimeCards(r, units) {
  const captured = r.capture?.chaotic_before
    ? `; captured ${r.capture.tau === null ? "behind the run's end" : `at ${units.at(r.capture.tau)}`} after a chaotic transient`
    : "";
  const chatter = r.chatter_impacts_per_period
    ? `, ${r.chatter_impacts_per_period} of chatter`
    : "";
  const sticks = r.sticks_per_period ? `, ${count(r.sticks_per_period, "stick")}` : "";
  const rhythm = !r.contacts
    ? ""
    : r.periodic
      ? `period ${count(r.period_cycles, "cycle")}: ${count(r.impacts_per_period, "impact")}${chatter}${sticks}, ${r.symmetric ? "symmetric" : "asymmetric"}${r.stable ? "" : ", unstable"}`
      : `${percent(r.synchronised.share)} of the contacts synchronised`;
  return [
    ["regime", r.type === "none" ? "none" : `Type ${r.type}`, r.description + captured],
    ["impacts per cycle, z", digits(r.z, 3), rhythm],
  ];
}

function verdictCards(e, r, {time}) {
  const error = e.qr?.standard_error[0];
  const exact = positives(e.qr);
  const raw = positives(e.raw_product);
  const orbit =
    r.periodic && r.contacts && e.verdict === "not_decided"
      ? `; the motion ends on a ${r.stable ? "stable" : "unstable"} periodic orbit`
      : "";
  return [
    [
      "verdict",
      verdicts[e.verdict] ?? "–",
      (e.verdict_reason?.replace("lambda1", "λ₁").replace("= -", "= −") ??
        "needs the estimator qr") + orbit,
    ],
    [
      "λ₁ (qr)",
      e.qr ? digits(e.qr.final[0]) : "–",
      (error == null ? "" : `± ${digits(error)}`) + (time.unit ? " per unit of τ" : ""),
    ],
    [
      "positive exponents (qr)",
      String(exact ?? "–"),
      raw == null
        ? ""
        : raw === exact
          ? "raw_product agrees"
          : `raw_product shows ${raw}, as the paper counted`,
    ],
    [
      "sum rule residual",
      e.sum_rule_residual == null ? "–" : minus(e.sum_rule_residual.toExponential(1)),
      e.qr && e.sum_rule_residual == null && e.impacts > 1 ? "not defined after a stick" : "",
    ],
    [
      "window",
      e.window
        ? `${e.window.map((t) => time.of(t).toFixed(1)).join(" to ")} ${time.unit}`.trim()
        : "–",
      count(e.impacts, "impact"),
    ],
  ];
}

/** entries: [term, value, a remark]. */
export function cards(list, entries) {
  list.replaceChildren(
    ...entries.map(([term, value, small]) =>
      element(
        "div",
        {},
        element("dt", {textContent: term}),
        element("dd", {}, value, element("small", {textContent: small ? ` ${small}` : ""})),
      ),
    ),
  );
}

export const listWarnings = (list, warnings) =>
  list.replaceChildren(...warnings.map((w) => element("li", {textContent: w})));

const millimetres = (metres, n = 1) => `${digits(metres * 1000, n)} mm`;
const most = (values) => values.reduce((a, v) => Math.max(a, Math.abs(v)), 0);
const median = (values) =>
  values.length ? [...values].sort((a, b) => a - b)[values.length >> 1] : null;
const rounded = (value) => (value == null ? "–" : minus(Number(value.toPrecision(3)).toString()));

/** What a laboratory measures. */
function engineeringCards(
  {energy, impacts, series, parameters: {si, derived}},
  {velocity, impulse, acceleration},
) {
  const free = energy.without_absorber.amplitude;
  const speed = impacts.relative_speed;
  const hit = (of) => (speed.length ? rounded(velocity.of(of(speed))) : "–");
  const blow = () =>
    `impulse ${rounded(impulse.of(median(impacts.impulse.map(Math.abs))))} ${impulse.unit}`;
  return [
    [
      "amplitude without absorber",
      free == null ? "–" : millimetres(free),
      `with it |x| comes to ${millimetres(energy.peak)}`,
    ],
    [
      "forcing",
      `${rounded(si.f)} Hz`,
      `${Number((si.f / derived.f0).toPrecision(4))} of f₀; base ± ${Number((si.F * 1000).toPrecision(3))} mm`,
    ],
    [
      "impact speed",
      `${hit(median)} ${velocity.unit}`,
      speed.length ? `median; at most ${hit(most)}; ${blow()}` : "",
    ],
    [
      "peak acceleration",
      `${rounded(acceleration.of(most(series.x_ddot)))} ${acceleration.unit}`,
      "of m₁ between the impacts",
    ],
  ];
}

export function summarise(answer, milliseconds, units) {
  const {exponents, regime, energy, impacts, sticking, parameters, warnings} = answer;
  const [type, z] = regimeCards(regime, units);
  const [verdict, lambda, positive, residual, window] = verdictCards(exponents, regime, units);
  const free = energy.without_absorber.amplitude;
  const entries = [
    type,
    z,
    verdict,
    lambda,
    ["taken by the impacts", percent(energy.share_impacts), "of the energy that is dissipated"],
    [
      "rms of x",
      percent(energy.rms_ratio),
      `of that without absorber${units.si || free == null ? "" : `, whose amplitude is ${millimetres(free)}`}`,
    ],
    ["impacts", String(impacts.tau.length), "chatter included"],
    [
      "stuck phases",
      String(sticking.side.length),
      sticking.side.length ? "shaded in the plots" : "",
    ],
    ...(units.si ? engineeringCards(answer, units) : []),
    positive,
    residual,
    window,
    [
      "answered in",
      `${milliseconds.toFixed(0)} ms`,
      `damping ζ = ${digits(parameters.derived.zeta, 5)}`,
    ],
  ];
  cards($("summary"), entries);
  listWarnings($("warnings"), warnings);
}

/** The exponents of each window asked for. */
export function tabulate(windows = [], {time}) {
  $("figure-windows").hidden = !windows.length;
  const row = (tag, cells) =>
    element("tr", {}, ...cells.map((textContent) => element(tag, {textContent})));
  const head = row("th", [
    time.unit ? "from (s)" : "τ from",
    time.unit ? "to (s)" : "to",
    "impacts",
    "λ₁",
    "λ₂",
    "λ₃",
    "λ₄",
    "verdict",
  ]);
  const rows = windows.map((w) => {
    const lambda = [0, 1, 2, 3].map((k) => (w.qr ? exponent(w.qr, k) : "–"));
    const error = w.qr?.standard_error[0];
    const asked = w.asked.map((t) => (time.unit ? time.of(t).toFixed(2) : String(t)));
    return row("td", [
      ...asked,
      String(w.impacts),
      error == null ? lambda[0] : `${lambda[0]} ± ${digits(error)}`,
      ...lambda.slice(1),
      verdicts[w.verdict] ?? "–",
    ]);
  });
  $("windows").replaceChildren(element("thead", {}, head), element("tbody", {}, ...rows));
}

/** A bar as long as its share of the whole. */
function bar(share, className) {
  const node = element("span", {className});
  node.style.width = `${Math.min(Math.max(share, 0), 1) * 100}%`;
  return node;
}

/** One amount beside another, as bars of one scale. */
function compare(term, withAbsorber, without) {
  const whole = Math.max(withAbsorber, without) || 1;
  const line = (name, value, className) => [
    element("span", {className: "name", textContent: name}),
    element("span", {className: "track"}, bar(value / whole, className)),
    element("span", {className: "amount", textContent: `${digits(value * 1000, 2)} mm`}),
  ];
  return element(
    "div",
    {className: "compare"},
    element("b", {textContent: term}),
    ...line("with absorber", withAbsorber, "with"),
    ...line("without", without, "without"),
  );
}

/** When a half and a tenth of a free decay's energy are left, with the absorber and without it. */
function decayTimes(decay, {at}) {
  const moment = (tau) => (tau == null ? "not in this run" : at(tau));
  const line = (what, name) =>
    decay[name] == null && decay.without_absorber[name] == null
      ? []
      : [
          `${what} is left ${decay[name] == null ? "" : "at "}${moment(decay[name])} (without absorber: ${moment(decay.without_absorber[name])})`,
        ];
  return [...line("half", "tau_half"), ...line("a tenth", "tau_tenth")];
}

/** What was supplied (by the base, or there at the start) went into the damper, the impacts, or is still there. */
export function accountEnergy(
  {input, at_start, damper, impacts, at_end, rms, peak, without_absorber, decay},
  units,
) {
  const supplied = damper + impacts + at_end || 1;
  const {of, unit} = units.energy;
  const parts = [
    ["damper", damper],
    ["impacts", impacts],
    ["left", at_end],
  ];
  const names = {damper: "damper", impacts: "impacts", left: "left at the end"};
  const amount = (value) =>
    `${value !== 0 && Math.abs(of(value)) < 1e-3 ? digits(of(value)) : rounded(of(value))} ${unit}`;
  const stack = element(
    "div",
    {className: "stack"},
    ...parts.map(([name, value]) => bar(value / supplied, name)),
  );
  const legend = element(
    "ul",
    {className: "parts"},
    ...parts.map(([name, value]) =>
      element(
        "li",
        {},
        element("span", {className: `key ${name}`, textContent: names[name]}),
        element("b", {textContent: percent(value / supplied)}),
        element("small", {textContent: amount(value)}),
      ),
    ),
  );
  const source = [
    input && `${amount(input)} from the base`,
    at_start && `${amount(at_start)} there at the start`,
  ]
    .filter(Boolean)
    .join(", ");
  $("energy-scale").hidden = units.si;
  $("energy").replaceChildren(
    stack,
    legend,
    element("p", {
      className: "note",
      textContent: [source, ...(decay ? decayTimes(decay, units) : [])].filter(Boolean).join("; "),
    }),
    compare("rms of x", rms, without_absorber.rms),
    compare("peak of |x|", peak, without_absorber.peak),
  );
}

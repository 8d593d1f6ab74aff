// Where the regimes lie along the parameter that was turned last: a band of them and lambda1 over
// it, filled coarse to fine by a sweep in the background. Its marker is the slider.
import {Problem, sweep} from "../shared/api.js";
import {colour} from "../shared/colours.js";
import {$, countUp, element} from "../shared/dom.js";
import {blank, Size} from "../shared/frame.js";
import {jsonLines} from "../shared/json_lines.js";
import {digits, short, withError} from "../shared/numbers.js";
import {regimeText, verdictColour, verdicts} from "../shared/quantities.js";
import {ticks} from "../shared/ticks.js";
import {fieldsOf, rangeOf, valueAt, written} from "./sliders.js";

const cycles = 300; // measured at each point, after
const transient = 150; // cycles
const points = 257; // 2^8 + 1, so that each halving lies between those before
const pause = 180; // ms without an edit before it begins
// A field that says how long a run is, or what is told of it, is not the system's.
const ofRun = [
  "tau_end",
  "cycles",
  "window",
  "windows",
  "samples_per_cycle",
  "section_phase",
  "max_points",
  "exponents",
  "perturbation",
  "include",
];

/** 0, n - 1, the middle, the quarters, ...: n = 2^k + 1 places, coarse to fine. */
function coarseToFine(n) {
  const order = [0, n - 1];
  for (let step = n - 1; step > 1; step /= 2)
    for (let i = step / 2; i < n; i += step) order.push(i);
  return order;
}
const order = coarseToFine(points);

const box = {left: 34, right: 14, top: 8, band: 13, bottom: 17};

export class Strip {
  /** turn(fields, slider, {hasty}): sets a value, as a slider does. */
  constructor(turn) {
    this.canvas = $("strip");
    this.turn = turn;
    this.key = null;
    this.found = [];
    this.waiting = 0;
    this.size = new Size(this.canvas, () => this.draw());
    this.marker = element("div", {className: "marker"});
    this.canvas.parentNode.append(this.marker);
    this.listen();
  }

  /** A run that is shown: its request, parameters, and the slider that was turned last. */
  show(request, parameters, slider) {
    const range =
      this.slider === slider && this.covers(slider, parameters)
        ? this.range
        : rangeOf(slider, parameters);
    const sets = slider.sets ?? slider.name;
    const dropped = [...ofRun, sets, ...(sets === "R" ? ["R_plus", "R_minus"] : [])];
    const base = Object.fromEntries(
      Object.entries(request).filter(([name]) => !dropped.includes(name)),
    );
    const key = JSON.stringify([base, sets, range]);
    Object.assign(this, {parameters, slider, range});
    if (key !== this.key) {
      this.key = key;
      this.abort?.abort();
      clearTimeout(this.waiting);
      this.stale = true;
      this.waiting = setTimeout(() => this.fill(base, sets), pause);
      this.draw();
    } else this.place();
  }

  covers(slider, parameters) {
    const value = valueAt(slider, parameters);
    return value >= this.range[0] && value <= this.range[1];
  }

  /** The place of entry i, in the slider's unit. */
  at(i) {
    const [from, to] = this.range;
    const least = 0.002 * (to - from); // where 0 is no value: no clearance, no forcing
    return Math.max(from + ((to - from) * i) / (points - 1), from === 0 ? least : from);
  }

  async fill(base, parameter) {
    const abort = new AbortController();
    this.abort = abort;
    const {slider, parameters} = this;
    const inField = (i) => fieldsOf(slider, this.at(i), parameters)[parameter];
    // What is shown is a system; what its neighbours' faults are is said of each of them alone.
    const here = this.nearest(valueAt(slider, parameters));
    const sequence = [here, ...order.filter((i) => i !== here)];
    const axes = [{parameter, values: sequence.map(inField)}];
    try {
      const body = {base, axes, cycles, transient_cycles: transient};
      const stream = await sweep(body, abort.signal);
      this.found = [];
      this.stale = false;
      for await (const {value} of jsonLines(stream)) {
        if (abort.signal.aborted) return;
        if (value.type !== "point" || value.error) continue;
        this.found[sequence[value.index]] = value;
        this.soon();
      }
      countUp(this.canvas);
    } catch (error) {
      if (abort.signal.aborted) return;
      this.found = [];
      this.trouble = error instanceof Problem ? error.message : "no answer from the server";
    }
    this.draw();
  }

  soon() {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  scale() {
    const {width} = this.size;
    const [from, to] = this.range;
    const room = width - box.left - box.right;
    return {
      width,
      px: (v) => box.left + ((v - from) / (to - from)) * room,
      value: (px) => from + ((px - box.left) / room) * (to - from),
    };
  }

  draw() {
    const {width, height} = this.size;
    if (!this.range || !width) return;
    const c = blank(this.canvas, this.size);
    c.globalAlpha = this.stale ? 0.5 : 1;
    const {px} = this.scale();
    this.bands(c, px);
    this.exponents(c, px, height);
    c.globalAlpha = 1;
    this.labels(c, px, width, height);
    this.place();
  }

  /** Each point that is there reaches to the middle between it and its neighbours. */
  bands(c, px) {
    const there = [];
    for (let i = 0; i < points; ++i) if (this.found[i]) there.push(i);
    let label = null;
    there.forEach((i, k) => {
      const [before, after] = [there[k - 1] ?? i, there[k + 1] ?? i];
      const left = px(this.at((before + i) / 2));
      const right = px(this.at((i + after) / 2));
      const {regime} = this.found[i];
      c.fillStyle = regime ? colour(`regime-${regime}`) : colour("nothing");
      c.fillRect(left, box.top, Math.max(right - left, 1) + 0.5, box.band);
      if (label?.regime !== regime) {
        this.label(c, label);
        label = {regime, left};
      }
      label.right = right;
    });
    this.label(c, label);
  }

  /** A regime's name under its stretch, where there is room for it. */
  label(c, label) {
    if (!label?.regime || label.regime === "none" || label.right - label.left < 18) return;
    c.fillStyle = colour("text");
    c.font = "600 11px system-ui";
    c.textAlign = "center";
    c.textBaseline = "top";
    c.fillText(label.regime, (label.left + label.right) / 2, box.top + box.band + 2);
  }

  exponents(c, px, height) {
    const values = this.found.flatMap((p) => p?.lambda?.[0] ?? []).sort((a, b) => a - b);
    const most = Math.max(values[Math.floor(values.length * 0.98)] ?? 0.1, 0.02) * 1.15;
    const least = Math.min(values[Math.floor(values.length * 0.05)] ?? 0, -0.15 * most);
    const [top, bottom] = [box.top + box.band + 4, height - box.bottom];
    this.py = (v) =>
      bottom - ((Math.min(Math.max(v, least), most) - least) / (most - least)) * (bottom - top);
    c.strokeStyle = colour("line");
    c.lineWidth = 1;
    c.setLineDash([]);
    c.beginPath();
    c.moveTo(box.left, this.py(0));
    c.lineTo(this.size.width - box.right, this.py(0));
    c.stroke();
    this.found.forEach((p, i) => {
      if (p?.lambda?.[0] == null) return;
      const [x, y] = [px(this.at(i)), this.py(p.lambda[0])];
      const error = p.standard_error?.[0] ?? 0;
      c.fillStyle = c.strokeStyle = colour(verdictColour(p));
      c.globalAlpha *= 0.4;
      c.beginPath();
      c.moveTo(x, this.py(p.lambda[0] - error));
      c.lineTo(x, this.py(p.lambda[0] + error));
      c.stroke();
      c.globalAlpha /= 0.4;
      c.fillRect(x - 1.5, y - 1.5, 3, 3);
    });
    this.ofExponents = [least, most];
  }

  labels(c, px, width, height) {
    const {unit = ""} = this.slider;
    c.font = "11px system-ui";
    c.fillStyle = colour("soft");
    c.textBaseline = "bottom";
    c.textAlign = "center";
    for (const t of ticks(...this.range, Math.max(3, width / 140)))
      c.fillText(
        `${short(t)}${unit && ` ${unit}`}`,
        Math.min(Math.max(px(t), 16), width - 18),
        height - 1,
      );
    c.textAlign = "right";
    c.textBaseline = "middle";
    const [, most] = this.ofExponents;
    c.fillText("0", box.left - 5, this.py(0));
    c.fillText(short(Number((most / 1.15).toPrecision(1))), box.left - 5, this.py(most / 1.15));
  }

  /** The marker at the value; its neighbour in words. */
  place() {
    const {slider, parameters, marker} = this;
    const value = valueAt(slider, parameters);
    marker.style.transform = `translateX(${this.scale().px(value)}px)`;
    const {canvas} = this;
    canvas.setAttribute("aria-valuemin", this.range[0]);
    canvas.setAttribute("aria-valuemax", this.range[1]);
    canvas.setAttribute("aria-valuenow", value);
    const p = this.found[this.nearest(value)];
    const there = p?.regime ? `: ${regimeText(p.regime)}` : "";
    canvas.setAttribute(
      "aria-valuetext",
      `${slider.symbol} = ${short(value)} ${slider.unit ?? ""}${there}`,
    );
    $("strip-parameter").textContent = slider.symbol;
    $("strip-trouble").textContent = this.trouble ?? "";
    this.trouble = "";
  }

  /** The entry nearest to a value. */
  nearest(value) {
    const [from, to] = this.range;
    return Math.min(
      Math.max(Math.round(((value - from) / (to - from)) * (points - 1)), 0),
      points - 1,
    );
  }

  /** What lies under the pointer, in words. */
  tell(px) {
    const value = this.scale().value(px);
    const p = this.found[this.nearest(value)];
    const {symbol, unit = ""} = this.slider;
    const where = `${symbol} = ${written(value, this.range)} ${unit}`.trim();
    const lambda =
      p?.lambda?.[0] == null ? "" : `, λ₁ = ${withError(p.lambda[0], p.standard_error?.[0], 3)}`;
    const verdict = p?.verdict ? `, ${verdicts[p.verdict]}` : "";
    const z = p?.z == null ? "" : `, z = ${digits(p.z, 2)}`;
    $("strip-tip").textContent = p?.regime
      ? `${where}: ${regimeText(p.regime)}${verdict}${lambda}${z}`
      : where;
  }

  set(wanted, hasty) {
    const {slider, parameters} = this;
    const [from, to] = this.range;
    const inside = Math.min(Math.max(wanted, Math.max(from, this.at(0))), to);
    const value = Number(written(inside, this.range));
    this.turn(fieldsOf(slider, value, parameters), slider, {hasty});
  }

  listen() {
    const {canvas} = this;
    const under = (event) =>
      this.scale().value(event.clientX - canvas.getBoundingClientRect().left);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.set(under(event), true);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) this.set(under(event), true);
      this.tell(event.clientX - canvas.getBoundingClientRect().left);
    });
    canvas.addEventListener("pointerup", (event) => this.set(under(event), false));
    canvas.addEventListener("pointerleave", () => {
      $("strip-tip").textContent = "";
    });
    canvas.addEventListener("keydown", (event) => this.press(event));
  }

  press(event) {
    const [from, to] = this.range;
    const step = ((event.shiftKey ? 10 : 1) * (to - from)) / (points - 1);
    const now = valueAt(this.slider, this.parameters);
    const moves = {
      ArrowLeft: now - step,
      ArrowDown: now - step,
      ArrowRight: now + step,
      ArrowUp: now + step,
      Home: from,
      End: to,
    };
    if (!(event.key in moves)) return;
    event.preventDefault();
    this.set(moves[event.key], false);
  }
}

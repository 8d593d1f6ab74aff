// The editable list of impacts: remove, move, add.
import {$, button, element} from "../shared/dom.js";
import {digits, toNumber} from "../shared/numbers.js";

const most = 2000; // rows; more would scroll slowly

const walls = {1: "+b", "-1": "−b"};
const taken = ["ok", "R is not known", "hidden"];
export const isLeftOut = (status) => !taken.includes(status);

/** How an impact is marked: by its edit, or else by its status or wall. */
export function kindOf(row) {
  if (row.removed) return "removed";
  if (row.t !== row.found) return "edited";
  if (isLeftOut(row.status)) return "left-out";
  return row.side > 0 ? "plus" : "minus";
}

function statusOf(row) {
  if (row.removed) return "removed";
  const stays = row.t === row.found || row.status === "added";
  return stays ? row.status : `moved from ${row.found.toFixed(5)}`;
}

const refuse = (input) => input.setAttribute("aria-invalid", true);

export class ImpactList {
  /** changed() is called after each change. */
  constructor(changed) {
    this.changed = changed;
    this.rows = [];
    this.body = $("measure-impacts");
    const form = $("measure-add");
    const [input] = form.elements;
    form.onsubmit = (event) => {
      event.preventDefault();
      if (this.add(toNumber(input.value))) input.value = "";
      else refuse(input);
      input.focus();
    };
    form.oninput = () => input.removeAttribute("aria-invalid");
    $("measure-doubtful").onchange = () => this.show();
  }

  /** Takes the impacts of an answer; span: [start, end] of the record in s. */
  set({time_s: times, side, R, status}, span) {
    this.span = span;
    this.rows = times.map((found, i) => ({found, side: side[i], R: R[i], status: status[i]}));
    this.reset();
  }

  reset() {
    const found = this.rows.filter((row) => row.status !== "added");
    this.rows = found.map((row) => ({...row, t: row.found, removed: false}));
    this.update();
  }

  get edited() {
    return this.rows.some((row) => ["removed", "edited"].includes(kindOf(row)));
  }

  /** The impact times to identify with, s. */
  times() {
    const kept = this.rows.filter((row) => !row.removed);
    return kept.map(({t}) => Number(t.toFixed(7)));
  }

  /** True when t is a time inside the record; t can be null. */
  inside(t) {
    return t !== null && t > this.span[0] && t < this.span[1];
  }

  add(t) {
    if (!this.inside(t)) return false;
    const row = {t, status: "added"};
    this.rows.push(row);
    this.update(row);
    return true;
  }

  update(wanted) {
    this.rows.sort((a, b) => a.t - b.t);
    this.show();
    this.lines.get(wanted)?.scrollIntoView({block: "nearest"});
    this.changed();
  }

  /** Shows all rows or, on request, those left out or edited with their neighbours. */
  show() {
    const isDoubtful = (row) => !["plus", "minus"].includes(kindOf(row));
    const all = !$("measure-doubtful").checked;
    const isWanted = ([i]) => all || this.rows.slice(Math.max(i - 1, 0), i + 2).some(isDoubtful);
    const wanted = [...this.rows.entries()].filter(isWanted);
    this.lines = new Map(wanted.slice(0, most).map(([i, row]) => [row, this.line(row, i)]));
    this.body.replaceChildren(...this.lines.values());
    const first = wanted.length > most ? `the first ${most} of ${wanted.length}` : "";
    $("measure-list-note").textContent = wanted.length ? first : "none";
  }

  line(row, i) {
    const cells = [
      String(i + 1),
      this.timeInput(row, i),
      this.removeButton(row, i),
      walls[row.side] ?? "–",
      digits(row.R),
      statusOf(row),
    ];
    return element("tr", {className: kindOf(row)}, ...cells.map((cell) => element("td", {}, cell)));
  }

  timeInput(row, i) {
    const onchange = ({target}) => {
      const t = toNumber(target.value);
      if (!this.inside(t)) return refuse(target);
      row.t = t === Number(row.found?.toFixed(5)) ? row.found : t;
      this.update(row);
      this.lines.get(row)?.querySelector("input").focus();
    };
    const ariaLabel = `time of impact ${i + 1} in s`;
    const [value, disabled] = [row.t.toFixed(5), row.removed];
    const type = {type: "text", inputMode: "decimal"};
    return element("input", {...type, value, ariaLabel, disabled, onchange});
  }

  removeButton(row, i) {
    const verb = row.removed ? "Restore" : "Remove";
    const toggle = () => {
      row.removed = !row.removed;
      if (row.status === "added") this.rows.splice(i, 1);
      this.update();
      const line = this.lines.get(row) ?? this.body.rows[i] ?? this.body.lastChild;
      line?.querySelector("button").focus();
    };
    const ariaLabel = `${verb.toLowerCase()} impact ${i + 1} at ${row.t.toFixed(4)} s`;
    return button(verb, toggle, {ariaLabel});
  }
}

// The impacts as a list to edit: remove one, move one, add one.
import {element} from "../shared/dom.js";

const most = 2000; // rows that a browser scrolls without effort

const walls = {1: "+b", "-1": "−b"};
const taken = ["ok", "R is not known", "hidden"];
export const isLeftOut = (status) => !taken.includes(status);

/** What is typed in, in s; NaN for what is no number. */
const moment = (text) => (text.trim() ? Number(text.trim().replace(",", ".")) : NaN);

const isEdited = (row) => row.removed || row.t !== row.found;

function statusOf(row) {
  if (row.removed) return "removed";
  if (row.found === null) return "added";
  return row.t === row.found ? row.status : `moved from ${row.found.toFixed(5)}`;
}

function classOf(row) {
  if (row.removed) return "removed";
  if (isEdited(row)) return "edited";
  return isLeftOut(row.status) ? "left-out" : "";
}

export class ImpactList {
  /** parts: {body, note, adding: a form, doubtful: a box}; changed: called after each change. */
  constructor(parts, changed) {
    Object.assign(this, {...parts, changed, rows: []});
    parts.adding.addEventListener("submit", (event) => {
      event.preventDefault();
      const input = parts.adding.elements[0];
      if (this.add(moment(input.value))) input.value = "";
      else input.setAttribute("aria-invalid", "true");
      input.focus();
    });
    parts.adding.addEventListener("input", (event) => event.target.removeAttribute("aria-invalid"));
    parts.doubtful.addEventListener("change", () => this.show());
  }

  /** The impacts of an answer; span: the record's [start, end] in s. */
  set(impacts, span) {
    this.span = span;
    this.rows = impacts.time_s.map((t, i) => ({
      t,
      found: t,
      side: impacts.side[i],
      R: impacts.R[i],
      status: impacts.status[i],
      removed: false,
    }));
    this.original = this.rows.map((row) => ({...row}));
    this.update();
  }

  reset() {
    this.rows = this.original.map((row) => ({...row}));
    this.update();
  }

  get edited() {
    return this.rows.some(isEdited);
  }

  times() {
    return this.rows.filter((row) => !row.removed).map((row) => row.t);
  }

  inside(t) {
    return Number.isFinite(t) && t > this.span[0] && t < this.span[1];
  }

  add(t) {
    if (!this.inside(t)) return false;
    const row = {t, found: null, status: "added", removed: false};
    this.rows.push(row);
    this.update(row);
    return true;
  }

  update(wanted) {
    this.rows.sort((a, b) => a.t - b.t);
    this.show();
    if (wanted) this.lines.get(wanted)?.scrollIntoView({block: "nearest"});
    this.changed();
  }

  /** All rows, or those left out, those beside them and those edited. */
  show() {
    const isDoubtful = (row) => row && (isEdited(row) || isLeftOut(row.status));
    const isWanted = ({i}) =>
      !this.doubtful.checked || [i - 1, i, i + 1].some((k) => isDoubtful(this.rows[k]));
    const wanted = this.rows.map((row, i) => ({row, i})).filter(isWanted);
    this.lines = new Map(wanted.slice(0, most).map(({row, i}) => [row, this.line(row, i)]));
    this.body.replaceChildren(...this.lines.values());
    const first = wanted.length > most ? `the first ${most} of ${wanted.length}` : "";
    this.note.textContent = wanted.length ? first : "none";
  }

  line(row, i) {
    const cells = [
      String(i + 1),
      this.timeInput(row, i),
      this.removeButton(row, i),
      walls[row.side] ?? "–",
      row.R == null ? "–" : row.R.toFixed(4).replace("-", "−"),
      statusOf(row),
    ];
    const className = classOf(row);
    return element("tr", {className}, ...cells.map((cell) => element("td", {}, cell)));
  }

  timeInput(row, i) {
    const input = element("input", {
      type: "text",
      inputMode: "decimal",
      value: row.t.toFixed(5),
      ariaLabel: `time of impact ${i + 1} in s`,
      disabled: row.removed,
    });
    input.addEventListener("change", () => {
      const t = moment(input.value);
      if (!this.inside(t)) return input.setAttribute("aria-invalid", "true");
      row.t = row.found !== null && t === Number(row.found.toFixed(5)) ? row.found : t;
      this.update(row);
      this.lines.get(row)?.querySelector("input").focus();
    });
    return input;
  }

  removeButton(row, i) {
    const button = element("button", {
      type: "button",
      textContent: row.removed ? "Restore" : "Remove",
      ariaLabel: `${row.removed ? "restore" : "remove"} impact ${i + 1} at ${row.t.toFixed(4)} s`,
    });
    button.addEventListener("click", () => {
      row.removed = !row.removed;
      if (row.removed && row.found === null) this.rows.splice(this.rows.indexOf(row), 1);
      this.update();
      const last = this.body.rows.length - 1;
      const line = this.lines.get(row) ?? this.body.rows[Math.min(i, last)];
      line?.querySelector("button").focus();
    });
    return button;
  }
}

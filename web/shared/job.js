// Runs one computation at a time, that of the newest request; older ones are aborted.
import delay from "delay";
import {TemporaryError} from "./api.js";
import {$, attributes, countUp, sayIn} from "./dom.js";
import {queryOf, unknownText} from "./form.js";

const lateAfter = 120; // ms after which a computation is reported as busy
const retryInterval = 2; // s between attempts while the service is unreachable or busy

/** True for temporary failures: no answer, a broken answer or 503. */
const isTemporary = (error) => error instanceof TemporaryError || error.status === 503;

/**
 * Has, as methods or given: ask(request, signal), which returns the answer; show(answer, request,
 * ms); fail(error, request) for permanent errors. Optional: busy(is, cancelled), called when a
 * computation takes longer than `lateAfter` and when it ends; later(text), while attempts fail.
 */
export class Job {
  #running = null;
  #next = null;

  constructor(parts) {
    Object.assign(this, parts);
  }

  /** Starts a request, which aborts an older one unless `dragging`; an equal one runs on. */
  start(request, {dragging = false} = {}) {
    const running = this.#running;
    const same = JSON.stringify(request) === running?.text;
    if (same && !this.#next && !running.abort.signal.aborted) {
      running.newest = request;
      return;
    }
    this.#next = request;
    if (!running) this.#compute();
    else if (!dragging || !running.answers) running.abort.abort();
  }

  cancel() {
    this.#next = null;
    this.#running?.abort.abort();
  }

  /** Computes the next request, and those that come in the meantime. */
  async #compute() {
    const request = this.#next;
    this.#next = null;
    const abort = new AbortController();
    const {signal} = abort;
    const running = {newest: request, abort, answers: true, text: JSON.stringify(request)};
    this.#running = running;
    const late = setTimeout(() => this.busy?.(true), lateAfter);
    const began = performance.now();
    let cancelled = false;
    try {
      const answer = await this.#answer(request, signal);
      if (!signal.aborted) await this.show(answer, running.newest, performance.now() - began);
    } catch (error) {
      if (!signal.aborted) this.fail(error, running.newest);
      else cancelled = !this.#next;
    } finally {
      clearTimeout(late);
      this.#running = null;
      if (this.#next) this.#compute();
      else this.busy?.(false, cancelled);
    }
  }

  /** Repeats the request while it fails temporarily. */
  async #answer(request, signal) {
    for (;;) {
      const attempt = new AbortController();
      try {
        return await this.ask(request, AbortSignal.any([signal, attempt.signal]));
      } catch (error) {
        attempt.abort(); // what else it asked for
        if (signal.aborted || !isTemporary(error)) throw error;
        this.#running.answers = false;
        this.later?.(`${error.message}; retrying every ${retryInterval} s`);
        await delay(retryInterval * 1000, {signal});
      }
    }
  }
}

/**
 * A tab of the page. Subclasses have ask() of a Job, and
 * form: its showErrors(errors) shows errors at their fields and returns those without a field;
 * request(): what the form holds, {base, ...}, by default the parts `base` and `own` of its fields;
 * open(query): shows the request of a query;
 * draw(): draws the results so far.
 */
export class RequestTab extends Job {
  asked = null; // query in the address, of the results shown or computed; null before the first
  #drawing = 0; // timer
  #cost = 0; // of drawing, ms

  /** prefix: of the ids of the tab; changed({edit, soon}): called when query() changes. */
  constructor(prefix, changed) {
    const say = sayIn(`${prefix}message`);
    super({changed, say, later: (text) => say(text, true), results: $(`${prefix}results`)});
    this.formElement = $(`${prefix}form`);
    this.formElement.onsubmit = () => this.submit();
    this.noteElement = $(`${prefix}note`);
    this.examples = $(`${prefix}example`);
    this.examples?.addEventListener("change", () => {
      const {query} = this.examples.selectedOptions[0].dataset;
      if (!query) return;
      this.open(new URLSearchParams(query));
      this.scrollToResults();
    });
    this.cancelButton = $(`${prefix}cancel`);
    this.cancelButton.onclick = () => this.cancel();
  }

  query() {
    return this.asked;
  }

  request() {
    const {base, own} = this.form.parted();
    return {base, ...own};
  }

  formQuery() {
    const {base, ...own} = this.request();
    return queryOf({...own, ...base});
  }

  /** Shows the fields of a query in the form, and reports unknown ones in its note. */
  fill(fields) {
    this.form.set(this.form.parse(fields));
    this.noteElement.textContent = unknownText(this.form.unknown(fields));
  }

  /** Requests what the form holds. */
  send() {
    const edit = this.asked !== null;
    this.asked = this.formQuery();
    this.form.showErrors([]);
    this.changed({edit});
    this.say("");
    this.markStale();
    this.start(this.request());
  }

  /** True if the results belong to another request; busy: a computation takes long. */
  isStale(_busy) {
    return this.asked !== null && this.formQuery() !== this.asked;
  }

  submit() {
    this.send();
    this.scrollToResults();
  }

  show() {
    this.say("");
    this.redraw();
    countUp(this.results);
  }

  /** Draws complete results, or draws in other colours. */
  redraw() {
    if (this.asked !== null) this.draw();
  }

  busy(is, cancelled) {
    this.cancelButton.hidden = !is;
    attributes(this.results, {"aria-busy": is});
    this.markStale(is);
    if (cancelled) this.say("cancelled");
  }

  /** Shows errors at the fields at fault, and those without a field as a message. */
  fail({message, errors = []}) {
    const left = this.form.showErrors(errors);
    this.sayFault([message, ...left.map(({detail}) => detail)]);
  }

  sayFault(texts) {
    this.say([...new Set(texts)].join("; "), true);
    this.markStale();
  }

  /** The part of a query that is the request. */
  requestOf(query) {
    return String(new URLSearchParams(query));
  }

  /** Selects the example that the form shows, if any: its option has the query. */
  showExample() {
    const [own, ...examples] = this.examples.options;
    const shown = this.requestOf(this.formQuery());
    const example = examples.find(({dataset}) => this.requestOf(dataset.query) === shown);
    (example ?? own).selected = true;
  }

  /** Marks the results if the form differs from their request. */
  markStale(busy = false) {
    if (this.examples) this.showExample();
    this.results.classList.toggle("stale", this.isStale(busy));
  }

  /** Draws at most ten times a second, using at most a fifth of the time. */
  drawSoon() {
    this.#drawing ||= setTimeout(
      () => {
        this.#drawing = 0;
        const began = performance.now();
        this.draw();
        this.#cost = performance.now() - began;
      },
      Math.max(100, 4 * this.#cost),
    );
  }

  /** On small screens the results lie below the form: scrolls to them. */
  scrollToResults() {
    const {offsetLeft, offsetWidth} = this.formElement;
    if (this.results.offsetLeft < offsetLeft + offsetWidth) this.results.scrollIntoView();
  }
}

// One computation at a time, of the newest request: the others are broken off or never begin.
import {Passing} from "./api.js";

const patience = 120; // ms after which what is shown is marked as that of another request
export const again = 2; // s after which a server that does not answer, or is busy, is asked again

/** Some seconds, or until one does not want to wait any longer. */
const sleep = (seconds, signal) =>
  new Promise((resolve) => {
    setTimeout(resolve, seconds * 1000);
    signal.onabort = resolve;
  });

/** Whether the same request may be answered later: there was no answer, or half of one. */
export const passes = (error) => error instanceof Passing || error.status === 503;

export class Job {
  running = null;
  next = null;

  /**
   * ask(request, signal): the answer, as a promise; show(answer, request, ms), which may take
   * its time; fail(error, request);
   * busy(is, cancelled): it computes for longer than a moment, or no longer; later(text): there is
   * no answer for now, as the text says; both may be left out. A request that is there already is
   * not begun again.
   */
  constructor(parts) {
    Object.assign(this, parts);
  }

  /**
   * hasty: one of many that come while a slider is dragged. It lets the one before it come to its
   * end, so that something is seen on the way.
   */
  start(request, {hasty = false} = {}) {
    const {running} = this;
    const same = JSON.stringify(request) === running?.text;
    if (same && !this.next && !running.abort.signal.aborted) return;
    this.next = request;
    if (!running) this.run();
    else if (!hasty || !running.answers) running.abort.abort();
  }

  busy() {}

  later() {}

  cancel() {
    this.next = null;
    this.running?.abort.abort();
  }

  async run() {
    while (this.next) {
      const request = this.next;
      this.next = null;
      await this.one(request);
    }
  }

  async one(request) {
    const abort = new AbortController();
    const {signal} = abort;
    this.running = {abort, answers: true, text: JSON.stringify(request)};
    const late = setTimeout(() => this.busy(true), patience);
    const began = performance.now();
    let cancelled = false;
    try {
      const answer = await this.answer(request, signal);
      if (!signal.aborted) await this.show(answer, request, performance.now() - began);
    } catch (error) {
      if (!signal.aborted) this.fail(error, request);
      else cancelled = !this.next;
    } finally {
      clearTimeout(late);
      this.running = null;
      if (!this.next) this.busy(false, cancelled);
    }
  }

  /** As long as there is no answer it is asked again. */
  async answer(request, signal) {
    for (;;)
      try {
        return await this.ask(request, signal);
      } catch (error) {
        if (signal.aborted || !passes(error)) throw error;
        this.running.answers = false;
        this.later(`${error.message}; asking again every ${again} s`);
        await sleep(again, signal);
      }
  }
}

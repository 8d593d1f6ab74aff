// A tab of the page: a form whose request is computed, and the results of the newest answer. This
// is what the tabs share: message, cancel button, errors at fields, and the look of results that
// belong to another request.
import {$, attributes, sayIn} from "./dom.js";
import {Job} from "./job.js";

/**
 * Subclasses have ask() and show() of a Job, and
 * form: its showErrors(errors) shows errors at their fields and returns those without a field;
 * submit(): sends the form;
 * isStale(busy): true if the results belong to another request; busy: a computation takes long;
 * query(): the query of the request in the address; null before the first;
 * open(query): shows the request of a query;
 * redraw(): draws in other colours.
 */
export class RequestTab extends Job {
  /** prefix: of the ids of the tab; changed({edit, soon}): called when query() changes. */
  constructor(prefix, changed) {
    super({changed, say: sayIn(`${prefix}message`), results: $(`${prefix}results`)});
    this.formElement = $(`${prefix}form`);
    this.formElement.onsubmit = (event) => {
      event.preventDefault();
      this.submit();
    };
    this.cancelButton = $(`${prefix}cancel`);
    this.cancelButton.onclick = () => this.cancel();
  }

  busy(is, cancelled) {
    this.cancelButton.hidden = !is;
    attributes(this.results, {"aria-busy": is});
    this.markStale(is);
    if (cancelled) this.say("cancelled");
  }

  later(text) {
    this.say(text, true);
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

  markStale(busy = false) {
    this.results.classList.toggle("stale", this.isStale(busy));
  }

  /** On small screens the results lie below the form: scrolls to them. */
  scrollToResults() {
    const {offsetLeft, offsetWidth} = this.formElement;
    if (this.results.offsetLeft < offsetLeft + offsetWidth) this.results.scrollIntoView();
  }
}

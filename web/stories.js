// Guided stories, in `stories` of the page: each step opens a request and says what to look at.
import {$, button, element} from "./shared/dom.js";

const guide = $("guide");

/** open(query) opens the request of a step. Returns false for an unknown story. */
export function start(name, open) {
  const story = [...$("stories").content.children].find(({dataset}) => dataset.story === name);
  if (story) show(story, 0, open);
  return Boolean(story);
}

function show(story, step, open) {
  const {children, dataset} = story;
  const to = (other) => () => show(story, other, open);
  const leave = () => {
    guide.hidden = true;
  };
  guide.hidden = false;
  guide.replaceChildren(
    element("b", {}, `${dataset.title}, ${step + 1} of ${children.length}`),
    element("p", {innerHTML: children[step].innerHTML, role: "status"}),
    button("Back", to(step - 1), {disabled: step === 0}),
    step + 1 < children.length ? button("Next", to(step + 1), {className: "go"}) : "",
    button("Leave", leave),
  );
  open(children[step].dataset.query);
}

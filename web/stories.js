// Guided stories, in `stories` of the page: each step opens a request and says what to look at.
import {$} from "./shared/dom.js";

const guide = $("guide");
const [title, text, back, next, leave] = guide.children;
leave.onclick = () => {
  guide.hidden = true;
};

/** open(query) opens the request of a step. Returns false for an unknown story. */
export function start(name, open) {
  const story = [...$("stories").content.children].find(({dataset}) => dataset.story === name);
  if (story) show(story, 0, open);
  return Boolean(story);
}

function show(story, step, open) {
  const {children, dataset} = story;
  const to = (other) => () => show(story, other, open);
  guide.hidden = false;
  title.textContent = `${dataset.title}, ${step + 1} of ${children.length}`;
  text.innerHTML = children[step].innerHTML;
  Object.assign(back, {onclick: to(step - 1), disabled: step === 0});
  Object.assign(next, {onclick: to(step + 1), hidden: step + 1 === children.length});
  open(children[step].dataset.query);
}

// Guided stories: each step opens a tab with a request and says what to look at. The real controls
// stay usable, and a story can be left at any moment. The texts are in `stories` of the page.
import {$, button, element} from "./shared/dom.js";

const guide = $("guide");
let story = null; // the <section> shown
let step = 0;

/** The story of a name; undefined if there is none. */
const found = (name) =>
  [...$("stories").content.children].find(({dataset}) => dataset.story === name);

/** open(query) opens the request of a step. Returns false for an unknown story. */
export function start(name, open) {
  story = found(name);
  if (!story) return false;
  step = 0;
  show(open);
  return true;
}

function show(open) {
  const {dataset, innerHTML} = story.children[step];
  const move = (by) => () => {
    step += by;
    show(open);
  };
  const leave = () => {
    guide.hidden = true;
  };
  const last = step === story.children.length - 1;
  guide.hidden = false;
  guide.replaceChildren(
    element("b", {}, `${story.dataset.title}, ${step + 1} of ${story.children.length}`),
    element("p", {innerHTML, role: "status"}),
    button("Back", move(-1), {disabled: step === 0}),
    last ? "" : button("Next", move(1), {className: "go"}),
    button("Leave", leave),
  );
  open(dataset.query);
}

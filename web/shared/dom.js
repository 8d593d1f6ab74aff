// Elements, built with less ceremony.

export const $ = (id) => document.getElementById(id);

/** Counts on a node what was done, for those who wait for it. */
export const countUp = (node, what = "done") => {
  node.dataset[what] = Number(node.dataset[what] ?? 0) + 1;
};

/** Lets the page hear of other things before what is next. */
export const nextTask = () =>
  new Promise((resolve) => {
    setTimeout(resolve);
  });

export const element = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

/** Writes a text into the element of an id. */
export const write = (id, text) => {
  $(id).textContent = text;
};

/** What a reader of the screen is told of a node, by names without `aria-`. */
export const aria = (node, states) => {
  for (const [name, value] of Object.entries(states)) node.setAttribute(`aria-${name}`, value);
};

/** Presses that of several buttons which is(button). */
export const press = (buttons, is) => {
  for (const button of buttons) aria(button, {pressed: is(button)});
};

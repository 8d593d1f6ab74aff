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

/** One that does something; more: its other properties. */
export const button = (textContent, onclick, more) =>
  element("button", {type: "button", textContent, onclick, ...more});

/** Hears of several events of a node: {type: what is called}. */
export const on = (node, handlers) => {
  for (const [type, f] of Object.entries(handlers)) node.addEventListener(type, f);
};

/** Those that have a value are set: what a node says of itself to those who cannot see it, and other attributes. */
export const attributes = (node, all) => {
  for (const [name, value] of Object.entries(all))
    if (value != null) node.setAttribute(name, value);
};

/** Shows those elements for which it holds, and hides the others: {id: whether}. */
export const reveal = (shown) => {
  for (const [id, is] of Object.entries(shown)) $(id).hidden = !is;
};

/** Texts of elements: {id: text}. */
export const write = (texts) => {
  for (const [id, text] of Object.entries(texts)) $(id).textContent = text;
};

/** Presses that of several buttons which is(button). */
export const press = (buttons, is) => {
  for (const one of buttons) attributes(one, {"aria-pressed": is(one)});
};

/** What says something in a place: say(text, whether it is a fault). */
export const sayIn =
  (id) =>
  (text, fault = false) => {
    $(id).textContent = text;
    $(id).classList.toggle("fault", fault);
  };

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

/** Shows those elements for which it holds, and hides the others: {id: whether}. */
export const reveal = (shown) => {
  for (const [id, is] of Object.entries(shown)) $(id).hidden = !is;
};

/** Texts of elements: {id: text}. */
export const write = (texts) => {
  for (const [id, text] of Object.entries(texts)) $(id).textContent = text;
};

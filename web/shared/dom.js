// Elements, built with less ceremony.

export const $ = (id) => document.getElementById(id);

export const element = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

/** A tab of this prefix while it computes: what it shows is of the request before. */
export function showBusy(prefix, is) {
  $(`${prefix}run`).disabled = is;
  $(`${prefix}cancel`).hidden = !is;
  $(`${prefix}results`).classList.toggle("stale", is);
}

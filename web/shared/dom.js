// Elements, built with less ceremony.

export const $ = (id) => document.getElementById(id);

export const element = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

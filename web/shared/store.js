// Files, results and texts that the browser keeps over reloads. Without permission to store, for
// example in a frame of another site, it keeps no files and results, and reading them resolves to
// undefined; texts are then kept until the page is left.
import {clear, createStore, get, keys, set} from "idb-keyval";

/** The storage of texts of this name, localStorage or sessionStorage. */
export function textsIn(name) {
  try {
    return window[name];
  } catch {
    const kept = new Map();
    return {getItem: (key) => kept.get(key) ?? null, setItem: (key, text) => kept.set(key, text)};
  }
}

const most = 50; // entries of a name, after which all of them are dropped

const stores = {}; // by name

/** The result of act(store) on a store; undefined without permission or space. */
async function within(name, act) {
  try {
    stores[name] ??= createStore(`vines-${name}`, name);
    return await act(stores[name]);
  } catch {
    return undefined;
  }
}

export const read = (name, key) => within(name, (store) => get(key, store));

/** Stores a value, a Blob or what can be cloned, in place of the previous one of its key. */
export const write = (name, key, value) =>
  within(name, async (store) => {
    if ((await keys(store)).length >= most) await clear(store);
    await set(key, value, store);
  });

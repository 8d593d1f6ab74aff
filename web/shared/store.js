// Files, results and texts that the browser keeps over reloads. Without permission to store, for
// example in a frame of another site, it keeps no files and results, and reading them resolves to
// undefined; texts are then kept until the page is left.

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

/** Runs act(store) on a store and resolves to the result of the request it returns. */
const within = (name, mode, act) =>
  new Promise((resolve, reject) => {
    const opening = indexedDB.open(`vines-${name}`);
    opening.onupgradeneeded = () => opening.result.createObjectStore(name);
    opening.onerror = () => reject(opening.error);
    opening.onsuccess = () => {
      const request = act(opening.result.transaction(name, mode).objectStore(name));
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
      request.transaction.oncomplete = () => opening.result.close();
    };
  });

export const read = (name, key) =>
  within(name, "readonly", (store) => store.get(key)).catch(() => undefined);

/** Stores a value, a Blob or what can be cloned, in place of the previous one of its key. */
export const write = (name, key, value) =>
  within(name, "readonly", (store) => store.count())
    .then((count) => count >= most && within(name, "readwrite", (store) => store.clear()))
    .then(() => within(name, "readwrite", (store) => store.put(value, key)))
    .catch(() => {}); // not permitted, or no space

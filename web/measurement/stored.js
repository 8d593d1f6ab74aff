// The record read last, kept by the browser so that a reload shows it again.

/** Runs act(store) on the store of records and resolves to the result of the request it returns. */
const within = (mode, act) =>
  new Promise((resolve, reject) => {
    const opening = indexedDB.open("vines", 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore("records");
    opening.onerror = () => reject(opening.error);
    opening.onsuccess = () => {
      const request = act(opening.result.transaction("records", mode).objectStore("records"));
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
    };
  });

/** Keeps a file in place of the previous one; without permission to store, nothing is kept. */
export const keep = (file) =>
  within("readwrite", (store) => store.put(file, "last")).catch(() => {});

/** The kept file if the page was reloaded, else undefined. */
export async function afterReload() {
  const [navigation] = performance.getEntriesByType("navigation");
  if (navigation?.type !== "reload") return undefined;
  return within("readonly", (store) => store.get("last")).catch(() => undefined);
}

// The service's routes, relative to the page, so that it works behind a path prefix too.

/** A problem document (RFC 9457) as an Error: .errors holds {pointer, value, range, detail} for each field at fault. */
export class Problem extends Error {
  constructor(document) {
    super(document.detail ?? document.title);
    this.errors = document.errors ?? [];
  }
}

async function read(response) {
  const body = await response.json().catch(() => ({title: `the server answered ${response.status} without JSON`}));
  if (!response.ok) throw new Problem(body);
  return body;
}

export const get = async (path) => read(await fetch(path));

export const simulate = async (fields, signal) =>
  read(await fetch("v1/simulate", {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(fields), signal}));

// The service's routes, relative to the page, so that it works behind a path prefix too.
import {askForKey, hasKey, keyHeaders} from "./key.js";

/**
 * A problem document (RFC 9457) as an Error: .errors holds {pointer, value, range, detail} for each
 * field at fault.
 */
export class Problem extends Error {
  constructor({detail, title, status, errors = []}) {
    super(detail ?? title);
    Object.assign(this, {status, errors});
  }
}

/** That there is no answer for now: the same request may be answered later. */
export class Passing extends Error {}

/** An error's message, and of the faults those details that it does not say already. */
export const wholeMessage = (error, faults) =>
  [error.message, ...faults.map((e) => e.detail).filter((d) => d !== error.message)].join("; ");

async function read(response) {
  const noJson = {title: `the server answered ${response.status} without JSON`};
  const body = await response.json().catch(() => null);
  if (!response.ok) throw new Problem({status: response.status, ...(body ?? noJson)});
  if (body === null) throw new Passing("the answer broke off");
  return body;
}

/** The response to a request; if it was broken off, who did so knows. */
export async function reach(path, options = {}) {
  let response = await answer(path, options);
  const isRefused = () => response.status === 401;
  // What the browser had loaded before showed no key, nor what was sent while one was typed.
  if (isRefused() && hasKey()) response = await answer(path, options);
  while (isRefused() && (await askForKey())) response = await answer(path, options);
  return response;
}

async function answer(path, options) {
  try {
    return await fetch(path, {...options, headers: {...options.headers, ...keyHeaders()}});
  } catch {
    throw new Passing("the server does not answer");
  }
}

export const get = async (path) => read(await reach(path));

const post = (path, body, signal, type = "application/json") =>
  reach(path, {method: "POST", headers: {"Content-Type": type}, body, signal});

const computing = (path) => async (fields, signal) =>
  read(await post(path, JSON.stringify(fields), signal));

export const simulate = computing("v1/simulate");

/** query: the fields; record: a file of CSV, sent as it is. */
export const identify = async (query, record, signal) =>
  read(await post(`v1/identify?${query}`, record, signal, "text/csv"));

/** The same with all in JSON. */
export const identifyJson = computing("v1/identify");

/** A sweep's answer, a stream of lines. */
export async function sweep(request, signal) {
  const response = await post("v1/sweep", JSON.stringify(request), signal);
  return response.ok ? response.body : read(response);
}

const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;
/** The address of a route, for use elsewhere. */
export const whole = (path) => new URL(path, location.href.split("?")[0]).href;

/** A request for a terminal. */
export const asCurl = (path, fields, flags = "-s") =>
  `curl ${flags} ${whole(path)} -d ${quoted(JSON.stringify(fields))}`;

export const getAsCurl = (path, flags = "-s") => `curl ${flags} ${quoted(whole(path))}`;

/** A file as the body. */
export function sendFileAsCurl(path, type, name, flags = "-s") {
  const address = path.includes("?") ? quoted(whole(path)) : whole(path);
  return `curl ${flags} ${address} -H 'Content-Type: ${type}' --data-binary ${quoted(`@${name}`)}`;
}

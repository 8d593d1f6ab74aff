// Answers to be held against each other.

/** The response to one of the golden requests. */
export const ask = async (url, {path, body, type = "application/json"}) => {
  const text = typeof body === "string" ? body : JSON.stringify(body);
  const options = body === undefined ? {} : {method: "POST", body: text};
  // A fault tells the request's name, which the service would make up.
  const headers = {"Content-Type": type, "X-Request-ID": "same"};
  return await fetch(url + path, {...options, headers});
};
/** A sweep's points come in any order, its progress by the clock. */
const steady = (text) =>
  text
    .split("\n")
    .filter((line) => !line.startsWith('{"type":"progress"'))
    .sort()
    .join("\n");
/** Its text, the same for the same answer. */
export const answerOf = async (url, request) => steady(await (await ask(url, request)).text());

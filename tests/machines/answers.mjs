// Responses in a form that can be compared byte by byte.

/** The response to one of the golden requests. */
export const ask = async (url, {path, body, type = "application/json"}) => {
  const text = typeof body === "string" ? body : JSON.stringify(body);
  const options = body === undefined ? {} : {method: "POST", body: text};
  // Problems contain the request ID, which the service would generate.
  const headers = {"Content-Type": type, "X-Request-ID": "same"};
  return await fetch(url + path, {...options, headers});
};
/** The text with its lines sorted and without progress lines: order and progress of a sweep vary. */
const steady = (text) =>
  text
    .split("\n")
    .filter((line) => !line.startsWith('{"type":"progress"'))
    .sort()
    .join("\n");
/** The text of the response, independent of the order of a sweep's lines. */
export const answerOf = async (url, request) => steady(await (await ask(url, request)).text());

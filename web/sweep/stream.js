// A sweep's points as they come.
import {Passing, sweep} from "../shared/api.js";
import {jsonLines} from "../shared/json_lines.js";

/**
 * The points that data (SweepData) still lacks, into it; throws if the stream ends before all are
 * there. heard(line): each line, until it is
 * broken off.
 */
export async function receive(data, signal, heard) {
  const missing = data.received ? {indices: data.missing()} : {};
  for await (const {text, value} of jsonLines(await sweep({...data.request, ...missing}, signal))) {
    if (value.type === "error") throw new (value.status === 503 ? Passing : Error)(value.detail);
    data.take(value, text);
    if (!signal.aborted) heard(value);
  }
  if (!data.complete) throw new Passing("the answer ended before its end");
}

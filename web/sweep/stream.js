// A sweep's points as they come. A stream that breaks is asked again for what it did not bring, a
// few times.
import {Problem, sweep} from "../shared/api.js";
import {jsonLines} from "../shared/json_lines.js";

const pauses = [1, 2, 4, 8]; // seconds between tries that bring nothing

const sleep = (seconds, signal) =>
  new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, seconds * 1000);
    const stop = () => {
      clearTimeout(timer);
      reject(signal.reason);
    };
    signal.addEventListener("abort", stop, {once: true});
  });

/** Whether the same request would be refused again. */
const hopeless = (error) => error instanceof Problem && error.status !== 503;

/** One stream into data (SweepData); throws if it ends before all is there. */
async function receive(request, data, signal, heard) {
  const missing = data.received ? {indices: data.missing()} : {};
  for await (const {text, value} of jsonLines(await sweep({...request, ...missing}, signal))) {
    if (value.type === "error") throw new Error(value.detail);
    data.take(value, text);
    heard(value);
  }
  if (!data.complete) throw new Error("the answer ended before its end");
}

/**
 * The whole sweep. heard(line): each line; broken(error, seconds): a stream broke and is asked for
 * the rest after so many.
 */
export async function follow(request, data, signal, {heard, broken}) {
  for (let tries = 0; !data.complete; ) {
    const before = data.received;
    try {
      await receive(request, data, signal, heard);
    } catch (error) {
      if (signal.aborted || hopeless(error)) throw error;
      if (data.received > before) tries = 0;
      if (tries === pauses.length) throw error;
      broken(error, pauses[tries]);
      await sleep(pauses[tries++], signal);
    }
  }
}

// A stream of JSON lines.
import {Passing} from "./api.js";

/**
 * The lines of a stream of JSON lines as {text, value}; a line may lie across chunks, and a
 * character, too.
 */
export async function* jsonLines(stream) {
  const reader = stream.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  try {
    for (;;) {
      const {done, value = ""} = await reader.read().catch(() => {
        throw new Passing("the answer broke off");
      });
      const texts = `${rest}${value}`.split("\n");
      rest = texts.pop();
      for (const text of texts) if (text) yield {text, value: JSON.parse(text)};
      if (done) return; // what has no end of line then is half a line
    }
  } finally {
    reader.cancel().catch(() => {});
  }
}

// The service's responses are byte-identical to the recorded ones, whose SHA-256 is in
// answers.json, for every compiler, instruction set and build. After an intended change of the
// responses, this records the new hashes, and the test passes trivially:
//   VINES=build/release/vines PUBLISH=1 node --test tests/machines/answers.test.mjs
import assert from "node:assert/strict";
import {createHash} from "node:crypto";
import {readFile, writeFile} from "node:fs/promises";
import {test} from "node:test";
import {identifications, requests} from "../golden/requests.mjs";
import {serviceFor} from "../http/raw.mjs";
import {answerOf, ask} from "./answers.mjs";

const file = new URL("answers.json", import.meta.url);

/** The text without commit, version and provenance (its last field), which depend on the build. */
const asRecorded = (text) =>
  text
    .replace(/,"provenance":.*$/m, "}")
    .replace(/"commit":"[^"]*",/, "")
    .replaceAll(/"version":"[^"]*"/g, '"version":""');

test("simulations, manifolds, sweeps and identifications have the recorded bytes", async (t) => {
  const service = await serviceFor(t);
  // Identifications use simulated records.
  const simulate = async (body) => (await ask(service.url, {path: "/v1/simulate", body})).json();
  const computed = requests.filter(({path}) => /^\/v1\/(simulate|manifold|sweep)/.test(path));
  const hashes = {};
  for (const request of [...computed, ...(await identifications(simulate))]) {
    const text = asRecorded(await answerOf(service.url, request));
    hashes[request.name] = createHash("sha256").update(text).digest("hex");
  }
  if (process.env.PUBLISH) await writeFile(file, `${JSON.stringify(hashes, null, 2)}\n`);
  assert.deepEqual(hashes, JSON.parse(await readFile(file, "utf8")));
});

// Fixtures of the client tests: a service, one with a key, and the file record.csv of the examples.
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {measured} from "../record.mjs";
import {startService} from "../service.mjs";

export const key = "a-key-of-thirty-two-characters--";

/**
 * Starts the services. Returns {folder, open, locked, stop}; folder: contains record.csv, 20 s of
 * fig20; open: a service without keys; locked: one that requires `key` and stops computations after
 * 0.5 s, for the tests of deadlines; stop(): ends both and deletes the folder.
 */
export async function startServices() {
  const folder = mkdtempSync(join(tmpdir(), "vines-clients-"));
  writeFileSync(join(folder, "keys"), `${key}\n`);
  const open = await startService();
  const locked = await startService(["--api-key-file", join(folder, "keys"), "--deadline", "0.5"]);
  writeFileSync(join(folder, "record.csv"), await measured(open.url, "fig20", 20));
  const stop = async () => {
    await Promise.all([open.stop(), locked.stop()]);
    rmSync(folder, {recursive: true});
  };
  return {folder, open, locked, stop};
}

/** Exit code and output of a finished process, as text for the messages of assertions. */
export const outcome = ({status, stdout, stderr}) => `${status}\n${stdout}\n${stderr}`;

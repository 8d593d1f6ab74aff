// Whom the clients ask: a running service, one with a key, and what the documents call record.csv.
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {measured} from "../record.mjs";
import {startService} from "../service.mjs";

export const key = "a-key-of-thirty-two-characters--";

/** Starts them: {room, open, locked, stop}, where room is a folder with the record. */
export async function startServices() {
  const room = mkdtempSync(join(tmpdir(), "vines-clients-"));
  writeFileSync(join(room, "keys"), `${key}\n`);
  const open = await startService();
  const locked = await startService(["--api-key-file", join(room, "keys"), "--deadline", "0.5"]);
  writeFileSync(join(room, "record.csv"), await measured(open.url, "fig20", 20));
  const stop = async () => {
    await Promise.all([open.stop(), locked.stop()]);
    rmSync(room, {recursive: true});
  };
  return {room, open, locked, stop};
}

/** How a program ended, for a test that fails. */
export const said = ({status, stdout, stderr}) => `${status}\n${stdout}\n${stderr}`;

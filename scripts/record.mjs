#!/usr/bin/env -S node
// scripts/record.mjs PRESET SECONDS [URL]: a measurement of a preset's oscillator as CSV, made from
// what the running service says of its motion: sampled, with noise, each impact as a short pulse.
import {measured} from "../tests/record.mjs";

const [preset, seconds, url = "http://127.0.0.1:8080"] = process.argv.slice(2);
if (!(Number(seconds) > 0)) {
  console.error("record: PRESET SECONDS [URL], for example fig20 20");
  process.exit(2);
}
process.stdout.write(await measured(url, preset, Number(seconds)));

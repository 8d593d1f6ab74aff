// Compares the instruction counts of the parts in parts.cpp with the recorded ones. A part fails if
// its count is more than 3 % above the record, or has none; more than 3 % below is reported. Counts
// vary from run to run only by a few dozen instructions of the allocator. If no comparison is
// possible, the exit code is 77, with which CTest marks a test as skipped.
// Usage: node count.mjs [record]
import {spawnSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

const tolerance = 0.03;
const recorded = new URL("recorded.json", import.meta.url);
const recordCommand = "scripts/instructions record";
const program =
  process.env.INSTRUCTION_PARTS ??
  new URL("../../build/release/tests/instruction_parts", import.meta.url).pathname;

// The C library selects memcpy by the processor; this setting selects that of baseline x86-64.
// Otherwise the copies alone can be 7 % of a trajectory.
const baselineEnvironment = {
  ...process.env,
  GLIBC_TUNABLES: "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-BMI2,-ERMS,-SSSE3",
};

const run = (command, args) => {
  const {status, stdout, stderr, error} = spawnSync(command, args, {
    encoding: "utf8",
    env: baselineEnvironment,
  });
  if (error || status !== 0) throw new Error(`${command}: ${error?.message ?? stderr}`);
  return stdout;
};

const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};

/** Compiler of the program, and its measured parts: {name, unit, count}, count units per run. */
const describe = () => {
  const [compiler, ...lines] = run(program, []).trim().split("\n");
  const parts = lines.map((line) => {
    const [name, unit, count] = line.split(" ");
    return {name, unit, count: Number(count)};
  });
  return {compiler, parts};
};

/** Instructions per unit of each part, by name. */
const countInstructions = (parts) => {
  const folder = mkdtempSync(join(tmpdir(), "instructions-"));
  try {
    const dumps = parts.map(({name}) => `--dump-after=${name}`);
    const out = `--callgrind-out-file=${join(folder, "out")}`;
    run("valgrind", ["--tool=callgrind", out, "--toggle-collect=part_*", ...dumps, program]);
    const totals = {};
    // Each part runs and is dumped twice. The second dump, with cached tables, replaces the first.
    const number = (file) => Number(file.split(".")[1] ?? 0);
    for (const file of readdirSync(folder).sort((a, b) => number(a) - number(b))) {
      const text = readFileSync(join(folder, file), "utf8");
      const name = /^desc: Trigger: --dump-after=(.*)$/m.exec(text)?.[1];
      if (name) totals[name] = Number(/^totals: (\d+)$/m.exec(text)[1]);
    }
    return Object.fromEntries(parts.map((p) => [p.name, Math.round(totals[p.name] / p.count)]));
  } finally {
    rmSync(folder, {recursive: true});
  }
};

if (spawnSync("valgrind", ["--version"]).error)
  skip("valgrind is not installed; scripts/setup test installs it");
const {compiler, parts} = describe();
const all = JSON.parse(readFileSync(recorded, "utf8"));

if (process.argv[2] === "record") {
  all[compiler] = countInstructions(parts);
  writeFileSync(recorded, `${JSON.stringify(all, null, 2)}\n`);
  console.log(`recorded for ${compiler}:`, all[compiler]);
  process.exit(0);
}

const before =
  all[compiler] ?? skip(`no counts are recorded for ${compiler}; ${recordCommand} records them`);
const now = countInstructions(parts);
let failed = 0;
for (const {name, unit} of parts) {
  const line = `${name}, ${now[name]} instructions per ${unit}`;
  if (!(name in before)) {
    console.log(`NEW: ${line}, without a recorded count; to add it: ${recordCommand}`);
    failed += 1;
    continue;
  }
  const change = now[name] / before[name] - 1;
  const percent = (100 * change).toFixed(1);
  const compared = `${line}, recorded ${before[name]}`;
  if (Math.abs(change) <= tolerance) {
    console.log(`as before: ${compared}`);
    continue;
  }
  const less = change < 0;
  console.log(
    `${less ? "SHRANK" : "GREW"}: ${compared}, ${percent} %; to accept it: ${recordCommand}`,
  );
  if (!less) failed += 1;
}
process.exit(failed === 0 ? 0 : 1);

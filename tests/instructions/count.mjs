// Compares the instruction counts of the parts in parts.cpp with the recorded ones: count.mjs
// [record]. More than 10 % above the record fails; more than 10 % below is reported. Counts vary
// from run to run only by a few dozen instructions of the allocator. Exit code 77, with which CTest
// marks a test as skipped, if no comparison is possible.
import {spawnSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

const most = 0.1;
const recorded = new URL("recorded.json", import.meta.url);
const anew = "scripts/instructions record";
const program =
  process.env.INSTRUCTION_PARTS ??
  new URL("../../build/release/tests/instruction_parts", import.meta.url).pathname;

// The C library selects memcpy by the processor; this setting selects the one of every x86-64.
// Otherwise the copies alone can be 7 % of a trajectory.
const everywhere = {
  ...process.env,
  GLIBC_TUNABLES: "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-BMI2,-ERMS,-SSSE3",
};

const run = (command, args) => {
  const {status, stdout, stderr, error} = spawnSync(command, args, {
    encoding: "utf8",
    env: everywhere,
  });
  if (error || status !== 0) throw new Error(`${command}: ${error?.message ?? stderr}`);
  return stdout;
};

const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};

/** The compiler of the program, and its parts. */
const described = () => {
  const [compiler, ...lines] = run(program, []).trim().split("\n");
  const parts = lines.map((line) => {
    const [name, unit, count] = line.split(" ");
    return {name, unit, count: Number(count)};
  });
  return {compiler, parts};
};

/** Instructions per unit of each part, by name. */
const counted = (parts) => {
  const folder = mkdtempSync(join(tmpdir(), "instructions-"));
  try {
    const dumps = parts.map(({name}) => `--dump-after=${name}`);
    const out = `--callgrind-out-file=${join(folder, "out")}`;
    run("valgrind", ["--tool=callgrind", out, "--toggle-collect=part_*", ...dumps, program]);
    const totals = {};
    // Two dumps of each part, in order of their numbers: the second finds its tables filled.
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
const {compiler, parts} = described();
const all = JSON.parse(readFileSync(recorded, "utf8"));

if (process.argv[2] === "record") {
  all[compiler] = counted(parts);
  writeFileSync(recorded, `${JSON.stringify(all, null, 2)}\n`);
  console.log(`recorded for ${compiler}:`, all[compiler]);
  process.exit(0);
}

const before = all[compiler] ?? skip(`nothing is recorded for ${compiler}; ${anew} does`);
const now = counted(parts);
let grown = 0;
for (const {name, unit} of parts) {
  const change = now[name] / before[name] - 1;
  const percent = (100 * change).toFixed(1);
  const line = `${name}, ${now[name]} instructions per ${unit}, recorded ${before[name]}`;
  // NaN: nothing is recorded for the part.
  if (Math.abs(change) <= most) {
    console.log(`as before: ${line}`);
    continue;
  }
  const less = change < 0;
  console.log(`${less ? "SHRANK" : "GREW"}: ${line}, ${percent} %; if it is to stay so: ${anew}`);
  if (!less) grown += 1;
}
process.exit(grown === 0 ? 0 : 1);

// Conversion of measurement files to CSV by scripts/to-csv, with Debian's Python.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, test} from "node:test";
import {fileURLToPath} from "node:url";

const python = "/usr/bin/python3";
const script = fileURLToPath(new URL("../../scripts/to-csv", import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "vines-to-csv-"));
after(() => rmSync(folder, {recursive: true}));
const at = (name) => join(folder, name);

function converted(...args) {
  const {status, stdout, stderr} = spawnSync(python, [script, ...args], {encoding: "utf8"});
  return {status, lines: stdout.trimEnd().split("\n"), message: stderr.trimEnd()};
}

/** WAV file with two 16-bit channels. */
function wav(rate, frames) {
  const header = Buffer.alloc(44);
  header.write("RIFF", 0);
  header.writeUInt32LE(36 + 4 * frames.length, 4);
  header.write("WAVEfmt ", 8);
  header.writeUInt32LE(16, 16);
  header.writeUInt16LE(1, 20);
  header.writeUInt16LE(2, 22);
  header.writeUInt32LE(rate, 24);
  header.writeUInt32LE(4 * rate, 28);
  header.writeUInt16LE(4, 32);
  header.writeUInt16LE(16, 34);
  header.write("data", 36);
  header.writeUInt32LE(4 * frames.length, 40);
  const data = Buffer.alloc(4 * frames.length);
  for (const [k, value] of frames.flat().entries()) data.writeInt16LE(value, 2 * k);
  return Buffer.concat([header, data]);
}

test("a WAV file's channels become columns with names and factors, with the file's sampling times", () => {
  writeFileSync(
    at("r.wav"),
    wav(2000, [
      [100, -5],
      [200, 7],
      [300, 9],
    ]),
  );
  assert.deepEqual(converted(at("r.wav")).lines, [
    "1: channel 1, 3 samples, 2000 Hz",
    "2: channel 2, 3 samples, 2000 Hz",
  ]);
  assert.deepEqual(converted(at("r.wav"), "displacement_mm=1*0.01", "acceleration_g=2").lines, [
    "time_s,displacement_mm,acceleration_g",
    "0,1,-5",
    "0.0005,2,7",
    "0.001,3,9",
  ]);
  const missing = converted(at("r.wav"), "acceleration_g=3");
  assert.equal(missing.status, 1);
  assert.match(missing.message, /^to-csv: acceleration_g=3: no channel 3; there are channel 1, /);
});

test("a MAT file's vectors and its matrices' columns are channels; the time must be named", () => {
  const made = spawnSync(
    python,
    [
      "-c",
      "import sys, scipy.io; scipy.io.savemat(sys.argv[1], " +
        "{'t': [0, .5, 1], 'x': [[1, 4], [2, 5], [3, 6]], 'fs': 2.0, 'by': 'me'})",
      at("r.mat"),
    ],
    {encoding: "utf8"},
  );
  assert.equal(made.status, 0, made.stderr);
  assert.deepEqual(converted(at("r.mat"), "time_s=t", "displacement_m=x:2").lines, [
    "time_s,displacement_m",
    "0,4",
    "0.5,5",
    "1,6",
  ]);
  assert.match(
    converted(at("r.mat"), "displacement_m=x:1").message,
    /does not tell time: give --rate/,
  );
  assert.deepEqual(converted(at("r.mat"), "displacement_m=x:1", "--rate", "4").lines[3], "0.5,3");
});

test("the fields of a MAT file's structs are channels", () => {
  const made = spawnSync(
    python,
    [
      "-c",
      "import sys, scipy.io; scipy.io.savemat(sys.argv[1], " +
        "{'run': {'time': [0, .5, 1], 'laser': {'mm': [1, 2, 3]}}})",
      at("s.mat"),
    ],
    {encoding: "utf8"},
  );
  assert.equal(made.status, 0, made.stderr);
  assert.deepEqual(
    converted(at("s.mat"), "time_s=run.time", "displacement_mm=run.laser.mm").lines,
    ["time_s,displacement_mm", "0,1", "0.5,2", "1,3"],
  );
});

test("options can stand between the columns", () => {
  writeFileSync(at("o.wav"), wav(2000, [[100, -5]]));
  assert.deepEqual(
    converted(at("o.wav"), "displacement_mm=1", "--rate", "10", "acceleration_g=2").lines,
    ["time_s,displacement_mm,acceleration_g", "0,100,-5"],
  );
});

test("a LabVIEW .lvm file is read without its comments, with its decimal sign and step", () => {
  writeFileSync(
    at("r.lvm"),
    [
      "LabVIEW Measurement",
      "Separator\tTab",
      "Decimal_Separator\t,",
      "***End_of_Header***",
      "",
      "Channels\t2\t\t",
      "Y_Unit_Label\tmm\tg\t",
      "Delta_X\t0,000500\t0,000500\t",
      "***End_of_Header***\t\t\t",
      "X_Value\tLaser\tPiezo\tComment",
      "\t1,5\t-2,5\tstart",
      "\t1,6\t-2,6",
      "",
    ].join("\r\n"),
  );
  assert.deepEqual(converted(at("r.lvm")).lines, [
    "1: Laser [mm], 2 samples, 2000 Hz",
    "2: Piezo [g], 2 samples, 2000 Hz",
  ]);
  assert.deepEqual(converted(at("r.lvm"), "displacement_mm=Laser", "acceleration_g=Piezo").lines, [
    "time_s,displacement_mm,acceleration_g",
    "0,1.5,-2.5",
    "0.0005,1.6,-2.6",
  ]);
});

test("a missing file, or one of another kind, is refused in one sentence", () => {
  writeFileSync(at("broken.wav"), "no sound");
  writeFileSync(at("r.xls"), "");
  for (const [file, message] of [
    ["broken.wav", /^to-csv: broken\.wav cannot be read: /],
    ["r.xls", /^to-csv: r\.xls: known are \.wav, \.mat, \.tdms, \.lvm, \.uff/],
    ["none.mat", /^to-csv: there is no file /],
  ]) {
    const {status, message: actual} = converted(at(file));
    assert.equal(status, 1);
    assert.match(actual, message);
  }
});

// Compares the output of the programs that make the reference files with the stored files. The
// environment variables MAKE_REFERENCE and MAKE_LAWS are their paths.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readFileSync} from "node:fs";
import test from "node:test";

const lines = (text) => text.trimEnd().split("\n");
const stored = (name) => lines(readFileSync(new URL(`${name}.txt`, import.meta.url), "utf8"));
const made = (name, tauEnd) =>
  lines(execFileSync(process.env.MAKE_REFERENCE, [name, tauEnd], {encoding: "utf8"}));

// The last four lines of the output: window, exponents by qr, sum rule, exponents by eigenvalues.

test("a short run with the closed form's damping gives the first lines, with a stick", () => {
  const run = made("closed_b0.015", "100").slice(0, -4);
  assert.ok(run.some((line) => line.startsWith("# stick")));
  assert.deepEqual(run, stored("closed_b0.015").slice(0, run.length));
});

test("a short run with the equation of motion's damping gives the first lines", () => {
  const run = made("eom_b0.008", "200").slice(0, -4);
  assert.ok(run.length > 50);
  assert.deepEqual(run, stored("eom_b0.008").slice(0, run.length));
});

test("the exponents of a short run satisfy the sum rule of damping and impacts", () => {
  const [, qr, sumrule, eig] = made("closed_b0.022", "200").slice(-4);
  const [, sum, rule] = sumrule.split(" ");
  assert.equal(sum, rule); // as text
  for (const line of [qr, eig]) {
    const exponents = line.split(" ").slice(1).map(Number);
    assert.equal(exponents.length, 4);
    assert.ok(Math.abs(exponents.reduce((a, b) => a + b) - rule) < 1e-13);
  }
});

test("motions under gravity, friction, R of the speed and a load are the stored ones", () => {
  for (const law of ["gravity", "friction", "restitution", "load", "all"])
    assert.deepEqual(
      lines(execFileSync(process.env.MAKE_LAWS, [law], {encoding: "utf8"})),
      stored(`law_${law}`),
    );
});

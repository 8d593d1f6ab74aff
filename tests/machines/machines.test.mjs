// Responses do not depend on the processor. The C library selects variants of its functions by the
// instruction sets of the processor; without fused operations it computes as on an older processor.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {readFileSync} from "node:fs";
import {test} from "node:test";
import {identifications, requests} from "../golden/requests.mjs";
import {serviceFor} from "../http/raw.mjs";
import {answerOf, ask} from "./answers.mjs";

const older = {GLIBC_TUNABLES: "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-FMA4"};

/** The reason to skip the comparison on this computer, or false. */
const nothingToCompare = () => {
  if (!process.report.getReport().header.glibcVersionRuntime)
    return "the C library is not glibc: its variants cannot be selected";
  if (!/ fma /.test(readFileSync("/proc/cpuinfo", "utf8")))
    return "the processor has no fused operations to disable";
  return false;
};

test("a response is the same, byte for byte, on a processor without fused operations", {
  skip: nothingToCompare(),
}, async (t) => {
  const services = [await serviceFor(t), await serviceFor(t, [], older)];
  const simulate = async (body) =>
    (await ask(services[0].url, {path: "/v1/simulate", body})).json();
  const routed = requests.filter(({path}) => path.startsWith("/v1/"));
  for (const request of [...routed, ...(await identifications(simulate))]) {
    const [here, there] = await Promise.all(services.map(({url}) => answerOf(url, request)));
    assert.ok(here === there, `${request.name} differs`);
  }
});

test("core and api call no function of the C library whose variants round differently", () => {
  const inexact =
    /^c?(sin|cos|sincos|tan|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|erf|erfc|[lt]gamma|a?(sin|cos|tan)h?|atan2|abs|arg)[fl]?$/;
  for (const library of process.env.LIBRARIES.split(" ")) {
    const {status, stdout} = spawnSync("nm", ["-u", library], {encoding: "utf8"});
    assert.equal(status, 0, library);
    const called = [...stdout.matchAll(/^ *U (\w+)$/gm)].map(([, name]) => name);
    assert.ok(called.length > 0, library);
    assert.deepEqual([...new Set(called.filter((name) => inexact.test(name)))], [], library);
  }
});

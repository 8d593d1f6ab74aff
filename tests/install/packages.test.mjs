// Files installed by CMake and by the Debian packages, from the build of the program under test.
// Needs CMake, CPack and dpkg; lintian is optional.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync, statSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {after, before, test} from "node:test";
import {program} from "../service.mjs";

const build = dirname(program);
const folder = mkdtempSync(join(tmpdir(), "vines-packages-"));
after(() => rmSync(folder, {recursive: true}));

/** Runs a program that must succeed. Returns its output. */
function run(file, ...args) {
  const {status, stdout, stderr} = spawnSync(file, args, {cwd: folder, encoding: "utf8"});
  assert.equal(status, 0, `${file} ${args.join(" ")}\n${stdout}${stderr}`);
  return stdout;
}

const version = run(program, "--version").trim().split(" ").at(-1);
const architecture = run("dpkg", "--print-architecture").trim();

/** Paths of all files below a folder. */
const filesOf = (path) =>
  readdirSync(path, {recursive: true}).filter((name) => statSync(join(path, name)).isFile());

test("cmake --install puts each file where it is expected; manual and unit fit the program", () => {
  const prefix = join(folder, "prefix");
  run("cmake", "--install", build, "--prefix", prefix, "--component", "program");
  assert.deepEqual(filesOf(prefix).sort(), [
    "bin/vines",
    "lib/systemd/system/vines.service",
    "share/bash-completion/completions/vines",
    "share/fish/vendor_completions.d/vines.fish",
    "share/man/man1/vines.1",
    "share/zsh/site-functions/_vines",
  ]);
  const read = (name) => readFileSync(join(prefix, name), "utf8");
  const installed = join(prefix, "bin/vines");
  assert.equal(run(installed, "manual"), read("share/man/man1/vines.1"));
  assert.match(
    read("lib/systemd/system/vines.service"),
    new RegExp(`^ExecStart=${installed} serve$`, "m"),
  );
});

/** Each package's file, control fields and paths. */
const packages = {};
before(() => {
  run(
    "cpack",
    "-G",
    "DEB",
    "--config",
    join(build, "CPackConfig.cmake"),
    "-B",
    join(folder, "made"),
    "-D",
    `CPACK_OUTPUT_FILE_PREFIX=${folder}`,
  );
  for (const name of ["vines", "libvines-core-dev"]) {
    const file = join(folder, `${name}_${version}_${architecture}.deb`);
    const lines = run("dpkg-deb", "-f", file)
      .trim()
      .split(/\n(?! )/);
    const fields = Object.fromEntries(lines.map((line) => /^(.*?): *(.*)/s.exec(line).slice(1)));
    const paths = run("dpkg-deb", "-c", file).match(/(?<= \.)\/.*[^/\n]$/gm);
    packages[name] = {file, fields, paths};
  }
});

test("the program's package is complete and depends on the libraries that it loads", () => {
  const {fields, paths} = packages.vines;
  assert.deepEqual(paths.sort(), [
    "/etc/default/vines",
    "/usr/bin/vines",
    "/usr/lib/systemd/system/vines.service",
    "/usr/share/bash-completion/completions/vines",
    "/usr/share/doc/vines/changelog.gz",
    "/usr/share/doc/vines/copyright",
    "/usr/share/fish/vendor_completions.d/vines.fish",
    "/usr/share/man/man1/vines.1.gz",
    "/usr/share/zsh/vendor-completions/_vines",
  ]);
  for (const library of ["libc6 (", "libcpp-httplib", "libssl3", "zlib1g"])
    assert.ok(fields.Depends.includes(library), fields.Depends);
  assert.doesNotMatch(fields.Depends, /-dev/);
});

test("the core's package has headers, library, and the files for CMake and pkg-config", () => {
  const {fields, paths} = packages["libvines-core-dev"];
  assert.match(fields.Depends, /libeigen3-dev/);
  for (const end of [
    "/libvines_core.a",
    "/cmake/vines/vinesConfig.cmake",
    "/pkgconfig/vines-core.pc",
    "/usr/include/vines/core/analysis/analysis.hpp",
  ])
    assert.ok(
      paths.some((path) => path.endsWith(end)),
      end,
    );
  assert.ok(!paths.some((path) => path.includes(folder))); // no path of the build
});

test("all files of the package are owned by root, and its unit starts its program", () => {
  const {file} = packages.vines;
  const list = run("dpkg-deb", "-c", file);
  for (const line of list.trim().split("\n")) assert.match(line, /^\S+ root\/root /);
  run("dpkg-deb", "-x", file, join(folder, "root"));
  const unit = readFileSync(join(folder, "root/usr/lib/systemd/system/vines.service"), "utf8");
  assert.match(unit, /^ExecStart=\/usr\/bin\/vines serve$/m);
  assert.match(
    run(join(folder, "root/usr/bin/vines"), "--version"),
    new RegExp(`${version}$`, "m"),
  );
});

const lintian = spawnSync("lintian", ["--version"]).error ? {skip: "lintian is not installed"} : {};

test("lintian reports nothing about the packages", lintian, () => {
  // Suppressed: the tag expects Debian's library folder, which only a build for the prefix /usr,
  // such as the preset `package`, uses.
  const suppressed = "pkg-config-unavailable-for-cross-compilation";
  const files = Object.values(packages).map(({file}) => file);
  const flags = ["--allow-root", "--fail-on", "none", "--suppress-tags", suppressed];
  assert.equal(run("lintian", ...flags, ...files), "");
});

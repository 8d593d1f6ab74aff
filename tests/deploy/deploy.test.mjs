// The files in deploy/ are valid for Kubernetes, HAProxy, Prometheus, Compose, systemd and the program.
import assert from "node:assert/strict";
import {execFile, spawnSync} from "node:child_process";
import {access, mkdtemp, readdir, readFile, rm, writeFile} from "node:fs/promises";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {delimiter, join} from "node:path";
import {before, test} from "node:test";
import {fileURLToPath} from "node:url";
import {program, startService} from "../service.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const require = createRequire(join(root, "web/package.json"));
const {parse, parseAllDocuments} = require("yaml");

/** Runs a program to its end. Resolves to its exit code and output. */
const run = (file, args, env = {}) =>
  new Promise((resolve) => {
    execFile(file, args, {cwd: root, env: {...process.env, ...env}}, (error, stdout, stderr) =>
      resolve({code: error ? error.code : 0, text: stdout + stderr}),
    );
  });

const texts = {};
let compose;
before(async () => {
  for (const name of await readdir(join(root, "deploy")))
    texts[name] = await readFile(join(root, "deploy", name), "utf8");
  texts["vines.default"] = await readFile(join(root, "packaging/debian/vines.default"), "utf8");
  texts.Dockerfile = await readFile(join(root, "Dockerfile"), "utf8");
  compose = parse(texts["compose.yaml"], {merge: true});
});

// Kubernetes.

const kubernetes = () =>
  Object.entries(texts)
    .filter(([name]) => name.startsWith("kubernetes-"))
    .flatMap(([, text]) => parseAllDocuments(text).map((document) => document.toJS()));

/**
 * Returns [proxy, unread]: a copy of the value that records which keys are read, and a function
 * that lists the paths not read so far.
 */
function observed(value, path = "") {
  if (value === null || typeof value !== "object") return [value, () => []];
  const seen = new Set();
  const parts = Object.entries(value).map(([key, part]) => [key, observed(part, `${path}/${key}`)]);
  const copy = Array.isArray(value) ? [] : {};
  for (const [key, [part]] of parts) copy[key] = part;
  const get = (target, key) => {
    seen.add(key);
    return target[key];
  };
  const unseen = () =>
    parts.flatMap(([key, [, below]]) => (seen.has(key) ? below() : [`${path}/${key}`]));
  return [new Proxy(copy, {get}), unseen];
}

/**
 * Throws if a resource violates the published schema of its kind. The schemas allow unknown keys,
 * which a cluster would drop; such keys are recognised because validation never reads them.
 */
function validate(resource) {
  const {[resource.kind]: Kind} = require(`kubernetes-models/${resource.apiVersion}`);
  const [value, unseen] = observed(resource);
  Kind.prototype.validate.call(value);
  assert.deepEqual(unseen(), [], `unknown keys of a ${resource.kind}`);
}

test("every Kubernetes resource follows the published schema of its kind", () => {
  const resources = kubernetes();
  assert.ok(resources.length >= 8);
  for (const resource of resources) validate(resource);
});

test("a resource with an invalid value, an unknown key or a missing one is rejected", () => {
  const faults = {
    type: (spec) => {
      spec.template.spec.terminationGracePeriodSeconds = "40";
    },
    choice: (spec) => {
      spec.template.spec.containers[0].imagePullPolicy = "Maybe";
    },
    quantity: (spec) => {
      spec.template.spec.containers[0].resources.limits.memory = "1 GB";
    },
    unknown: (spec) => {
      spec.template.spec.containers[0].readynessProbe = {};
    },
    missing: (spec) => {
      delete spec.selector;
    },
  };
  const [deployment] = kubernetes().filter(({kind}) => kind === "Deployment");
  for (const [name, spoil] of Object.entries(faults)) {
    const copy = structuredClone(deployment);
    spoil(copy.spec);
    assert.throws(() => validate(copy), name);
  }
});

// The program.

/** Flags and environment variables in the help of each subcommand. */
async function known() {
  const names = new Map();
  for (const subcommand of ["serve", "healthcheck", "sweep", "merge"]) {
    const {text} = await run(program, [subcommand, "--help"]);
    names.set(subcommand, new Set(text.match(/--[a-z][a-z-]*|VINES_[A-Z_]+/g)));
  }
  return names;
}

/**
 * Command lines of the program in a file, as [match, subcommand, arguments]: shell commands, lists
 * of arguments, and the `args` of a Kubernetes container.
 */
function commands(text) {
  const shell = text.replace(/\\\n/g, " ");
  const written = shell.matchAll(
    /(?:"\$VINES"|\/vines|\bvines)"?,? "?(serve|healthcheck|sweep|merge)\b([^\n|]*)/g,
  );
  const listed = text.matchAll(/args: \["(serve|healthcheck|sweep|merge)"([^\]]*)\]/g);
  return [...written, ...listed];
}

/** Lines that call another program; their flags are not checked, except in commands(). */
const otherPrograms = /sbatch|parallel|kubectl|docker|cmake|systemctl/i;

test("keys come from a Secret at the path of the variable, and only the Ingress's port is open", () => {
  const of = (wanted) => kubernetes().filter(({kind}) => kind === wanted)[0];
  const {containers, volumes} = of("Deployment").spec.template.spec;
  const [{env, ports, volumeMounts}] = containers;
  const file = env.find(({name}) => name === "VINES_API_KEY_FILE").value;
  assert.equal(file, join(volumeMounts[0].mountPath, "keys"));
  assert.equal(
    volumes.find(({name}) => name === volumeMounts[0].name).secret.secretName,
    "vines-keys",
  );
  const {podSelector, ingress, egress} = of("NetworkPolicy").spec;
  assert.deepEqual(podSelector, of("Deployment").spec.selector);
  assert.deepEqual(
    ingress.flatMap((rule) => rule.ports.map(({port}) => port)),
    [ports[0].name],
  );
  assert.equal(egress, undefined);
  const [{host, http}] = of("Ingress").spec.rules;
  assert.equal(host, env.find(({name}) => name === "VINES_ALLOW_HOST").value);
  assert.equal(http.paths[0].backend.service.port.name, of("Service").spec.ports[0].name);
});

test("every flag and variable in a file belongs to the program or is defined in the file", async () => {
  const names = await known();
  const all = new Set([...names.values()].flatMap((set) => [...set]));
  for (const name of texts["haproxy.cfg"].match(/(?<=presetenv )\w+/g)) all.add(name);
  for (const name of texts.Dockerfile.match(/(?<=ARG )\w+/g)) all.add(name);
  let flags = 0;
  for (const [file, text] of Object.entries(texts)) {
    for (const variable of text.match(/\bVINES_\w+/g) ?? [])
      assert.ok(all.has(variable), `${variable} of ${file}`);
    if (file !== "Dockerfile")
      for (const line of text.split("\n").filter((text) => !otherPrograms.test(text)))
        for (const flag of line.match(/--[a-z][a-z-]*/g) ?? [])
          assert.ok(all.has(flag), `${flag} of ${file}`);
    for (const [, subcommand, rest] of commands(text))
      for (const flag of rest.match(/--[a-z][a-z-]*/g) ?? []) {
        assert.ok(names.get(subcommand).has(flag), `${flag} of ${subcommand} in ${file}`);
        ++flags;
      }
  }
  assert.ok(flags >= 10, `only ${flags} flags were found`);
});

test("every stop timeout exceeds the drain time and the time of the shutdown", async () => {
  // The service ends finish_time + final_time after the drain, its process 0.3 s later. The unit
  // states its longest drain in a comment.
  const source = await readFile(join(root, "src/http/serve.cpp"), "utf8");
  const times = [...source.matchAll(/_time = std::chrono::seconds\((\d+)\)/g)];
  assert.equal(times.length, 2);
  const end = times.reduce((sum, [, seconds]) => sum + Number(seconds), 0.3);
  const checkGrace = (what, grace, drain) =>
    assert.ok(grace > drain + end, `${what}: ${grace} s for ${drain} + ${end} s`);
  for (const [name, service] of Object.entries(compose.services))
    if (service.image === "vines") {
      const {stop_grace_period, environment} = service;
      checkGrace(name, Number.parseInt(stop_grace_period, 10), Number(environment.VINES_DRAIN));
    }
  const {spec} = kubernetes().find(({kind}) => kind === "Deployment").spec.template;
  const drain = spec.containers[0].env.find(({name}) => name === "VINES_DRAIN").value;
  checkGrace("Deployment", spec.terminationGracePeriodSeconds, Number(drain));
  const unit = texts["vines.service"];
  checkGrace(
    "unit",
    Number(unit.match(/TimeoutStopSec=(\d+)/)[1]),
    Number(unit.match(/up to (\d+) s/)[1]),
  );
});

// Compose.

test("each container of the compose file is locked down and has limits", async () => {
  for (const [name, service] of Object.entries(compose.services)) {
    assert.equal(service.read_only, true, name);
    assert.deepEqual(service.cap_drop, ["ALL"], name);
    assert.deepEqual(service.security_opt, ["no-new-privileges:true"], name);
    assert.equal(service.restart, "unless-stopped", name);
    for (const bound of ["cpus", "mem_limit", "pids_limit", "stop_grace_period"])
      assert.ok(service[bound], `${bound} of ${name}`);
    assert.ok(service.build || service.healthcheck, `${name}: no health check`);
    for (const volume of service.volumes ?? [])
      if (volume.startsWith("./")) await access(join(root, "deploy", volume.split(":")[0]));
  }
  assert.match(texts.Dockerfile, /^HEALTHCHECK /m);
});

test("only the proxy is published to other hosts; Prometheus is on loopback only", () => {
  const published = Object.entries(compose.services).filter(([, service]) => service.ports);
  assert.deepEqual(Object.fromEntries(published.map(([name, {ports}]) => [name, ports])), {
    proxy: ["8080:8080"],
    prometheus: ["127.0.0.1:9090:9090"],
  });
});

test("the proxy and Prometheus know every replica, which has as many threads as CPUs", () => {
  const replicas = Object.entries(compose.services).filter(([, {image}]) => image === "vines");
  const addresses = replicas.map(([name]) => `${name}:8080`);
  assert.deepEqual(Object.values(compose.services.proxy.environment), addresses);
  const [job] = parse(texts["prometheus.yml"]).scrape_configs;
  assert.deepEqual(job.static_configs, [{targets: addresses}]);
  for (const [name, {environment, cpus}] of replicas)
    assert.equal(Number(environment.VINES_COMPUTE_THREADS), cpus, name);
});

// HAProxy, Prometheus, systemd.

test("HAProxy accepts its file, with addresses and with names that cannot be resolved yet", async () => {
  for (const env of [{}, compose.services.proxy.environment]) {
    const {code, text} = await run("haproxy", ["-c", "-f", "deploy/haproxy.cfg"], env);
    assert.equal(code, 0, text);
  }
});

const alerts = () => parse(texts["alerts.yml"]).groups.flatMap(({rules}) => rules);

/** promtool of the PATH, or the one fetched by scripts/setup. */
const promtool = (args) =>
  run("promtool", args, {
    PATH: [process.env.PATH, join(root, "build/tools")].join(delimiter),
  });

test("Prometheus accepts its files, and each alert is raised by its cause", async () => {
  for (const args of [
    ["check", "config", "deploy/prometheus.yml"],
    ["check", "rules", "deploy/alerts.yml"],
    ["test", "rules", "tests/deploy/alerts.test.yml"],
  ]) {
    const {code, text} = await promtool(args);
    assert.equal(code, 0, `${args.join(" ")}: ${text}`);
  }
  const tests = await readFile(join(root, "tests/deploy/alerts.test.yml"), "utf8");
  for (const {alert} of alerts()) assert.ok(tests.includes(`        alertname: ${alert}\n`), alert);
});

const dashboard = () => JSON.parse(texts["grafana.json"]).panels.flatMap(({targets}) => targets);

test("Prometheus accepts each query of the dashboard", async (t) => {
  const folder = await mkdtemp(join(tmpdir(), "vines-rules-"));
  t.after(() => rm(folder, {recursive: true}));
  const rules = dashboard().map(({expr}, i) => ({record: `query_${i}`, expr}));
  const file = join(folder, "queries.yml");
  await writeFile(file, JSON.stringify({groups: [{name: "dashboard", rules}]}));
  const {code, text} = await promtool(["check", "rules", file]);
  assert.equal(code, 0, text);
  assert.match(text, new RegExp(`${rules.length} rules found`));
});

test("every metric in an alert or in the dashboard is exported by the service", async (t) => {
  const service = await startService();
  t.after(() => service.stop());
  await (await fetch(`${service.url}/v1/simulate?tau_end=20`)).text();
  const text = await (await fetch(`${service.url}/metrics`)).text();
  const served = new Set([...text.matchAll(/^\w+/gm)].map(([name]) => name));
  const names = [...alerts(), ...dashboard()].flatMap(
    ({expr}) => expr.match(/\b(?:vines|process)_\w+/g) ?? [],
  );
  assert.ok(names.length >= 20);
  for (const name of names) assert.ok(served.has(name), name);
});

const exposureLimit = 1.5;
const analyze = spawnSync("systemd-analyze", ["--version"]).error
  ? {skip: "systemd-analyze is missing (Debian's package systemd)"}
  : {};

test(
  `systemd accepts the unit and rates its exposure below ${exposureLimit} of 10`,
  analyze,
  async (t) => {
    const folder = await mkdtemp(join(tmpdir(), "vines-unit-"));
    t.after(() => rm(folder, {recursive: true}));
    const unit = join(folder, "vines.service");
    // systemd-analyze checks that the program exists.
    await writeFile(unit, texts["vines.service"].replace("/usr/bin/vines", program));
    assert.deepEqual(await run("systemd-analyze", ["verify", "--man=no", unit]), {
      code: 0,
      text: "",
    });
    const {text} = await run("systemd-analyze", ["security", "--offline=true", unit]);
    const level = Number(text.match(/Overall exposure level .*: ([\d.]+)/)[1]);
    assert.ok(level < exposureLimit, text);
  },
);

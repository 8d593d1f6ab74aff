// The simulation tab in Chromium.
import assert from "node:assert/strict";
import {execFile} from "node:child_process";
import {mkdtemp, rm, writeFile} from "node:fs/promises";
import {createServer} from "node:http";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";
import {promisify} from "node:util";
import {until} from "../http/raw.mjs";
import {startService} from "../service.mjs";
import {drawn, frames, painted, resize, swept} from "./browser.mjs";
import {
  asked,
  automatic,
  beyond,
  browser,
  cells,
  cellsByName,
  colours,
  downloaded,
  fits,
  hash,
  input,
  narrow,
  newPage,
  origin,
  pixels,
  platformQuery,
  service,
  unfold,
  unfoldForm,
  visit,
} from "./support.mjs";
import {sum, weigh} from "./weight.mjs";

const overTime = ["x", "relative", "largest", "lambda"];
const planes = ["section", "manifold"];
const instrument = [
  ...overTime.map((name) => `#plot-${name} canvas`),
  ...planes.map((n) => `#plot-${n}`),
];
const wide = {viewport: {width: 1440, height: 900}};

/** A page for a visitor who prefers reduced motion: the player does not start. */
const still = (query = "", options = wide) => visit(query, {...options, reducedMotion: "reduce"});

const shown = (page) => page.$eval("#results", (node) => Number(node.dataset.shown));
/** Performs an action and waits until its run is drawn completely. */
async function after(page, act) {
  const before = await page.$eval("#results", (node) => Number(node.dataset.done));
  await act();
  await drawn(page, before + 1);
}

const sentence = (page) => page.textContent("#sentence");
const number = (name) => `#slider-${name}`;
const range = (name) => `.slider:has(#slider-${name}) input[type=range]`;

/** Moves a slider to a value in its unit. */
const turn = (page, name, value) =>
  page.$eval(
    range(name),
    (node, value) => {
      node.value = value;
      for (const type of ["input", "change"]) node.dispatchEvent(new Event(type, {bubbles: true}));
    },
    value,
  );
const type = async (page, name, text) => {
  await page.fill(number(name), text);
  await page.keyboard.press("Enter");
};

/** Advances the clock of the page's scripts. */
const advanceClock = (page, ms) =>
  page.evaluate((ms) => {
    const now = performance.now.bind(performance);
    performance.now = () => now() + ms;
  }, ms);

const marked = (page) =>
  page.$$eval("figure.about", (figures) =>
    figures.map((f) => [f.id, f.querySelector(".tag").textContent]),
  );

const view = (page) => new URL(page.url()).searchParams.get("view")?.split(",").map(Number);
const viewed = (page) => page.waitForFunction(() => location.search.includes("view="));

async function stripDrawn(page, n = 1) {
  await page.waitForFunction((n) => Number(document.getElementById("strip").dataset.done) >= n, n);
  await painted(page);
}

async function unfoldDetails(page) {
  await page.click("#details > summary");
  await page.waitForFunction(() => document.getElementById("details").dataset.done);
  await painted(page);
}

// First screen.

test("the page opens with the paper's Fig. 3 on one screen: a sentence, the machine, all plots and the regimes", async () => {
  const page = await visit("", wide);
  assert.match(
    await sentence(page),
    /^b = 22\.0 mm: strongly modulated \(II\), chaotic so far\. λ₁ = 0\.\d+ ± 0\.\d+; rms x \d\d % of that without absorber\.$/,
  );
  assert.deepEqual(await marked(page), [["figure-x", "Fig. 3"]]);
  for (const canvas of [...instrument, "#machine"])
    assert.ok((await colours(page, canvas)) > 3, canvas);
  await stripDrawn(page);
  const lowest = await page.$eval(".strip", (node) => node.getBoundingClientRect().bottom);
  assert.ok(lowest <= 900, `the strip ends at ${lowest}`);
  for (const regime of ["I", "II", "III", "IV"])
    assert.ok((await pixels(page, "#strip", `regime-${regime}`)) > 100, regime);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("texts have the system's font, in the size and line height of the style sheet", async () => {
  const page = await still();
  const font = await page.$eval("body", (body) => {
    const {fontFamily, fontSize, lineHeight} = getComputedStyle(body);
    return [fontFamily, fontSize, lineHeight];
  });
  assert.deepEqual(font, ["system-ui, sans-serif", "15px", "21.75px"]);
  await page.close();
});

test("the content security policy lets no inline script run", async () => {
  const policy = (await fetch(service.url)).headers.get("content-security-policy");
  assert.match(policy, /default-src 'none'/);
  assert.doesNotMatch(policy, /unsafe/);
});

test("the page's files are compressed, and cached until their content changes", async () => {
  const index = await fetch(service.url);
  assert.equal(index.headers.get("cache-control"), "no-cache");
  const [, path] = /src="([^"]+)"/.exec(await index.text());
  const script = await fetch(`${service.url}/${path}`);
  assert.match(script.headers.get("cache-control"), /immutable/);
  assert.equal(script.headers.get("content-encoding"), "gzip");
});

test("the first view loads at most 90 kB, compressed", async () => {
  const bytes = await weigh(service.url);
  const names = Object.keys(bytes).map((path) => path.replace(/^[0-9a-f]{12}\//, ""));
  for (const name of ["", "icon.svg", "style.css", "main.js", "system.svg"])
    assert.ok(names.includes(name), name);
  assert.ok(sum(bytes) <= 90000, JSON.stringify(bytes));
});

test("other tabs are loaded when they are opened", async () => {
  const page = await visit("?preset=fig11");
  const loaded = [];
  page.on("request", (request) => loaded.push(new URL(request.url()).pathname));
  await page.click("#tab-sweep");
  await swept(page, 1);
  assert.ok(
    loaded.some((path) => /\/sweep[^/]*\.js$/.test(path)),
    loaded.join(" "),
  );
  await page.close();
});

test("each preset stays in the address and tags the plots of its figure", async () => {
  const {presets} = await (await fetch(`${service.url}/v1/presets`)).json();
  const figures = presets.filter(({source}) => source !== "machine");
  assert.equal(figures.length, 37);
  const page = await still("?preset=table4");
  await unfoldForm(page);
  for (const {name, source} of figures) {
    await after(page, () => page.selectOption("#preset", name));
    assert.equal(new URL(page.url()).search, `?preset=${name}`);
    const tags = await marked(page);
    assert.ok(tags.length > 0, name);
    for (const [, tag] of tags) assert.equal(tag, source.split(",")[0]);
  }
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a chip loads a figure; a changed parameter keeps the preset's name and removes the tags", async () => {
  const page = await still();
  await after(page, () => page.click("text=III symmetric"));
  assert.equal(await page.inputValue(number("b")), "15.0");
  assert.match(await sentence(page), /two symmetric \(III\), stable periodic orbit/);
  assert.deepEqual(
    (await marked(page)).map(([id]) => id),
    ["figure-relative", "figure-lambda", "figure-raw_product"],
  );
  await after(page, () => turn(page, "b", 18));
  assert.match(page.url(), /\?preset=fig11&b=0\.018$/);
  assert.deepEqual(await marked(page), []);
  assert.match(await page.textContent("#preset-note"), /Fig\. 11, changed/);
  await page.close();
});

test("a term explains itself on hover and focus", async () => {
  const page = await still();
  await page.hover("label[for=slider-b]");
  assert.match(await page.textContent("#term"), /clearance b.*\|x − y\| ≤ b/);
  await page.focus("#figure-lambda [data-term]");
  assert.match(await page.textContent("#term"), /exponents λ.*chaos/);
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#term"));
  const missing = await page.$$eval(
    "[data-term]",
    (nodes) => nodes.filter(({dataset}) => !document.getElementById(`term-${dataset.term}`)).length,
  );
  assert.equal(missing, 0);
  await page.close();
});

test("each step of each guided story opens without an error, and a story can be left", async () => {
  const page = await still("?story=chaos");
  assert.match(await page.textContent("#guide"), /Chaos begins, 1 of 3/);
  await after(page, () => page.click("#guide >> text=Next"));
  assert.match(page.url(), /preset=fig11&b=0\.016/);
  await after(page, () => page.click("#guide >> text=Back"));
  await page.click("#guide >> text=Leave");
  assert.ok(await page.isHidden("#guide"));
  const steps = await page.$$eval("#story option", (options) => options.length);
  assert.equal(steps, 7);
  const queries = await page.$eval("#stories", ({content}) =>
    [...content.querySelectorAll("p")].map(({dataset}) => dataset.query),
  );
  for (const query of queries.filter((text) => !text.startsWith("tab="))) {
    const answer = await fetch(`${service.url}/v1/simulate?${query}&include=regime`);
    assert.equal(answer.status, 200, query);
  }
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

// Sliders and numbers.

test("each slider changes the run and the address immediately, and Back undoes the edit", async () => {
  const page = await still("?preset=fig9");
  const before = await sentence(page);
  const turned = {b: [16, /b = 16\.0 mm/], R: [0.7, /R = 0\.7/], G: [15, /G = 15\.0 mm/]};
  Object.assign(turned, {Omega: [0.98, /Ω = 0\.98/], zeta: [0.02, /ζ = 0\.02/]});
  for (const [name, [value, words]] of Object.entries(turned)) {
    await after(page, () => turn(page, name, value));
    assert.match(await sentence(page), words);
    assert.equal(Number(await page.inputValue(number(name))), value);
    await advanceClock(page, 1000); // edits within 800 ms share a history entry
  }
  const [query] = [new URL(page.url()).searchParams];
  assert.equal(query.get("R"), "0.7");
  assert.equal(query.get("damping"), "closed_form", "the damping stays that of the paper");
  for (let k = 0; k < 5; ++k) await page.goBack();
  await page.waitForFunction(
    (text) => document.getElementById("sentence").textContent === text,
    before,
  );
  assert.equal(new URL(page.url()).search, "?preset=fig9");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a number is typed with a decimal point or comma; an invalid one is reported and the run stays", async () => {
  const page = await still("?preset=fig11");
  await after(page, () => type(page, "b", "18,5"));
  assert.match(await sentence(page), /^b = 18\.5 mm/);
  await page.locator(number("b")).blur();
  assert.ok(!(await page.$eval("#results", (node) => node.classList.contains("stale"))));
  await type(page, "b", "1.8.5");
  assert.match(await page.textContent("#message"), /Clearance: “1\.8\.5” is not a number/);
  assert.match(await sentence(page), /^b = 18\.5 mm/);
  await type(page, "b", "-1");
  await page.waitForSelector("#message.fault:has-text('must lie')");
  assert.match(await page.textContent("#message"), /Clearance “-1”: b must lie in 1e−6 to 1e6 mm/);
  assert.equal(await page.getAttribute(number("b"), "aria-invalid"), "true");
  assert.equal(await page.isVisible("#fields"), false, "the number itself is marked");
  assert.ok(await page.$eval("#results", (node) => node.classList.contains("stale")));
  await after(page, () => type(page, "b", "18"));
  assert.equal(await page.textContent("#message"), "");
  assert.ok(!(await page.$eval("#results", (node) => node.classList.contains("stale"))));
  browser.complaints.length = 0; // Chromium logs each 422
  await page.close();
});

test("a fault has the colour of faults; a file dragged over the tab does not move what is below", async () => {
  const page = await still("?preset=fig11");
  await unfoldForm(page);
  await type(page, "b", "x");
  const colourOf = (selector) => page.$eval(selector, (node) => getComputedStyle(node).color);
  await page.$eval("#error-b", (node) => node.append("error"));
  assert.equal(await colourOf("#message.fault"), await colourOf("#error-b"));
  const [before, dragged] = await page.$eval("#more", (node) => {
    const bottom = () => node.getBoundingClientRect().bottom;
    const before = bottom();
    node.dispatchEvent(new DragEvent("dragover", {bubbles: true}));
    return [before, bottom()];
  });
  assert.ok(await page.$(".about input[type=file]"), "the zone is marked");
  assert.equal(dragged, before);
  await page.close();
});

test("new input aborts a long run", async () => {
  const page = await still("?preset=fig11");
  await unfold(page);
  await page.fill(input("tau_end"), "");
  const runs = asked(page, "/v1/simulate");
  const long = page.waitForRequest((request) => {
    const {cycles, max_impacts: most} = request.postDataJSON() ?? {};
    return cycles === 400000 && most === 2000000;
  });
  await page.fill(input("cycles"), "400000");
  await page.fill(input("max_impacts"), "2000000");
  await page.keyboard.press("Enter");
  await long;
  await page.waitForSelector("#results.stale");
  assert.match(await page.textContent("#message"), /computing/);
  await page.fill(input("cycles"), "100");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !document.querySelector("#results.stale"));
  assert.equal(runs.at(-1).cycles, 100);
  assert.match(await page.textContent("#moment"), /τ = /);
  assert.ok((await page.getAttribute("#plot-x", "aria-valuemax")) < 700);
  browser.complaints.length = 0; // the aborted request
  await page.close();
});

test("a run that is sent again gets its deferred results", async () => {
  const page = await still("?preset=fig11");
  await page.clock.install();
  let answer;
  await page.route("**/v1/simulate", async (route) => {
    const isDeferred = route.request().postDataJSON().include.includes("manifold");
    if (!isDeferred) return route.continue();
    await new Promise((resolve) => {
      answer = resolve;
    });
    return route.continue();
  });
  const run = async (n) => {
    await page.$eval("#form", (form) => form.requestSubmit());
    await page.waitForFunction((n) => document.getElementById("results").dataset.shown === n, n);
    await page.clock.fastForward(1000); // the deferred results are requested after 100 ms
  };
  const deferred = page.waitForRequest((request) => request.postData()?.includes("manifold"));
  await run("2");
  await deferred;
  await run("3");
  answer();
  await drawn(page, 2);
  await page.close();
});

test("an unreachable server is reported, and the request is repeated until it answers", async () => {
  const own = await startService();
  const page = await newPage();
  await page.goto(`${own.url}/?preset=fig11`);
  await drawn(page, 1);
  const {port} = new URL(own.url);
  await own.stop();
  await turn(page, "b", 20);
  await page.waitForFunction(() =>
    /does not answer/.test(document.getElementById("message").textContent),
  );
  const again = await startService(["--port", port], {}, false);
  await page.waitForFunction(() =>
    /b = 20\.0/.test(document.getElementById("sentence").textContent),
  );
  assert.equal(await page.textContent("#message"), "");
  await page.close();
  await again.stop();
  browser.complaints.length = 0; // refused connections
});

test("an address with faults shows Fig. 3 and names every fault", async () => {
  const page = await still("?preset=nope&b=abc&colour=red&R=2");
  assert.match(await sentence(page), /^b = 22\.0 mm: strongly modulated/);
  const note = await page.textContent("#message");
  for (const fault of [/preset=nope/, /colour/, /\bb must|"abc"/, /\bR\b/])
    assert.match(note, fault);
  assert.equal(new URL(page.url()).search, "?preset=fig3");
  const other = await still("?tab=xyz");
  assert.match(await other.textContent("#message"), /"tab"/);
  browser.complaints.length = 0; // Chromium logs the 422
  for (const each of [page, other]) await each.close();
});

test("the machine is drawn with and without the absorber, and the reduction stands in large figures", async () => {
  const page = await still("?preset=fig11");
  for (const canvas of ["#machine", "#machine-without"])
    assert.ok((await colours(page, canvas)) > 3, canvas);
  assert.equal(await page.textContent("#reduction-figure"), "59 %");
  assert.equal(await page.textContent("#reduction-word"), "less vibration");
  assert.match(
    await page.textContent("#reduction-rms"),
    /^rms of x \d\.\d+ mm instead of \d\.\d+ mm$/,
  );
  await after(page, () => turn(page, "b", 1));
  assert.match(await page.textContent("#reduction-figure"), /^[\d.]+ %$/);
  await page.close();
});

test("a wall of the machine is dragged to set b, the ball to set its start", async () => {
  const page = await still("?preset=fig11");
  const box = await page.locator("#machine").boundingBox();
  const y = box.y + box.height / 2;
  const grabbed = async (from) => {
    // The cursor of the canvas shows where a part is.
    for (let x = from; x < box.x + box.width; x += 4) {
      await page.mouse.move(x, y);
      if ((await page.$eval("#machine", (node) => node.style.cursor)) === "ew-resize") return x;
    }
    return assert.fail("no part found");
  };
  const wall = await grabbed(box.x);
  await page.mouse.move(wall + 8, y);
  await page.mouse.down();
  await page.mouse.move(wall + 18, y, {steps: 3});
  await after(page, () => page.mouse.up());
  const b = Number(new URL(page.url()).searchParams.get("b"));
  assert.ok(b > 0.005 && b < 0.015, `b = ${b}`);
  await page.close();
});

test("a periodic motion shows its last six cycles, a click on a small plot enlarges it", async () => {
  const page = await still("?preset=fig11");
  const ends = [];
  for (const key of ["Home", "End"]) {
    await page.focus("#plot-x");
    await page.keyboard.press(key);
    ends.push(Number(await page.getAttribute("#plot-x", "aria-valuenow")));
  }
  assert.ok(Math.abs((ends[1] - ends[0]) / (2 * Math.PI) - 6) < 0.01, `${ends}`);
  assert.ok(await page.isVisible("#whole"));
  await enlarge(page, "manifold");
  assert.ok(!(await page.$("#figure-x.chosen")));
  await page.focus("#plot-lambda");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#figure-lambda.chosen");
  await page.close();
});

test("My machine is a valid system in SI that is edited field by field", async () => {
  const page = await still();
  await after(page, () => page.click("text=My machine"));
  assert.equal(await page.getAttribute("text=My machine", "aria-pressed"), "true");
  assert.match(await page.textContent("#moment"), /^t = /);
  await unfoldForm(page);
  await after(page, async () => {
    await page.fill(input("m1"), "2");
    await page.keyboard.press("Enter");
  });
  assert.match(page.url(), /m1=2&f0=14/);
  assert.equal(await page.textContent("#message"), "");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

const machine = `m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&F=0.0004&f=14&b=0.03`;

test("inclination and friction have sliders, the machine is drawn inclined, and the motion is drawn from samples", async () => {
  const page = await still(`?${machine}&R=0.4&inclination=0.1&mu=0.05&cycles=60`);
  assert.equal(await page.inputValue(number("inclination")), "5.73");
  assert.equal(await page.inputValue(number("mu")), "0.05");
  assert.ok(!(await page.isVisible(number("gravity"))));
  const before = await hash(page, "#machine-without");
  await after(page, () => turn(page, "inclination", 8));
  assert.match(page.url(), /inclination=0\.1396/);
  assert.match(await sentence(page), /^Inclination|^inclination = 8/i);
  assert.notEqual(await hash(page, "#machine-without"), before);
  const reduced = await still("?preset=fig11&gravity=0.0002&friction=0.0001");
  assert.equal(await reduced.inputValue(number("gravity")), "0.200");
  assert.equal(await reduced.inputValue(number("friction")), "0.100");
  assert.deepEqual(browser.complaints, []);
  for (const each of [page, reduced]) await each.close();
});

test("R as a function of the speed is typed, stays in the address and reaches the service", async () => {
  const page = await still(`?${machine}`);
  await unfold(page);
  await page.fill(input("R"), "");
  const runs = asked(page, "/v1/simulate");
  await after(page, async () => {
    await page.fill(input("restitution"), "speed_m_s=0, 1; R=0.8, 0.6");
    await page.keyboard.press("Enter");
  });
  const restitution = {speed_m_s: [0, 1], R: [0.8, 0.6]};
  assert.deepEqual(runs.at(-1).restitution, restitution);
  const again = await still(new URL(page.url()).search);
  await unfold(again);
  assert.equal(await again.inputValue(input("restitution")), "speed_m_s=0, 1; R=0.8, 0.6");
  assert.deepEqual(browser.complaints, []);
  for (const each of [page, again]) await each.close();
});

test("a load of another kind in the address reaches the service unchanged", async () => {
  const page = await newPage();
  const runs = asked(page, "/v1/simulate");
  const forcing = {kind: "harmonics", f: [14], F: [0.0004], phase: [0]};
  const text = encodeURIComponent(JSON.stringify(forcing));
  await page.goto(
    `${service.url}/?m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&forcing=${text}`,
  );
  await drawn(page, 1);
  assert.deepEqual(runs[0].forcing, forcing);
  browser.complaints.length = 0; // Chromium logs a 422 of a service without this kind
  await page.close();
});

test("a recorded load in a file replaces F and f and is drawn above the response", async () => {
  const page = await still(`?${machine}&R=0.4`);
  const rows = Array.from({length: 2000}, (_, k) => {
    const t = k / 200;
    return `${1000 * t},${Math.sin(2 * Math.PI * (12 + 0.4 * t) * t) / 9.80665}`;
  });
  const buffer = Buffer.from(`time (ms),acceleration (g)\n${rows.join("\n")}\n`);
  const runs = asked(page, "/v1/simulate");
  await after(page, () =>
    page.setInputFiles("#load-file", {name: "chirp.csv", mimeType: "text/csv", buffer}),
  );
  const {forcing, F, f} = runs[0];
  assert.deepEqual([F, f, forcing.time_s.length], [undefined, undefined, 2000]);
  assert.ok(Math.abs(forcing.acceleration_m_s2[3] - Math.sin(2 * Math.PI * 12.006 * 0.015)) < 1e-6);
  assert.match(await page.textContent("#load-note"), /^chirp\.csv, 2000 samples$/);
  assert.ok((await colours(page, "#plot-load canvas")) > 10);
  assert.ok((await pixels(page, "#plot-x canvas", "motion")) > 500);
  assert.ok(
    (await colours(page, "#machine-without")) > 3,
    "the machine without absorber, from a run",
  );
  assert.equal(await page.isVisible("#regimes"), false);
  assert.ok(!(await page.isVisible(number("f"))));
  await unfoldDetails(page);
  assert.equal(await page.isVisible("#figure-divergence"), false);
  const bad = {name: "bad.csv", mimeType: "text/csv", buffer: Buffer.from("a,b\n1,2\n3,4\n")};
  await page.setInputFiles("#load-file", bad);
  await page.waitForSelector("#message:has-text('bad.csv cannot be read: it needs a column time')");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("an error of a field is shown at the field, and correcting it draws the run", async () => {
  const page = await still("?b=0.015&tau_end=300");
  await unfold(page);
  await page.fill(input("windows"), "18; 20,abc");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#error-windows:not(:empty)");
  await after(page, async () => {
    await page.fill(input("windows"), "18,100");
    await page.keyboard.press("Enter");
  });
  assert.equal(await page.textContent("#error-windows"), "");
  browser.complaints.length = 0; // Chromium logs each 422
  await page.close();
});

test("a failed request for the version is not reported: the page is usable", async () => {
  const page = await newPage();
  let fail;
  await page.route("**/version", (route) => {
    fail = () => route.fulfill({status: 500, json: {title: "broken"}});
  });
  const asking = page.waitForRequest("**/version");
  await page.goto(`${service.url}/?preset=fig11`);
  await drawn(page, 1);
  await asking;
  await fail();
  await painted(page);
  assert.equal(await page.textContent("#message"), "");
  await page.close();
  browser.complaints.length = 0; // Chromium logs the 500
});

test("a zoom just before another tab is opened leaves the address of that tab unchanged", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.click("#tab-simulation");
  await drawn(page, 1);
  await page.clock.install();
  await page.evaluate(() => {
    document
      .getElementById("plot-x")
      .dispatchEvent(new KeyboardEvent("keydown", {key: "+", bubbles: true}));
    document.getElementById("tab-measurement").click();
  });
  await page.clock.fastForward(1000); // the address is written after 200 ms
  assert.match(page.url(), /\?tab=measurement&preset=fig15$/);
  await page.goBack();
  assert.match(page.url(), /\?preset=fig3&view=\d/);
  await page.close();
});

test("unknown names in the address are reported", async () => {
  const page = await still("?b=0.018&clearence=3&tau_end=400");
  assert.match(await page.textContent("#message"), /unknown names in the address: "clearence"/);
  assert.match(await sentence(page), /b = 18\.0 mm/);
  const other = await still("?preset=fig99");
  assert.match(await other.textContent("#message"), /"preset=fig99"/);
  await page.close();
  await other.close();
});

// Zoom and cursor.

/** Makes a plot the large one. */
const enlarge = async (page, name) => {
  await page.click(`#figure-${name} figcaption b`);
  await page.waitForSelector(`#figure-${name}.chosen`);
  await painted(page);
};

const middle = async (page, name) => {
  const box = await page.locator(`#plot-${name} .over`).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2, box];
};

test("wheel, drag and keys zoom all plots together; edits and links keep the zoom, Escape resets it", async () => {
  const page = await still("?preset=fig9");
  const [x, y, box] = await middle(page, "x");
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -200);
  await page.waitForSelector("#plot-x .hint:not([hidden])");
  assert.equal(view(page), undefined, "without Ctrl or focus the wheel scrolls the page");
  await page.focus("#plot-x");
  for (let k = 0; k < 6; ++k) {
    const address = page.url();
    await page.mouse.wheel(0, -200);
    await page.waitForFunction((address) => location.href !== address, address);
  }
  const [from, to] = view(page);
  assert.ok(to - from < 300 && from < 854 && to > 854, `${from} to ${to}`);
  const pictures = await Promise.all(overTime.map((name) => hash(page, `#plot-${name} canvas`)));
  await after(page, () => turn(page, "b", 21));
  assert.deepEqual(view(page), [from, to]);
  const link = await still(new URL(page.url()).search);
  assert.deepEqual(view(link), [from, to]);
  await link.close();
  await page.mouse.move(box.x + box.width * 0.4, y);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, y, {steps: 4});
  const before = new URL(page.url()).search;
  await page.mouse.up();
  await page.waitForFunction((search) => location.search !== search, before);
  const [left, right] = view(page);
  assert.ok(Math.abs((right - left) / (to - from) - 0.2) < 0.02, "a fifth of it");
  await page.focus("#plot-x");
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => !location.search.includes("view="));
  await page.keyboard.press("+");
  await viewed(page);
  const now = await Promise.all(overTime.map((name) => hash(page, `#plot-${name} canvas`)));
  for (const [k, picture] of now.entries()) assert.notEqual(picture, pictures[k], overTime[k]);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a window that ends before the run is visible at first; Escape shows the whole run, and the window again", async () => {
  const page = await still("?preset=fig3");
  await page.focus("#plot-x");
  const before = await hash(page, "#plot-lambda canvas");
  await page.keyboard.press("Escape");
  await viewed(page);
  assert.deepEqual(view(page), [0, 5521.3]);
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => !location.search.includes("view="));
  assert.equal(await hash(page, "#plot-lambda canvas"), before);
  await page.close();
});

test("a dense periodic motion is drawn evenly and without gaps", async () => {
  const page = await still("?preset=fig11&cycles=3000");
  await page.click("#whole");
  for (const name of ["x", "relative"]) {
    await enlarge(page, name);
    const heights = await page.$eval(`#plot-${name} canvas`, (canvas) => {
      const {width, height} = canvas;
      const copy = new OffscreenCanvas(width, height).getContext("2d", {willReadFrequently: true});
      copy.drawImage(canvas, 0, 0);
      const beside = 10; // px at the right of the plot
      const [from, to] = [width / 2, width - beside - 2];
      const inkIn = (column) => {
        const {data} = copy.getImageData(column, 0, 1, height);
        return data.filter((value, i) => i % 4 === 3 && value === 255).length; // opaque
      };
      const all = Array.from({length: Math.floor(to - from)}, (_, k) => inkIn(Math.ceil(from) + k));
      const grid = Math.max(...all); // grid lines span the full height
      return all.filter((height) => height < grid - 5);
    });
    assert.ok(heights.length > 200);
    const [least, most] = [Math.min(...heights), Math.max(...heights)];
    assert.ok(least > 30 && most - least < 4, `${name}: ${least} to ${most} px`);
  }
  await page.close();
});

test("the impacts in view are drawn the same in a run of many impacts and in a short one", async () => {
  const [long, short] = await Promise.all(
    [60000, 2000].map(async (end) => {
      const page = await still(`?preset=fig3&window=20,300&tau_end=${end}&view=100,160`);
      await painted(page);
      const picture = await hash(page, "#plot-relative canvas");
      await page.close();
      return picture;
    }),
  );
  assert.equal(long, short);
});

test("all plots and the machine share a cursor, and the nearest impact is ringed in each", async () => {
  const page = await still("?preset=fig11");
  await enlarge(page, "relative");
  const [, y, box] = await middle(page, "relative");
  const machine = await hash(page, "#machine");
  await page.mouse.move(box.x + 0.4 * box.width, y);
  assert.match(await page.textContent("#moment"), /^τ = 1686\.\d · \d+ impacts so far · y′ = /);
  assert.notEqual(await hash(page, "#machine"), machine);
  const shares = await page.$$eval("#plots .cursor", (nodes) =>
    nodes.map((node) => {
      const {left, width} = node.parentNode.getBoundingClientRect();
      return (node.getBoundingClientRect().left - left) / width;
    }),
  );
  assert.equal(shares.length, 4);
  for (const share of shares) assert.ok(Math.abs(share - 0.4) < 0.02, `${share} of the width`);
  for (const name of [...overTime.slice(0, 3), ...planes])
    assert.ok(await page.isVisible(`#figure-${name} .lit`), name);
  assert.match(await page.textContent("#value-x"), /^−?\d.*mm$/);
  await page.focus("#plot-x");
  const moment = await page.textContent("#moment");
  await page.keyboard.press("n");
  const next = await page.textContent("#moment");
  const impacts = (text) => Number(/(\d+) impacts/.exec(text)[1]);
  assert.equal(impacts(next), impacts(moment) + 1, "n goes to the next impact");
  assert.match(await page.getAttribute("#plot-x", "aria-valuetext"), /^τ = .*mm$/);
  await page.close();
});

test("pointing at a point of the section rings its impact in the plots over time", async () => {
  const page = await still("?preset=fig11");
  await enlarge(page, "section");
  const box = await page.locator("#plot-section").boundingBox();
  const before = await page.textContent("#moment");
  // The last half of a periodic run is two points; the scan passes near one of them.
  for (let x = 60; x < box.width && (await page.textContent("#moment")) === before; x += 18)
    for (let y = 10; y < box.height; y += 18) await page.mouse.move(box.x + x, box.y + y);
  assert.notEqual(await page.textContent("#moment"), before);
  assert.ok(await page.isVisible("#figure-x .lit"));
  await page.close();
});

test("the machine plays, pauses and scrubs; with reduced motion it does not start by itself", async () => {
  const page = await visit("?preset=fig11", wide);
  const moment = () => page.textContent("#moment");
  const first = await moment();
  await page.waitForFunction(
    (text) => document.getElementById("moment").textContent !== text,
    first,
  );
  await page.click("#play");
  const paused = await moment();
  await frames(page, 20);
  assert.equal(await moment(), paused);
  await page.$eval("#scrub", (node) => {
    node.value = "500";
    node.dispatchEvent(new Event("input", {bubbles: true}));
  });
  assert.match(await moment(), /^τ = 1690\./);
  const quiet = await still("?preset=fig11");
  const before = await quiet.textContent("#moment");
  await frames(quiet, 20);
  assert.equal(await quiet.textContent("#moment"), before);
  assert.equal(await quiet.getAttribute("#play", "aria-label"), "Play");
  await page.close();
  await quiet.close();
});

test("the regime strip is a slider of the parameter changed last: a click and the keys set it", async () => {
  const page = await still("?preset=fig11");
  await stripDrawn(page);
  const box = await page.locator("#strip").boundingBox();
  await after(page, () => page.mouse.click(box.x + box.width * 0.5, box.y + 40));
  const b = Number(await page.inputValue(number("b")));
  assert.ok(b > 21 && b < 26, `b = ${b} mm`);
  assert.match(
    await page.textContent("#strip-tip"),
    /^b = 2\d\.\d mm: II, .*chaotic, λ₁ = 0\.\d+ ± /,
  );
  await page.focus(".strip .marker");
  await after(page, () => page.keyboard.press("ArrowRight"));
  assert.ok(Number(await page.inputValue(number("b"))) > b);
  await after(page, () => turn(page, "R", 0.7));
  await stripDrawn(page, 2);
  assert.equal(await page.textContent("#strip-parameter"), "R");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the strip shows lambda1, the largest |x| or the impacts, and keeps what it has computed", async () => {
  const page = await still("?preset=fig11");
  const sweeps = asked(page, "/v1/sweep");
  await stripDrawn(page);
  sweeps.splice(0);
  const pictures = [await hash(page, "#strip")];
  await page.selectOption("#strip-quantity", "x_max");
  await painted(page);
  pictures.push(await hash(page, "#strip"));
  assert.ok((await pixels(page, "#strip", "without")) > 20, "without the absorber, dashed");
  await page.selectOption("#strip-quantity", "section");
  await stripDrawn(page, 2);
  assert.deepEqual(
    sweeps.map(({section}) => section),
    ["impact"],
  );
  pictures.push(await hash(page, "#strip"));
  assert.equal(new Set(pictures).size, 3);
  await page.selectOption("#strip-quantity", "lambda1");
  await stripDrawn(page, 3);
  assert.equal(sweeps.length, 1, "the first sweep is kept");
  assert.equal(await hash(page, "#strip"), pictures[0]);
  await page.close();
});

test("a motion that ends on an orbit is not called chaotic", async () => {
  const page = await still("?preset=fig12");
  assert.match(await sentence(page), /two asymmetric \(IV\), stable periodic orbit/);
  assert.doesNotMatch(await sentence(page), /chaotic so far/);
  await unfoldDetails(page);
  assert.doesNotMatch(await page.textContent("#details"), /as the paper counted/);
  await page.close();
});

test("a run without impacts is drawn and described", async () => {
  const page = await still("?b=0.5&tau_end=300");
  assert.match(await sentence(page), /^b = 500 mm: the ball meets no wall\./);
  assert.match(await page.textContent("#warnings"), /no exponents/);
  assert.ok((await colours(page, "#plot-x canvas")) > 3);
  await unfoldDetails(page);
  assert.match(await page.textContent("#summary"), /regimenone no impacts/);
  assert.match(await page.textContent("#summary"), /verdict– .*the ball has no impacts in the end/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("with different R at the walls the manifold shows the run's points without branches", async () => {
  const page = await still("?R_plus=0.6&R_minus=0.7&tau_end=600");
  assert.ok((await colours(page, "#plot-manifold")) > 3);
  assert.equal(await pixels(page, "#plot-manifold", "c2"), 0);
  assert.equal(await page.isVisible("#figure-manifold .key.stable"), false);
  assert.match(await page.textContent("#figure-x .params"), /R₊ = 0\.6, R₋ = 0\.7/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

// Details.

const details = [
  "acceleration",
  "z",
  "divergence",
  "qr",
  "eigenvalues",
  "raw_product",
  "J",
  "M",
  "T",
  "differences",
]
  .map((name) => `#plot-${name} canvas`)
  .concat(["portrait", "velocities", "stroboscopic"].map((name) => `#plot-${name}`));

test("the details hold all numbers and plots, are requested when opened, and follow the run", async () => {
  const page = await still();
  const runs = asked(page, "/v1/simulate");
  await unfoldDetails(page);
  assert.deepEqual(
    runs.map(({include}) => include.includes("series")),
    [true],
  );
  for (const canvas of details) assert.ok((await colours(page, canvas)) > 3, canvas);
  assert.match(
    await page.textContent("#summary-title"),
    /Window: τ = 1\d\.\d to 1\d\d\d\.\d, \d+ impacts/,
  );
  const summary = await page.textContent("#summary");
  assert.match(summary, /λ₁ \(qr\)0\.\d{4} ± 0\.\d{4}/);
  // Or 4, where an eigenvalue of the last product is computed as zero.
  assert.match(summary, /positive exponents \(qr\)1 [34] by the raw product/);
  assert.match(summary, /regimeType II strongly modulated response/);
  assert.match(summary, /verdictchaotic λ₁ = 0\.\d+ lies \d+\.\d standard errors above zero/);
  assert.equal(await page.isVisible("#figure-multipliers"), false);
  await after(page, () => page.click("text=III symmetric"));
  await page.waitForFunction(() => Number(document.getElementById("details").dataset.done) > 1);
  const periodic = await page.textContent("#summary");
  assert.match(periodic, /regimeType III two symmetric impacts per cycle/);
  assert.match(periodic, /period 1 cycle: 2 impacts, symmetric/);
  assert.match(await page.textContent("#summary-run"), /sticking phases1/);
  assert.ok((await pixels(page, "#plot-multipliers", "before")) >= 4 * 25, "four multipliers");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the details are marked while they show the numbers of an earlier run", async () => {
  const page = await still("?b=0.015&tau_end=300");
  await unfoldDetails(page);
  assert.equal(await page.isVisible("#details.stale"), false);
  await page.route("**/v1/simulate", (route) =>
    route.request().postDataJSON().include.includes("section")
      ? route.fulfill({status: 500, json: {title: "broken"}})
      : route.continue(),
  );
  await turn(page, "b", 20);
  await page.waitForSelector("#message.fault:has-text('are missing: broken')");
  await page.waitForSelector("#details.stale");
  await page.unroute("**/v1/simulate");
  await after(page, () => turn(page, "b", 15));
  await page.waitForSelector("#details:not(.stale)");
  assert.match(browser.complaints.splice(0).join(), /^[^,]*500[^,]*$/);
  await page.close();
});

test("the details of a ball that starts at a wall are complete", async () => {
  const page = await visit("?b=0.022&x0=0&y0=-0.022");
  await page.click("#details > summary");
  await page.waitForFunction(() => document.getElementById("details").dataset.done);
  assert.equal(await page.textContent("#details-message"), "");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the plots of the details zoom with those of the first screen", async () => {
  const page = await still("?b=0.015&tau_end=300");
  await unfoldDetails(page);
  const before = await hash(page, "#plot-acceleration canvas");
  await page.focus("#plot-x");
  await page.keyboard.press("+");
  await viewed(page);
  await painted(page);
  assert.notEqual(await hash(page, "#plot-acceleration canvas"), before);
  await page.close();
});

test("the energy balance adds up, and the oscillator is compared with the one without absorber", async () => {
  const page = await still("?preset=fig11");
  await unfoldDetails(page);
  const numbers = async (rows) =>
    (await cells(page, rows)).map((row) => row.slice(1).map((text) => parseFloat(text)));
  const shares = (await numbers("#energy-parts tbody tr")).map(([share]) => share);
  assert.equal(shares.length, 3);
  assert.ok(Math.abs(shares.reduce((a, b) => a + b) - 100) < 1.5, shares.join(" + "));
  const [[rms, without]] = await numbers("#energy-compared tbody tr");
  assert.ok(rms > 0 && rms < without);
  await page.close();
});

test("a free decay is drawn, with its initial energy and decay times", async () => {
  const page = await still("?G=0&x0=0.02&tau_end=600");
  assert.match(await sentence(page), /free decay, no forcing/);
  await unfoldDetails(page);
  assert.match(
    await page.textContent("#summary"),
    /verdict– without forcing \(G = 0\) the motion dies out/,
  );
  const energy = await page.textContent("#energy");
  assert.match(energy, /200 mm² at the start; half of the energy is left at τ = \d+/);
  const left = (part) => `${part} is left at τ = ([\\d.]+) \\(without absorber: τ = ([\\d.]+)\\)`;
  const decay = new RegExp(`${left("half of the energy")}; ${left("a tenth")}`);
  const times = decay.exec(energy).slice(1).map(Number);
  assert.ok(times[0] < times[1] && times[2] < times[3], "the absorber shortens the decay");
  for (const canvas of [...instrument, ...details])
    assert.ok((await colours(page, canvas)) > 2, canvas);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("windows are listed with their exponents and verdicts, and a link keeps them", async () => {
  const page = await still("?b=0.022&damping=closed_form&tau_end=1709");
  await unfold(page);
  await after(page, async () => {
    await page.fill(input("windows"), "18.13, 800; 800,1700;");
    await page.keyboard.press("Enter");
  });
  assert.match(page.url(), /windows=18\.13%2C800%3B800%2C1700/);
  await unfoldDetails(page);
  const first = await cells(page, "#windows tbody tr");
  assert.equal(first.length, 2);
  assert.deepEqual(first[1].slice(0, 2), ["800", "1700"]);
  assert.match(first[1][3], /^0\.\d{4} ± 0\.\d{4}$/);
  assert.match(first[1][6], /^−(0\.\d{4}|∞)$/); // the window can contain sticking
  assert.match(first[1][7], /chaotic|not decided/);
  const again = await still(new URL(page.url()).search);
  await unfoldDetails(again);
  assert.deepEqual(await cells(again, "#windows tbody tr"), first);
  assert.equal(await again.inputValue(input("windows")), "18.13, 800; 800, 1700");
  await page.close();
  await again.close();
});

test("a pinned run is drawn with the runs that follow, and can be swapped and unpinned", async () => {
  const page = await still("?preset=fig9");
  await page.click("#pin");
  assert.match(await page.textContent("#pinned-run"), /pinned: b = 22\.0 mm, R = 0\.60/);
  await after(page, () => turn(page, "b", 15));
  for (const canvas of [
    "#plot-x canvas",
    "#plot-relative canvas",
    "#plot-lambda canvas",
    "#plot-section",
  ])
    assert.ok((await pixels(page, canvas, "pinned")) > 20, canvas);
  assert.match(await page.textContent("#plot-lambda .legend"), /λ₁ pinned/);
  assert.match(page.url(), /b=0\.015&pinned=preset%3Dfig9$/);
  const again = await still(new URL(page.url()).search);
  await again.waitForFunction(() => document.getElementById("pinned-run").textContent);
  assert.match(await again.textContent("#pinned-run"), /pinned: b = 22\.0 mm, R = 0\.60/);
  assert.ok((await pixels(again, "#plot-x canvas", "pinned")) > 20, "a link shows the same");
  await again.close();
  await after(page, () => page.click("#swap"));
  assert.match(await sentence(page), /^b = 22\.0 mm/);
  assert.match(
    await page.textContent("#pinned-run"),
    /pinned: b = 15\.0 mm.* rms of x \d\d % → \d\d %, λ₁ .* → .*, z 2\.00 → 1/,
  );
  await page.click("#unpin");
  assert.doesNotMatch(page.url(), /pinned/);
  assert.equal(await pixels(page, "#plot-x canvas", "pinned"), 0);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

// Export.

test("each plot exports its numbers as table and CSV, and its picture as SVG and PNG, with its parameters", async () => {
  const page = await still("?preset=fig9&view=100,140");
  await enlarge(page, "relative");
  await page.click("#figure-relative .menu");
  assert.match(await page.textContent("#data h2"), /Relative motion x − y/);
  assert.match(await page.textContent("#data"), /b = 22\.0 mm, R = 0\.60, G = 20\.0 mm/);
  const rows = await cells(page, "#data tbody tr");
  assert.equal(rows[0][0], "100");
  const file = async (form) => downloaded(page, `#data >> text=${form}`);
  const csv = (await file("CSV")).text.trim().split("\n");
  assert.equal(csv[0], "τ,x − y (mm)");
  for (const line of csv.slice(1)) {
    const [tau, gap] = line.split(",").map(Number);
    assert.ok(tau >= 100 && tau <= 140 && Math.abs(gap) <= 22.000001, line);
  }
  const svg = (await file("SVG")).text;
  assert.match(svg, /^<svg xmlns=.*Relative motion x − y.*b = 22\.0 mm, R = 0\.60/);
  const wellFormed = await page.evaluate(
    (text) => !new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror"),
    svg,
  );
  assert.ok(wellFormed);
  assert.match((await file("PNG")).text, /^.PNG/);
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("#data"), false);
  await unfoldDetails(page);
  assert.equal(await page.locator("#details .menu").count(), 14);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a run is copied as a link, curl command, Python program and JSON, and each gives the same run", async () => {
  await browser.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  const page = await still("?preset=fig9&b=0.021");
  const copied = async (form) => {
    await page.selectOption("#copies", form);
    await page.waitForFunction(() => document.getElementById("message").textContent === "copied");
    return page.evaluate(() => navigator.clipboard.readText());
  };
  assert.equal(await copied("link"), page.url());
  assert.deepEqual(JSON.parse(await copied("JSON")), {preset: "fig9", b: 0.021});
  const run = (command, ...flags) => promisify(execFile)(command, flags, {maxBuffer: 2 ** 26});
  const regime = /strongly modulated \((I+)\)/.exec(await sentence(page))[1];
  const {stdout: python} = await run("python3", "-c", await copied("Python"));
  assert.match(python, new RegExp(`^\\[0\\.\\d+, .*\\] ${regime}\n$`));
  const {stdout: curl} = await run("sh", "-c", await copied("curl"));
  assert.equal(JSON.parse(curl).parameters.b, 0.021);
  await page.close();
});

/** A page of another origin with address() in an <iframe>. */
async function frameOf(address) {
  const host = createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end(`<!doctype html><iframe src="${address()}" width="1200" height="700"></iframe>`);
  });
  await new Promise((resolve) => host.listen(0, "127.0.0.1", resolve));
  return {host, origin: `http://127.0.0.1:${host.address().port}`};
}

test("the skip link leads to the plots, and a frame for another page can be copied", async () => {
  const page = await still("?preset=fig11");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.activeElement?.id === "figure-x");
  await browser.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.selectOption("#copies", "embed");
  await page.waitForFunction(() => document.getElementById("message").textContent === "copied");
  assert.match(
    await page.evaluate(() => navigator.clipboard.readText()),
    /^<iframe src="http:.*preset=fig11&embed=1"/,
  );
  await page.close();
});

test("a page of an allowed origin can embed the plots, also without storage; another origin cannot", async () => {
  let address = "";
  const [allowed, other] = [await frameOf(() => address), await frameOf(() => address)];
  const own = await startService(["--embed-origin", allowed.origin]);
  address = `${own.url}/?embed=1&preset=fig11`;
  const page = await browser.context.newPage();
  // A frame of another site can be forbidden to store anything.
  await page.addInitScript(() => {
    const get = () => {
      throw new DOMException("storage is denied", "SecurityError");
    };
    for (const name of ["localStorage", "sessionStorage", "indexedDB"])
      Object.defineProperty(window, name, {get});
  });
  await page.goto(allowed.origin);
  const frame = page.frames()[1];
  await frame.waitForFunction(() => document.getElementById("results")?.dataset.done);
  assert.ok(await frame.isVisible("#plot-x canvas"));
  for (const hidden of ["#form", "header", "footer", "#details"])
    assert.equal(await frame.isVisible(hidden), false, hidden);
  const refused = page.waitForEvent("console", (message) => /frame-ancestors/.test(message.text()));
  await page.goto(other.origin);
  await refused;
  assert.equal(await page.frames()[1].$("#plot-x"), null);
  await page.close();
  for (const {host} of [allowed, other]) host.close();
  await own.stop();
  browser.complaints.length = 0; // the refused frame
});

/**
 * Runs use(page, url, enterKey) with a new page and a service that requires the key
 * "key-of-the-laboratory"; the browser must report nothing but 401.
 */
async function withRequiredKey(t, use) {
  const folder = await mkdtemp(join(tmpdir(), "vines-key-"));
  t.after(() => rm(folder, {recursive: true}));
  const file = join(folder, "keys");
  await writeFile(file, "key-of-the-laboratory\n");
  const own = await startService(["--api-key-file", file]);
  const page = await browser.context.newPage();
  await use(page, own.url, async (key) => {
    await page.fill("dialog[open] input[type=password]", key);
    await page.keyboard.press("Enter");
  });
  await page.close();
  await own.stop();
  const refusals = browser.complaints.splice(0); // Chromium logs each 401
  for (const text of refusals) assert.match(text, /401/);
}

test("the page asks once for a required key, again after a wrong one, and keeps it", (t) =>
  withRequiredKey(t, async (page, url, enterKey) => {
    await page.goto(url);
    await enterKey("no-key-of-the-laboratory");
    await page.waitForSelector("dialog[open]:has-text('does not accept this key')");
    await enterKey("key-of-the-laboratory");
    await drawn(page, 1);
    assert.equal(await page.$("dialog[open]"), null);
    await page.reload();
    await drawn(page, 1);
    assert.doesNotMatch(page.url(), /laboratory/);
  }));

test("a key typed while another request is pending is used for that request", (t) =>
  withRequiredKey(t, async (page, url, enterKey) => {
    let release;
    const released = new Promise((resolve) => {
      release = resolve;
    });
    // The request for the presets with the wrong key is answered after the right key was typed.
    await page.route("**/v1/presets", async (route) => {
      if (/wrong/.test(await route.request().headerValue("authorization"))) await released;
      await route.continue();
    });
    await page.goto(url);
    await enterKey("wrong-key-of-the-laboratory");
    await page.waitForSelector("dialog[open]:has-text('does not accept this key')");
    await enterKey("key-of-the-laboratory");
    await page.waitForSelector("dialog[open]", {state: "detached"});
    release();
    await page.waitForFunction(
      () =>
        document.getElementById("results").dataset.done || document.querySelector("dialog[open]"),
    );
    assert.equal(await page.locator("dialog[open]").count(), 0, "no further question");
  }));

test("a dialog closed by Escape stores no key", (t) =>
  withRequiredKey(t, async (page, url) => {
    await page.goto(url);
    await page.fill("dialog[open] input[type=password]", "λ".repeat(20)); // not allowed in a header
    await page.keyboard.press("Escape");
    await page.waitForSelector("#message.fault");
    assert.match(await page.textContent("#message"), /could not start: .*API key/);
    assert.equal(await page.evaluate(() => sessionStorage.length), 0);
  }));

test("a printed page shows the results without the controls", async () => {
  const page = await still("?preset=fig9");
  await page.emulateMedia({media: "print"});
  for (const hidden of ["#form", ".tabs", "#play", "#scrub", "footer"])
    assert.equal(await page.isVisible(hidden), false, hidden);
  for (const shownOnPaper of ["#sentence", "#reduction", "#figure-x .params", ...instrument])
    assert.ok(await page.isVisible(shownOnPaper), shownOnPaper);
  for (const width of [1440, 718]) {
    await resize(page, {width, height: 900});
    for (const name of overTime) {
      const inside = (selector) =>
        page.$eval(`#figure-${name} ${selector}`, (node) => {
          const {top, bottom} = node.getBoundingClientRect();
          return {top, bottom, height: bottom - top};
        });
      const [canvas, caption] = [await inside("canvas"), await inside("figcaption")];
      const figure = await page.$eval(`#figure-${name}`, (f) => f.getBoundingClientRect().bottom);
      assert.ok(canvas.height > 30, `${name} at ${width} px: ${canvas.height}`);
      assert.ok(
        canvas.bottom <= figure + 1 && canvas.top >= caption.bottom - 1,
        `${name}: ${width}`,
      );
    }
  }
  await page.close();
});

test("a link to a run of defaults shows that run, not the paper's figure", async () => {
  const page = await still("?b=0.018&tau_end=400");
  await unfold(page);
  for (const name of ["b", "tau_end"]) {
    await page.fill(input(name), "");
    await after(page, () => page.keyboard.press("Enter"));
  }
  const link = new URL(page.url()).search;
  const again = await still(link);
  assert.equal(await sentence(again), await sentence(page));
  assert.equal(await again.inputValue("#preset"), "");
  for (const each of [page, again]) await each.close();
});

// Remarks.

test("remarks unfold over the page and include those of the deferred answer", async () => {
  const page = await still("?b=0.01&tau_end=40000&max_points=500");
  await page.click("#remarks summary");
  const covered = await page.$eval("#warnings", (list) => {
    const {left, top, width, height} = list.getBoundingClientRect();
    const at = document.elementFromPoint(left + width / 2, top + height - 6);
    return height < 20 || !list.contains(at);
  });
  assert.equal(covered, false);
  assert.match(await page.textContent("#warnings"), /eigenvalues|raw_product|last \d+ of/);
  await page.close();
});

test("an undecided verdict is shown with the service's reason", async () => {
  const query = "b=0.02348832184448838&tau_end=600";
  const {exponents} = await (await fetch(`${service.url}/v1/simulate?${query}`)).json();
  const [lambda1, error] = [exponents.qr.final[0], exponents.qr.standard_error[0]];
  const page = await still(`?${query}`);
  assert.ok(
    (await sentence(page)).includes(
      `λ₁ = ${lambda1.toFixed(3)} ± ${error.toFixed(3)}, not decided;`,
    ),
  );
  assert.match(
    await page.textContent("#warnings"),
    /not decided: .*standard errors above zero; a verdict needs/,
  );
  await page.close();
});

test("the link to the details opens them, and the form does not cover them", async () => {
  const page = await still();
  await page.click("#to-details");
  await page.waitForFunction(() => document.getElementById("details").dataset.done);
  assert.ok(await page.isVisible("#summary"));
  for (const y of [140, 700]) {
    await page.evaluate((top) => scrollTo(0, top), y);
    await painted(page);
    const over = await page.$eval("#strip, #details", () => {
      const hits = [".strip", "#details"].map((selector) => {
        const {left, top, bottom} = document.querySelector(selector).getBoundingClientRect();
        const at = Math.max(top, 0) + 4;
        return at < Math.min(bottom, innerHeight)
          ? document.elementFromPoint(left + 20, at)?.closest("form")
          : null;
      });
      return hits.some(Boolean);
    });
    assert.equal(over, false, `scrolled by ${y}`);
  }
  await page.close();
});

test("the damping slider can leave zero again", async () => {
  const page = await still("?preset=fig3");
  await after(page, () => turn(page, "zeta", 0));
  await after(page, () => turn(page, "zeta", 0.02));
  assert.equal(Number(await page.inputValue(number("zeta"))), 0.02);
  assert.match(await sentence(page), /^ζ = 0\.02/);
  assert.match(page.url(), /preset=fig3&/);
  await page.close();
});

test("a pinned run shorter than the run shown is drawn up to its end", async () => {
  const page = await still("?preset=fig3&pinned=preset%3Dfig11");
  await page.waitForSelector("#pinned-run:not(:empty)");
  await painted(page);
  assert.ok((await pixels(page, "#plot-x canvas", "motion")) > 500);
  await page.click("#figure-x .menu");
  assert.doesNotMatch(await page.textContent("#data"), /NaN|Infinity|undefined/);
  await page.close();
});

test("the strip reports when its settled point differs from the run above", async () => {
  const query = "b=0.0193153126&G=0.0332982985&Omega=1.0242&damping=closed_form&tau_end=1000";
  const page = await still(`?${query}`);
  assert.match(await sentence(page), /\(II\), chaotic/);
  await stripDrawn(page);
  const told = await page.textContent("#strip-tip");
  assert.match(told, /at the marker, after 150 cycles: III, regular; the run above: II, chaotic/);
  await page.close();
});

test("each plot of the details has a unique name", async () => {
  const page = await still();
  await unfoldDetails(page);
  const names = await page.$$eval("#details [role=img], #details [role=slider]", (plots) =>
    plots.map((plot) => plot.getAttribute("aria-label")),
  );
  assert.ok(names.length > 12);
  for (const name of names) assert.match(name, /^[A-ZT|a-z].{3,}/);
  assert.equal(new Set(names).size, names.length, names.join("; "));
  await page.close();
});

// Form fields.

test("each field shows the origin of its value, and an empty field shows its default", async () => {
  const page = await still();
  await unfold(page);
  assert.equal(await origin(page, "b"), "fig3");
  assert.equal(await origin(page, "tau_end"), "fig3");
  assert.equal(await origin(page, "epsilon"), "default");
  assert.equal(await page.getAttribute(input("epsilon"), "placeholder"), "0.00840557");
  assert.equal(await page.getAttribute(input("R"), "placeholder"), "0.6");
  await page.fill(input("b"), "30");
  assert.equal(await origin(page, "b"), "", "typed, and no longer the preset's");
  await after(page, () => page.keyboard.press("Enter"));
  assert.equal(await origin(page, "b"), "");
  assert.equal(await page.inputValue("#preset"), "fig3", "the walls are not the system");
  await unfoldDetails(page);
  const rows = await cellsByName(page, "#parameters tbody tr");
  assert.deepEqual(rows.b, ["b", "0.03 m", "given"]);
  assert.deepEqual(rows.epsilon, ["ε", "0.00840557", "default"]);
  assert.deepEqual(rows.damping, ["damping", "closed form", "preset fig3"]);
  assert.equal(rows.zeta[0], "ζ");
  await page.close();
});

test("an empty field stands for the preset's value, and a field that is emptied returns to it", async () => {
  const page = await still("?preset=fig3&tau_end=600&window=100,500");
  await unfold(page);
  assert.equal(await page.inputValue(input("b")), "");
  assert.equal(await page.getAttribute(input("b"), "placeholder"), "22");
  for (const [name, query] of Object.entries({window: "&tau_end=600", tau_end: ""})) {
    await after(page, async () => {
      await page.fill(input(name), "");
      await page.keyboard.press("Enter");
    });
    assert.equal(new URL(page.url()).search, `?preset=fig3${query}`);
  }
  assert.equal(await page.getAttribute(input("window"), "placeholder"), "18.13, 1708.9");
  assert.deepEqual(await marked(page), [["figure-x", "Fig. 3"]]);
  await after(page, () => page.selectOption("#preset", ""));
  assert.equal(await page.inputValue(input("window")), "18.13, 1708.9");
  assert.match(
    page.url(),
    /\?b=0\.022&damping=closed_form&tau_end=5521\.3&window=18\.13%2C1708\.9/,
  );
  await page.close();
});

test("a mass typed over a preset makes a system in SI, whose other fields are the paper's and can be replaced", async () => {
  const page = await still();
  await unfold(page);
  await page.fill(input("m1"), "12");
  await after(page, () => page.keyboard.press("Enter"));
  assert.equal(new URL(page.url()).search, "?preset=fig3&m1=12");
  assert.equal(await origin(page, "k1"), "fig3");
  assert.equal(await page.getAttribute(input("k1"), "placeholder"), "11680");
  assert.equal(await automatic(page, "damping"), "equation_of_motion");
  assert.equal(await page.textContent("#preset-note"), "Fig. 3, changed");
  await page.click("#remarks summary");
  assert.match(await page.textContent("#warnings"), /not given, and taken from preset fig3: c1/);
  await page.close();
});

test("a field of the oscillator typed over an experiment keeps its other values, each given once", async () => {
  const page = await still("?preset=fig20");
  await unfold(page);
  await page.fill(input("f0"), "8.4");
  assert.ok(await page.isDisabled(input("k1")));
  await after(page, () => page.keyboard.press("Enter"));
  assert.equal(new URL(page.url()).search, "?preset=fig20&f0=8.4");
  assert.equal(await page.inputValue(input("k1")), "");
  assert.equal(await page.getAttribute(input("c1"), "placeholder"), "3.02");
  await page.close();
});

test("a chosen damping and window stay when the system of a preset is replaced", async () => {
  const page = await still();
  await unfold(page);
  await page.selectOption(input("damping"), {value: "closed_form"});
  await page.fill(input("window"), "20, 1000");
  await page.fill(input("epsilon"), "0.01");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => location.search.includes("epsilon"));
  assert.equal(await page.inputValue(input("damping")), "closed_form");
  assert.equal(await page.inputValue(input("window")), "20, 1000");
  assert.match(page.url(), /\?preset=fig3&damping=closed_form&epsilon=0\.01&window=20%2C1000/);
  await page.close();
});

test("fields over a preset in a link mean the same on the page as in the service", async () => {
  for (const query of [
    "preset=fig20&epsilon=0.02",
    "preset=fig20&Omega=1.01",
    "preset=fig3&lambda=2",
    "preset=fig3&b=0.03",
    "preset=fig20&tau_end=500",
  ]) {
    const page = await still(`?${query}`);
    await unfold(page);
    assert.equal(new URL(page.url()).search, `?${query}`);
    const answer = await fetch(`${service.url}/v1/simulate?${query}&include=impacts`);
    const {parameters} = await answer.json();
    assert.equal(await automatic(page, "damping"), parameters.damping, query);
    const shownIn = async (name) =>
      (await page.inputValue(input(name))) || (await page.getAttribute(input(name), "placeholder"));
    const window = (await shownIn("window")).split(", ").map(Number);
    assert.deepEqual(window.map(Math.round), parameters.window.map(Math.round), query);
    await page.close();
  }
});

test("a field that follows from another is disabled and shows its value; SI fields disable the reduced ones", async () => {
  const page = await still(`?${platformQuery}&tau_end=300`);
  await unfold(page);
  const following = [
    ["k1", "92853.2", "from f0, m1"],
    ["c1", "12.6669", "from damping_ratio, m1, f0"],
    ["m2", "0.12", "from mass_ratio, m1"],
    ["cycles", "47.7465", "from tau_end"],
    ["epsilon", "0.01", "from mass_ratio, m1"],
  ];
  for (const [name, value, from] of following) {
    assert.ok(await page.isDisabled(input(name)), name);
    assert.equal(await page.getAttribute(input(name), "placeholder"), value);
    assert.equal(await origin(page, name), from);
  }
  await page.fill(input("f0"), "");
  assert.ok(await page.isEnabled(input("k1")));
  await page.fill(input("k1"), "92853.2");
  assert.ok(await page.isDisabled(input("f0")));
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => location.search.includes("k1=92853.2"));
  await page.waitForFunction(
    (field) => document.querySelector(field).placeholder === "14",
    input("f0"),
  );
  browser.complaints.length = 0; // of the system without k1 and f0
  await page.close();
});

test("a system in SI has SI sliders and units, one without has τ", async () => {
  const page = await still(`?${platformQuery}&tau_end=900&windows=100,400`);
  for (const name of ["F", "f", "c1"]) assert.ok(await page.isVisible(number(name)), name);
  await unfoldDetails(page);
  assert.match(await page.textContent("#moment"), /^t = .*mm\/s$/);
  assert.match(
    await page.textContent("#summary-run"),
    /impact speed\d+ mm\/s median; at most \d+; impulse 0\.\d+ N s/,
  );
  assert.match(await page.textContent("#summary-run"), /peak acceleration\d+ m\/s²/);
  assert.match(await page.textContent("#windows thead"), /^from \(s\)to \(s\)/);
  assert.match(await page.textContent("#energy-parts"), /\d+ J/);
  const reduced = await visit("?b=0.02&tau_end=300&windows=100,200");
  await unfoldDetails(reduced);
  assert.match(await reduced.textContent("#moment"), /^τ = /);
  assert.match(await reduced.textContent("#windows thead"), /^τ from/);
  assert.match(await reduced.textContent("#energy-parts"), /mm²/);
  assert.deepEqual(browser.complaints, []);
  for (const p of [page, reduced]) await p.close();
});

test("the sliders of frequency and damping in SI set f in Hz and c1, and keep the preset", async () => {
  const page = await still("?preset=fig20");
  await after(page, () => type(page, "f", "8.4"));
  assert.match(page.url(), /\?preset=fig20&f=8\.4$/);
  await after(page, () => type(page, "c1", "2"));
  assert.match(page.url(), /\?preset=fig20&c1=2&f=8\.4$/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the system is sketched in the page's colours and its equation written out", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await visit("?tau_end=100", {colorScheme, ...wide});
    await unfoldDetails(page);
    await page.waitForSelector("#model-sketch svg");
    const colourOf = (selector) => page.$eval(selector, (node) => getComputedStyle(node).color);
    assert.equal(await colourOf("#model-sketch svg"), await colourOf("body"), colorScheme);
    assert.match(
      (await page.textContent("#figure-model")).replace(/[\s\u2009]+/g, " "),
      /m1x″ \+ c1x′ \+ k1x = k1F sin 2πft \+ 2πf c1F cos 2πft ?y″ = 0 while \|x − y\| < b/,
    );
    await page.close();
  }
});

// Small screens.

for (const width of [390, 360])
  test(`on a screen of ${width} px there is one plot at a time, the parameters are in a sheet, and the page fits`, async () => {
    const page = await still("", {viewport: {width, height: 780}});
    assert.ok(await fits(page));
    const visible = async () =>
      page.$$eval("#instrument figure", (list) =>
        list.filter((f) => f.offsetHeight).map((f) => f.id),
      );
    assert.deepEqual(await visible(), ["figure-x"]);
    const top = await page.$eval("#figure-x", (node) => node.getBoundingClientRect().top);
    assert.ok(top < 500, `the plot begins at ${top}`);
    for (const name of [...overTime.slice(1), ...planes]) {
      const short = await page.getAttribute(`#figure-${name}`, "data-short");
      await page.click(`#switch button:text-is("${short}")`);
      assert.deepEqual(await visible(), [`figure-${name}`]);
      const canvas = planes.includes(name) ? `#plot-${name}` : `#plot-${name} canvas`;
      await painted(page);
      assert.ok((await colours(page, canvas)) > 3, name);
    }
    assert.ok(await page.isVisible(number("b")));
    assert.ok(!(await page.isVisible(number("R"))));
    await page.click("#sheet");
    assert.ok(await page.isVisible(number("R")));
    await page.click("#sheet");
    await unfoldDetails(page);
    assert.ok(await fits(page));
    const parts = "#panel-simulation :is(canvas, svg, figure, td), header *";
    assert.deepEqual(await beyond(page, parts, ".scroll"), []);
    await page.close();
  });

test("the titles of the form and of the displacement fit into one line", async () => {
  for (const width of [1440, 390, 360]) {
    const page = await still("", {viewport: {width, height: 900}});
    const clipped = await page.$$eval("#figure-x figcaption small", (notes) =>
      notes.filter((n) => n.scrollWidth > n.clientWidth).map((n) => n.textContent),
    );
    assert.deepEqual(clipped, [], `${width} px`);
    if (width < 700) await page.click("#sheet");
    const lines = await page.$eval("#more > summary", (summary) => {
      const text = document.createRange();
      text.selectNodeContents(summary);
      return new Set([...text.getClientRects()].map(({top}) => top)).size;
    });
    assert.equal(lines, 1, `${width} px`);
    await page.close();
  }
});

test("one finger scrolls a zoomed plot, two zoom", async () => {
  const page = await still("?preset=fig9", {viewport: {width: 390, height: 780}});
  const [x, y] = await middle(page, "x");
  const touches = await browser.context.newCDPSession(page);
  const put = (type, ...places) =>
    touches.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: places.map((px, id) => ({x: px, y, id})),
    });
  await put("touchStart", x - 20, x + 20);
  for (let k = 1; k <= 8; ++k) await put("touchMove", x - 20 - 10 * k, x + 20 + 10 * k);
  await put("touchEnd");
  // The fingers end five times as far apart as they start.
  await page.waitForFunction(() => {
    const view = new URLSearchParams(location.search).get("view")?.split(",").map(Number);
    return view && view[1] - view[0] < document.getElementById("plot-x").ariaValueMax / 4.9;
  });
  const [from, to] = view(page);
  const zoomed = new URL(page.url()).search;
  await put("touchStart", x);
  for (let k = 1; k <= 8; ++k) await put("touchMove", x - 10 * k);
  await put("touchEnd");
  await page.waitForFunction((search) => location.search !== search, zoomed);
  const [left, right] = view(page);
  assert.ok(left > from && Math.abs(right - left - (to - from)) < 1, `${left} to ${right}`);
  await page.close();
});

test("a hidden plot is drawn when it gets a width", async () => {
  const page = await still("?preset=fig11", narrow);
  assert.equal(await shown(page), 1);
  await resize(page, {width: 1440, height: 900});
  for (const canvas of instrument) await until(async () => (await colours(page, canvas)) > 3);
  await page.close();
});

test("a length shown in mm keeps all digits; its errors are in m", async () => {
  const page = await still("?b=0.013043478260869565&tau_end=200");
  await unfold(page);
  assert.equal(await page.inputValue(input("b")), "13.0434782608696");
  await page.fill(input("R"), "0,61");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => location.search.includes("R=0.61"));
  assert.match(page.url(), /b=0\.013043478260869565&/);
  await page.fill(input("b"), "-1");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#error-b:not(:empty)");
  assert.match(await page.textContent("#error-b"), /must lie in .* m$/);
  browser.complaints.length = 0; // Chromium logs the 422
  await page.close();
});

// The sweep tab in Chromium.
import assert from "node:assert/strict";
import {test} from "node:test";
import {until} from "../http/raw.mjs";
import {startService} from "../service.mjs";
import {drawn, open, painted, swept} from "./browser.mjs";
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
  pixels,
  platform,
  service,
  unfold,
  visit,
} from "./support.mjs";

const small =
  "tab=sweep&axis1=b,0.003,0.04,24&cycles=60&transient_cycles=30&section=impact&damping=closed_form";
const long = "tab=sweep&axis1=b,0.02,0.04,300&cycles=20000&damping=closed_form";
const stacked = ["section", "lambda", "other"].map((name) => `#plot-sweep-${name} canvas`);

/** Moves the pointer to fractions of a plot's width and height. */
async function hoverAt(page, plot, x, y = 0.5) {
  const box = await page.locator(`${plot} .over`).boundingBox();
  await page.locator(`${plot} .over`).hover({position: {x: box.width * x, y: box.height * y}});
}

async function clickAt(page, plot, x, y) {
  const over = page.locator(`${plot} .over`);
  await over.scrollIntoViewIfNeeded();
  // A click before the next frame could hit the previous state.
  await painted(page);
  const box = await over.boundingBox();
  await page.mouse.click(box.x + box.width * x, box.y + box.height * y);
}

/** The input of a field, by the id of its error text. */
const field = (id) => `#panel-sweep [aria-describedby='${id}']`;

const tip = (page) => page.textContent(".stacked:not([hidden]) .tip");

test("tabs are chosen by click and arrow keys; the first sweep is the range of Figs. 10 to 14, and Back returns to it", async () => {
  const page = await visit("?b=0.015&tau_end=100");
  await page.click("#tab-sweep");
  await swept(page, 1);
  assert.equal(await page.inputValue("#sweep-example"), "0");
  assert.match(
    page.url(),
    /tab=sweep&axis1=b%2C0\.003%2C0\.04%2C400&cycles=1000&section=impact&preset=table1/,
  );
  assert.equal(await page.isVisible("#panel-simulation"), false);
  for (const canvas of stacked) assert.ok((await colours(page, canvas)) > 3, canvas);
  const expected = [
    ["VI", 5, 30],
    ["V", 8, 30],
    ["IV", 10, 30],
    ["III", 85, 110],
    ["II", 120, 190],
    ["I", 70, 120],
  ];
  for (const [regime, least, most] of expected) {
    const n = Number(await page.textContent(`#sweep-regime-${regime}`));
    assert.ok(n >= least && n <= most, `${regime}: ${n} points`);
    assert.ok((await pixels(page, "#plot-sweep-other canvas", `regime-${regime}`)) > 20, regime);
  }
  await page.focus("#tab-simulation");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("#tab-simulation", "aria-current"), "page");
  assert.ok(await page.isVisible("#plot-x canvas"));
  assert.match(page.url(), /\?b=0\.015&tau_end=100/);
  await page.goBack();
  await page.waitForSelector("#plot-sweep-section canvas");
  assert.equal(
    await page.getAttribute("#sweep-results", "data-done"),
    "1",
    "the sweep is still there",
  );
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a sweep fills its diagrams and counts its points, and a link shows the same", async () => {
  const page = await visit(`?${small}`);
  assert.match(await page.textContent("#sweep-rate"), /24 of 24 points · \d+ per second$/);
  for (const canvas of stacked) assert.ok((await colours(page, canvas)) > 3, canvas);
  await hoverAt(page, "#plot-sweep-lambda", 0.3);
  assert.match(
    await tip(page),
    /^b1\d\.\d+ mmregimeIII, two symmetric.*z2.*λ₁−0\.\d+ ± .*regular.*Click to simulate this point$/,
  );
  await page.selectOption("#sweep-coordinate", "y_dot_after");
  await page.selectOption("#sweep-quantity", "share_impacts");
  await page.fill(field("sweep-error-axis1_count"), "12");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.match(await page.textContent("#sweep-rate"), /12 of 12/);
  const again = await open(browser.context, page.url());
  assert.equal(await again.inputValue("#sweep-coordinate"), "y_dot_after");
  assert.equal(await again.inputValue("#sweep-quantity"), "share_impacts");
  for (const canvas of stacked)
    assert.equal(await hash(again, canvas), await hash(page, canvas), canvas);
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await again.close();
});

test("zooming one diagram of a sweep zooms the others", async () => {
  const page = await visit(`?${small}`);
  await page.locator("#plot-sweep-lambda .over").scrollIntoViewIfNeeded();
  const box = await page.locator("#plot-sweep-lambda .over").boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, {steps: 5});
  assert.ok(await page.isHidden("#sweep-stack .tip"), "no tooltip during a drag");
  await page.mouse.up();
  assert.ok(await page.isHidden("#sweep-stack .tip"), "nor after it");
  await refined(page); // later than a click would take effect
  assert.match(page.url(), /tab=sweep/, "the end of a drag is no click");
  for (const name of ["section", "other"]) {
    await hoverAt(page, `#plot-sweep-${name}`, 0.02);
    const b = Number((await tip(page)).match(/^b(\d+\.?\d*) mm/)[1]);
    assert.ok(b > 16 && b < 20, `b at the left edge of ${name}: ${b}`);
  }
  await page.close();
});

test("a click on a point simulates it, and Back returns to the sweep", async () => {
  const page = await visit(`?${small}`);
  await clickAt(page, "#plot-sweep-other", 0.5, 0.2);
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.0\d+&damping=closed_form&cycles=272$/);
  assert.equal(await page.inputValue("#fields [aria-describedby='error-cycles']"), "272");
  assert.match(await page.textContent("#sentence"), /strongly modulated \(II\)/);
  await page.goBack();
  await page.waitForSelector("#sweep-stack:visible");
  assert.equal(await page.getAttribute("#sweep-results", "data-done"), "1");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the keyboard moves between points and simulates one", async () => {
  const page = await visit(`?${small}&carry_state=up`);
  await page.focus("#sweep-stack");
  for (const key of ["Home", "ArrowRight", "ArrowRight"]) await page.keyboard.press(key);
  assert.match(await tip(page), /^b6\.2/);
  await page.keyboard.press("Enter");
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.0062/);
  await page.click("#pin");
  await page.goBack();
  await page.focus("#sweep-stack");
  for (const key of ["Home", "Enter"]) await page.keyboard.press(key);
  await drawn(page, 2);
  assert.match(page.url(), /\?b=0\.003&.*&pinned=b%3D0\.0062/, "the pinned run stays");
  await page.close();
});

test("a cancelled sweep keeps its points, frees the service, and can be resumed", async (t) => {
  const one = await startService(["--sweeps", "1"]);
  t.after(() => one.stop());
  const page = await newPage();
  await page.goto(`${one.url}/?${long}`);
  await page.waitForFunction(() => document.getElementById("sweep-bar").value > 2);
  const body = JSON.stringify({axes: [{parameter: "b", values: [0.02]}], cycles: 10});
  const other = () => fetch(`${one.url}/v1/sweep`, {method: "POST", body});
  assert.equal((await other()).status, 503, "the one sweep that the service takes is running");
  assert.match(
    await page.textContent("#sweep-rate"),
    /\d+ of 300 points · .* per second · .* left/,
  );
  await page.click("#sweep-cancel");
  await page.waitForFunction(
    () => document.getElementById("sweep-message").textContent === "cancelled",
  );
  await until(async () => (await other()).status === 200);
  const kept = await page.evaluate(() => document.getElementById("sweep-bar").value);
  assert.ok(kept > 2 && kept < 300);
  let asked;
  page.on("request", (request) => {
    if (request.url().endsWith("/v1/sweep")) asked = JSON.parse(request.postData());
  });
  await page.click("#sweep-resume");
  await page.waitForFunction((kept) => document.getElementById("sweep-bar").value > kept, kept);
  assert.equal(asked.indices.length, 300 - kept);
  await page.close();
});

test("an interrupted stream resumes with the missing points", async () => {
  const page = await newPage();
  const asked = [];
  await page.route("**/v1/sweep", async (route) => {
    const request = route.request().postDataJSON();
    asked.push(request.indices?.length);
    if (asked.length > 2) return route.continue();
    const response = await route.fetch();
    const text = await response.text();
    // Half a response, cut inside a line; then none.
    if (asked.length > 1) return route.abort("connectionreset");
    return route.fulfill({response, body: text.slice(0, text.length / 2)});
  });
  await page.goto(`${service.url}/?${small}`);
  await swept(page, 1);
  assert.equal(asked.length, 3);
  assert.equal(asked[0], undefined);
  assert.ok(asked[1] > 3 && asked[1] < 21, `${asked[1]} were missing`);
  assert.equal(asked[2], asked[1]);
  assert.match(await page.textContent("#sweep-rate"), /24 of 24/);
  assert.equal(await page.textContent("#sweep-message"), "");
  const file = await downloaded(page, "#sweep-download");
  assert.equal(file.name, "sweep-b.ndjson");
  const [first, ...points] = file.text.trim().split("\n").map(JSON.parse);
  assert.equal(first.type, "start");
  const indices = points.map((line) => line.index).sort((a, b) => a - b);
  assert.deepEqual(indices, [...Array(24).keys()]);
  browser.complaints.length = 0; // Chromium logs the reset connection
  await page.close();
});

test("errors of a sweep are shown at their fields", async () => {
  const page = await visit(`?${small}`);
  const fault = async (id, value, text) => {
    const before = await page.inputValue(field(id));
    await page.fill(field(id), value);
    await page.click("#sweep-run");
    await page.waitForFunction(
      ([id, text]) => document.getElementById(id).textContent.includes(text),
      [id, text],
    );
    assert.equal(await page.getAttribute(field(id), "aria-invalid"), "true");
    await page.fill(field(id), before);
  };
  await fault("sweep-error-axis1_count", "0", "must lie in");
  await fault("sweep-error-axis1_from", "-1", "must lie in");
  await fault("sweep-error-cycles", "-1", "must lie in");
  await fault("sweep-error-R", "7", "must lie in");
  await fault("sweep-error-starts", "x0=0; x9=1", "unknown field");
  await fault("sweep-error-axis1_count", "1000000", "at most");
  // Without a second axis the third one is the second of the request.
  await page.click("#sweep-group-axis3 > summary");
  await page.selectOption(field("sweep-error-axis3_parameter"), "b");
  await page.click("#sweep-run");
  await page.waitForFunction(() =>
    document.getElementById("sweep-error-axis3_from").textContent.includes("needs from"),
  );
  assert.match(await page.textContent("#sweep-rate"), /24 of 24/, "the last sweep is still there");
  browser.complaints.length = 0; // Chromium logs each 422
  await page.close();
});

test("two axes make a map of a quantity or of regimes; a click on a cell simulates it", async () => {
  const axes = "axis1=b,0.005,0.035,12&axis2=R,0.4,0.8,8";
  const run = "cycles=60&transient_cycles=30&damping=closed_form";
  const page = await visit(`?tab=sweep&${axes}&${run}`);
  assert.ok((await colours(page, "#plot-sweep-map canvas")) > 40);
  await page.selectOption("#sweep-mapped", "regime");
  await painted(page);
  for (const regime of ["III", "II"])
    assert.ok((await pixels(page, "#plot-sweep-map canvas", `regime-${regime}`)) > 1000, regime);
  assert.match(page.url(), /map=regime/);
  await hoverAt(page, "#plot-sweep-map", 0.3, 0.06);
  assert.match(await tip(page), /^b13\.\d+ mmR0\.8regimeIII/);
  await clickAt(page, "#plot-sweep-map", 0.3, 0.06);
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.013\d+&R=0\.8&damping=closed_form&cycles=272$/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a map of attractors over two initial values has a colour for each twin, and their fractions", async () => {
  const plane = "axis1=x0,-0.003,0.003,8&axis2=y_dot0,-0.02,0.02,6";
  const page = await visit(
    `?tab=sweep&${plane}&cycles=50&transient_cycles=300&b=0.0065&y0=0&damping=closed_form&map=attractor`,
  );
  await swept(page, 1);
  const twins = await page.$$eval("#sweep-attractors li", (items) =>
    items.map(({textContent}) => textContent.match(/^(p1-[0-9a-f]{8}) (\d+) %$/).slice(1)),
  );
  assert.equal(twins.length, 2);
  assert.notEqual(twins[0][0], twins[1][0]);
  assert.equal(Number(twins[0][1]) + Number(twins[1][1]), 100);
  await page.selectOption("#sweep-mapped", "z");
  assert.equal(await page.locator("#sweep-attractors li").count(), 0);
});

test("several starts over a logarithmic axis have different symbols", async () => {
  const starts = "axis1=b,0.003,0.04,20,log&starts=x0=0;y_dot0=0.02&cycles=40";
  const page = await visit(`?tab=sweep&${starts}&section=stroboscopic&coordinate=gap`);
  assert.equal(await page.inputValue("#sweep-coordinate"), "gap");
  assert.match(await page.textContent("#sweep-starts"), /1: x\(0\) = 0 mm2: y′\(0\) = 20 mm per τ/);
  for (const name of ["c1", "minus"])
    assert.ok((await pixels(page, "#plot-sweep-lambda canvas", name)) > 20, name);
  await hoverAt(page, "#plot-sweep-section", 0.5);
  assert.match(await tip(page), /^b1[01]\.?\d* mmstart 1regime.*start 2regime/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

const smallMap = "tab=sweep&axis1=b,0.005,0.035,8&axis2=R,0.4,0.8,6&cycles=30";
for (const query of [small, smallMap, "tab=sweep"])
  test(`a sweep fits a narrow screen: ${query}`, async () => {
    const page = await visit(`?${query}`, narrow);
    assert.ok(await fits(page));
    assert.deepEqual(await beyond(page, "#panel-sweep :is(canvas, select, figure, .key)"), []);
    await page.close();
  });

const platformSweep =
  "tab=sweep&axis1=f,13.7,14.3,13&starts=default+set&cycles=150" +
  "&m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&F=0.0004&R=0.4&b=0.03&beside=x_max";
const fromOneStart = platformSweep.replace("starts=default+set&", "");
const peaks = (page) => cellsByName(page, "#sweep-peaks tbody tr");

test("the default set of starts shows the worst motion, the best as rings, the amplitude without the absorber dashed, and motions without contact in another colour", async () => {
  const page = await visit(`?${platformSweep}`);
  assert.ok(await page.isChecked("#sweep-default-set"));
  assert.equal(await page.inputValue("#sweep-quantity"), "x_max");
  assert.match(
    await page.textContent("#sweep-motions"),
    /worst start.*best start, where the motions differ/,
  );
  assert.ok(await page.isVisible("#sweep-free"));
  for (const name of ["best", "wall", "text"])
    assert.ok((await pixels(page, "#plot-sweep-other canvas", name)) > 20, name);
  assert.ok((await pixels(page, "#plot-sweep-lambda canvas", "untouched")) > 20);
  assert.ok(Number(await page.textContent("#sweep-regime-none")) > 3);
  await hoverAt(page, "#plot-sweep-other", 0.29);
  const told = [
    /^f13\.85 Hzregimeno impacts/,
    /without absorber16\.\d+ mm/,
    /middle1[67]\.\d+ mm, no impacts/,
    /at the wall1\d\.\d+ mm, Type III/,
    /moving.*previous point.*next point/,
  ];
  assert.match(await tip(page), new RegExp(told.map((part) => part.source).join(".*")));
  assert.match(
    await tip(page),
    /Click to simulate this point, from its start: (middle|no contact|previous point|next point)$/,
  );
  await page.selectOption("#sweep-quantity", "impact_speed");
  assert.equal(await page.isVisible("#sweep-free"), false);
  const speeds = await hash(page, "#plot-sweep-other canvas");
  await page.selectOption("#sweep-quantity", "z");
  assert.notEqual(await hash(page, "#plot-sweep-other canvas"), speeds);
  assert.equal(await pixels(page, "#plot-sweep-other canvas", "wall"), 0);
  const {middle, "at the wall": wall, "without the absorber": free} = await peaks(page);
  assert.ok(Number(middle[0]) > 1.3 * Number(wall[0]), `${middle[0]} beside ${wall[0]} mm`);
  assert.deepEqual(free.slice(0, 2), ["33.3", "14"]);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("verdicts, motions without contact and missing points have different colours", async () => {
  const page = await visit(`?${small}`);
  const named = await page.evaluate(() =>
    ["untouched", "regular", "chaotic", "undecided", "second", "regime-none", "nothing"].map(
      (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(),
    ),
  );
  assert.equal(new Set(named).size, named.length, named.join(" "));
  await page.close();
});

test("the default-set box fills in the starts and disables the section; a list of starts unchecks it", async () => {
  const page = await visit(`?${small}`);
  await page.check("#sweep-default-set");
  assert.equal(await page.inputValue(field("sweep-error-starts")), "default set");
  for (const name of ["section", "carry_state"])
    assert.ok(await page.isDisabled(field(`sweep-error-${name}`)), name);
  const requests = asked(page, "/v1/sweep");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.equal(requests[0].starts, "default set");
  assert.equal(requests[0].section, undefined);
  assert.equal(await page.isVisible("#figure-sweep-section"), false);
  assert.match(page.url(), /starts=default\+set/);
  await page.fill(field("sweep-error-starts"), "x0=0; y_dot0=0.02");
  assert.equal(await page.isChecked("#sweep-default-set"), false);
  await page.click("#sweep-run");
  await swept(page, 3);
  assert.equal(requests[1].starts.length, 2);
  assert.equal(await page.isVisible("#sweep-motions"), false);
  await page.close();
});

test("a reduction removes an axis: the peak and its place are drawn over the other axis, or listed per start", async () => {
  const page = await visit(`?${platformSweep}&axis2=b,0.02,0.04,3`);
  assert.ok(await page.isVisible("#sweep-map"));
  await page.selectOption(field("sweep-error-reduce"), "max over f");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.match(page.url(), /reduce=max\+over\+f/);
  assert.match(await page.textContent("#sweep-rate"), /3 of 3/);
  assert.equal(await page.isVisible("#figure-sweep-lambda"), false);
  assert.deepEqual(
    await page.$$eval("#sweep-quantity option", (list) => list.map((o) => o.value)),
    ["x_max", "where", "z"],
  );
  const ofThreePoints = {text: 20, best: 2};
  for (const [name, least] of Object.entries(ofThreePoints))
    assert.ok((await pixels(page, "#plot-sweep-other canvas", name)) > least, name);
  await hoverAt(page, "#plot-sweep-other", 0.5);
  assert.match(await tip(page), /^b30 mm.*largest \|x\|2\d\.\d+ mm at f = 1[34]\.\d+ Hz/);
  await page.selectOption(field("sweep-error-axis2_parameter"), "none");
  await page.fill(`#sweep-group-system .field-b input`, "30");
  await page.click("#sweep-run");
  await swept(page, 3);
  assert.equal(await page.isVisible("#sweep-stack"), false);
  const {middle, "without the absorber": free} = await peaks(page);
  assert.ok(Number(middle[0]) > 20 && Number(middle[0]) < 33, middle[0]);
  assert.equal(free[0], "33.3");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a third axis has a map for each value, of the worst or the best start", async () => {
  const short = platformSweep.replace("R=0.4&", "").replace("cycles=150", "cycles=60");
  const axes = "axis2=b,0.025,0.035,3&axis3=R,0.4,0.6,2";
  const page = await visit(`?${short}&${axes}&map=x_max`);
  assert.match(await page.textContent("#sweep-rate"), /78 of 78/);
  assert.equal(await page.textContent("#sweep-slice-word"), "where R =");
  const first = await hash(page, "#plot-sweep-map canvas");
  await page.selectOption("#sweep-start", "best");
  await painted(page);
  assert.notEqual(await hash(page, "#plot-sweep-map canvas"), first);
  await page.selectOption("#sweep-start", "0");
  await page.selectOption("#sweep-slice", "1");
  await painted(page);
  assert.notEqual(await hash(page, "#plot-sweep-map canvas"), first);
  await clickAt(page, "#plot-sweep-map", 0.5, 0.5);
  await drawn(page, 1);
  const query = new URL(page.url()).searchParams;
  const value = (name) => Number(Number(query.get(name)).toFixed(9));
  assert.deepEqual(["f", "b", "R", "m1"].map(value), [14, 0.03, 0.6, 12]);
  browser.complaints.length = 0;
  await page.close();
});

test("the warnings of a sweep are listed", async () => {
  const page = await visit(`?${fromOneStart}&damping=closed_form&y0=0`);
  const warnings = await page.textContent("#sweep-warnings");
  assert.match(warnings, /damping is closed_form \(given\)/);
  assert.match(warnings, /the motion depends on the start/);
  await page.close();
});

test("system fields over an example's preset, or swept, leave its damping unless that is given; fields show their origin", async () => {
  const page = await visit("?tab=sweep");
  const damping = field("sweep-error-damping");
  const automatic = () =>
    page.$eval(damping, ({value, options}) => value || options[0].text.replace("automatic: ", ""));
  assert.equal(await automatic(), "closed_form");
  const epsilon = "#sweep-group-reduced .field-epsilon";
  assert.equal(await page.textContent(`${epsilon} .origin`), "default");
  assert.equal(await page.getAttribute(`${epsilon} input`, "placeholder"), "0.00840557");
  await page.selectOption(field("sweep-error-axis1_parameter"), "lambda");
  for (const [name, value] of Object.entries({from: "1", to: "2", count: "5"}))
    await page.fill(field(`sweep-error-axis1_${name}`), value);
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.equal(await automatic(), "equation_of_motion");
  assert.match(await page.textContent("#sweep-warnings"), /not the preset's closed_form/);
  await page.selectOption("#sweep-example", {label: "Map over b and R"});
  await page.click("#sweep-cancel");
  assert.equal(await page.inputValue(damping), "");
  await page.selectOption(damping, "closed_form");
  await page.click("#sweep-group-SI > summary");
  await page.fill("#sweep-group-SI .field-m1 input", "12");
  assert.equal(await page.inputValue(damping), "closed_form");
  assert.ok(await page.isDisabled(`${epsilon} input`));
  await page.close();
});

test("the section of a sweep in SI shows velocities in mm/s", async () => {
  const alone = fromOneStart.replace("&beside=x_max", "");
  const page = await visit(`?${alone}&section=impact&coordinate=x_dot_after`);
  await page.click("#figure-sweep-section .menu");
  assert.match(await page.textContent("#data-table thead"), /x′ after \(mm\/s\)/);
  await page.close();
});

test("the results of a default set fit a narrow screen", async () => {
  const page = await visit(`?${platformSweep}`, narrow);
  assert.ok(await fits(page));
  assert.deepEqual(await beyond(page, "#panel-sweep :is(canvas, select, figure, td, .key)"), []);
  await page.close();
});

test("a platform typed over Fig. 3 is simulated in seconds, and its sweep lists the peaks from the wall and the middle", async () => {
  const page = await visit("", {viewport: {width: 1400, height: 1000}});
  await unfold(page);
  const inMm = {...platform, F: "0,4", b: "30"};
  for (const [name, value] of Object.entries(inMm)) await page.fill(input(name), value);
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.getElementById("moment").textContent.startsWith("t ="));
  await page.waitForFunction(() => Number(document.getElementById("slider-f").value) === 14);
  assert.equal(await automatic(page, "damping"), "equation_of_motion");
  await page.click("#tab-sweep");
  await page.waitForFunction(() => document.getElementById("sweep-results").dataset.done);
  await page.selectOption("#sweep-example", {
    label: "A platform's resonance, worst of several starts",
  });
  await page.waitForFunction(() =>
    /^81 of 81/.test(document.getElementById("sweep-rate").textContent),
  );
  await swept(page, 2);
  assert.equal(await page.inputValue("#sweep-quantity"), "x_max");
  const {middle, "at the wall": wall} = await peaks(page);
  assert.equal(middle[0], "28.7");
  // Peak of a chaotic motion: 13.5 to 15.2 mm for neighbouring starts.
  assert.ok(Math.abs(Number(wall[0]) - 14.4) < 1.2, `${wall[0]} mm from the wall`);
  assert.equal(middle[2], "no impacts, or no harmonic forcing");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

/** Drags between fractions of a plot. */
async function drag(page, plot, [x0, y0], [x1, y1]) {
  const over = page.locator(`${plot} .over`);
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  await page.mouse.move(box.x + box.width * x0, box.y + box.height * y0);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * x1, box.y + box.height * y1, {steps: 4});
  await page.mouse.up();
}

const refined = (page) =>
  page.waitForFunction(() => document.getElementById("sweep-results").dataset.refined === "1");
const beganToRefine = (page) =>
  page.waitForFunction(() => document.getElementById("sweep-refined").textContent !== "");

/** Text of a plot's export dialog. */
async function summaryOf(page, figure) {
  await page.click(`${figure} button.menu`);
  const text = await page.textContent("#data");
  await page.click("#data button:text-is('Close')");
  return text;
}

const mediumMap =
  "tab=sweep&axis1=b,0.005,0.035,24&axis2=R,0.4,0.8,16&cycles=200&transient_cycles=60&damping=closed_form";

test("a zoomed map is refined with the same colour scale, and a link shows the same", async () => {
  const page = await visit(`?${mediumMap}`);
  const before = await summaryOf(page, "#figure-sweep-map");
  const requests = asked(page, "/v1/sweep");
  await drag(page, "#plot-sweep-map", [0.1, 0.2], [0.5, 0.6]);
  await refined(page);
  assert.equal(requests.length, 1);
  const [b, R] = requests[0].axes;
  assert.ok(b.from > 0.0075 && b.to < 0.0205 && b.count === 24, JSON.stringify(b));
  assert.ok(R.from > 0.54 && R.to < 0.73 && R.count === 16, JSON.stringify(R));
  await hoverAt(page, "#plot-sweep-map", 0.5, 0.5);
  const told = Number((await tip(page)).match(/^b([\d.]+) mm/)[1]);
  const steps = (told - 5) / (30 / 23);
  assert.ok(Math.abs(steps - Math.round(steps)) > 1e-3, `${told} mm is none of the first points`);
  const colours = (text) => text.match(/colours from [−\d.]+ to [\d.]+/)[0];
  assert.equal(colours(await summaryOf(page, "#figure-sweep-map")), colours(before));
  await page.keyboard.press("Escape");
  const shown = page.url();
  assert.match(shown, /view=0\.00\d+,0\.0\d+,0\.5\d*,0\.7\d*/);
  const again = await open(browser.context, shown);
  await refined(again);
  assert.equal(again.url(), shown);
  await page.locator("#plot-sweep-map .over").dblclick();
  await page.waitForFunction(() => !location.search.includes("view="));
  assert.equal(requests.length, 1, "the whole is there already");
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await again.close();
});

test("zoomed diagrams are refined unless their points carry states over", async () => {
  for (const [carry, more] of [
    ["", 1],
    ["&carry_state=up", 0],
  ]) {
    const page = await browser.context.newPage();
    await page.clock.install();
    await page.goto(`${service.url}/?${small}${carry}`);
    await swept(page, 1);
    const requests = asked(page, "/v1/sweep");
    await drag(page, "#plot-sweep-lambda", [0.3, 0.5], [0.5, 0.5]);
    await page.clock.fastForward(1000); // refinement starts after 350 ms
    if (more) await refined(page);
    assert.equal(requests.length, more);
    const text = await summaryOf(page, "#figure-sweep-lambda");
    assert.equal(/at \d+ of 48 points/.test(text), more === 1, text);
    await page.close();
  }
});

test("a map is filled before a tenth of its points are received", async () => {
  const page = await newPage();
  await page.goto(
    `${service.url}/?tab=sweep&axis1=b,0.005,0.035,64&axis2=R,0.4,0.8,64&cycles=6000&map=regime`,
  );
  await page.waitForFunction(() => document.getElementById("sweep-bar").value > 100);
  const filled = await page.waitForFunction(() => {
    const canvas = document.querySelector("#plot-sweep-map canvas");
    const over = document.querySelector("#plot-sweep-map .over");
    const c = canvas.getContext("2d");
    const [ground] = new Uint32Array(c.getImageData(1, 1, 1, 1).data.buffer);
    const {offsetLeft: x, offsetTop: y, offsetWidth: w, offsetHeight: h} = over;
    let bare = 0;
    for (let i = 1; i < 20; ++i)
      for (let j = 1; j < 20; ++j) {
        const at = [x + (i / 20) * w, y + (j / 20) * h].map((v) => v * devicePixelRatio);
        const [pixel] = new Uint32Array(c.getImageData(...at, 1, 1).data.buffer);
        bare += pixel === ground;
      }
    return bare === 0 && {received: document.getElementById("sweep-bar").value};
  });
  const {received} = await filled.jsonValue();
  assert.ok(received < 0.1 * 64 * 64, `${received} points were received`);
  await page.click("#sweep-cancel");
  browser.complaints.length = 0; // Chromium warns about reading from canvases
  await page.close();
});

test("the frequency-response example shows the largest |x| with the absorber and, dashed, without", async () => {
  const page = await visit("?tab=sweep");
  await page.selectOption("#sweep-example", {
    label: "Frequency response, with and without the absorber",
  });
  await swept(page, 2);
  assert.equal(await page.inputValue("#sweep-quantity"), "x_max");
  assert.ok(await page.isVisible("#sweep-free"));
  for (const name of ["text", "wall"])
    assert.ok((await pixels(page, "#plot-sweep-other canvas", name)) > 100, name);
  await page.click("#figure-sweep-other button.menu");
  const [head] = await cells(page, "#data thead tr");
  assert.deepEqual(head, ["Ω", "largest |x| (mm)", "without the absorber", "regime"]);
  const rows = await cells(page, "#data tbody tr");
  const peak = Math.max(...rows.map((row) => Number(row[2])));
  assert.ok(peak > 7 && peak < 14, `${peak} mm without`);
  await page.close();
});

test("the plots of a sweep are exported as pictures and numbers", async () => {
  const page = await visit(`?${small}`);
  for (const [name, part] of [
    ["section", "<image "],
    ["lambda", "<path "],
    ["other", ">III</text>"],
  ]) {
    await page.click(`#figure-sweep-${name} button.menu`);
    const svg = await downloaded(page, "#data button:text-is('SVG')");
    assert.ok(svg.text.includes(part), `${name}: ${svg.text.slice(0, 2000)}`);
    assert.match(svg.text, /damping = closed_form/);
    const csv = await downloaded(page, "#data button:text-is('CSV')");
    assert.match(csv.text, /^b \(mm\),/);
    await page.click("#data button:text-is('Close')");
  }
  const map = await visit(`?${smallMap}`);
  await map.click("#figure-sweep-map button.menu");
  assert.match((await downloaded(map, "#data button:text-is('SVG')")).text, /<image .*λ₁<\/text>/);
  assert.equal(
    (await downloaded(map, "#data button:text-is('CSV')")).text.trim().split("\n").length,
    49,
  );
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await map.close();
});

test("results that differ from the form look stale; a new sweep over the same axis keeps the zoom, a link without zoom resets it", async () => {
  const page = await visit(`?${small}`);
  const isStale = () => page.$eval("#sweep-results", (node) => node.classList.contains("stale"));
  await drag(page, "#plot-sweep-lambda", [0.3, 0.5], [0.5, 0.5]);
  await page.waitForFunction(() => location.search.includes("view="));
  const view = new URL(page.url()).searchParams.get("view");
  assert.equal(await isStale(), false);
  await page.fill(`#sweep-group-system .field-R input`, "0.62");
  assert.ok(await isStale());
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.equal(await isStale(), false);
  assert.equal(new URL(page.url()).searchParams.get("view"), view);
  await page.goBack();
  await page.waitForFunction(() => !location.search.includes("R=0.62"));
  await page.evaluate((query) => {
    history.replaceState(null, "", query);
    dispatchEvent(new PopStateEvent("popstate"));
  }, `?${small}&R=0.5`);
  await page.waitForFunction(() => location.search.includes("R=0.5"));
  await page.waitForFunction(() => !location.search.includes("view="));
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("on a phone the first plot of a sweep begins within two screens", async () => {
  const page = await visit(`?${small}`, {viewport: {width: 360, height: 740}});
  const top = await page.$eval("#plot-sweep-section", (node) => node.getBoundingClientRect().top);
  const at = top + (await page.evaluate(() => scrollY));
  assert.ok(at < 2 * 740, `${at} px down`);
  await page.close();
});

test("a refinement continues when the menus change", async () => {
  const page = await visit(
    `?${mediumMap.replace("cycles=200", "cycles=4000").replace("24&", "10&").replace("16&", "8&")}`,
  );
  const requests = asked(page, "/v1/sweep");
  await drag(page, "#plot-sweep-map", [0.1, 0.2], [0.6, 0.7]);
  await beganToRefine(page);
  await page.selectOption("#sweep-mapped", "z");
  await refined(page);
  assert.equal(requests.length, 1, "it ran on");
  await page.click("#figure-sweep-map button.menu");
  const csv = await downloaded(page, "#data button:text-is('CSV')");
  assert.ok(csv.text.trim().split("\n").length > 80, "all of it is there");
  await page.close();
});

test("a tap shows a point's tooltip, whose button simulates the point", async () => {
  const page = await visit(`?${smallMap}`);
  const over = page.locator("#plot-sweep-map .over");
  await over.scrollIntoViewIfNeeded();
  await over.evaluate((node) => {
    const {left, top, width, height} = node.getBoundingClientRect();
    const at = {clientX: left + width / 2, clientY: top + height / 2, bubbles: true};
    const finger = {...at, pointerType: "touch", pointerId: 7, detail: 1};
    node.setPointerCapture = () => {}; // the pointer of a synthetic touch cannot be captured
    for (const type of ["pointerdown", "pointerup", "pointerout", "click"])
      node.dispatchEvent(new PointerEvent(type, finger));
    node.closest(".stacked").dispatchEvent(new PointerEvent("pointerleave", finger));
  });
  await page.waitForSelector("#sweep-map .tip button");
  await page.$eval("#sweep-map", (node) =>
    node.dispatchEvent(new PointerEvent("pointerleave", {pointerType: "touch"})),
  );
  await page.click("#sweep-map .tip button");
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.0/);
  await page.close();
});

test("Back and Forward between sweeps restore their menus", async () => {
  const page = await visit(`?${small}&beside=x_max`);
  await page.fill(`#sweep-group-system .field-R input`, "0.5");
  await page.click("#sweep-run");
  await swept(page, 2);
  await page.goBack();
  await swept(page, 3);
  assert.doesNotMatch(page.url(), /R=0\.5/);
  await page.goForward();
  await swept(page, 4);
  assert.match(page.url(), /R=0\.5/);
  await page.selectOption("#sweep-quantity", "z");
  await clickAt(page, "#plot-sweep-other", 0.5, 0.2);
  await drawn(page, 1);
  await page.goBack();
  await page.waitForSelector("#sweep-stack:visible");
  assert.equal(await page.inputValue("#sweep-quantity"), "z");
  await page.close();
});

test("a map after diagrams starts with lambda1, and diagrams after a map with their first quantity", async () => {
  const page = await visit(`?${small}`);
  const beside = await page.inputValue("#sweep-quantity");
  await page.selectOption(field("sweep-error-axis2_parameter"), "R");
  for (const [name, text] of Object.entries({from: "0.5", to: "0.6", count: "3"}))
    await page.fill(field(`sweep-error-axis2_${name}`), text);
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.equal(await page.inputValue("#sweep-mapped"), "lambda1");
  assert.doesNotMatch(page.url(), /map=|beside=/);
  await page.selectOption("#sweep-mapped", "z");
  await page.selectOption(field("sweep-error-axis2_parameter"), "none");
  await page.click("#sweep-run");
  await swept(page, 3);
  assert.equal(await page.inputValue("#sweep-quantity"), beside);
  assert.doesNotMatch(page.url(), /map=|beside=/);
  await page.close();
});

test("a link opens a reduction that leaves no axis", async () => {
  const page = await visit(`?${platformSweep}&reduce=max+over+f`);
  const requests = asked(page, "/v1/sweep");
  assert.ok((await peaks(page)).middle, "the table of its starts");
  assert.equal(await page.textContent("#sweep-message"), "");
  assert.equal(requests.length, 0, "it is not asked for again");
  await page.close();
});

test("a new parameter of an axis clears its ends, which are typed in the unit shown", async () => {
  const page = await visit("?tab=sweep&axis1=Omega,0.94,1.06,8&cycles=30");
  const requests = asked(page, "/v1/sweep");
  await page.selectOption(field("sweep-error-axis1_parameter"), "b");
  await page.fill(field("sweep-error-axis1_from"), "0.94");
  await page.fill(field("sweep-error-axis1_to"), "15");
  await page.click("#sweep-run");
  await swept(page, 2);
  const [{from, to}] = requests.at(-1).axes;
  assert.deepEqual([from, to], [0.00094, 0.015]);
  await page.close();
});

test("Enter during a sweep replaces it", async () => {
  const page = await newPage();
  await page.goto(`${service.url}/?${long}`);
  await page.waitForFunction(() => document.getElementById("sweep-bar").value > 2);
  const cycles = page.locator(field("sweep-error-cycles"));
  await cycles.fill("40");
  await cycles.press("Enter");
  await swept(page, 1);
  assert.match(await page.textContent("#sweep-rate"), /^300 of 300 points/);
  assert.match(page.url(), /cycles=40\b/);
  await page.close();
});

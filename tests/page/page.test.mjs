// The page in real Chromium, as a visitor uses it.
import {after, before, test} from "node:test";
import assert from "node:assert/strict";
import {startBrowser, open, drawn} from "./browser.mjs";
import {startService} from "../service.mjs";

let service, browser;
before(async () => { service = await startService(); browser = await startBrowser(); });
after(async () => { await browser.stop(); await service.stop(); });

/** A canvas as numbers, a pixel each; read from a copy, because Chromium complains of canvases that are read. */
const image = async (page, selector) => new Uint32Array(await page.evaluate((selector) => {
  const {width, height} = document.querySelector(selector);
  const copy = new OffscreenCanvas(width, height).getContext("2d", {willReadFrequently: true});
  copy.drawImage(document.querySelector(selector), 0, 0);
  return [...new Uint32Array(copy.getImageData(0, 0, width, height).data.buffer)];
}, selector));

/** How many different colours a canvas shows: an empty one has one. */
const colours = async (page, selector) => new Set(await image(page, selector)).size;

const lines = ["x", "largest", "relative", "z", "qr", "eigenvalues", "raw_product", "J", "M", "T", "differences"].map((name) => `#plot-${name} canvas`);
const scatters = ["portrait", "section", "velocities", "stroboscopic", "manifold"].map((name) => `#plot-${name}`);
const canvases = [...lines, ...scatters];

/** How many pixels of a canvas have exactly the colour that the style sheet names so. */
async function pixels(page, selector, name) {
  const colour = await page.evaluate((name) => {
    const c = new OffscreenCanvas(1, 1).getContext("2d", {willReadFrequently: true});
    c.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    c.fillRect(0, 0, 1, 1);
    return new Uint32Array(c.getImageData(0, 0, 1, 1).data.buffer)[0];
  }, name);
  return (await image(page, selector)).filter((pixel) => pixel === colour).length;
}

const marked = (page) => page.$$eval("figure.about", (figures) => figures.map((f) => [f.id, f.querySelector(".tag").textContent]));

test("the first thing that a visitor sees is the paper's Fig. 3, computed and drawn, with nothing in the console", async () => {
  const page = await open(browser.context, service.url);
  assert.equal(await page.inputValue("#preset"), "fig3");
  for (const canvas of canvases) assert.ok(await colours(page, canvas) > 3, canvas);
  const summary = await page.textContent("#summary");
  assert.match(summary, /λ₁ \(qr\)0\.\d{4} ± 0\.\d{4}/);
  assert.match(summary, /positive exponents \(qr\)1 raw_product shows 4/);
  assert.match(summary, /regimeType II strongly modulated response/);
  assert.match(summary, /z1\.\d{3} \d\d % of the contacts synchronised/);
  assert.match(summary, /verdictchaotic λ₁ = 0\.\d+ lies \d+\.\d standard errors above zero/);
  assert.match(summary, /taken by the impacts\d\d %/);
  assert.match(summary, /rms of x\d\d % of that without absorber/);
  assert.equal(await page.isVisible("#figure-multipliers"), false);
  assert.equal(await page.isVisible("#figure-windows"), false);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the content security policy lets no inline script run", async () => {
  const response = await fetch(service.url);
  const policy = response.headers.get("content-security-policy");
  assert.match(policy, /default-src 'none'/);
  assert.doesNotMatch(policy, /unsafe/);
});

test("a preset fills the form and draws", async () => {
  const page = await open(browser.context, service.url);
  await page.selectOption("#preset", "fig11");
  await drawn(page, 2);
  assert.equal(await page.inputValue("label:has-text('b, m') input"), "0.015");
  assert.match(await page.textContent("#summary"), /stuck phases1/);
  assert.match(page.url(), /preset=fig11/);
  await page.close();
});

test("a fault is shown at its field, and mending it draws again", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.015&tau_end=300`);
  const b = page.locator("label:has-text('b, m') input");
  await b.fill("-1");
  await page.click("#run");
  await page.waitForSelector("#error-b:not(:empty)");
  assert.match(await page.textContent("#error-b"), /b must lie in/);
  assert.equal(await b.getAttribute("aria-invalid"), "true");
  await b.fill("1,5");
  await page.click("#run");
  await page.waitForFunction(() => document.getElementById("error-b").textContent.includes("number"));
  await b.fill("0.02");
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.textContent("#error-b"), "");
  browser.complaints.length = 0;  // Chromium notes each 422 in its console
  await page.close();
});

test("Fig. 9 is marked at the displacement and at the largest modulus of T, and choosing it leads there", async () => {
  const page = await open(browser.context, `${service.url}/?preset=fig5`, {viewport: {width: 1400, height: 700}});
  assert.deepEqual(await marked(page), [["figure-qr", "Fig. 5"], ["figure-raw_product", "Fig. 5"]]);
  assert.equal(await page.evaluate(() => scrollY), 0, "a link does not scroll");
  await page.click("#motion > summary");
  await page.selectOption("#preset", "fig9");
  await drawn(page, 2);
  assert.deepEqual(await marked(page), [["figure-x", "Fig. 9"], ["figure-largest", "Fig. 9"]]);
  await page.waitForFunction(() => Math.abs(document.getElementById("figure-x").getBoundingClientRect().top) < 40);
  assert.ok(await colours(page, "#plot-largest canvas") > 3);
  await page.close();
});

test("an emptied field of a preset is not filled again by a link", async () => {
  const page = await open(browser.context, `${service.url}/?preset=fig3&tau_end=600&window=100,500`);
  assert.equal(await page.inputValue("label:has-text('b, m') input"), "0.022");
  assert.match(page.url(), /preset=fig3/);
  await page.fill("label[title*='exponents are taken'] input", "");
  await page.click("#run");
  await drawn(page, 2);
  assert.doesNotMatch(page.url(), /preset|window/);
  assert.equal(await page.inputValue("#preset"), "");
  assert.deepEqual(await marked(page), []);
  await page.close();
});

test("a plot without a width is drawn when it gets one", async () => {
  const page = await open(browser.context, service.url);
  const display = (value) => page.evaluate((value) => { document.getElementById("matrices").style.display = value; }, value);
  await display("none");
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.locator("#plot-T canvas").count(), 0);
  await display("");
  await page.waitForSelector("#plot-T canvas");
  assert.ok(await colours(page, "#plot-T canvas") > 3);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("windows are listed with their exponents and verdicts, and the link holds them", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.022&damping=closed_form&tau_end=1709`);
  await page.fill("label:has-text('windows') input", "18.13, 800; 800,1700;");
  await page.click("#run");
  await drawn(page, 2);
  assert.match(page.url(), /windows=18\.13%2C800%3B800%2C1700/);
  const rows = (page) => page.$$eval("#windows tbody tr", (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const first = await rows(page);
  assert.equal(first.length, 2);
  assert.deepEqual(first[1].slice(0, 2), ["800", "1700"]);
  assert.match(first[1][3], /^0\.\d{4} ± 0\.\d{4}$/);
  assert.match(first[1][6], /^−0\.\d{4}$/);
  assert.match(first[1][7], /chaotic|not decided/);
  const again = await open(browser.context, page.url());
  assert.deepEqual(await rows(again), first);
  assert.equal(await again.inputValue("label:has-text('windows') input"), "18.13, 800; 800, 1700");
  await page.close();
  await again.close();
});

test("a faulty list of windows is shown at its field", async () => {
  const page = await open(browser.context, `${service.url}/?tau_end=300`);
  await page.fill("label:has-text('windows') input", "18; 20,abc");
  await page.click("#run");
  await page.waitForSelector("#error-windows:not(:empty)");
  browser.complaints.length = 0;  // Chromium notes each 422 in its console
  await page.close();
});

test("a periodic response shows its type, its period and its Floquet multipliers within the unit circle", async () => {
  const page = await open(browser.context, `${service.url}/?preset=fig11`);
  const summary = await page.textContent("#summary");
  assert.match(summary, /regimeType III two symmetric impacts per cycle/);
  assert.match(summary, /period 1 cycle: 2 impacts, symmetric/);
  assert.ok(await page.isVisible("#figure-multipliers"));
  const dots = await pixels(page, "#plot-multipliers", "before");
  assert.ok(dots >= 4 * 25, `four multipliers, ${dots} pixels`);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("where the energy goes adds up, and the oscillator is compared with itself without absorber", async () => {
  const page = await open(browser.context, `${service.url}/?preset=fig11`);
  const shares = await page.$$eval("#energy .parts b", (list) => list.map((node) => parseFloat(node.textContent)));
  assert.equal(shares.length, 3);
  assert.ok(Math.abs(shares.reduce((a, b) => a + b) - 100) < 1.5, shares.join(" + "));
  const [rms, without] = await page.$$eval("#energy .amount", (list) => list.map((node) => parseFloat(node.textContent)));
  assert.ok(rms > 0 && rms < without);
  await page.close();
});

test("walls with different R leave the manifold's branches out and keep the run's points", async () => {
  const page = await open(browser.context, `${service.url}/?R_plus=0.6&R_minus=0.7&tau_end=600`);
  assert.match(await page.textContent("#warnings"), /same R at both walls/);
  assert.ok(await colours(page, "#plot-manifold") > 3);
  assert.equal(await pixels(page, "#plot-manifold", "c2"), 0);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a free decay is drawn: energy from the start, no amplitude without absorber", async () => {
  const page = await open(browser.context, `${service.url}/?G=0&x0=0.02&tau_end=600`);
  assert.match(await page.textContent("#summary"), /free decay, no forcing/);
  assert.match(await page.textContent("#energy"), /200 mm² there at the start; half is left at τ = \d+/);
  for (const canvas of canvases) assert.ok(await colours(page, canvas) > 3, canvas);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the address holds the request: a link shows the same run", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.018&damping=closed_form&tau_end=400&window=20,300`);
  const first = await page.textContent("#summary");
  const again = await open(browser.context, page.url());
  const strip = (text) => text.replace(/answered in.*/, "");
  assert.equal(strip(await again.textContent("#summary")), strip(first));
  await page.close();
  await again.close();
});

test("a run without impacts is drawn and says that it has no exponents", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.5&tau_end=300`);
  assert.match(await page.textContent("#warnings"), /no exponents/);
  assert.match(await page.textContent("#summary"), /regimenone no impacts/);
  assert.equal(await page.isVisible("#figure-multipliers"), false);
  assert.ok(await colours(page, "#plot-x canvas") > 3);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("zooming into one plot over tau zooms the others", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.015&tau_end=300`);
  const over = page.locator("#plot-x .u-over"), box = await over.boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, {steps: 5});
  await page.mouse.up();
  await page.waitForTimeout(200);
  for (const name of ["relative", "largest", "z", "T", "differences"]) {
    await page.hover(`#plot-${name} .u-over`, {position: {x: 5, y: 40}});
    await page.waitForTimeout(100);
    const tau = Number((await page.textContent(`#plot-${name} .u-legend .u-series:first-child .u-value`)).trim());
    assert.ok(tau > 100 && tau < 140, `tau at the left edge of ${name}: ${tau}`);
  }
  await page.close();
});

for (const query of ["", "?preset=fig11", "?b=0.022&tau_end=900&windows=18,400;400,900"])
  test(`on a narrow screen nothing is wider than the screen: ${query || "the first view"}`, async () => {
    const page = await open(browser.context, `${service.url}/${query}`, {viewport: {width: 390, height: 800}});
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    const beyond = await page.$$eval("figure :is(canvas, .stack, .compare, .u-legend)", (nodes) => nodes.filter((n) => n.offsetWidth && n.getBoundingClientRect().right > innerWidth).map((n) => n.closest("figure").id));
    assert.deepEqual(beyond, []);
    await page.close();
  });

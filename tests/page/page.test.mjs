// The page in real Chromium, as a visitor uses it.
import {after, before, test} from "node:test";
import assert from "node:assert/strict";
import {startBrowser, open, drawn} from "./browser.mjs";
import {startService} from "../service.mjs";

let service, browser;
before(async () => { service = await startService(); browser = await startBrowser(); });
after(async () => { await browser.stop(); await service.stop(); });

/** How many different colours a canvas shows: an empty one has one. */
const colours = (page, selector) => page.evaluate((selector) => {
  const canvas = document.querySelector(selector);
  const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return new Set(new Uint32Array(data.buffer)).size;
}, selector);

const canvases = ["#plot-x canvas", "#plot-relative canvas", "#plot-qr canvas", "#plot-eigenvalues canvas", "#plot-raw_product canvas", "#plot-portrait", "#plot-velocities"];

test("the first thing that a visitor sees is the paper's Fig. 3, computed and drawn, with nothing in the console", async () => {
  const page = await open(browser.context, service.url);
  assert.equal(await page.inputValue("#preset"), "fig3");
  for (const canvas of canvases) assert.ok(await colours(page, canvas) > 3, canvas);
  const summary = await page.textContent("#summary");
  assert.match(summary, /λ₁ \(qr\)0\.\d{4} ± 0\.\d{4}/);
  assert.match(summary, /positive exponents \(qr\)1/);
  assert.match(summary, /positive \(raw_product\)4/);
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
  assert.ok(await colours(page, "#plot-x canvas") > 3);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("zooming into one plot over tau zooms the other", async () => {
  const page = await open(browser.context, `${service.url}/?b=0.015&tau_end=300`);
  const over = page.locator("#plot-x .u-over"), box = await over.boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, {steps: 5});
  await page.mouse.up();
  await page.waitForTimeout(200);
  await page.hover("#plot-relative .u-over", {position: {x: 5, y: 40}});
  await page.waitForTimeout(100);
  const tau = Number((await page.textContent("#plot-relative .u-legend .u-series:first-child .u-value")).trim());
  assert.ok(tau > 100 && tau < 140, `tau at the left edge: ${tau}`);
  await page.close();
});

test("on a narrow screen nothing is wider than the screen", async () => {
  const page = await open(browser.context, service.url, {viewport: {width: 390, height: 800}});
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await page.close();
});

// The motions tab in Chromium.
import assert from "node:assert/strict";
import {test} from "node:test";
import {drawn, found} from "./browser.mjs";
import {
  asked,
  beyond,
  browser,
  cellsByName,
  downloaded,
  fits,
  narrow,
  newPage,
  pixels,
  service,
  visit,
} from "./support.mjs";

const query = "tab=motions&parameter=b&from=0.014&to=0.018&count=9&preset=fig11";
const canvas = "#plot-motions canvas";
const input = (name) => `#motions-fields [aria-describedby='motions-error-${name}']`;

test("motions from several starts, stable and unstable branches and named special points are drawn", async () => {
  const page = await visit(`?${query}`);
  assert.match(
    await page.textContent("#motions-count"),
    /^\d+ runs from several starts, \d+ branches, \d+ special points$/,
  );
  for (const name of ["c2", "c3", "wall"]) assert.ok((await pixels(page, canvas, name)) > 30, name);
  const specials = await cellsByName(page, "#motions-special tbody tr");
  assert.equal(specials["torus: quasi-periodic motion begins"][0], "16.286");
  assert.equal(specials.fold[0], "17.2747");
  assert.equal(specials.end[3], "the parameter reaches the end of its range");
  await page.click("#figure-motions button.menu");
  const csv = await downloaded(page, "#data button:text-is('CSV')");
  assert.match(csv.text, /^b \(mm\),largest \|x\| \(mm\),rms of x \(mm\),z,kind\n/);
  assert.match(csv.text, /,"branch 1, unstable"\n/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the marker lists the motions at its place, and each opens in Simulation from its state", async () => {
  const page = await visit(`?${query}`);
  const at = () => page.textContent("#motions-at");
  assert.match(await at(), /^At b = 15 mm: *stable, largest \|x\| \(mm\): 2\.6/);
  await page.focus("#plot-motions .grip");
  for (let k = 0; k < 150; ++k) await page.keyboard.press("ArrowRight");
  assert.match(await at(), /^At b = 16\.2 mm:.*stable.*unstable, largest \|x\| \(mm\): 5\.\d/);
  await page.click("#motions-at button:has-text('unstable')");
  await drawn(page, 1);
  const fields = new URL(page.url()).searchParams;
  assert.ok(Math.abs(fields.get("b") - 0.0162) < 1e-4, fields.get("b"));
  for (const name of ["x0", "x_dot0", "y0", "y_dot0"]) assert.ok(fields.get(name), name);
  await page.goBack();
  await page.waitForSelector("#panel-motions:not([hidden])");
  assert.equal(await page.getAttribute("#motions-results", "data-done"), "1");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a click on a branch opens the orbit there", async () => {
  const page = await visit(`?${query}`);
  const over = page.locator("#plot-motions .over");
  const {width, height} = await over.boundingBox();
  // Scans downwards until an orbit is near the pointer.
  for (let y = 4; y < height; y += 8) {
    await over.hover({position: {x: 0.3 * width, y}});
    if (await page.getAttribute("#plot-motions .over", "title")) {
      await over.click({position: {x: 0.3 * width, y}});
      break;
    }
  }
  await drawn(page, 1);
  assert.match(page.url(), /preset=fig11&b=0\.01[45]\d*&x0=/);
  await page.close();
});

test("the search can be stopped, keeps what it has, and an edited form marks the results as stale", async () => {
  const page = await newPage();
  await page.route("**/v1/continue", () => {}); // never answered
  await page.goto(`${service.url}/?${query}`);
  await page.waitForFunction(() =>
    /^[1-9]/.test(document.getElementById("motions-count").textContent),
  );
  await page.click("#motions-cancel");
  await page.waitForFunction(
    () => document.getElementById("motions-message").textContent === "cancelled",
  );
  assert.match(
    await page.textContent("#motions-count"),
    /^\d+ runs from several starts, 0 branches/,
  );
  await page.fill(input("to"), "17");
  assert.ok(await page.$eval("#motions-results", (node) => node.classList.contains("stale")));
  await page.close();
  browser.complaints.length = 0; // the aborted request
});

test("where one of its requests fails for a while, the other one is stopped and both are repeated", async () => {
  const page = await newPage();
  const begun = {};
  /** Gives the first request to a route to `first`, and the later ones to the service. */
  const route = (path, first) =>
    page.route(`**/v1/${path}`, (each) => {
      if (begun[path]) return each.continue();
      begun[path] = each.request();
      return first(each);
    });
  await route("continue", () => {}); // never answered
  await route("sweep", (each) => each.fulfill({status: 503, json: {detail: "too busy"}}));
  const stopped = page.waitForEvent("requestfailed", (request) => request === begun.continue);
  await page.goto(`${service.url}/?${query}`);
  await stopped;
  await found(page, 1);
  await page.close();
  browser.complaints.length = 0; // the 503
});

test("a range is required, an error is shown at its field, and the address holds the request", async () => {
  const page = await visit(`?${query}`);
  await page.selectOption(input("parameter"), "R");
  assert.equal(await page.inputValue(input("from")), "", "the range belongs to the parameter");
  await page.click("#motions-form .go");
  await page.waitForSelector("#motions-error-from:not(:empty)");
  const requests = asked(page, "/v1/continue");
  await page.fill(input("from"), "0.5");
  await page.fill(input("to"), "0.7");
  await page.click("#motions-form .go");
  await found(page, 2);
  assert.equal(requests[0].parameter, "R");
  assert.match(page.url(), /parameter=R&from=0\.5&to=0\.7&count=9&preset=fig11$/);
  browser.complaints.length = 0; // Chromium logs the 422
  await page.close();
});

test("an end of the range beyond that of the parameter is marked", async () => {
  const page = await newPage();
  await page.goto(`${service.url}/?tab=motions&parameter=R&from=0.5&to=1.2`);
  await page.waitForSelector("#motions-error-to:has-text('R must lie in [0, 1]')");
  assert.equal(await page.getAttribute(input("to"), "aria-invalid"), "true");
  browser.complaints.length = 0; // Chromium logs the 422
  await page.close();
});

test("Back and Forward lead through the searches, and another tab keeps what is not sent yet", async () => {
  const page = await visit(`?${query}`);
  await page.fill(input("to"), "17");
  await page.click("#motions-form .go");
  await found(page, 2);
  await page.goBack();
  await found(page, 3);
  assert.match(page.url(), /to=0\.018/);
  await page.goForward();
  await found(page, 4);
  assert.match(page.url(), /to=0\.017/);
  await page.fill(input("to"), "16.5");
  await page.click("#tab-simulation");
  await drawn(page, 1);
  await page.click("#tab-motions");
  await page.waitForSelector("#panel-motions:not([hidden])");
  assert.equal(await page.inputValue(input("to")), "16.5");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a search over lambda places each motion at its value", async () => {
  const page = await visit("?tab=motions&parameter=lambda&from=1&to=1.5&count=5&preset=fig11");
  assert.equal(await page.textContent("#motions-message"), "");
  assert.ok((await pixels(page, canvas, "c2")) > 30);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the tab fits a narrow screen", async () => {
  const page = await visit(`?${query}`, narrow);
  assert.ok(await fits(page));
  assert.deepEqual(await beyond(page, "#panel-motions :is(canvas, select, figure, button)"), []);
  await page.close();
});

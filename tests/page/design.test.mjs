// The design tab in Chromium.
import assert from "node:assert/strict";
import {test} from "node:test";
import {drawn} from "./browser.mjs";
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

const search = "b_count=6&f_count=9&starts=one&cycles=40&transient_cycles=40";
const machine = "m1=2&f0=8&damping_ratio=0.01";
const query = `tab=design&${machine}&m2=0.04&f=7,9&acceleration=5&R=0.2,0.6&${search}`;
const input = (name) => `#design-fields [aria-describedby='design-error-${name}']`;

test("the best absorber stands beside the machine without one and with a tuned mass damper", async () => {
  const page = await visit(`?${query}`);
  const cards = await page.$$eval("#design-cards dd", (nodes) => nodes.map((n) => n.textContent));
  assert.match(cards[0], /^99 mm largest/);
  assert.match(cards[1], /^[345]\d(\.\d)? mm [345]\d % of that$/);
  assert.match(cards[2], /^17\.7 mm 18 % of that$/);
  assert.match(
    await page.textContent("#design-sentence"),
    /^A cavity with b = .* for a ball of 40 g/,
  );
  for (const name of ["soft", "c1", "c4"])
    assert.ok((await pixels(page, "#plot-design-response canvas", name)) > 100, name);
  assert.ok((await pixels(page, "#plot-design-map", "c2")) > 30);
  const margins = await cellsByName(page, "#design-margins tbody tr");
  assert.match(margins.b[1], /^× [\d.]+ to [\d.]+$/);
  assert.match(await page.textContent("#design-walls"), /impacts per second, of up to .* m\/s/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("each absorber tried is one dot, of its most exact value: the best one is the lowest", async () => {
  const page = await visit(`?${query}&over=mean`);
  await page.click("#figure-design-map button.menu");
  const {text} = await downloaded(page, "#data button:text-is('CSV')");
  const tried = text
    .split("\n")
    .map((row) => row.split(","))
    .filter(([b]) => Number(b) > 0);
  const names = tried.map(([b, , kind]) => `${b} ${kind}`);
  assert.equal(new Set(names).size, tried.length);
  const [best] = tried.sort((one, other) => one[1] - other[1]);
  const sentence = await page.textContent("#design-sentence");
  assert.match(sentence, new RegExp(`^A cavity with b = ${Number(best[0]).toPrecision(3)} mm`));
  await page.close();
});

test("the worst case opens in Simulation, and Back returns to the design without a new search", async () => {
  const page = await visit(`?${query}`);
  const requests = asked(page, "/v1/design");
  await page.click("#design-simulate");
  await drawn(page, 1);
  const fields = new URL(page.url()).searchParams;
  for (const name of ["m1", "f0", "b", "R", "m2", "f", "acceleration"]) assert.ok(fields.get(name));
  await page.goBack();
  await page.waitForSelector("#panel-design:not([hidden])");
  assert.match(await page.textContent("#design-sentence"), /^A cavity/);
  assert.equal(requests.length, 0);
  await page.close();
});

test("without a request in the address the form shows an example and waits", async () => {
  const page = await newPage();
  const requests = asked(page, "/v1/design");
  await page.goto(`${service.url}/?tab=design`);
  await page.waitForSelector(input("f"));
  assert.equal(await page.inputValue(input("f")), "7, 9");
  assert.equal(requests.length, 0);
  await page.fill(input("f"), "-1, 9");
  await page.click("#design-form .go");
  await page.waitForSelector("#design-error-f:not(:empty)");
  assert.deepEqual(requests[0].f, [-1, 9]);
  browser.complaints.length = 0; // Chromium logs the 422
  await page.close();
});

test("the design fits a narrow screen", async () => {
  const page = await visit(`?${query}`, narrow);
  assert.ok(await fits(page));
  assert.deepEqual(await beyond(page, "#panel-design :is(canvas, select, figure, button)"), []);
  await page.close();
});

test("under a shock the absorbers are compared without a band, and the best one opens under it", async () => {
  const shock = encodeURIComponent("kind=half_sine; acceleration_m_s2=30; duration_s=0.03");
  const page = await visit(
    `?tab=design&${machine}&m2=0.04&R=0.2&forcing=${shock}&b_count=6&cycles=40`,
  );
  assert.match(await page.textContent("#design-sentence"), /under this load/);
  assert.equal(await page.isVisible("#figure-design-response"), false);
  assert.match(await page.textContent("#design-walls"), /of the load\.$/);
  await page.click("#design-simulate");
  await drawn(page, 1);
  assert.match(page.url(), /forcing=/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("where the machine alone does not decay, its time and the shares of it are left out", async () => {
  const page = await visit(
    "?tab=design&m1=2&f0=8&damping_ratio=0&m2=0.04&R=0.4&initial_velocity=0.3&b_count=3&cycles=60",
  );
  const cards = await page.$$eval("#design-cards dd", (nodes) => nodes.map((n) => n.textContent));
  assert.equal(cards[0], "– time to a tenth of the energy");
  for (const card of cards.slice(1)) assert.match(card, /^[\d.]+ s$/);
  await page.close();
});

test("after an impulse the times of decay are compared, and the worst case opens as a free decay", async () => {
  const page = await visit(
    `?tab=design&${machine}&m2=0.04&R=0.2&initial_velocity=0.2,0.5&b_count=6&cycles=60`,
  );
  const cards = await page.$$eval("#design-cards dd", (nodes) => nodes.map((n) => n.textContent));
  assert.match(cards[0], /^2\.3 s time to a tenth of the energy/);
  assert.match(cards[2], /^0\.58\d s /);
  assert.equal(await page.isVisible("#figure-design-response"), false);
  assert.ok((await pixels(page, "#plot-design-map", "c1")) > 20);
  await page.click("#design-simulate");
  await drawn(page, 1);
  const fields = new URL(page.url()).searchParams;
  assert.equal(fields.get("F"), "0");
  assert.ok(Number(fields.get("x_dot0")) > 0.003);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

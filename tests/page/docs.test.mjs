// The page of the OpenAPI document: content, links, copying and trying examples.
import assert from "node:assert/strict";
import {mkdtemp, rm, writeFile} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";
import {startService} from "../service.mjs";
import {browser, findingsInBothSchemes, fits, newPage, service} from "./support.mjs";

/** The page at a hash, after its script has started. */
async function visit(place = "", {url = service.url, viewport} = {}) {
  const page = await newPage();
  if (viewport) await page.setViewportSize(viewport);
  await page.goto(`${url}/docs${place}`);
  await page.waitForSelector("#docs-message[data-done]", {state: "attached"});
  return page;
}

const openapi = async () => (await fetch(`${service.url}/v1/openapi.json`)).json();
const isOpen = (page, id) => page.$eval(`[id="${id}"]`, (node) => node.closest("details").open);
/** Waits until the element is in view. */
const inView = (page, id) =>
  page.waitForFunction((id) => {
    const {top, bottom} = document.getElementById(id).getBoundingClientRect();
    return bottom > 0 && top < innerHeight;
  }, id);
const narrow = {width: 360, height: 740};

/** Clicks "Try it" of an operation's nth example; returns status and text of the response. */
async function tried(page, id, n = 0) {
  const example = page.locator(`#${id} .example`).nth(n);
  const button = example.getByRole("button", {name: "Try it"});
  await button.click();
  await button.waitFor(); // it says "Stop" meanwhile
  const answer = example.locator(".answer");
  return {
    status: await example.locator(".message").textContent(),
    text: await answer.textContent(),
  };
}

test("every operation and schema of the document is on the page and in its contents", async () => {
  const {paths, components, info} = await openapi();
  const page = await visit();
  for (const [path, methods] of Object.entries(paths))
    for (const [method, {operationId, summary}] of Object.entries(methods)) {
      const title = `${method.toUpperCase()} ${path} ${summary}`;
      assert.equal(await page.textContent(`details:has(> [id="${operationId}"]) h3`), title);
      assert.ok(await page.$(`#docs-toc a[href="#${operationId}"]`), operationId);
    }
  const operations = Object.values(paths).flatMap((methods) => Object.values(methods));
  assert.equal(await page.locator("details.operation").count(), operations.length);
  const names = await page.$$eval("#docs-schemas > details > [id]", (all) => all.map(({id}) => id));
  assert.deepEqual(
    names,
    Object.keys(components.schemas).map((name) => `schema-${name}`),
  );
  const {commit} = await (await fetch(`${service.url}/version`)).json();
  const head = await page.textContent("#docs-head");
  for (const said of [info.version, commit, info.description, `${service.url}/`, "Bearer KEY"])
    assert.ok(head.includes(said), said);
  await page.close();
});

test("an operation shows each field with its type, range, default and meaning, and each status", async () => {
  const page = await visit("#simulate_by_query");
  const {paths} = await openapi();
  const {parameters, responses} = paths["/v1/simulate"].get;
  const row = await page.$eval('[id="simulate_by_query.b"]', (tr) =>
    [...tr.cells].map((cell) => cell.textContent),
  );
  assert.deepEqual(row.slice(0, 2), ["b", "number, 1e-9 to 1000, default 0.022"]);
  assert.match(row[2], /^clearance: half-width of the cavity/);
  const fields = await page.$$eval('tr[id^="simulate_by_query."]', (rows) => rows.length);
  assert.equal(fields, parameters.length);
  await page.getByText("Other statuses").first().click();
  await page.getByText("304 If-None-Match").first().waitFor();
  const said = await page.$$eval(
    "#simulate_by_query summary code, #simulate_by_query p > code",
    (all) => all.map(({textContent}) => textContent),
  );
  for (const status of Object.keys(responses)) assert.ok(said.includes(status), status);
  await page.close();
});

test("a link opens the elements around its target and shows it", async () => {
  for (const place of ["sweep", "schema-Impacts", "identify.fixed"]) {
    const page = await visit(`#${place}`);
    assert.ok(await isOpen(page, place.split(".")[0]), place);
    await inView(page, place);
    await page.close();
  }
  const page = await visit();
  assert.equal(await page.isVisible(".fields"), false, "folded");
  await page.click("#docs-toc a[href='#manifold']");
  await page.waitForSelector("#manifold .fields");
  await inView(page, "manifold");
  await page.click("details:has(> #manifold) > summary");
  await page.click("#docs-toc a[href='#manifold']");
  await page.waitForSelector("#manifold .fields");
  await page.close();
});

test("an example is copied as a curl command", async () => {
  await browser.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  const page = await visit("#simulate_by_query");
  const copied = async (id, n) => {
    const example = page.locator(`#${id} .example`).nth(n);
    await example.getByRole("button", {name: "Copy curl"}).click();
    await example.getByText("copied").waitFor();
    return page.evaluate(() => navigator.clipboard.readText());
  };
  const address = `${service.url}/v1/simulate`;
  const line = `curl -s '${address}?preset=fig11&include=regime,energy'`;
  assert.equal(await copied("simulate_by_query", 0), line);
  await page.goto(`${service.url}/docs#simulate`);
  const {paths} = await openapi();
  const {examples} = paths["/v1/simulate"].post.requestBody.content["application/json"];
  const machine = Object.keys(examples).indexOf("machine");
  const body = JSON.stringify(examples.machine.value);
  assert.equal(await copied("simulate", machine), `curl -s ${address} -d '${body}'`);
  await page.goto(`${service.url}/docs#identify`);
  const file = `curl -s ${service.url}/v1/identify -H 'Content-Type: text/csv' --data-binary '@FILE'`;
  assert.equal(await copied("identify", 1), file);
  await page.close();
});

test("trying an example shows status, time and the first lines of the response", async () => {
  const page = await visit("#simulate_by_query");
  const got = await tried(page, "simulate_by_query");
  assert.match(got.status, /^200 OK · \d+ ms · \d+\.\d kB · beginning of \d+ lines$/);
  assert.match(got.text, /^\{\n {2}"version": "\d/);
  assert.ok(got.text.split("\n").length <= 60);
  await page.goto(`${service.url}/docs#sweep`);
  const swept = await tried(page, "sweep");
  assert.match(swept.status, /^200 OK · \d+ ms/);
  assert.equal(JSON.parse(swept.text.split("\n")[0]).type, "start");
  await page.goto(`${service.url}/docs#openapi`);
  const long = await tried(page, "openapi");
  assert.match(long.text, /"openapi": "3\.1\.0"/);
  assert.ok(long.text.length < 7000);
  await page.goto(`${service.url}/docs#healthz`);
  assert.equal((await tried(page, "healthz")).text, '{\n  "status": "ok"\n}');
  await page.close();
});

test("a response of the size limit is complete, a larger one truncated", async () => {
  const page = await visit("#healthz");
  for (const [bytes, said] of [
    [1 << 20, "1048.6 kB"],
    [(1 << 20) + 1, "more than 1048.6 kB, truncated"],
  ]) {
    await page.route("**/healthz", (route) => route.fulfill({body: "x".repeat(bytes)}));
    const {status} = await tried(page, "healthz");
    assert.match(status, new RegExp(`^200 OK · \\d+ ms · ${said} · beginning`));
    await page.unroute("**/healthz");
  }
  await page.close();
});

test("an example asks for a required key, sends it, and all commands then contain it", async (t) => {
  const folder = await mkdtemp(join(tmpdir(), "vines-docs-"));
  const file = join(folder, "keys");
  await writeFile(file, "a-key-of-the-tests-0\n");
  const closed = await startService(["--api-key-file", file]);
  t.after(async () => {
    await closed.stop();
    await rm(folder, {recursive: true});
  });
  const page = await newPage();
  await page.goto(`${closed.url}/docs#presets`);
  const answer = tried(page, "presets");
  await page.fill("dialog input", "a-key-of-the-tests-0");
  await page.keyboard.press("Enter");
  assert.match((await answer).status, /^200 OK/);
  const line = await page.textContent("#presets .example code");
  assert.equal(line, `curl -s -H "Authorization: Bearer $KEY" '${closed.url}/v1/presets'`);
  await page.close();
  // The console notes the 401 that made the page ask for a key.
  const told = browser.complaints.splice(0);
  assert.ok(
    told.every((text) => text.includes("401")),
    told.join(),
  );
});

test("the page reports a service that answers 503 or cannot be reached", async () => {
  const page = await newPage();
  await page.route("**/version", (route) =>
    route.fulfill({status: 503, json: {detail: "too busy"}}),
  );
  await page.goto(`${service.url}/docs`);
  await page.waitForSelector("#docs-message.fault");
  assert.equal(
    await page.textContent("#docs-message"),
    "The version of the server cannot be loaded: too busy.",
  );
  await page.unroute("**/version");
  await page.reload();
  await page.waitForSelector("#docs-message[data-done]", {state: "attached"});
  await page.click("#docs-toc a[href='#version']");
  await page.route("**/version", (route) => route.abort());
  const example = page.locator("#version .example");
  await example.getByRole("button", {name: "Try it"}).click();
  await example.getByText("the server does not answer").waitFor();
  await page.close();
  const told = browser.complaints.splice(0);
  assert.ok(
    told.every((text) => /503|ERR_FAILED/.test(text)),
    told.join(),
  );
});

test("without JavaScript the page shows the interface and links to the document", async () => {
  const html = await (await fetch(`${service.url}/docs`)).text();
  assert.match(html, /<noscript>.*href="v1\/openapi\.json".*<\/noscript>/);
  assert.match(html, /<tr id="simulate_by_query\.b">.*half-width of the cavity/);
  const main = await (await fetch(`${service.url}/`)).text();
  assert.match(main, /<a href="docs">/, "the page leads here");
});

test("the page fits a phone of 360 px", async () => {
  const page = await visit("", {viewport: narrow});
  assert.ok(await fits(page), "folded");
  await page.click("#docs-unfold");
  await page.waitForSelector("#schema-Problem .fields");
  assert.ok(await fits(page), "unfolded");
  await tried(page, "sweep", 1);
  assert.ok(await fits(page), "with an answer");
  await page.close();
});

test("the keyboard reaches the contents, an operation and its example", async () => {
  const page = await visit();
  await page.focus("#docs-contents > summary");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.hash), "#simulate_by_query");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#simulate_by_query .example");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#simulate_by_query .answer:not([hidden])");
  await page.close();
});

test("axe-core finds nothing, light and dark", async () => {
  const page = await visit("#sweep", {viewport: {width: 1440, height: 900}});
  await page.click("#docs-toc a[href='#identify']");
  await page.click("#docs-toc a[href='#simulate_by_query']");
  await tried(page, "simulate_by_query");
  await page.evaluate(() => {
    location.hash = "#schema-Energy.without_absorber.rms";
  });
  await page.waitForSelector("tr:target");
  assert.deepEqual(await findingsInBothSchemes(page), []);
  await page.close();
});

test("files are named by content, scripts come from the service, and the console is silent", async () => {
  const answer = await fetch(`${service.url}/docs`);
  assert.match(answer.headers.get("content-type"), /^text\/html/);
  assert.match(answer.headers.get("content-security-policy"), /script-src 'self'/);
  const cached = (response) => response.headers.get("cache-control") ?? "";
  assert.doesNotMatch(cached(answer), /immutable/);
  const files = (await answer.text()).match(/(?<=(?:src|href)=")[0-9a-f]{12}\/docs\/[^"]+/g);
  assert.deepEqual(
    files.map((path) => path.replace(/^.*\//, "")),
    ["docs.css", "docs.js"],
  );
  for (const path of files)
    assert.match(cached(await fetch(`${service.url}/${path}`)), /immutable/, path);
  assert.deepEqual(browser.complaints, []);
});

test("the documents are pages below /help, and each link of them and of the explanations leads to a place", async () => {
  const texts = new Map();
  const read = async (address) => {
    const answer = await fetch(address);
    assert.equal(answer.status, 200, address);
    return answer.text();
  };
  const check = async (from) => {
    const links = (await read(from)).matchAll(/(?:href|src)="([^"]+)"/g);
    const own = [...links].map(([, link]) => new URL(link, from));
    for (const {href, hash, origin, pathname} of own) {
      if (origin !== service.url) continue;
      const address = href.split("#")[0];
      if (!texts.has(address)) texts.set(address, await read(address));
      const anchor = decodeURIComponent(hash.slice(1));
      const place = anchor === "" || texts.get(address).includes(`id="${anchor}"`);
      assert.ok(place || pathname === "/docs", `${from} links to ${href}`);
    }
  };
  await check(`${service.url}/help`);
  const documents = [...texts.keys()].filter((address) => address.includes("/help/"));
  assert.ok(documents.length > 8);
  for (const address of documents) await check(address);
  await check(`${service.url}/`);
});

// Chromium for the page's tests: its headless shell, which draws the same pages without the windows
// and menus that are a third of a new page's time.
import {mkdtemp, rm} from "node:fs/promises";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const {chromium} = require("playwright-core");

/**
 * True for requests aborted by the page because newer input replaced them, or an example read as much
 * as it shows. Chromium sometimes also reports a fully read stream as aborted.
 */
const brokenOff = (request) =>
  /\/(v1\/(simulate|sweep|continue|design|identify)|healthz)\b/.test(request.url()) &&
  request.failure().errorText === "net::ERR_ABORTED";

/**
 * Starts Chromium with a fresh profile. `complaints` collects console errors and warnings, uncaught
 * exceptions and failed requests of all pages.
 */
export async function startBrowser() {
  const profile = await mkdtemp(join(tmpdir(), "vines-page-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium-headless-shell",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
  context.setDefaultTimeout(120000); // slow machines must not fail the tests
  const complaints = [];
  context.on("page", (page) => {
    page.on("console", (message) => {
      if (message.type() === "error" || message.type() === "warning")
        complaints.push(message.text());
    });
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("requestfailed", (request) => {
      if (!brokenOff(request) && !closing.has(page))
        complaints.push(`${request.url()}: ${request.failure().errorText}`);
    });
  });
  const stop = async () => {
    await context.close();
    await rm(profile, {recursive: true, force: true});
  };
  return {context, complaints, stop};
}

// Pages that are being closed, which aborts their requests.
const closing = new Set();

// Empty pages that tests have closed: a visit with one takes half of the time of one with a new page.
const spare = [];

/** An empty page. Closed, it is emptied of all that a test adds to it, for the next one. */
export async function emptyPage(context) {
  const page = spare.pop() ?? (await context.newPage());
  page.close = async () => {
    await page.evaluate(() => sessionStorage.clear());
    closing.add(page);
    await page.goto("about:blank");
    closing.delete(page);
    await page.unrouteAll();
    page.removeAllListeners("request");
    await page.mouse.move(-1, -1);
    await page.setViewportSize({width: 1280, height: 720});
    await page.emulateMedia({
      colorScheme: null,
      forcedColors: null,
      media: null,
      reducedMotion: null,
    });
    spare.push(page);
  };
  return page;
}

/**
 * Opens a page and waits for its first result: a drawn simulation, a complete sweep, or the
 * measurement form.
 */
export async function open(context, url, options = {}) {
  const page = await emptyPage(context);
  const {viewport, ...media} = options;
  if (viewport) await page.setViewportSize(viewport);
  await page.emulateMedia(media);
  await page.goto(url);
  if (url.includes("tab=measurement"))
    await page.waitForFunction(() => document.getElementById("measure-preset").value);
  else if (url.includes("tab=motions")) await found(page, 1);
  else if (url.includes("tab=design")) await designed(page, 1);
  else await (url.includes("tab=sweep") ? swept : drawn)(page, 1);
  return page;
}

/** Waits for the n-th result of a tab; its error says what the tab shows instead. */
const done = (id) => async (page, n) => {
  try {
    await page.waitForFunction(
      ([id, n]) => Number(document.getElementById(id).dataset.done ?? 0) >= n,
      [id, n],
      {polling: 50}, // ms: an overloaded machine draws no frames for long
    );
  } catch (error) {
    const shown = await page.evaluate(
      (id) => [
        {...document.getElementById(id).dataset},
        document.getElementById(id.replace("results", "message")).textContent,
      ],
      id,
    );
    throw new Error(`${error.message} ${id} ${n}: ${JSON.stringify(shown)} ${page.url()}`);
  }
};
/** Resolves after n animation frames. */
export const frames = (page, n) =>
  page.evaluate(async (n) => {
    for (let k = 0; k < n; ++k) await new Promise(requestAnimationFrame);
  }, n);
/** Resolves when pending drawing is done. */
export const painted = (page) => frames(page, 2);

/** Gives the page another size; resolves when it has been drawn in it. */
export async function resize(page, size) {
  await page.setViewportSize(size);
  await page.waitForFunction(({width}) => innerWidth === width, size);
  await painted(page);
}

export const drawn = done("results");
export const identified = done("measure-results");
export const swept = done("sweep-results");
export const found = done("motions-results");
export const designed = done("design-results");

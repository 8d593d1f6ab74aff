// A real Chromium for the page's tests.
import {mkdtemp, rm} from "node:fs/promises";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const {chromium} = require("playwright-core");

/**
 * A page breaks off what a newer input has overtaken. (And Chromium now and then calls a request
 * aborted whose stream a script has read to its end.)
 */
const brokenOff = (request) =>
  /\/v1\/(simulate|sweep|identify)\b/.test(request.url()) &&
  request.failure().errorText === "net::ERR_ABORTED";

/**
 * Chromium with a profile of its own; what its pages write to the console as errors, and what they
 * refuse to load, is collected.
 */
export async function startBrowser() {
  const profile = await mkdtemp(join(tmpdir(), "vines-page-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
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
  context.setDefaultTimeout(120000); // a busy machine is slow, not wrong
  const complaints = [];
  context.on("page", (page) => {
    page.on("console", (message) => {
      if (message.type() === "error" || message.type() === "warning")
        complaints.push(message.text());
    });
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("requestfailed", (request) => {
      if (!brokenOff(request)) complaints.push(`${request.url()}: ${request.failure().errorText}`);
    });
  });
  const stop = async () => {
    await context.close();
    await rm(profile, {recursive: true, force: true});
  };
  return {context, complaints, stop};
}

/**
 * Opens a page and waits until its first answer is drawn: of a simulation, or of a whole sweep; or
 * until a record can be chosen.
 */
export async function open(context, url, options = {}) {
  const page = await context.newPage();
  if (options.viewport) await page.setViewportSize(options.viewport);
  if (options.colorScheme) await page.emulateMedia({colorScheme: options.colorScheme});
  await page.goto(url);
  if (url.includes("tab=measurement"))
    await page.waitForFunction(() => document.getElementById("measure-preset").value);
  else await (url.includes("tab=sweep") ? swept : drawn)(page, 1);
  return page;
}

const done = (id) => (page, n) =>
  page.waitForFunction(
    ([id, n]) => Number(document.getElementById(id).dataset.done ?? 0) >= n,
    [id, n],
  );
/** Resolves when the page has drawn what it heard of until now. */
export const painted = (page) =>
  page.evaluate(
    () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))),
  );

export const drawn = done("results");
export const identified = done("measure-results");
export const swept = done("sweep-results");

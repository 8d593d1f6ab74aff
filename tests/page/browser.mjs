// A real Chromium for the page's tests.
import {mkdtemp, rm} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {createRequire} from "node:module";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const {chromium} = require("playwright-core");

/** Chromium with a profile of its own; what its pages write to the console as errors, and what they refuse to load, is collected. */
export async function startBrowser() {
  const profile = await mkdtemp(join(tmpdir(), "vines-page-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
  const complaints = [];
  context.on("page", (page) => {
    page.on("console", (message) => { if (message.type() === "error" || message.type() === "warning") complaints.push(message.text()); });
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("requestfailed", (request) => complaints.push(`${request.url()}: ${request.failure().errorText}`));
  });
  return {context, complaints, stop: async () => { await context.close(); await rm(profile, {recursive: true, force: true}); }};
}

/** Opens a page and waits until its n-th answer is drawn. */
export async function open(context, url, options = {}) {
  const page = await context.newPage();
  if (options.viewport) await page.setViewportSize(options.viewport);
  if (options.colorScheme) await page.emulateMedia({colorScheme: options.colorScheme});
  await page.goto(url);
  await drawn(page, 1);
  return page;
}

export const drawn = (page, n) => page.waitForFunction((n) => Number(document.getElementById("results").dataset.done ?? 0) >= n, n, {timeout: 20000});

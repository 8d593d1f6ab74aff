// A running service and a real Chromium for the page's tests.
import {spawn} from "node:child_process";
import {mkdtemp, rm} from "node:fs/promises";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {createRequire} from "node:module";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const {chromium} = require("playwright-core");

/** Starts the program given by VINES on a free port; resolves to {url, stop}. */
export async function startService() {
  const program = process.env.VINES ?? new URL("../../build/release/vines", import.meta.url).pathname;
  const child = spawn(program, ["serve", "--port", "0"], {stdio: ["ignore", "pipe", "ignore"]});
  const url = await new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      const found = text.match(/listens on (\S+)/);
      if (found) resolve(found[1]);
    });
    child.on("exit", (code) => reject(new Error(`${program} ended with ${code}: ${text}`)));
  });
  return {url, stop: () => new Promise((resolve) => { child.removeAllListeners("exit"); child.on("exit", resolve); child.kill("SIGTERM"); })};
}

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

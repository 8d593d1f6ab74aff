#!/usr/bin/env -S node
// scripts/screenshots FOLDER [QUERY]: pictures of the page, wide and narrow, light and dark.
import {startBrowser, open} from "../tests/page/browser.mjs";
import {startService} from "../tests/service.mjs";

const [folder = ".", query = ""] = process.argv.slice(2);
const service = await startService();
const browser = await startBrowser();
for (const colorScheme of ["light", "dark"])
  for (const [name, width, height] of [["wide", 1500, 1250], ["narrow", 420, 900]]) {
    const page = await open(browser.context, `${service.url}/${query}`, {viewport: {width, height}, colorScheme});
    await page.waitForTimeout(300);
    await page.screenshot({path: `${folder}/${name}-${colorScheme}.png`, fullPage: name === "wide"});
    if (name === "narrow") {
      await page.locator("#results").scrollIntoViewIfNeeded();
      await page.screenshot({path: `${folder}/${name}-${colorScheme}.png`, fullPage: true});
    }
    await page.close();
  }
if (browser.complaints.length) console.error(browser.complaints.join("\n"));
await browser.stop();
await service.stop();

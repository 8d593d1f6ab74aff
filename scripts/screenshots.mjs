#!/usr/bin/env -S node
// scripts/screenshots FOLDER [QUERY]: pictures of the page, wide and narrow, light and dark: the first screen and the whole page.
// With VINES_WEB_DIR=web they show the page in that folder instead of the one compiled in.
import {startBrowser, open} from "../tests/page/browser.mjs";
import {startService} from "../tests/service.mjs";

const [folder = ".", query = ""] = process.argv.slice(2);
const service = await startService();
const browser = await startBrowser();
for (const colorScheme of ["light", "dark"])
  for (const [name, width, height] of [["wide", 1400, 1250], ["narrow", 390, 844]]) {
    const page = await open(browser.context, `${service.url}/${query}`, {viewport: {width, height}, colorScheme});
    await page.waitForTimeout(300);  // the legends have their final height
    await page.screenshot({path: `${folder}/${name}-${colorScheme}.png`});
    await page.screenshot({path: `${folder}/${name}-${colorScheme}-whole.png`, fullPage: true});
    await page.close();
  }
if (browser.complaints.length) console.error(browser.complaints.join("\n"));
await browser.stop();
await service.stop();

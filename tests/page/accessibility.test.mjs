// axe-core reports no violations on any tab, light or dark.
import assert from "node:assert/strict";
import {test} from "node:test";
import {measured} from "../record.mjs";
import {drawn, identified, swept} from "./browser.mjs";
import {browser, findingsInBothSchemes, service} from "./support.mjs";

const tabs = {
  "a simulation with its details": async (page) => {
    await page.goto(`${service.url}/?preset=fig9`);
    await drawn(page, 1);
    await page.click("#more > summary");
    await page.click("#details > summary");
    await page.waitForFunction(() => document.getElementById("details").dataset.done);
    await page.click("#pin");
  },
  "the numbers of a plot": async (page) => {
    await page.goto(`${service.url}/?preset=fig9`);
    await drawn(page, 1);
    await page.click("#figure-x .menu");
  },
  "a sweep": async (page) => {
    await page.goto(`${service.url}/?tab=sweep&axis1=b,0.003,0.04,24&cycles=60`);
    await swept(page, 1);
  },
  "a map": async (page) => {
    await page.goto(`${service.url}/?tab=sweep&axis1=b,0.005,0.035,8&axis2=R,0.4,0.8,6&cycles=30`);
    await swept(page, 1);
  },
  "a measurement": async (page) => {
    await page.goto(`${service.url}/?tab=measurement&preset=fig15`);
    await page.waitForFunction(() => document.getElementById("measure-preset").value);
    const buffer = Buffer.from(await measured(service.url, "fig15", 6));
    await page.setInputFiles("#measure-file", {name: "record.csv", mimeType: "text/csv", buffer});
    await page.click("#measure-run");
    await identified(page, 1);
  },
};

for (const [name, show] of Object.entries(tabs))
  test(`axe-core finds nothing, light and dark: ${name}`, async () => {
    const page = await browser.context.newPage();
    await page.setViewportSize({width: 1440, height: 900});
    await page.emulateMedia({reducedMotion: "reduce"});
    await show(page);
    assert.deepEqual(await findingsInBothSchemes(page), []);
    await page.close();
  });

#!/usr/bin/env -S node
// scripts/screenshots.mjs FOLDER [QUERY]: takes screenshots of the page, wide and narrow, light, dark and in
// forced colours: the first screen and the complete page. Without a query it shows the first simulation, the first sweep, a map
// and a measurement. VINES_WEB_DIR=build/page selects the page in that folder instead of the compiled one.
import {identified, open, startBrowser} from "../tests/page/browser.mjs";
import {measured} from "../tests/record.mjs";
import {startService} from "../tests/service.mjs";

const [folder = ".", query] = process.argv.slice(2);
const map =
  "?tab=sweep&axis1=b,0.003,0.04,120&axis2=R,0.3,0.9,80&cycles=200&transient_cycles=100" +
  "&damping=closed_form&map=regime";
const usual = {
  "": "",
  "sweep-": "?tab=sweep",
  "map-": map,
  "measurement-": "?tab=measurement&preset=fig20",
};
const views = query === undefined ? usual : {"": query};
const screens = [
  {name: "wide", viewport: {width: 1440, height: 900}},
  {name: "tablet", viewport: {width: 1024, height: 768}},
  {name: "phone", viewport: {width: 390, height: 844}},
  {name: "small", viewport: {width: 320, height: 640}},
  {name: "landscape", viewport: {width: 844, height: 390}},
];
const schemes = {
  light: {colorScheme: "light"},
  dark: {colorScheme: "dark"},
  forced: {colorScheme: "light", forcedColors: "active"},
};
const service = await startService();
const browser = await startBrowser();
const record = {
  name: "record.csv",
  mimeType: "text/csv",
  buffer: Buffer.from(await measured(service.url, "fig20", 20)),
};

async function picture(address, options, path) {
  const page = await open(browser.context, `${service.url}/${address}`, options);
  if (address.includes("tab=measurement")) {
    await page.setInputFiles("#measure-file", record);
    await page.click("#measure-run");
    await identified(page, 1);
  }
  await page.waitForTimeout(300); // the legends have their final height
  await page.screenshot({path: `${path}.png`});
  await page.screenshot({path: `${path}-whole.png`, fullPage: true});
  await page.close();
}

try {
  for (const [view, address] of Object.entries(views))
    for (const colours of ["light", "dark", "forced"])
      for (const {name, viewport} of screens)
        await picture(
          address,
          {viewport, ...schemes[colours]},
          `${folder}/${view}${name}-${colours}`,
        );
  if (browser.complaints.length) console.error(browser.complaints.join("\n"));
} finally {
  await browser.stop();
  await service.stop();
}

#!/usr/bin/env -S node
// scripts/page-speed.mjs: measures the speed of the page in Chromium; prints medians and maxima.
// Run it on an idle machine: Chromium and the service share its processors.
import {startBrowser} from "../tests/page/browser.mjs";
import {sum, weigh} from "../tests/page/weight.mjs";
import {startService} from "../tests/service.mjs";

const repeats = 7;
const turns = 160; // of a slider
const runs = 200; // over which the heap has to stay as it is

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const worst = (values) => Math.max(...values);
const row = (what, value, asked) =>
  console.log(`${what.padEnd(58)}${value.padStart(16)}   ${asked}`);
const ms = (values) => `${median(values).toFixed(0)} (${worst(values).toFixed(0)}) ms`;

const shown = (page, n = 1) =>
  page.waitForFunction(
    (n) => Number(document.getElementById("results").dataset.shown ?? 0) >= n,
    n,
  );

/** Time from navigation to the first plots, and the layout shift meanwhile. */
async function navigation(context, url) {
  const times = [];
  const shifts = [];
  for (let k = 0; k < repeats; ++k) {
    const page = await context.newPage();
    await page.setViewportSize({width: 1440, height: 900});
    await page.addInitScript(() => {
      window.shift = 0;
      new PerformanceObserver((list) => {
        for (const entry of list.getEntries())
          if (!entry.hadRecentInput) window.shift += entry.value;
      }).observe({type: "layout-shift", buffered: true});
      const look = () => {
        const drawn = document.getElementById("results")?.dataset.shown;
        if (drawn) window.drawn = performance.now();
        else requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await page.goto(url);
    await shown(page);
    await page.waitForTimeout(1500);
    times.push(await page.evaluate(() => window.drawn));
    shifts.push(await page.evaluate(() => window.shift));
    await page.close();
  }
  row("first plots after navigation", ms(times), "300 ms");
  row("layout shift", worst(shifts).toFixed(4), "below .02");
}

/** Time from a slider's input to the frame that shows its run. */
const turned = (page, turns) =>
  page.evaluate(async (turns) => {
    const results = document.getElementById("results");
    const slider = document.querySelector("#sliders input[type=range]");
    const painted = () =>
      new Promise((resolve) => {
        const look = () => {
          const {port1, port2} = new MessageChannel();
          port1.onmessage = () => resolve(performance.now());
          port2.postMessage(0);
        };
        requestAnimationFrame(look);
      });
    const times = [];
    for (let k = 0; k < turns; ++k) {
      const before = Number(results.dataset.shown);
      const began = performance.now();
      slider.value = String(12 + (k % 80) * 0.2);
      slider.dispatchEvent(new Event("input", {bubbles: true}));
      await new Promise((resolve) => {
        const watch = new MutationObserver(() => {
          if (Number(results.dataset.shown) <= before) return;
          watch.disconnect();
          resolve();
        });
        watch.observe(results, {attributes: true});
      });
      times.push((await painted()) - began);
      await new Promise((resolve) => setTimeout(resolve, 30));
    }
    return times;
  }, turns);

async function slider(context, url) {
  const page = await context.newPage();
  await page.setViewportSize({width: 1440, height: 900});
  await page.goto(`${url}/?preset=fig9`);
  await shown(page);
  await page.waitForTimeout(1500);
  await turned(page, 20);
  row("slider input to paint, tau = 1709", ms(await turned(page, turns)), "33 (60) ms");
  const heap = async () => {
    await page.requestGC();
    return page.evaluate(() => performance.memory.usedJSHeapSize / 1e6);
  };
  const before = await heap();
  await turned(page, runs);
  const after = await heap();
  row(
    `heap before and after ${runs} more runs`,
    `${before.toFixed(1)}, ${after.toFixed(1)} MB`,
    "stable",
  );
  await page.close();
}

/** The longest task on the page's thread while 100,000 impacts are fetched and drawn. */
async function many(context, url) {
  const page = await context.newPage();
  await page.setViewportSize({width: 1440, height: 900});
  await page.addInitScript(() => {
    window.tasks = [];
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) window.tasks.push([entry.startTime, entry.duration]);
    }).observe({type: "longtask", buffered: true});
  });
  await page.goto(`${url}/?preset=fig11`);
  await shown(page);
  await page.waitForTimeout(1500);
  await page.evaluate(() => window.tasks.splice(0));
  await page.evaluate(() => {
    history.pushState(null, "", "?b=0.015&damping=closed_form&cycles=50000");
    dispatchEvent(new PopStateEvent("popstate"));
  });
  await shown(page, 2);
  await page.waitForTimeout(4000);
  const tasks = await page.evaluate(() => window.tasks.map(([, duration]) => duration));
  row("longest task, 100,000 impacts", `${worst([0, ...tasks]).toFixed(0)} ms`, "100 ms");
  await page.close();
}

const service = await startService();
const browser = await startBrowser();
try {
  const bytes = sum(await weigh(service.url));
  row("files of the first view, gzipped", `${(bytes / 1000).toFixed(1)} kB`, "90 kB");
  await navigation(browser.context, service.url);
  await slider(browser.context, service.url);
  await many(browser.context, service.url);
} finally {
  await browser.stop();
  await service.stop();
}

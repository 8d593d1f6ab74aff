// axe-core reports no violations on any tab, light or dark.
import assert from "node:assert/strict";
import {test} from "node:test";
import {measured} from "../record.mjs";
import {designed, drawn, found, identified, swept} from "./browser.mjs";
import {leastDifference} from "./palette.mjs";
import {browser, findingsInBothSchemes, service} from "./support.mjs";

const design =
  "m1=2&f0=8&damping_ratio=0.01&m2=0.04&f=7,9&acceleration=5&R=0.2&b_count=4&f_count=5&starts=one&cycles=20";

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
  "all motions over a parameter": async (page) => {
    await page.goto(
      `${service.url}/?tab=motions&parameter=b&from=0.014&to=0.018&count=5&preset=fig11`,
    );
    await found(page, 1);
  },
  "a design": async (page) => {
    await page.goto(`${service.url}/?tab=design&${design}`);
    await designed(page, 1);
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

const screens = {
  "320 px": [320, 640],
  "a phone in landscape": [844, 390],
  "200 % zoom": [720, 450],
  "a tablet": [1024, 768],
};
for (const [name, [width, height]] of Object.entries(screens))
  test(`no tab scrolls sideways on ${name}, and sliders are 24 px high`, async () => {
    const page = await browser.context.newPage();
    await page.setViewportSize({width, height});
    for (const [address, wait] of [
      ["?preset=fig11", drawn],
      ["?preset=fig11&embed=1", drawn],
      ["?tab=sweep&axis1=b,0.003,0.04,24&cycles=60", swept],
      ["?tab=motions&parameter=b&from=0.014&to=0.018&count=5&preset=fig11", found],
      [`?tab=design&${design}`, designed],
      ["?tab=measurement", identified],
    ]) {
      await page.goto(`${service.url}/${address}`);
      await wait(page, 1);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= width, `${address}: ${wide} px`);
    }
    await page.goto(`${service.url}/?preset=fig11`);
    await drawn(page, 1);
    const heights = await page.$$eval("input[type=range]", (inputs) =>
      inputs.map((input) => input.offsetHeight).filter(Boolean),
    );
    assert.ok(Math.min(...heights) >= 24, heights.join());
    await page.close();
  });

/** Colours of the style sheet by name, as [r, g, b]. */
const coloursOf = (page, names) =>
  page.evaluate((names) => {
    const probe = document.body.appendChild(document.createElement("i"));
    const found = names.map((name) => {
      probe.style.color = `var(--${name})`;
      return getComputedStyle(probe).color.match(/\d+/g).map(Number);
    });
    probe.remove();
    return found;
  }, names);

test("colours that stand for different things differ for everyone, also with a colour blindness", async () => {
  const regimes = ["VI", "V", "IV", "III", "II", "I", "none"].map((name) => `regime-${name}`);
  const verdicts = ["chaotic", "regular", "undecided", "untouched"];
  const limits = [
    [regimes, regimes, 13.5],
    [verdicts, verdicts, 13.5],
    [verdicts, regimes, 7.5],
    [["plus"], ["minus"], 13.5],
    [["before"], ["after"], 13.5],
    [["c1"], ["without"], 13.5],
  ];
  const page = await browser.context.newPage();
  await page.goto(service.url);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({colorScheme});
    for (const [some, others, least] of limits) {
      const [ofSome, ofOthers] = [await coloursOf(page, some), await coloursOf(page, others)];
      for (const [i, one] of some.entries())
        for (const [k, other] of others.entries()) {
          const difference = one === other ? Infinity : leastDifference(ofSome[i], ofOthers[k]);
          assert.ok(difference >= least, `${colorScheme}: ${one}, ${other}: ${difference}`);
        }
    }
  }
  await page.close();
});

test("forced colours show the selected tab and the pressed chip", async () => {
  const page = await browser.context.newPage();
  await page.emulateMedia({forcedColors: "active"});
  await page.goto(service.url);
  await drawn(page, 1);
  const background = (selector) =>
    page.$eval(selector, (node) => getComputedStyle(node).backgroundColor);
  assert.notEqual(
    await background(".tabs [aria-current]"),
    await background(".tabs a:not([aria-current])"),
  );
  assert.notEqual(
    await background(".chip[aria-pressed=true]"),
    await background(".chip[aria-pressed=false]"),
  );
  await page.close();
});

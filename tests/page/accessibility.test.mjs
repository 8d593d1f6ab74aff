// axe-core reports no violations on any tab, light or dark; nothing overlaps on any screen.
import assert from "node:assert/strict";
import {test} from "node:test";
import {measured} from "../record.mjs";
import {designed, drawn, found, identified, painted, resize, swept} from "./browser.mjs";
import {leastDifference} from "./palette.mjs";
import {findingsInBothSchemes, newPage, service, unfoldForm} from "./support.mjs";

const design =
  "m1=2&f0=8&damping_ratio=0.01&m2=0.04&f=7,9&acceleration=5&R=0.2&b_count=4&f_count=5&starts=one&cycles=20";

const tabs = {
  "a simulation with its details": async (page) => {
    await page.goto(`${service.url}/?preset=fig9`);
    await drawn(page, 1);
    await unfoldForm(page);
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
    const page = await newPage();
    await page.setViewportSize({width: 1440, height: 900});
    await page.emulateMedia({reducedMotion: "reduce"});
    await show(page);
    assert.deepEqual(await findingsInBothSchemes(page), []);
    await page.close();
  });

const tabAddresses = [
  ["?preset=fig11", drawn],
  ["?preset=fig11&embed=1", drawn],
  ["?tab=sweep&axis1=b,0.003,0.04,24&cycles=60", swept],
  ["?tab=motions&parameter=b&from=0.014&to=0.018&count=5&preset=fig11", found],
  [`?tab=design&${design}`, designed],
  ["?tab=measurement", identified],
];
// Wide and small screens; a page loaded on a small one folds its forms.
const screens = [
  [
    [1440, 900],
    [1280, 720],
    [1024, 768],
  ],
  [
    [960, 540],
    [844, 390], // a phone in landscape
    [800, 600],
    [800, 500],
    [720, 450], // 1440 x 900 at 200 % zoom
    [390, 844],
    [320, 640],
  ],
];

/**
 * Pairs of visible elements that overlap, neither inside the other. A page with a sheet of
 * parameters is scrolled to its end, where the sheet covers nothing.
 */
const overlaps = (page) =>
  page.evaluate(() => {
    const hasSheet = document.getElementById("sheet").checkVisibility();
    scrollTo(0, hasSheet ? document.documentElement.scrollHeight : 0);
    const parts = "header, footer, form, .headline, .strip, #details > summary, .cards > div";
    const plots = ".machine, .player, canvas, figure, figcaption, .plot, .plane";
    const results = ".results > :not(.telling)";
    const boxes = [...document.querySelectorAll([parts, plots, results])]
      .filter((node) => node.checkVisibility())
      .map((node) => ({node, ...node.getBoundingClientRect().toJSON()}));
    const meet = (one, other) =>
      Math.min(one.right, other.right) - Math.max(one.left, other.left) > 1 &&
      Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > 1;
    const nameOf = ({node}) => node.id || node.className || `${node.parentNode.id} ${node.tagName}`;
    return boxes.flatMap((one, k) =>
      boxes
        .slice(k + 1)
        .filter((other) => !one.node.contains(other.node) && meet(one, other))
        .map((other) => `${nameOf(one)}, ${nameOf(other)}`),
    );
  });

/** Fails if something overlaps, is too wide or is too low for a finger. */
async function checkLayout(page, width) {
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= width, `${width}: ${wide} px`);
  assert.deepEqual(await overlaps(page), [], `on ${width} px`);
  const heights = await page.$$eval("input[type=range]", (inputs) =>
    inputs.map((input) => input.offsetHeight).filter(Boolean),
  );
  assert.ok(Math.min(...heights) >= 24, `${width}: sliders of ${heights} px`);
}

for (const [address, wait] of tabAddresses)
  test(`nothing overlaps or scrolls sideways on any screen: ${address}`, async () => {
    for (const sizes of screens) {
      const page = await newPage();
      for (const [k, [width, height]] of sizes.entries()) {
        await resize(page, {width, height});
        if (k === 0) {
          await page.goto(`${service.url}/${address}`);
          await wait(page, 1);
          await painted(page);
        }
        await checkLayout(page, width);
        const high = await page.evaluate(() => document.documentElement.scrollHeight);
        if (address.includes("embed") && width === 800)
          assert.ok(high <= height, `the frame scrolls: ${high} px`);
      }
      await page.close();
    }
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
  const page = await newPage();
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
  const page = await newPage();
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

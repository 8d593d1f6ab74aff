// Shared by the page's tests: a service, Chromium, and functions that examine what is drawn.
import {readFile} from "node:fs/promises";
import {createRequire} from "node:module";
import {after, before} from "node:test";
import {startService} from "../service.mjs";
import {emptyPage, open, startBrowser} from "./browser.mjs";

export let service;
export let browser;
before(async () => {
  service = await startService(["--deadline", "600"]); // slow machines must not fail the tests
  browser = await startBrowser();
});
after(async () => {
  await browser.stop();
  await service.stop();
});

/** A page for a test that gives it no clock and no script. */
export const newPage = () => emptyPage(browser.context);
/** A page of the service with its first result. */
export const visit = (address = "", options = {}) =>
  open(browser.context, `${service.url}/${address}`, options);
export const narrow = {viewport: {width: 390, height: 800}};

/**
 * Names the selected elements that extend beyond the right edge of the screen, except those inside
 * `except`.
 */
export const beyond = (page, selector, except = null) =>
  page.$$eval(
    selector,
    (nodes, except) => {
      const reaches = (node) => {
        const {width, right} = node.getBoundingClientRect();
        return width && right > innerWidth;
      };
      const excepted = (node) => except && node.closest(except);
      return nodes
        .filter((node) => reaches(node) && !excepted(node))
        .map((node) => node.id || node.closest("figure")?.id || node.textContent);
    },
    except,
  );
export const fits = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth <= innerWidth);

export const cells = (page, rows) =>
  page.$$eval(rows, (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));

/** The rows of a table by the text of their first cell. */
export const cellsByName = async (page, rows) =>
  Object.fromEntries((await cells(page, rows)).map(([name, ...others]) => [name, others]));

/** The file that a click saves. */
export async function downloaded(page, link) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(link)]);
  const bytes = await readFile(await download.path());
  return {name: download.suggestedFilename(), bytes, text: bytes.toString()};
}

/**
 * Examines a canvas: the number of colours (an empty canvas has one), the number of pixels in
 * exactly the colour `name` of the style sheet, and a hash. The pixels are counted in the page, in
 * a copy, because Chromium warns about reading from a visible canvas.
 */
const survey = (page, selector, name = "text") =>
  page.evaluate(
    ([selector, name]) => {
      const read = (width, height, draw) => {
        const copy = new OffscreenCanvas(width, height);
        const context = copy.getContext("2d", {willReadFrequently: true});
        draw(context);
        return new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
      };
      const probe = document.body.appendChild(document.createElement("i"));
      probe.style.color = `var(--${name})`; // as in light or dark
      const [wanted] = read(1, 1, (c) => {
        c.fillStyle = getComputedStyle(probe).color;
        c.fillRect(0, 0, 1, 1);
      });
      probe.remove();
      const canvas = document.querySelector(selector);
      const seen = new Set();
      let pixels = 0;
      let hash = 0;
      for (const pixel of read(canvas.width, canvas.height, (c) => c.drawImage(canvas, 0, 0))) {
        seen.add(pixel);
        pixels += pixel === wanted;
        hash = Math.imul(hash ^ pixel, 0x01000193);
      }
      return {colours: seen.size, pixels, hash};
    },
    [selector, name],
  );

export const colours = async (page, selector) => (await survey(page, selector)).colours;
export const pixels = async (page, selector, name) => (await survey(page, selector, name)).pixels;
export const hash = async (page, selector) => (await survey(page, selector)).hash;

export const platform = {
  m1: "12",
  f0: "14",
  damping_ratio: ".006",
  mass_ratio: ".01",
  F: ".0004",
  f: "14",
  b: ".03",
  R: ".4",
};
export const platformQuery = String(new URLSearchParams(platform));

/** Collects the requests of a page to a route. */
export function asked(page, route) {
  const requests = [];
  page.on("request", (request) => {
    if (request.url().endsWith(route)) requests.push(request.postDataJSON());
  });
  return requests;
}

export const input = (name) => `#fields [aria-describedby='error-${name}']`;
export const origin = (page, name) => page.textContent(`#fields .field-${name} .origin`);

/** The value that the service chooses for an empty menu of the form. */
export const automatic = (page, name) =>
  page.$eval(input(name), ({value, options}) =>
    value ? null : options[0].text.replace("automatic: ", ""),
  );

/** Opens the form; resolves after the page's own listener, which scrolls to it and fills in origins. */
export const unfoldForm = (page) =>
  page.$eval(
    "#more",
    (form) =>
      new Promise((resolve) => {
        form.addEventListener("toggle", resolve, {once: true});
        form.querySelector("summary").click();
      }),
  );

/** Opens the form and its groups. */
export async function unfold(page) {
  await unfoldForm(page);
  for (const part of await page.$$("#fields details:not([open]) > summary")) await part.click();
}

const require = createRequire(new URL("../../web/package.json", import.meta.url));

/** Accessibility violations reported by axe-core, a text for each; of all rules, unless `rules` names some. */
export async function findings(page, rules) {
  const axe = await readFile(require.resolve("axe-core/axe.min.js"), "utf8");
  return page.evaluate(
    async ([source, runOnly]) => {
      new Function(source)();
      const {violations} = await window.axe.run(document, {runOnly, resultTypes: ["violations"]});
      return violations.flatMap(({id, nodes}) =>
        nodes.map(({target, failureSummary}) => `${id}: ${target.join(" ")}: ${failureSummary}`),
      );
    },
    [axe, rules],
  );
}

/** Violations in the light scheme, and contrast violations in the dark one: no other rule depends on colours. */
export async function findingsInBothSchemes(page) {
  await page.emulateMedia({colorScheme: "light"});
  const light = await findings(page);
  await page.emulateMedia({colorScheme: "dark"});
  return [...light, ...(await findings(page, ["color-contrast"])).map((text) => `dark: ${text}`)];
}

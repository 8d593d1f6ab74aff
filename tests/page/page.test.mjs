// The page in real Chromium, as a visitor uses it.
import assert from "node:assert/strict";
import {readFile} from "node:fs/promises";
import {after, before, test} from "node:test";
import {measured} from "../record.mjs";
import {startService} from "../service.mjs";
import {drawn, identified, open, startBrowser, swept} from "./browser.mjs";

let service;
let browser;
before(async () => {
  service = await startService();
  browser = await startBrowser();
});
after(async () => {
  await browser.stop();
  await service.stop();
});

/** A page of the service, once its first answer is drawn. */
const visit = (address = "", options = {}) =>
  open(browser.context, `${service.url}/${address}`, options);
const narrow = {viewport: {width: 390, height: 800}};

/** What of a selection reaches beyond the right edge of the screen, but for `except`. */
const beyond = (page, selector, except = null) =>
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
const fits = (page) => page.evaluate(() => document.documentElement.scrollWidth <= innerWidth);

/** The texts of a table's cells. */
const cells = (page, rows) =>
  page.$$eval(rows, (list) => list.map((row) => [...row.cells].map((cell) => cell.textContent)));

/** The same by the text of the first in each row. */
const cellsByName = async (page, rows) =>
  Object.fromEntries((await cells(page, rows)).map(([name, ...others]) => [name, others]));

/** The file that a click on a link saves. */
async function downloaded(page, link) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(link)]);
  return {name: download.suggestedFilename(), text: await readFile(await download.path(), "utf8")};
}

/**
 * Of a canvas: how many colours it shows (an empty one has one), how many pixels have exactly the
 * one that the style sheet names so, and a hash of all. It is counted in the page, where the pixels
 * are, and of a copy, because Chromium complains of canvases that are read.
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
      const style = getComputedStyle(document.documentElement);
      const [wanted] = read(1, 1, (c) => {
        c.fillStyle = style.getPropertyValue(`--${name}`).trim();
        c.fillRect(0, 0, 1, 1);
      });
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

const colours = async (page, selector) => (await survey(page, selector)).colours;
const pixels = async (page, selector, name) => (await survey(page, selector, name)).pixels;
const hash = async (page, selector) => (await survey(page, selector)).hash;

const lines = [
  "x",
  "acceleration",
  "largest",
  "relative",
  "z",
  "qr",
  "eigenvalues",
  "raw_product",
  "J",
  "M",
  "T",
  "differences",
].map((name) => `#plot-${name} canvas`);
const scatters = ["portrait", "section", "velocities", "stroboscopic", "manifold"].map(
  (name) => `#plot-${name}`,
);
const canvases = [...lines, ...scatters];

const marked = (page) =>
  page.$$eval("figure.about", (figures) =>
    figures.map((f) => [f.id, f.querySelector(".tag").textContent]),
  );

test("the first thing that a visitor sees is the paper's Fig. 3, computed and drawn, with nothing in the console", async () => {
  const page = await visit();
  assert.equal(await page.inputValue("#preset"), "fig3");
  for (const canvas of canvases) assert.ok((await colours(page, canvas)) > 3, canvas);
  const summary = await page.textContent("#summary");
  assert.match(summary, /λ₁ \(qr\)0\.\d{4} ± 0\.\d{4}/);
  // Or three, where an eigenvalue of the last product comes out as zero.
  assert.match(summary, /positive exponents \(qr\)1 raw_product shows [34]/);
  assert.match(summary, /regimeType II strongly modulated response/);
  assert.match(summary, /z1\.\d{3} \d\d % of the contacts synchronised/);
  assert.match(summary, /verdictchaotic λ₁ = 0\.\d+ lies \d+\.\d standard errors above zero/);
  assert.match(summary, /taken by the impacts\d\d %/);
  assert.match(summary, /rms of x\d\d % of that without absorber/);
  assert.equal(await page.isVisible("#figure-multipliers"), false);
  assert.equal(await page.isVisible("#figure-windows"), false);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the content security policy lets no inline script run", async () => {
  const response = await fetch(service.url);
  const policy = response.headers.get("content-security-policy");
  assert.match(policy, /default-src 'none'/);
  assert.doesNotMatch(policy, /unsafe/);
});

test("a preset fills the form and draws", async () => {
  const page = await visit();
  await page.selectOption("#preset", "fig11");
  await drawn(page, 2);
  assert.equal(await page.inputValue("#fields label:has-text('b, m') input"), "0.015");
  assert.match(await page.textContent("#summary"), /stuck phases1/);
  assert.match(page.url(), /preset=fig11/);
  await page.close();
});

test("a reduced field over a preset in SI changes that field alone, and the link keeps both", async () => {
  const page = await visit("?preset=fig20&Omega=1.01");
  assert.equal(await page.inputValue("#preset"), "fig20");
  assert.equal(new URL(page.url()).search, "?preset=fig20&Omega=1.01");
  await page.close();
});

test("a fault is shown at its field, and mending it draws again", async () => {
  const page = await visit("?b=0.015&tau_end=300");
  const b = page.locator("#fields label:has-text('b, m') input");
  await b.fill("-1");
  await page.click("#run");
  await page.waitForSelector("#error-b:not(:empty)");
  assert.match(await page.textContent("#error-b"), /b must lie in/);
  assert.equal(await b.getAttribute("aria-invalid"), "true");
  await b.fill("1,5");
  await page.click("#run");
  await page.waitForFunction(() =>
    document.getElementById("error-b").textContent.includes("number"),
  );
  await b.fill("0.02");
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.textContent("#error-b"), "");
  browser.complaints.length = 0; // Chromium notes each 422 in its console
  await page.close();
});

test("Fig. 9 is marked at the displacement and at the largest modulus of T, and choosing it leads there", async () => {
  const page = await visit("?preset=fig5", {
    viewport: {width: 1400, height: 700},
  });
  assert.deepEqual(await marked(page), [
    ["figure-qr", "Fig. 5"],
    ["figure-raw_product", "Fig. 5"],
  ]);
  assert.equal(await page.evaluate(() => scrollY), 0, "a link does not scroll");
  await page.click("#motion > summary");
  await page.selectOption("#preset", "fig9");
  await drawn(page, 2);
  assert.deepEqual(await marked(page), [
    ["figure-x", "Fig. 9"],
    ["figure-largest", "Fig. 9"],
  ]);
  await page.waitForFunction(
    () => Math.abs(document.getElementById("figure-x").getBoundingClientRect().top) < 40,
  );
  assert.ok((await colours(page, "#plot-largest canvas")) > 3);
  await page.close();
});

test("an emptied field of a preset is not filled again by a link", async () => {
  const page = await visit("?preset=fig3&tau_end=600&window=100,500");
  assert.equal(await page.inputValue("#fields label:has-text('b, m') input"), "0.022");
  assert.match(page.url(), /preset=fig3/);
  await page.fill("#fields label[title*='exponents are taken'] input", "");
  await page.click("#run");
  await drawn(page, 2);
  assert.doesNotMatch(page.url(), /preset|window/);
  assert.equal(await page.inputValue("#preset"), "");
  assert.deepEqual(await marked(page), []);
  await page.close();
});

test("a plot without a width is drawn when it gets one", async () => {
  const page = await visit();
  const display = (value) =>
    page.evaluate((value) => {
      document.getElementById("matrices").style.display = value;
    }, value);
  await display("none");
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.locator("#plot-T canvas").count(), 0);
  await display("");
  await page.waitForSelector("#plot-T canvas");
  assert.ok((await colours(page, "#plot-T canvas")) > 3);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("windows are listed with their exponents and verdicts, and the link holds them", async () => {
  const page = await visit("?b=0.022&damping=closed_form&tau_end=1709");
  await page.fill("#fields label:has-text('windows') input", "18.13, 800; 800,1700;");
  await page.click("#run");
  await drawn(page, 2);
  assert.match(page.url(), /windows=18\.13%2C800%3B800%2C1700/);
  const first = await cells(page, "#windows tbody tr");
  assert.equal(first.length, 2);
  assert.deepEqual(first[1].slice(0, 2), ["800", "1700"]);
  assert.match(first[1][3], /^0\.\d{4} ± 0\.\d{4}$/);
  assert.match(first[1][6], /^−(0\.\d{4}|∞)$/); // a stick may fall in the window
  assert.match(first[1][7], /chaotic|not decided/);
  const again = await open(browser.context, page.url());
  assert.deepEqual(await cells(again, "#windows tbody tr"), first);
  assert.equal(
    await again.inputValue("#fields label:has-text('windows') input"),
    "18.13, 800; 800, 1700",
  );
  await page.close();
  await again.close();
});

test("a faulty list of windows is shown at its field", async () => {
  const page = await visit("?tau_end=300");
  await page.fill("#fields label:has-text('windows') input", "18; 20,abc");
  await page.click("#run");
  await page.waitForSelector("#error-windows:not(:empty)");
  browser.complaints.length = 0; // Chromium notes each 422 in its console
  await page.close();
});

test("a periodic response shows its type, its period and its Floquet multipliers within the unit circle", async () => {
  const page = await visit("?preset=fig11");
  const summary = await page.textContent("#summary");
  assert.match(summary, /regimeType III two symmetric impacts per cycle/);
  assert.match(summary, /period 1 cycle: 2 impacts, symmetric/);
  assert.ok(await page.isVisible("#figure-multipliers"));
  const dots = await pixels(page, "#plot-multipliers", "before");
  assert.ok(dots >= 4 * 25, `four multipliers, ${dots} pixels`);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("where the energy goes adds up, and the oscillator is compared with itself without absorber", async () => {
  const page = await visit("?preset=fig11");
  const numbers = async (selector) =>
    (await page.locator(selector).allTextContents()).map((text) => parseFloat(text));
  const shares = await numbers("#energy .parts b");
  assert.equal(shares.length, 3);
  assert.ok(Math.abs(shares.reduce((a, b) => a + b) - 100) < 1.5, shares.join(" + "));
  const [rms, without] = await numbers("#energy .amount");
  assert.ok(rms > 0 && rms < without);
  await page.close();
});

test("walls with different R leave the manifold's branches out and keep the run's points", async () => {
  const page = await visit("?R_plus=0.6&R_minus=0.7&tau_end=600");
  assert.match(await page.textContent("#warnings"), /same R at both walls/);
  assert.ok((await colours(page, "#plot-manifold")) > 3);
  assert.equal(await pixels(page, "#plot-manifold", "c2"), 0);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a free decay is drawn: energy from the start, no amplitude without absorber", async () => {
  const page = await visit("?G=0&x0=0.02&tau_end=600");
  assert.match(await page.textContent("#summary"), /free decay, no forcing/);
  assert.match(
    await page.textContent("#summary"),
    /verdict– without forcing \(G = 0\) the motion dies out/,
  );
  const energy = await page.textContent("#energy");
  assert.match(energy, /200 mm² there at the start; half is left at τ = \d+/);
  const left = (part) => `${part} is left at τ = ([\\d.]+) \\(without absorber: τ = ([\\d.]+)\\)`;
  const decay = new RegExp(`${left("half")}; ${left("a tenth")}`);
  const times = decay.exec(energy).slice(1).map(Number);
  assert.ok(times[0] < times[1] && times[2] < times[3], "the absorber shortens the decay");
  for (const canvas of canvases) assert.ok((await colours(page, canvas)) > 3, canvas);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the address holds the request: a link shows the same run", async () => {
  const page = await visit("?b=0.018&damping=closed_form&tau_end=400&window=20,300");
  const first = await page.textContent("#summary");
  const again = await open(browser.context, page.url());
  const strip = (text) => text.replace(/answered in.*/, "");
  assert.equal(strip(await again.textContent("#summary")), strip(first));
  await page.close();
  await again.close();
});

test("a run without impacts is drawn and says that it has no exponents", async () => {
  const page = await visit("?b=0.5&tau_end=300");
  assert.match(await page.textContent("#warnings"), /no exponents/);
  assert.match(await page.textContent("#summary"), /regimenone no impacts/);
  assert.match(await page.textContent("#summary"), /verdict– .*the free mass meets no wall/);
  assert.equal(await page.isVisible("#figure-multipliers"), false);
  assert.ok((await colours(page, "#plot-x canvas")) > 3);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("zooming into one plot over tau zooms the others", async () => {
  const page = await visit("?b=0.015&tau_end=300");
  const over = page.locator("#plot-x .u-over");
  const box = await over.boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, {steps: 5});
  await page.mouse.up();
  await page.waitForTimeout(200);
  for (const name of ["acceleration", "relative", "largest", "z", "T", "differences"]) {
    await page.hover(`#plot-${name} .u-over`, {position: {x: 5, y: 40}});
    await page.waitForTimeout(100);
    const legend = `#plot-${name} .u-legend .u-series:first-child .u-value`;
    const tau = Number((await page.textContent(legend)).trim());
    assert.ok(tau > 100 && tau < 140, `tau at the left edge of ${name}: ${tau}`);
  }
  await page.close();
});

for (const query of ["", "?preset=fig11", "?b=0.022&tau_end=900&windows=18,400;400,900"])
  test(`on a narrow screen nothing is wider than the screen: ${query || "the first view"}`, async () => {
    const page = await visit(query, narrow);
    assert.ok(await fits(page));
    assert.deepEqual(await beyond(page, "figure :is(canvas, .stack, .compare, .u-legend)"), []);
    await page.close();
  });

// A system of one's own.

const input = (name) => `#fields [aria-describedby='error-${name}']`;
const origin = (page, name) => page.textContent(`#fields .field-${name} .origin`);
const platform = {
  m1: "12",
  f0: "14",
  damping_ratio: ".006",
  mass_ratio: ".01",
  F: ".0004",
  f: "14",
  b: ".03",
  R: ".4",
};
const platformQuery = String(new URLSearchParams(platform));

/** Counts the requests of a page to a route. */
function asked(page, route) {
  const requests = [];
  page.on("request", (request) => {
    if (request.url().endsWith(route)) requests.push(request.postDataJSON());
  });
  return requests;
}

test("each field says where its value comes from, and an empty one shows it", async () => {
  const page = await visit();
  assert.equal(await origin(page, "b"), "fig3");
  assert.equal(await origin(page, "tau_end"), "fig3");
  assert.equal(await origin(page, "epsilon"), "default");
  assert.equal(await page.getAttribute(input("epsilon"), "placeholder"), "0.00840557");
  assert.equal(await page.getAttribute(input("R"), "placeholder"), "0.6");
  await page.fill(input("b"), "0.03");
  assert.equal(await origin(page, "b"), "", "typed, and no longer the preset's");
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await origin(page, "b"), "");
  assert.equal(
    await page.inputValue("#preset"),
    "fig3",
    "the walls are not the system: its name stays",
  );
  await page.click("#parameters > summary");
  const rows = await cellsByName(page, "#parameters tr");
  assert.deepEqual(rows.b, ["b", "0.03 m (30 mm)", "given"]);
  assert.deepEqual(rows.epsilon, ["ε", "0.00840557", "default"]);
  assert.deepEqual(rows.damping, ["", "closed form", "preset fig3"]);
  assert.equal(rows.zeta[0], "ζ");
  await page.close();
});

test("a mass typed over a preset takes the place of its system, its damping and its window, and what is missing is said at its field", async () => {
  const page = await visit();
  await page.click("#group-SI > summary");
  await page.fill(input("m1"), "12");
  assert.equal(await page.inputValue(input("damping")), "equation_of_motion");
  assert.equal(await page.inputValue(input("window")), "");
  assert.equal(await page.inputValue("#preset"), "");
  assert.match(
    await page.textContent("#preset-note"),
    /your own, in place of Fig\. 3; damping is equation_of_motion; window is empty/,
  );
  assert.equal(await origin(page, "damping"), "", "it is Fig. 3's no more");
  assert.equal(await page.inputValue(input("b")), "0.022", "the rest stays");
  await page.click("#run");
  for (const name of ["c1", "k1", "m2", "F", "f"])
    await page.waitForSelector(`#error-${name}:not(:empty)`);
  assert.match(await page.textContent("#error-k1"), /k1 \(or f0\) is missing/);
  browser.complaints.length = 0; // Chromium notes each 422 in its console
  await page.close();
});

test("a damping that was chosen stays when masses are typed over the preset; so does a window of one's own", async () => {
  const page = await visit();
  await page.selectOption(input("damping"), "equation_of_motion");
  await page.selectOption(input("damping"), "closed_form");
  await page.fill(input("window"), "20, 1000");
  await page.click("#group-reduced > summary");
  await page.fill(input("epsilon"), "0.01");
  assert.equal(await page.inputValue(input("damping")), "closed_form");
  assert.equal(await page.inputValue(input("window")), "20, 1000");
  await page.click("#run");
  await drawn(page, 2);
  assert.match(
    page.url(),
    /\?b=0\.022&damping=closed_form&epsilon=0\.01&tau_end=5521\.3&window=20%2C1000/,
  );
  await page.close();
});

test("a mass typed over a preset in SI leaves a whole system, shown in seconds", async () => {
  const page = await visit("?preset=fig20");
  assert.equal(await origin(page, "m2"), "fig20");
  await page.fill(input("m2"), "0.05");
  assert.equal(await page.inputValue("#preset"), "");
  await page.click("#run");
  await drawn(page, 2);
  assert.match(page.url(), /m1=4\.168&k1=11470&c1=3\.02&m2=0\.05&F=/);
  assert.match(await page.textContent("#plot-x .u-legend"), /^t \(s\)/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("of two fields that say the same the one that follows is greyed out and shows its value; reduced fields give way to SI", async () => {
  const page = await visit(`?${platformQuery}&tau_end=300`);
  const following = [
    ["k1", "92853.2", "from f0, m1"],
    ["c1", "12.6669", "from damping_ratio, m1, f0"],
    ["m2", "0.12", "from mass_ratio, m1"],
    ["cycles", "47.7465", "from tau_end"],
    ["epsilon", "0.01", "from mass_ratio, m1"],
  ];
  for (const [name, value, from] of following) {
    assert.ok(await page.isDisabled(input(name)), name);
    assert.equal(await page.getAttribute(input(name), "placeholder"), value);
    assert.equal(await origin(page, name), from);
  }
  await page.fill(input("f0"), "");
  assert.ok(await page.isEnabled(input("k1")));
  await page.fill(input("k1"), "92853.2");
  assert.ok(await page.isDisabled(input("f0")));
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.getAttribute(input("f0"), "placeholder"), "14");
  assert.match(page.url(), /k1=92853\.2/);
  await page.close();
});

test("a reduced field over a preset in SI, and a system over one of Table 1 by a link, mean what the service takes them for", async () => {
  for (const query of [
    "preset=fig20&epsilon=0.02",
    "preset=fig3&lambda=2",
    "preset=fig3&b=0.03",
    "preset=fig20&tau_end=500",
  ]) {
    const page = await visit(`?${query}`);
    assert.equal(new URL(page.url()).search, `?${query}`);
    const answer = await fetch(`${service.url}/v1/simulate?${query}&include=impacts`);
    const {parameters} = await answer.json();
    assert.equal(await page.inputValue(input("damping")), parameters.damping, query);
    const shown = async (name) =>
      (await page.inputValue(input(name))) || (await page.getAttribute(input(name), "placeholder"));
    const window = (await shown("window")).split(", ").map(Number);
    assert.deepEqual(window.map(Math.round), parameters.window.map(Math.round), query);
    await page.close();
  }
});

test("a system in SI is shown in seconds, mm/s, m/s² and J; the switch goes to tau without a request and is remembered, not in the link", async () => {
  const page = await visit(`?${platformQuery}&tau_end=900&windows=100,400`);
  const requests = asked(page, "/v1/simulate");
  const legend = (name) => page.textContent(`#plot-${name} .u-legend`);
  const heads = () => page.textContent("#windows thead");
  const amounts = () => page.textContent("#energy .parts");
  for (const name of ["x", "acceleration", "relative", "qr", "T", "differences"])
    assert.match(await legend(name), /^t \(s\)/, name);
  assert.match(await page.textContent("#summary"), /window0\.\d to 10\.\d s/);
  assert.match(
    await page.textContent("#summary"),
    /impact speed\d+ mm\/s median; at most \d+; impulse 0\.\d+ N s/,
  );
  assert.match(await page.textContent("#summary"), /peak acceleration\d+ m\/s²/);
  assert.match(await heads(), /^from \(s\)to \(s\)/);
  assert.match(await amounts(), /\d+ J/);
  const seconds = await hash(page, "#plot-velocities");
  const address = page.url();
  await page.click("#units >> text=τ");
  for (const name of ["x", "acceleration", "qr"]) assert.match(await legend(name), /^τ/, name);
  assert.match(await heads(), /^τ from/);
  assert.match(await amounts(), /mm²/);
  assert.notEqual(await hash(page, "#plot-velocities"), seconds);
  assert.equal(requests.length, 0);
  assert.equal(page.url(), address);
  const again = await open(browser.context, address);
  assert.match(await again.textContent("#plot-x .u-legend"), /^τ/);
  await again.click("#units >> text=mm/s");
  assert.equal(await hash(again, "#plot-velocities"), seconds);
  const reduced = await visit("?b=0.02&tau_end=300");
  assert.match(
    await reduced.textContent("#plot-x .u-legend"),
    /^τ/,
    "without SI there are no seconds",
  );
  assert.equal(await reduced.isVisible("#units"), false);
  assert.deepEqual(browser.complaints, []);
  for (const p of [page, again, reduced]) await p.close();
});

test("the system is sketched and its equation written out: open on a wide screen, closed on a narrow one", async () => {
  for (const [width, isOpen] of [
    [1400, true],
    [390, false],
  ]) {
    const page = await visit("?tau_end=100", {
      viewport: {width, height: 800},
    });
    await page.waitForSelector("#model-sketch svg", {state: "attached"});
    assert.equal(await page.isVisible("#model-sketch svg"), isOpen);
    if (!isOpen) await page.click("#model > summary");
    const box = await page.locator("#model-sketch svg").boundingBox();
    assert.ok(box.width > 200 && box.x + box.width < width, `${box.width} px`);
    assert.match(
      (await page.textContent("#model")).replace(/[\s\u2009]+/g, " "),
      /m1x″ \+ c1x′ \+ k1x = k1F sin 2πft \+ 2πf c1F cos 2πft y″ = 0 while \|x − y\| < b/,
    );
    assert.deepEqual(browser.complaints, []);
    await page.close();
  }
});

test("the sketch takes the colours of the page", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await visit("?tau_end=100", {
      colorScheme,
      viewport: {width: 1400, height: 900},
    });
    await page.waitForSelector("#model-sketch svg");
    const colourOf = (selector) => page.$eval(selector, (node) => getComputedStyle(node).color);
    assert.equal(await colourOf("#model-sketch svg"), await colourOf("body"), colorScheme);
    await page.close();
  }
});

for (const query of [`?${platformQuery}&tau_end=900&windows=18,400;400,900`, "?preset=fig3"])
  test(`on a narrow screen neither the system nor the parameters are wider than the screen: ${query}`, async () => {
    const page = await visit(query, narrow);
    for (const part of ["#model", "#parameters"]) await page.click(`${part} > summary`);
    for (const part of await page.$$("#fields details:not([open]) > summary")) await part.click();
    const cut = await page.$$eval(".field .name", (names) =>
      names.filter((n) => n.scrollWidth > n.clientWidth).map((n) => n.textContent),
    );
    assert.deepEqual(cut, []);
    assert.ok(await fits(page));
    const parts = "#panel-simulation :is(canvas, svg, input, select, figure, td, .origin)";
    assert.deepEqual(await beyond(page, parts, ".scroll"), []);
    await page.close();
  });

// Sweeps.

const small =
  "tab=sweep&axis1=b,0.003,0.04,24&cycles=60&transient_cycles=30&section=impact&damping=closed_form";
const long = "tab=sweep&axis1=b,0.02,0.04,300&cycles=20000&damping=closed_form";
const stacked = ["section", "lambda", "other"].map((name) => `#plot-sweep-${name} canvas`);

/** The place on the screen of the point at share t of a plot's width. */
async function hoverAt(page, plot, x, y = 0.5) {
  const box = await page.locator(`${plot} .u-over`).boundingBox();
  await page.locator(`${plot} .u-over`).hover({position: {x: box.width * x, y: box.height * y}});
}

/** Clicks there. */
async function clickAt(page, plot, x, y) {
  const over = page.locator(`${plot} .u-over`);
  await over.scrollIntoViewIfNeeded();
  // A click at once may still hit what was there before.
  await page.evaluate(
    () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))),
  );
  const box = await over.boundingBox();
  await page.mouse.click(box.x + box.width * x, box.y + box.height * y);
}

/** The input of a sweep's field, by the place of its error. */
const field = (id) => `#panel-sweep [aria-describedby='${id}']`;

const tip = (page) => page.textContent(".stacked:not([hidden]) .tip");

test("the tabs are chosen by click and by arrow keys; the first sweep is Table 3's range, and Back leads back", async () => {
  const page = await visit("?b=0.015&tau_end=100");
  await page.click("#tab-sweep");
  await swept(page, 1);
  assert.equal(await page.inputValue("#sweep-example"), "0");
  assert.match(
    page.url(),
    /tab=sweep&axis1=b%2C0\.003%2C0\.04%2C400&cycles=1000&section=impact&damping=closed_form/,
  );
  assert.equal(await page.isVisible("#panel-simulation"), false);
  for (const canvas of stacked) assert.ok((await colours(page, canvas)) > 3, canvas);
  const expected = [
    ["VI", 5, 30],
    ["V", 8, 30],
    ["IV", 10, 30],
    ["III", 85, 110],
    ["II", 120, 190],
    ["I", 70, 120],
  ];
  for (const [regime, least, most] of expected) {
    const n = Number(await page.textContent(`#sweep-regime-${regime}`));
    assert.ok(n >= least && n <= most, `${regime}: ${n} points`);
    assert.ok((await pixels(page, "#plot-sweep-other canvas", `regime-${regime}`)) > 20, regime);
  }
  await page.focus("#tab-sweep");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await page.getAttribute("#tab-simulation", "aria-selected"), "true");
  assert.ok(await page.isVisible("#plot-x canvas"));
  assert.match(page.url(), /\?b=0\.015&tau_end=100/);
  await page.goBack();
  await page.waitForSelector("#plot-sweep-section canvas");
  assert.equal(
    await page.getAttribute("#sweep-results", "data-done"),
    "1",
    "the sweep is still there",
  );
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a sweep fills its diagrams, counts what has come, and a link shows the same", async () => {
  const page = await visit(`?${small}`);
  assert.match(await page.textContent("#sweep-rate"), /24 of 24 points · \d+ per second$/);
  for (const canvas of stacked) assert.ok((await colours(page, canvas)) > 3, canvas);
  await hoverAt(page, "#plot-sweep-lambda", 0.3);
  assert.match(
    await tip(page),
    /b0\.01\d+ mregimeIII, two symmetric.*z2.*λ₁−0\.\d+ ± .*regular.*Click: simulate it$/,
  );
  await page.selectOption("#sweep-coordinate", "y_dot_after");
  await page.selectOption("#sweep-quantity", "share_impacts");
  await page.fill(field("sweep-axis1-error-count"), "12");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.match(await page.textContent("#sweep-rate"), /12 of 12/);
  const again = await open(browser.context, page.url());
  assert.equal(await again.inputValue("#sweep-coordinate"), "y_dot_after");
  assert.equal(await again.inputValue("#sweep-quantity"), "share_impacts");
  for (const canvas of stacked)
    assert.equal(await hash(again, canvas), await hash(page, canvas), canvas);
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await again.close();
});

test("zooming into one diagram of a sweep zooms the others", async () => {
  const page = await visit(`?${small}`);
  await page.locator("#plot-sweep-lambda .u-over").scrollIntoViewIfNeeded();
  const box = await page.locator("#plot-sweep-lambda .u-over").boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, {steps: 5});
  await page.mouse.up();
  await page.waitForTimeout(400);
  assert.match(page.url(), /tab=sweep/, "the end of a drag is no click");
  for (const name of ["section", "other"]) {
    await hoverAt(page, `#plot-sweep-${name}`, 0.02);
    const b = Number((await tip(page)).match(/^b(0\.\d+)/)[1]);
    assert.ok(b > 0.016 && b < 0.02, `b at the left edge of ${name}: ${b}`);
  }
  await page.close();
});

test("a click on a point simulates it, and Back leads to the sweep", async () => {
  const page = await visit(`?${small}`);
  await clickAt(page, "#plot-sweep-other", 0.5, 0.2);
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.0\d+&damping=closed_form&cycles=272$/);
  assert.equal(await page.inputValue("#fields [aria-describedby='error-cycles']"), "272");
  assert.match(await page.textContent("#summary"), /regimeType II/);
  await page.goBack();
  await page.waitForSelector("#sweep-stack:visible");
  assert.equal(await page.getAttribute("#sweep-results", "data-done"), "1");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the keyboard goes from point to point and simulates one", async () => {
  const page = await visit(`?${small}&carry_state=up`);
  await page.focus("#sweep-stack");
  for (const key of ["Home", "ArrowRight", "ArrowRight"]) await page.keyboard.press(key);
  assert.match(await tip(page), /^b0\.0062/);
  await page.keyboard.press("Enter");
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.0062/);
  await page.close();
});

test("cancelling a sweep keeps its points, frees the service, and what is missing can be asked for", async (t) => {
  const one = await startService(["--sweeps", "1"]);
  t.after(() => one.stop());
  const page = await browser.context.newPage();
  await page.goto(`${one.url}/?${long}`);
  await page.waitForFunction(() => document.getElementById("sweep-bar").value > 2);
  const body = JSON.stringify({axes: [{parameter: "b", values: [0.02]}], cycles: 10});
  const other = () => fetch(`${one.url}/v1/sweep`, {method: "POST", body});
  assert.equal((await other()).status, 503, "the one sweep that the service takes is running");
  assert.match(
    await page.textContent("#sweep-rate"),
    /\d+ of 300 points · .* per second · .* left/,
  );
  await page.click("#sweep-cancel");
  await page.waitForFunction(
    () => document.getElementById("sweep-message").textContent === "cancelled",
  );
  const began = Date.now();
  while ((await other()).status !== 200) assert.ok(Date.now() - began < 3000, "idle soon");
  const kept = await page.evaluate(() => document.getElementById("sweep-bar").value);
  assert.ok(kept > 2 && kept < 300);
  let asked;
  page.on("request", (request) => {
    if (request.url().endsWith("/v1/sweep")) asked = JSON.parse(request.postData());
  });
  await page.click("#sweep-resume");
  await page.waitForFunction((kept) => document.getElementById("sweep-bar").value > kept, kept);
  assert.equal(asked.indices.length, 300 - kept);
  await page.close();
});

test("a stream that breaks is asked again for what it did not bring", async () => {
  const page = await browser.context.newPage();
  const asked = [];
  await page.route("**/v1/sweep", async (route) => {
    const request = route.request().postDataJSON();
    asked.push(request.indices?.length);
    if (asked.length > 2) return route.continue();
    const response = await route.fetch();
    const text = await response.text();
    // Half an answer, cut within a line; then none.
    if (asked.length > 1) return route.abort("connectionreset");
    return route.fulfill({response, body: text.slice(0, text.length / 2)});
  });
  await page.goto(`${service.url}/?${small}`);
  await swept(page, 1);
  assert.equal(asked.length, 3);
  assert.equal(asked[0], undefined);
  assert.ok(asked[1] > 3 && asked[1] < 21, `${asked[1]} were missing`);
  assert.equal(asked[2], asked[1]);
  assert.match(await page.textContent("#sweep-rate"), /24 of 24/);
  assert.equal(await page.textContent("#sweep-message"), "");
  const file = await downloaded(page, "#sweep-download");
  assert.equal(file.name, "sweep-b.ndjson");
  const [first, ...points] = file.text.trim().split("\n").map(JSON.parse);
  assert.equal(first.type, "start");
  const indices = points.map((line) => line.index).sort((a, b) => a - b);
  assert.deepEqual(indices, [...Array(24).keys()]);
  browser.complaints.length = 0; // Chromium notes the connection that was reset
  await page.close();
});

test("faults of a sweep are shown at their fields", async () => {
  const page = await visit(`?${small}`);
  const fault = async (id, value, text) => {
    const before = await page.inputValue(field(id));
    await page.fill(field(id), value);
    await page.click("#sweep-run");
    await page.waitForFunction(
      ([id, text]) => document.getElementById(id).textContent.includes(text),
      [id, text],
    );
    assert.equal(await page.getAttribute(field(id), "aria-invalid"), "true");
    await page.fill(field(id), before);
  };
  await fault("sweep-axis1-error-count", "0", "must lie in");
  await fault("sweep-axis1-error-from", "-1", "must lie in");
  await fault("sweep-error-cycles", "-1", "must lie in");
  await fault("sweep-base-error-R", "7", "must lie in");
  await fault("sweep-error-starts", "x0=0; x9=1", "unknown field");
  await fault("sweep-axis1-error-count", "1000000", "at most");
  await page.selectOption(field("sweep-axis2-error-parameter"), "b");
  await page.click("#sweep-run");
  await page.waitForFunction(() =>
    document.getElementById("sweep-axis2-error-from").textContent.includes("needs from"),
  );
  assert.match(await page.textContent("#sweep-rate"), /24 of 24/, "the last sweep is still there");
  browser.complaints.length = 0; // Chromium notes each 422 in its console
  await page.close();
});

test("two axes make a map, in colours or of regimes; a click on a cell simulates it", async () => {
  const axes = "axis1=b,0.005,0.035,12&axis2=R,0.4,0.8,8";
  const run = "cycles=60&transient_cycles=30&damping=closed_form";
  const page = await visit(`?tab=sweep&${axes}&${run}`);
  assert.ok((await colours(page, "#plot-sweep-map canvas")) > 40);
  await page.selectOption("#sweep-mapped", "regime");
  await page.waitForTimeout(100);
  for (const regime of ["III", "II"])
    assert.ok((await pixels(page, "#plot-sweep-map canvas", `regime-${regime}`)) > 1000, regime);
  assert.match(page.url(), /map=regime/);
  await hoverAt(page, "#plot-sweep-map", 0.3, 0.06);
  assert.match(await tip(page), /^b0\.013\d+ mR0\.8regimeIII/);
  await clickAt(page, "#plot-sweep-map", 0.3, 0.06);
  await drawn(page, 1);
  assert.match(page.url(), /\?b=0\.013\d+&R=0\.8&damping=closed_form&cycles=272$/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("several starts over a logarithmic axis have symbols of their own", async () => {
  const starts = "axis1=b,0.003,0.04,20,log&starts=x0=0;y_dot0=0.02&cycles=40";
  const page = await visit(`?tab=sweep&${starts}&section=stroboscopic&coordinate=gap`);
  assert.equal(await page.inputValue("#sweep-coordinate"), "gap");
  assert.match(await page.textContent("#sweep-starts"), /1: x\(0\) = 02: y′\(0\) = 0\.02/);
  for (const name of ["c1", "before"])
    assert.ok((await pixels(page, "#plot-sweep-lambda canvas", name)) > 20, name);
  await hoverAt(page, "#plot-sweep-section", 0.5);
  assert.match(await tip(page), /^b0\.01[01]\d* mstart 1regime.*start 2regime/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

const smallMap = "tab=sweep&axis1=b,0.005,0.035,8&axis2=R,0.4,0.8,6&cycles=30";
for (const query of [small, smallMap, "tab=sweep"])
  test(`on a narrow screen no sweep is wider than the screen: ${query}`, async () => {
    const page = await visit(`?${query}`, narrow);
    assert.ok(await fits(page));
    assert.deepEqual(await beyond(page, "#panel-sweep :is(canvas, select, figure, .key)"), []);
    await page.close();
  });

const platformSweep =
  "tab=sweep&axis1=f,13.7,14.3,13&starts=default+set&cycles=150" +
  "&m1=12&f0=14&damping_ratio=0.006&mass_ratio=0.01&F=0.0004&R=0.4&b=0.03&beside=x_max";
const fromOneStart = platformSweep.replace("starts=default+set&", "");
const peaks = (page) => cellsByName(page, "#sweep-peaks tbody tr");

test("the default set of starts shows the worst motion and, hollow, the best; the amplitude without the absorber is dashed; an untouched ball has its own colour", async () => {
  const page = await visit(`?${platformSweep}`);
  assert.ok(await page.isChecked("#sweep-default-set"));
  assert.equal(await page.inputValue("#sweep-quantity"), "x_max");
  assert.match(
    await page.textContent("#sweep-motions"),
    /the worst of the starts.*the best, where they end apart/,
  );
  assert.ok(await page.isVisible("#sweep-free"));
  for (const name of ["best", "wall", "text"])
    assert.ok((await pixels(page, "#plot-sweep-other canvas", name)) > 20, name);
  assert.ok((await pixels(page, "#plot-sweep-lambda canvas", "untouched")) > 20);
  assert.ok(Number(await page.textContent("#sweep-regime-none")) > 3);
  await hoverAt(page, "#plot-sweep-other", 0.29);
  const told = [
    /^f13\.85 Hzregimeno impacts/,
    /without16\.\d+ mm/,
    /middle1[67]\.\d+ mm, no impacts/,
    /at the wall1\d\.\d+ mm, Type III/,
    /moving.*previous point.*next point/,
  ];
  assert.match(await tip(page), new RegExp(told.map((part) => part.source).join(".*")));
  assert.match(
    await tip(page),
    /Click: simulate it, from its start: (middle|untouched|previous point|next point)$/,
  );
  await page.selectOption("#sweep-quantity", "z");
  assert.equal(await page.isVisible("#sweep-free"), false);
  assert.equal(await pixels(page, "#plot-sweep-other canvas", "wall"), 0);
  const {middle, "at the wall": wall, "without the absorber": free} = await peaks(page);
  assert.ok(Number(middle[0]) > 1.3 * Number(wall[0]), `${middle[0]} beside ${wall[0]} mm`);
  assert.deepEqual(free.slice(0, 2), ["33.3", "14"]);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("no verdict's colour is that of an untouched ball, and no regime's that of nothing", async () => {
  const page = await visit(`?${small}`);
  const named = await page.evaluate(() =>
    ["untouched", "regular", "chaotic", "undecided", "second", "regime-none", "nothing"].map(
      (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(),
    ),
  );
  assert.equal(new Set(named).size, named.length, named.join(" "));
  await page.close();
});

test("the box of the default set fills in the starts and leaves no place for a section; a list of starts takes the box away", async () => {
  const page = await visit(`?${small}`);
  await page.check("#sweep-default-set");
  assert.equal(await page.inputValue(field("sweep-error-starts")), "default set");
  for (const name of ["section", "carry_state"])
    assert.ok(await page.isDisabled(field(`sweep-error-${name}`)), name);
  const requests = asked(page, "/v1/sweep");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.equal(requests[0].starts, "default set");
  assert.equal(requests[0].section, undefined);
  assert.equal(await page.isVisible("#figure-sweep-section"), false);
  assert.match(page.url(), /starts=default\+set/);
  await page.fill(field("sweep-error-starts"), "x0=0; y_dot0=0.02");
  assert.equal(await page.isChecked("#sweep-default-set"), false);
  await page.click("#sweep-run");
  await swept(page, 3);
  assert.equal(requests[1].starts.length, 2);
  assert.equal(await page.isVisible("#sweep-motions"), false);
  await page.close();
});

test("a reduction folds an axis: over the other one there is the peak and where it is; where none is left, a table of the starts", async () => {
  const page = await visit(`?${platformSweep}&axis2=b,0.02,0.04,3`);
  assert.ok(await page.isVisible("#sweep-map"));
  await page.selectOption(field("sweep-error-reduce"), "max over f");
  await page.click("#sweep-run");
  await swept(page, 2);
  assert.match(page.url(), /reduce=max\+over\+f/);
  assert.match(await page.textContent("#sweep-rate"), /3 of 3/);
  assert.equal(await page.isVisible("#figure-sweep-lambda"), false);
  assert.deepEqual(
    await page.$$eval("#sweep-quantity option", (list) => list.map((o) => o.value)),
    ["x_max", "where", "z"],
  );
  const ofThreePoints = {text: 20, best: 2};
  for (const [name, least] of Object.entries(ofThreePoints))
    assert.ok((await pixels(page, "#plot-sweep-other canvas", name)) > least, name);
  await hoverAt(page, "#plot-sweep-other", 0.5);
  assert.match(await tip(page), /^b0\.03 m.*largest \|x\|2\d\.\d+ mm at f = 1[34]\.\d+ Hz/);
  await page.selectOption(field("sweep-axis2-error-parameter"), "none");
  await page.fill(`#sweep-base-group-system .field-b input`, "0.03");
  await page.click("#sweep-run");
  await swept(page, 3);
  assert.equal(await page.isVisible("#sweep-stack"), false);
  const {middle, "without the absorber": free} = await peaks(page);
  assert.ok(Number(middle[0]) > 20 && Number(middle[0]) < 33, middle[0]);
  assert.equal(free[0], "33.3");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a third axis has a map for each of its values, of the worst or the best start", async () => {
  const short = platformSweep.replace("R=0.4&", "").replace("cycles=150", "cycles=60");
  const axes = "axis2=b,0.025,0.035,3&axis3=R,0.4,0.6,2";
  const page = await visit(`?${short}&${axes}&map=x_max`);
  assert.match(await page.textContent("#sweep-rate"), /78 of 78/);
  assert.equal(await page.textContent("#sweep-slice-word"), "where R =");
  const first = await hash(page, "#plot-sweep-map canvas");
  await page.selectOption("#sweep-start", "best");
  await page.waitForTimeout(100);
  assert.notEqual(await hash(page, "#plot-sweep-map canvas"), first);
  await page.selectOption("#sweep-start", "0");
  await page.selectOption("#sweep-slice", "1");
  await page.waitForTimeout(100);
  assert.notEqual(await hash(page, "#plot-sweep-map canvas"), first);
  await clickAt(page, "#plot-sweep-map", 0.5, 0.5);
  await drawn(page, 1);
  const query = new URL(page.url()).searchParams;
  const value = (name) => Number(Number(query.get(name)).toFixed(9));
  assert.deepEqual(["f", "b", "R", "m1"].map(value), [14, 0.03, 0.6, 12]);
  browser.complaints.length = 0;
  await page.close();
});

test("what a sweep warns of is listed: that the motion depends on the start, and of a damping that is not the ratio's", async () => {
  const page = await visit(`?${fromOneStart}&damping=closed_form&y0=0`);
  const warnings = await page.textContent("#sweep-warnings");
  assert.match(warnings, /damping is closed_form \(given\)/);
  assert.match(warnings, /the motion depends on the start/);
  await page.close();
});

test("masses typed over an example, or swept, reset its damping, unless it was chosen; the base says where its values come from", async () => {
  const page = await visit("?tab=sweep");
  const damping = field("sweep-base-error-damping");
  assert.equal(await page.inputValue(damping), "closed_form");
  const epsilon = "#sweep-base-group-reduced .field-epsilon";
  assert.equal(await page.textContent(`${epsilon} .origin`), "default");
  assert.equal(await page.getAttribute(`${epsilon} input`, "placeholder"), "0.00840557");
  await page.selectOption(field("sweep-axis1-error-parameter"), "lambda");
  assert.equal(await page.inputValue(damping), "equation_of_motion");
  assert.match(await page.textContent("#sweep-note"), /damping is equation_of_motion/);
  await page.selectOption("#sweep-example", "1");
  assert.equal(await page.inputValue(damping), "closed_form");
  assert.equal(await page.textContent("#sweep-note"), "");
  await page.click("#sweep-cancel");
  await page.selectOption(damping, "equation_of_motion");
  await page.selectOption(damping, "closed_form");
  await page.click("#sweep-base-group-SI > summary");
  await page.fill("#sweep-base-group-SI .field-m1 input", "12");
  assert.equal(await page.inputValue(damping), "closed_form");
  assert.ok(await page.isDisabled(`${epsilon} input`));
  await page.close();
});

test("the section of a sweep in SI has its velocities in mm/s, or per unit of tau", async () => {
  const alone = fromOneStart.replace("&beside=x_max", "");
  const page = await visit(`?${alone}&section=impact&coordinate=x_dot_after`);
  const seconds = await hash(page, "#plot-sweep-section canvas");
  const requests = asked(page, "/v1/sweep");
  await page.click("#sweep-units >> text=τ");
  await page.waitForTimeout(100);
  assert.notEqual(await hash(page, "#plot-sweep-section canvas"), seconds);
  await page.click("#sweep-units >> text=mm/s");
  await page.waitForTimeout(100);
  assert.equal(await hash(page, "#plot-sweep-section canvas"), seconds);
  assert.equal(requests.length, 0);
  await page.close();
});

test("on a narrow screen the worst and the best of a default set, and their peaks, are no wider than the screen", async () => {
  const page = await visit(`?${platformSweep}`, narrow);
  assert.ok(await fits(page));
  assert.deepEqual(await beyond(page, "#panel-sweep :is(canvas, select, figure, td, .key)"), []);
  await page.close();
});

test("a platform by hand: typed over Fig. 3 it is simulated in seconds; its sweep tells the peaks from the wall and from the middle", async () => {
  const page = await visit("", {viewport: {width: 1400, height: 1000}});
  await page.click("#group-SI > summary");
  for (const [name, value] of Object.entries(platform)) await page.fill(input(name), value);
  await page.click("#run");
  await drawn(page, 2);
  assert.equal(await page.inputValue(input("damping")), "equation_of_motion");
  assert.equal(await page.inputValue("#preset"), "");
  assert.match(await page.textContent("#summary"), /amplitude without absorber33\.3 mm/);
  assert.match(await page.textContent("#summary"), /damping ζ = 0\.00600/);
  assert.match(await page.textContent("#plot-x .u-legend"), /^t \(s\)/);
  await page.click("#tab-sweep");
  await page.waitForFunction(() => document.getElementById("sweep-results").dataset.done);
  await page.selectOption("#sweep-example", {
    label: "A platform's resonance, worst of several starts",
  });
  await page.waitForFunction(() =>
    /^81 of 81/.test(document.getElementById("sweep-rate").textContent),
  );
  await swept(page, 2);
  assert.equal(await page.inputValue("#sweep-quantity"), "x_max");
  const {middle, "at the wall": wall} = await peaks(page);
  assert.equal(middle[0], "28.7");
  // Of a chaotic motion: 13.5 to 15.2 mm of neighbouring starts.
  assert.ok(Math.abs(Number(wall[0]) - 14.4) < 1.2, `${wall[0]} mm from the wall`);
  assert.equal(middle[2], "no impacts");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

// Measurements.

const asFile = (text, name = "record.csv", encoding = "utf8") => ({
  name,
  mimeType: "text/csv",
  buffer: Buffer.from(text, encoding),
});

/** A page that has identified a record. */
async function identify(text, query = "", options = {}) {
  const page = await visit(`?tab=measurement${query}`, options);
  await page.setInputFiles("#measure-file", asFile(text));
  await page.click("#measure-run");
  await identified(page, 1);
  return page;
}

const records = {};
/** Of 6 s: 68 impacts, too few to be called regular; of 12 s they are enough. */
async function regular(seconds = 6) {
  records[seconds] ??= await measured(service.url, "fig15", seconds);
  return records[seconds];
}
const measuredCanvases = [
  "a canvas",
  "x canvas",
  "qr canvas",
  "raw canvas",
  "R canvas",
  "steps canvas",
  "portrait",
  "section",
].map((name) => `#plot-measured-${name}`);
const rows = (page) =>
  page.$$eval("#measure-impacts tr", (list) =>
    list.map((row) =>
      [...row.cells].map((cell) => cell.querySelector("input")?.value ?? cell.textContent),
    ),
  );

test("a record shows itself when it is chosen; identified, its impacts, section, exponents and verdict", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(await regular(12)));
  await page.waitForSelector("#plot-measured-a canvas");
  assert.equal(
    await pixels(page, "#plot-measured-a canvas", "plus"),
    0,
    "no impacts are known yet",
  );
  await page.click("#measure-run");
  await identified(page, 1);
  for (const canvas of measuredCanvases) assert.ok((await colours(page, canvas)) > 3, canvas);
  for (const name of ["plus", "minus"])
    for (const plot of ["a canvas", "x canvas", "section"])
      assert.ok((await pixels(page, `#plot-measured-${plot}`, name)) > 20, `${plot}: ${name}`);
  const summary = await page.textContent("#measure-summary");
  assert.match(summary, /verdictregular the slope's 90 % interval lies below/);
  assert.match(summary, /impacts\d+ 0 left out/);
  assert.match(summary, /R at \+b0\.8[45]\d+ ± 0\.000\d+ \d+ impacts/);
  assert.match(summary, /b fitted\d\.\d+ ± 0\.0\d+ mm given 9 mm, agrees/);
  assert.match(summary, /forcing G(10|9\.99\d*|10\.0\d) mm/);
  const fitted = await page.textContent("#measure-fitted");
  assert.match(fitted, /frequency of the forcing8\.349\d* ± 0\.0000\d+ Hz/);
  assert.match(fitted, /damping ratio ζ0\.006\d*, as given/);
  assert.match(fitted, /half clearance b\d\.\d+ ± 0\.0\d+ mm/);
  assert.equal((await rows(page)).length, Number(summary.match(/impacts(\d+) 0 left/)[1]));
  const file = await downloaded(page, "#measure-download");
  assert.equal(JSON.parse(file.text).verdict, "regular");
  assert.equal(file.name, "record-identified.json");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a spreadsheet's file with a preamble, a row of units and decimal commas is the same record", async () => {
  const g = 9.80665;
  const [, ...samples] = (await regular()).trim().split("\n");
  const inUnits = samples.map((line) => {
    const [t, x, a] = line.split(",").map(Number);
    return [1e3 * t, 1e3 * x, a / g].join(";").replaceAll(".", ",");
  });
  const above = [
    "\ufeffsep=;",
    "Gerät;LMS 7;",
    "",
    "Time;Displacement;Acceleration 1;",
    "ms;mm;[g];",
  ];
  const text = [...above, ...inUnits.map((line) => `${line};`), ";;"].join("\r\n");
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(text, "record.txt", "utf16le"));
  await page.waitForSelector("#plot-measured-a canvas");
  assert.match(await page.textContent("#measure-about"), new RegExp(`, ${samples.length} samples`));
  await page.click("#measure-run");
  await identified(page, 1);
  assert.match(await page.textContent("#measure-summary"), /impacts68 0 left out/);
  for (const name of ["a canvas", "x canvas"])
    assert.ok((await pixels(page, `#plot-measured-${name}`, "plus")) > 20, name);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the form's link holds its fields, another tab keeps the record, and other units and separators draw the same", async () => {
  const text = (await regular(12))
    .replace(/^.*\n/, "Zeit;Weg;a\n")
    .replace(/(?<=\d),/g, ";")
    .replaceAll(".", ",");
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(text));
  await page.click("#measure-group-record > summary");
  await page.fill("[aria-describedby='measure-error-time_column']", "zeit");
  await page.fill("[aria-describedby='measure-error-displacement_column']", "Weg");
  await page.fill("[aria-describedby='measure-error-threshold']", "7");
  await page.click("#measure-run");
  await identified(page, 1);
  assert.match(
    page.url(),
    /tab=measurement&preset=fig15&time_column=zeit&displacement_column=Weg&threshold=7$/,
  );
  assert.match(await page.textContent("#measure-summary"), /verdictregular/);
  for (const name of ["a canvas", "x canvas"])
    assert.ok((await pixels(page, `#plot-measured-${name}`, "plus")) > 20, name);
  await page.click("#tab-simulation");
  await drawn(page, 1);
  await page.goBack();
  await page.waitForSelector("#plot-measured-a canvas");
  assert.equal(await page.getAttribute("#measure-results", "data-done"), "1");
  const again = await open(browser.context, page.url());
  assert.equal(
    await again.inputValue("[aria-describedby='measure-error-displacement_column']"),
    "Weg",
  );
  assert.equal(
    await again.inputValue("#measure-group-system label:has-text('b, m') input"),
    "0.009",
  );
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await again.close();
});

/** Adds the impact whose spike is at time t (s) of a record of 6 s: zooms there, and clicks on it. */
async function addBySpike(page, t) {
  const listed = (await rows(page)).length;
  const over = page.locator("#plot-measured-a .u-over");
  await page.click("#measure-add-at");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  const at = (share) => box.x + box.width * share;
  await page.mouse.move(at(t / 6 - 0.02), box.y + 40);
  await page.mouse.down();
  await page.mouse.move(at(t / 6 + 0.02), box.y + 40, {steps: 5});
  await page.mouse.up();
  await page.waitForTimeout(200);
  assert.equal((await rows(page)).length, listed, "the end of a drag adds nothing");
  const legend = "#plot-measured-a .u-legend .u-series:first-child .u-value";
  const timeAt = async (share) => {
    await page.mouse.move(at(share), box.y + 60);
    await page.waitForTimeout(50);
    return Number(await page.textContent(legend));
  };
  const left = await timeAt(0.01);
  const right = await timeAt(0.99); // a drag ends on whole pixels
  await page.mouse.click(at(0.01 + (0.98 * (t - left)) / (right - left)), box.y + 60);
  await page.waitForSelector("#measure-impacts tr.edited");
}

test("the list is edited by keyboard and by the plot; without one of its impacts the neighbours are inconsistent", async () => {
  const page = await identify(await regular(), "&preset=fig15");
  const before = await rows(page);
  assert.ok(await page.isDisabled("#measure-again"));
  await page.focus("#measure-impacts tr:nth-child(31) button");
  await page.keyboard.press("Enter");
  assert.equal((await rows(page))[30][5], "removed");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Restore");
  await page.click("#measure-again");
  await identified(page, 2);
  const after = await rows(page);
  assert.equal(after.length, before.length - 1);
  assert.match(
    await page.textContent("#measure-warnings"),
    /\d of \d+ impacts are inconsistent and left out/,
  );
  assert.match(after[30][5], /missing/);
  const crosses = await pixels(page, "#plot-measured-a canvas", "wall");
  assert.ok(crosses > 10, "left out impacts have marks of their own");
  await page.check("#measure-doubtful");
  assert.ok((await rows(page)).length < 10);
  await page.uncheck("#measure-doubtful");
  const t = Number(before[30][1]);
  await addBySpike(page, t);
  const added = (await rows(page)).find((row) => row[5] === "added");
  assert.ok(Math.abs(added[1] - t) < 0.002, `${added[1]} beside ${t}`);
  await page.click("#measure-again");
  await identified(page, 3);
  assert.equal(await page.textContent("#measure-warnings"), "");
  // Move one, by its field, and take all back.
  const fifth = "#measure-impacts tr:nth-child(5) input";
  await page.fill(fifth, "1e9");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute(fifth, "aria-invalid"), "true");
  await page.fill(fifth, String(Number(before[4][1]) + 0.001));
  await page.keyboard.press("Enter");
  assert.match((await rows(page))[4][5], /moved from/);
  await page.click("#measure-reset");
  const times = (list) => list.map((row) => Number(row[1]).toFixed(3));
  assert.deepEqual(times(await rows(page)), times(before));
  await page.fill("#measure-add input", "0.5");
  await page.keyboard.press("Enter");
  assert.ok((await rows(page)).some((row) => row[5] === "added"));
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("of a record without acceleration the impacts are found, too, by the displacement's kinks", async () => {
  const page = await identify(await regular(), "&preset=fig15");
  const times = (await rows(page)).map((row) => Number(row[1])).filter((t) => t < 2.4);
  const lines = (await regular()).split("\n").slice(0, 5001);
  const withoutIt = lines.map((line) => line.replace(/,[^,]*$/, ""));
  await page.setInputFiles("#measure-file", asFile(withoutIt.join("\n")));
  await page.waitForFunction(() =>
    document.getElementById("measure-about").textContent.includes("5000 samples"),
  );
  await page.click("#measure-run");
  await identified(page, 2);
  const found = (await rows(page)).map((row) => Number(row[1])).filter((t) => t < 2.4);
  assert.equal(found.length, times.length);
  for (const [k, t] of times.entries()) assert.ok(Math.abs(found[k] - t) < 0.001, `${t}`);
  assert.match(await page.textContent("#measure-warnings"), /without an acceleration/);
  assert.equal(await page.isVisible("#figure-measured-a"), false);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a list too long for an address is sent as JSON", async () => {
  const text = await regular(12);
  const page = await identify(text, "&preset=fig15");
  let type;
  page.on("request", (request) => {
    if (request.url().includes("/v1/identify")) type = request.headers()["content-type"];
  });
  // So many columns of nothing, as long a name, fill the address.
  await page.click("#measure-group-record > summary");
  const name = "acceleration_m_s2".padEnd(6100, "x");
  await page.setInputFiles("#measure-file", asFile(text.replace("acceleration_m_s2", name)));
  await page.fill("[aria-describedby='measure-error-acceleration_column']", name);
  await page.click("#measure-run");
  await identified(page, 2);
  assert.equal(type, "application/json");
  assert.match(await page.textContent("#measure-summary"), /verdictregular/);
  await page.close();
});

test("what is wrong with a file is shown with its line; what is wrong with a field, at the field", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.click("#measure-run");
  assert.match(await page.textContent("#measure-message"), /choose a file/);
  const lines = (await regular()).split("\n");
  lines[6] = "0.003,abc,1";
  await page.setInputFiles("#measure-file", asFile(lines.join("\n")));
  await page.click("#measure-run");
  await page.waitForSelector("#measure-lines:not([hidden])");
  assert.equal(
    await page.textContent("#measure-message"),
    'line 7, column displacement_m: "abc" is no number',
  );
  assert.match(await page.textContent("#measure-lines .at-fault"), /^ +7 {2}0\.003,abc,1\n$/);
  await page.setInputFiles("#measure-file", asFile(await regular()));
  assert.equal(await page.isVisible("#measure-lines"), false);
  const b = page.locator("#measure-group-system label:has-text('b, m') input");
  await b.fill("-1");
  await page.click("#measure-run");
  await page.waitForSelector("#measure-error-b:not(:empty)");
  await b.fill("0.009");
  await page.selectOption("#measure-preset", "");
  await page.click("#measure-run");
  await page.waitForSelector("#measure-error-m1:not(:empty)");
  await page.selectOption("#measure-preset", "fig15");
  await page.click("#measure-run");
  await identified(page, 1);
  browser.complaints.length = 0; // Chromium notes each 422 in its console
  await page.close();
});

test("on a narrow screen no measurement is wider than the screen", async () => {
  const page = await identify(await regular(), "&preset=fig15", narrow);
  assert.ok(await fits(page));
  const parts = "#panel-measurement :is(canvas, select, figure, input, .scroll, .u-legend)";
  assert.deepEqual(await beyond(page, parts, ".scroll td"), []);
  await page.close();
});

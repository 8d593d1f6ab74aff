// The measurement tab in Chromium.
import assert from "node:assert/strict";
import {test} from "node:test";
import {measured} from "../record.mjs";
import {drawn, identified, open, painted} from "./browser.mjs";
import {
  beyond,
  browser,
  colours,
  downloaded,
  fits,
  narrow,
  pixels,
  service,
  visit,
} from "./support.mjs";

const asFile = (text, name = "record.csv", encoding = "utf8") => ({
  name,
  mimeType: "text/csv",
  buffer: Buffer.from(text, encoding),
});

/** A page that has identified a record. */
async function identify(text, query = "", options = {}) {
  const page = await visit(`?tab=measurement${query}`, options);
  await page.setInputFiles("#measure-file", asFile(text)); // identified without a click
  await identified(page, 1);
  return page;
}

const records = {};
/**
 * A record of the periodic experiment. 6 s hold 68 impacts, too few for a verdict; 12 s are enough.
 */
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

const column = (quantity) =>
  `#measure-fields [aria-describedby='measure-error-${quantity}_column']`;

test("a chosen record is drawn and identified; its impacts, section, exponents and verdict are shown", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(await regular(12)));
  // A record whose columns are known is identified at once.
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
  assert.match(fitted, /clearance b\d\.\d+ ± 0\.0\d+ mm/);
  assert.equal((await rows(page)).length, Number(summary.match(/impacts(\d+) 0 left/)[1]));
  const file = await downloaded(page, "#measure-download");
  assert.equal(JSON.parse(file.text).verdict, "regular");
  assert.equal(file.name, "record-identified.json");
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("an address fixes the values that it names, and no others", async () => {
  const page = await visit("?tab=measurement&preset=fig15&fixed=displacement_offset");
  const fixed = "#measure-fields [role=group][aria-label=fixed] input:checked";
  assert.deepEqual(await page.$$eval(fixed, (all) => all.map(({value}) => value)), [
    "displacement_offset",
  ]);
  await page.close();
});

test("a value that is withheld is shown as a dash", async () => {
  // For a third of the record the sensor of the displacement shows 5 % less.
  const [head, ...samples] = (await regular()).trim().split("\n");
  const sagging = samples.map((line) => {
    const [t, x, a] = line.split(",").map(Number);
    return [t, t > 2 && t < 4 ? 0.95 * x : x, a].join(",");
  });
  const page = await identify([head, ...sagging].join("\n"), "&preset=fig15");
  assert.match(await page.textContent("#measure-fitted"), /clearance b– mm(?!, as given)/);
  assert.match(await page.textContent("#measure-summary"), /b fitted– given 9 mm/);
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

test("a link keeps the form's fields, switching tabs keeps the record, and other units and separators draw the same", async () => {
  const text = (await regular(12))
    .replace(/^.*\n/, "Zeit;Weg;a\n")
    .replace(/(?<=\d),/g, ";")
    .replaceAll(".", ",");
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(text));
  await page.waitForSelector(column("time"));
  await page.fill(column("time"), "zeit");
  await page.fill(column("displacement"), "Weg");
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
  assert.equal(await again.inputValue(column("displacement")), "Weg");
  assert.equal(await again.inputValue("#measure-group-system label:has-text('b, mm') input"), "9");
  assert.deepEqual(browser.complaints, []);
  await page.close();
  await again.close();
});

/** Adds the impact whose spike is at time t (s) of a record of 6 s: zooms in and clicks on it. */
async function addBySpike(page, t) {
  const listed = (await rows(page)).length;
  const over = page.locator("#plot-measured-a .over");
  await page.click("#measure-add-at");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  const at = (share) => box.x + box.width * share;
  await page.mouse.move(at(t / 6 - 0.02), box.y + 40);
  await page.mouse.down();
  await page.mouse.move(at(t / 6 + 0.02), box.y + 40, {steps: 5});
  await page.mouse.up();
  await painted(page);
  assert.equal((await rows(page)).length, listed, "the end of a drag adds nothing");
  const timeAt = async (share) => {
    await page.mouse.move(at(share), box.y + 60);
    await painted(page);
    return Number(await page.getAttribute("#plot-measured-a .cursor", "data-at"));
  };
  const left = await timeAt(0.01);
  const right = await timeAt(0.99); // a drag ends on whole pixels
  await page.mouse.click(at(0.01 + (0.98 * (t - left)) / (right - left)), box.y + 60);
  await page.waitForSelector("#measure-impacts tr.edited");
}

test("the list is edited by keyboard and plot; a removed impact makes its neighbours inconsistent", async () => {
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
  // Moves an impact by its field and undoes all edits.
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

test("impacts added before the first identification stay where the oscillator changes", async () => {
  const page = await visit("?tab=measurement&preset=fig15&m1=0");
  await page.setInputFiles("#measure-file", asFile(await regular()));
  await page.waitForSelector("#measure-message.fault");
  await page.fill("#measure-add input", "0.5");
  await page.keyboard.press("Enter");
  await page.fill("#measure-fields [aria-describedby='measure-error-m1']", "4");
  await page.keyboard.press("Tab");
  assert.deepEqual(
    (await rows(page)).map((row) => row[5]),
    ["added"],
  );
  browser.complaints.splice(0); // the error's status
  await page.close();
});

test("without an acceleration the impacts are found at kinks of the displacement", async () => {
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

test("fields too long for an address are sent as JSON", async () => {
  const text = await regular(12);
  const page = await identify(text, "&preset=fig15");
  let type;
  page.on("request", (request) => {
    if (request.url().includes("/v1/identify")) type = request.headers()["content-type"];
  });
  // A long column name makes the address too long.
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

test("errors of a file name its line, errors of a field are shown at the field", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.click("#measure-run");
  assert.match(await page.textContent("#measure-message"), /choose a file/);
  const lines = (await regular()).split("\n");
  lines[6] = "0.003,abc,1";
  await page.setInputFiles("#measure-file", asFile(lines.join("\n")));
  await page.click("#measure-run");
  const fault = 'line 7, column displacement_m: "abc" is not a number';
  await page.locator("#measure-message.fault", {hasText: fault}).waitFor();
  await page.setInputFiles("#measure-file", asFile(await regular()));
  const b = page.locator("#measure-group-system label:has-text('b, mm') input");
  await b.fill("-1");
  await page.click("#measure-run");
  await page.waitForSelector("#measure-error-b:not(:empty)");
  await b.fill("9");
  await page.selectOption("#measure-preset", "");
  await page.click("#measure-run");
  await page.waitForSelector("#measure-error-m1:not(:empty)");
  await page.selectOption("#measure-preset", "fig15");
  await page.click("#measure-run");
  await identified(page, 1);
  browser.complaints.length = 0; // Chromium logs each 422
  await page.close();
});

test("a measurement fits a narrow screen", async () => {
  const page = await identify(await regular(), "&preset=fig15", narrow);
  assert.ok(await fits(page));
  const parts = "#panel-measurement :is(canvas, select, figure, input, .scroll, .legend)";
  assert.deepEqual(await beyond(page, parts, ".scroll td"), []);
  await page.close();
});

test("a chosen record is identified, its plots are tagged with the paper's figures, and each plot can be exported", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(await regular()));
  await identified(page, 1);
  const tags = await page.$$eval("#panel-measurement .tag", (list) =>
    list.map((node) => node.textContent.replace("as ", "")),
  );
  assert.deepEqual(
    tags,
    [15, 16, 17, 18, 19, 19].map((n) => `Fig. ${n}`),
  );
  for (const name of ["a", "x", "qr", "R"]) {
    const figure = page.locator("figure", {has: page.locator(`#plot-measured-${name}`)});
    await figure.locator("button.menu").click();
    assert.match(await page.textContent("#data"), /68 impacts, not decided/);
    const csv = await downloaded(page, "#data button:text-is('CSV')");
    assert.equal(csv.name, `measured-${name}.csv`);
    assert.ok(csv.text.split("\n").length > 60, name);
    await page.click("#data button:text-is('Close')");
  }
  await page.focus("#plot-measured-x");
  for (const key of ["Home", "n", "n"]) await page.keyboard.press(key);
  const [first, second] = (await rows(page)).map((row) => Number(row[1]));
  const now = Number(await page.getAttribute("#plot-measured-x", "aria-valuenow"));
  assert.ok(now > first - 1e-4 && now < second + 1e-4, `${now} is no impact`);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a file with unknown column names is identified once its columns are chosen", async () => {
  const text = (await regular()).replace(/^.*\n/, "clock,wire,piezo\n");
  const page = await visit("?tab=measurement&preset=fig15");
  await page.setInputFiles("#measure-file", asFile(text));
  await page.waitForSelector(column("time"));
  assert.match(await page.textContent("#measure-message"), /choose which column is the time/);
  const names = await page.$$eval("#measure-columns option", (all) => all.map(({value}) => value));
  assert.deepEqual(names, ["clock", "wire", "piezo"]);
  await page.fill(column("displacement"), "wire");
  await page.fill(column("acceleration"), "piezo");
  await page.fill(column("time"), "clock");
  await page.press(column("time"), "Tab");
  await identified(page, 1);
  assert.match(await page.textContent("#measure-summary"), /impacts68 0 left out/);
  assert.match(page.url(), /time_column=clock/);
  browser.complaints.length = 0; // Chromium logs the 422 for the unknown columns
  await page.close();
});

test("a binary file is rejected with advice", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  const requests = [];
  page.on("request", (request) => requests.push(request.url()));
  const bytes = Buffer.from(Array.from({length: 4000}, (_, i) => (i * 37) % 251));
  const file = {name: "record.wav", mimeType: "audio/wav", buffer: bytes};
  await page.setInputFiles("#measure-file", file);
  await page.waitForFunction(() =>
    document.getElementById("measure-message").textContent.includes("not a text file"),
  );
  assert.match(
    await page.textContent("#measure-message"),
    /record\.wav cannot be read: it is not a text file; scripts\/to-csv/,
  );
  assert.deepEqual(requests, []);
  await page.close();
});

/** Checks that the true value lies within four standard errors of a card's value. */
function agrees(summary, name, truth) {
  const [, value, error] = summary.match(new RegExp(`${name}([\\d.]+) ± ([\\d.]+)`)).map(Number);
  assert.ok(Math.abs(value - truth) < 4 * error, `${name}: ${value} ± ${error}, not ${truth}`);
}

test("Measurement identifies the restitution and clearance of a simulated run", async () => {
  const page = await visit("?preset=fig3&R=0.65&tau_end=600");
  await page.click("#measure-this");
  await identified(page, 1);
  assert.equal(await page.inputValue("#measure-preset"), "");
  const summary = await page.textContent("#measure-summary");
  assert.match(summary, /verdictchaotic/);
  for (const wall of ["R at \\+b", "R at −b"]) agrees(summary, wall, 0.65);
  agrees(summary, "b fitted", 22);
  assert.match(page.url(), /tab=measurement&b=0\.022&m1=1&k1=1/);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("the tab opens with a sample, and a record of one's own is shown again after a reload", async () => {
  const page = await visit("?tab=measurement");
  await identified(page, 1);
  assert.match(await page.textContent("#measure-about"), /^sample-fig20\.csv/);
  await page.setInputFiles("#measure-file", asFile(await regular(), "mine.csv"));
  await page.waitForFunction(() => document.getElementById("measure-results").dataset.done > 1);
  const summary = await page.textContent("#measure-summary");
  const impacts = /impacts(\d+)/;
  await page.reload();
  await identified(page, 1);
  assert.match(await page.textContent("#measure-about"), /^mine\.csv/);
  assert.equal(
    impacts.exec(await page.textContent("#measure-summary"))[1],
    impacts.exec(summary)[1],
  );
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a simulated record is identified with one click", async () => {
  const page = await visit("?tab=measurement");
  await page.click("#measure-samples button:has-text('periodic')");
  await identified(page, 1);
  assert.equal(await page.inputValue("#measure-preset"), "fig15");
  const summary = await page.textContent("#measure-summary");
  assert.match(summary, /verdictregular/);
  for (const wall of ["R at \\+b", "R at −b"]) agrees(summary, wall, 0.85);
  assert.deepEqual(browser.complaints, []);
  await page.close();
});

test("a long identification shows the elapsed time and can be cancelled", async () => {
  const page = await visit("?tab=measurement&preset=fig15");
  await page.route("**/v1/identify?*", () => {}); // never answered
  await page.setInputFiles("#measure-file", asFile(await regular()));
  await page.waitForFunction(() =>
    /identifying \d+ samples … [12] s/.test(document.getElementById("measure-message").textContent),
  );
  await page.click("#measure-cancel");
  await page.waitForFunction(
    () => document.getElementById("measure-message").textContent === "cancelled",
  );
  assert.equal(await page.isVisible("#measure-cancel"), false);
  browser.complaints.length = 0; // Chromium logs the aborted request
  await page.close();
});

test("an impact picked in one plot of a measurement is ringed in the others", async () => {
  const page = await identify(await regular(), "&preset=fig15");
  await page.locator("#plot-measured-section").scrollIntoViewIfNeeded();
  await page.evaluate(() => {
    const canvas = document.getElementById("plot-measured-section");
    const {left, top, width, height} = canvas.getBoundingClientRect();
    // Scans the plane; the last point passed stays picked.
    for (let i = 1; i < 40; ++i)
      for (let j = 1; j < 40; ++j) {
        const at = {clientX: left + (i / 40) * width, clientY: top + (j / 40) * height};
        canvas.dispatchEvent(new PointerEvent("pointermove", at));
      }
  });
  for (const name of ["portrait", "section"])
    assert.ok(await page.isVisible(`figure:has(#plot-measured-${name}) .lit:not([hidden])`), name);
  assert.ok(await page.isVisible("#plot-measured-x .lit"));
  const t = Number(await page.getAttribute("#plot-measured-x", "aria-valuenow"));
  const times = (await rows(page)).map((row) => Number(row[1]));
  assert.ok(
    times.some((v) => Math.abs(v - t) < 1e-4),
    `${t} is no impact`,
  );
  await page.close();
});

test("the newer of two samples is identified, and a new oscillator keeps the chosen columns", async () => {
  const page = await visit("?tab=measurement");
  await page.click("#measure-samples button:has-text('periodic')");
  await page.click("#measure-samples button:has-text('chaotic')");
  await identified(page, 1);
  assert.match(await page.textContent("#measure-about"), /sample-fig20/);
  assert.match(await page.textContent("#measure-summary"), /verdictchaotic/);
  await page.click("#measure-group-record > summary");
  await page.fill(column("displacement"), "displacement_m");
  await page.press(column("displacement"), "Tab");
  await identified(page, 2);
  await page.selectOption("#measure-preset", "fig15");
  assert.match(page.url(), /displacement_column=displacement_m/);
  assert.ok(
    await page.$eval("#measure-results", (node) => node.classList.contains("stale")),
    "what is shown is of the other oscillator",
  );
  await page.close();
});

// Reports in a browser (how long they take to open is printed, not judged): small, silent on the network, zoomed, light and dark, on any width, on paper.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, made, open, results, run } from "./common.mjs";

let browser;
let pages;

before(async () => {
  browser = await launch("--disable-gpu");
  const [plate, slow] = [made("plate", "run", "scenarios/plate_edge.toml"), made("slow", "run", "scenarios/slow_regulator.toml")];
  const compare = join(results, "compare.html");
  run("compare", plate, slow, "--out", compare, "--force");
  pages = {
    diagnosis: join(made("diagnosis", "diagnose", "assets/proof/cases/case-01"), "report.html"),
    run: join(plate, "report.html"),
    bench: join(made("bench", "run", "scenarios/paper_stairstep_sensed.toml"), "report.html"),
    compare,
  };
});
after(() => browser.close());

const address = (name) => String(pathToFileURL(pages[name]));
const first = "figure.chart .plot[data-drawn]";
// The charts are above the fold of no page: go there, and they are drawn.
const drawn = async (page) => {
  await page.locator("figure.chart").first().scrollIntoViewIfNeeded();
  await page.waitForSelector(first);
};

for (const name of ["diagnosis", "run", "bench", "compare"]) {
  test(`${name}: opens, at most 3 MB, without a network or an error`, async () => {
    assert.ok(statSync(pages[name]).size <= 3_000_000, `${statSync(pages[name]).size} bytes`);
    const { page, faults, requests, seconds } = await open(browser, address(name));
    await drawn(page);
    assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), []);
    assert.deepEqual(faults, []);
    console.log(`${name}: ${(statSync(pages[name]).size / 1e6).toFixed(2)} MB, open after ${seconds.toFixed(2)} s`);
    await page.context().close();
  });

  test(`${name}: nothing overflows on a phone, a tablet and a wide screen, light or dark`, async () => {
    for (const width of [390, 1024, 1920]) {
      for (const colorScheme of ["light", "dark"]) {
        const { page, faults } = await open(browser, address(name), { viewport: { width, height: 900 }, colorScheme });
        await page.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
        await drawn(page);
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        assert.ok(beyond <= 0, `${beyond} px beyond ${width}`);
        const theme = await page.evaluate(() => document.documentElement.dataset.theme);
        assert.equal(theme, colorScheme);
        assert.deepEqual(faults, []);
        await page.context().close();
      }
    }
  });
}

test("a chart zooms with all of its recording, and shows all again", async () => {
  const { page, faults } = await open(browser, address("run"));
  await drawn(page);
  const shown = () => page.evaluate(() => window.idcCharts.filter((chart) => chart.plot && chart.told.group === "run").map((chart) => [chart.plot.scales.x.min, chart.plot.scales.x.max]));
  const [whole] = await shown();
  const box = await page.locator("figure.chart .u-over").first().boundingBox();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 60, { steps: 5 });
  await page.mouse.up();
  const zoomed = await shown();
  assert.ok(zoomed.length > 1, "several charts of the run are drawn");
  for (const [from, to] of zoomed) {
    assert.ok(Math.abs((to - from) / (whole[1] - whole[0]) - 0.25) < 0.02, `${from} to ${to} of ${whole}`);
  }
  await page.locator("figure.chart.zoomed button.reset").first().click();
  for (const ends of await shown()) assert.deepEqual(ends, whole);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("values stand under the pointer", async () => {
  const { page } = await open(browser, address("run"));
  await drawn(page);
  const value = page.locator("figure.chart .u-legend .u-value").nth(1);
  assert.equal(await value.textContent(), "–");
  const box = await page.locator("figure.chart .u-over").first().boundingBox();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.5 * box.height);
  assert.match(await value.textContent(), /^-?\d/);
  await page.context().close();
});

test("two fingers zoom a chart", async () => {
  const { page } = await open(browser, address("run"), { hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  await drawn(page);
  const box = await page.locator("figure.chart .u-over").first().boundingBox();
  const client = await page.context().newCDPSession(page);
  const touch = async (type, places) => {
    await client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map((x) => ({ x: box.x + x * box.width, y: box.y + 0.5 * box.height })) });
  };
  await touch("touchStart", [0.4, 0.6]);
  await touch("touchMove", [0.2, 0.8]);
  await touch("touchEnd", []);
  const [min, max, last] = await page.evaluate(() => { const { plot } = window.idcCharts[0]; return [plot.scales.x.min, plot.scales.x.max, plot.data[0].at(-1)]; });
  assert.ok(Math.abs((max - min) / last - 1 / 3) < 0.03, `${min} to ${max} of ${last}`);
  await page.context().close();
});

test("the theme switches and is remembered", async () => {
  const { page } = await open(browser, address("diagnosis"));
  await drawn(page);
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.getByRole("button", { name: "Light or dark" }).click();
  const dark = await ground();
  assert.notEqual(light, dark);
  await page.reload();
  assert.equal(await ground(), dark);
  await page.context().close();
});

test("it prints light, with every chart", async () => {
  const { page } = await open(browser, address("diagnosis"), { colorScheme: "dark" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  const state = await page.evaluate(() => [document.documentElement.dataset.theme, window.idcCharts.every((chart) => chart.plot)]);
  assert.deepEqual(state, ["light", true]);
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 50_000, `${pdf.length} bytes`);
  await page.context().close();
});

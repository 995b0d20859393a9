// Reports in a browser (how long they take to open is printed, not judged): small, silent on the network, zoomed, light and dark, on paper. What they look like: pages.test.mjs.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, made, open, results, run, unwrapped } from "./common.mjs";

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
}

for (const [name, count] of [["run", 2], ["bench", 1]]) {
  test(`${name}: the picture is there`, async () => {
    const { page, faults } = await open(browser, address(name));
    await unwrapped(page);
    const pictures = await page.evaluate(async () => Promise.all([...document.querySelectorAll(".sketches svg image")].map(async (picture) => {
      const image = new Image();
      image.src = picture.getAttribute("href");
      await image.decode();
      const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      const colours = new Set();
      let covered = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] > 128) { covered += 1; colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]); }
      }
      return [4 * covered / data.length, colours.size];
    })));
    assert.equal(pictures.length, count);
    for (const [share, colours] of pictures) assert.ok(share > 0.02 && share < 0.9 && colours > 3, `${share} covered, ${colours} colours`);
    if (name === "run") {
      const words = await page.locator(".sketches text").allTextContents();
      assert.ok(words.some((word) => /^\+[\d.]+ %$/.test(word)) && words.includes("force error") && words.includes("start"), words.join());
      assert.equal(await page.evaluate(() => new Set([...document.querySelectorAll(".sketches figure:nth-child(2) line[stroke-width='5']")].map((line) => line.getAttribute("stroke"))).size > 1), true);
    }
    assert.deepEqual(faults, []);
    await page.context().close();
  });
}

test("phase names stand above the signals, zoomed too", async () => {
  for (const width of [390, 1280]) {
    const { page } = await open(browser, address("run"), { viewport: { width, height: 900 } });
    await drawn(page);
    const names = () => page.evaluate(() => { const { plot } = window.idcCharts[0]; return [plot.names, plot.bbox.top / devicePixelRatio]; });
    const [all, top] = await names();
    assert.deepEqual(all.map((name) => name.label), ["approach", "engage", "follow", "retract"]);
    for (const name of all) assert.ok(name.top >= 0 && name.bottom <= top, `${name.label} to ${name.bottom}, signals from ${top}`);
    for (const [which, name] of all.entries()) {
      for (const other of all.slice(which + 1)) assert.ok(name.right <= other.left || name.bottom <= other.top || other.bottom <= name.top, `${name.label} on ${other.label}`);
    }
    // The phase that is looked at is named though its beginning is out of sight.
    await page.evaluate(() => { const { plot } = window.idcCharts[0]; const [, , follow, retract] = window.idcCharts[0].content.markers; plot.setScale("x", { min: follow.at + 0.4 * (retract.at - follow.at), max: follow.at + 0.6 * (retract.at - follow.at) }); });
    await page.waitForTimeout(100);
    const [zoomed] = await names();
    assert.deepEqual(zoomed.map((name) => name.label), ["follow"]);
    await page.context().close();
  }
});

// Ranges of the charts of the run that are drawn.
const shown = (page) => page.evaluate(() => window.idcCharts.filter((chart) => chart.plot && chart.content.group === "run").map((chart) => [chart.plot.scales.x.min, chart.plot.scales.x.max]));
// Draws over the second quarter of the first chart.
const zoom = async (page) => {
  const box = await page.locator("figure.chart .u-over").first().boundingBox();
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 60, { steps: 5 });
  await page.mouse.up();
};

test("a chart zooms with all of its recording, and shows all again", async () => {
  const { page, faults } = await open(browser, address("run"));
  await drawn(page);
  const [whole] = await shown(page);
  await page.evaluate(() => {
    const { plot } = window.idcCharts[0];
    const { setScale } = plot;
    window.calls = 0;
    plot.setScale = (...range) => { window.calls += 1; setScale(...range); };
  });
  await zoom(page);
  const zoomed = await shown(page);
  assert.ok(zoomed.length > 1, "several charts of the run are drawn");
  for (const [from, to] of zoomed) {
    assert.ok(Math.abs((to - from) / (whole[1] - whole[0]) - 0.25) < 0.02, `${from} to ${to} of ${whole}`);
    assert.deepEqual([from, to], zoomed[0]);
  }
  assert.equal(await page.evaluate(() => window.calls), 0, "those that follow do not tell the first chart in turn");
  await page.locator("figure.chart.zoomed button.reset").first().click();
  for (const ends of await shown(page)) assert.deepEqual(ends, whole);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a chart that comes into sight takes the zoom of its recording", async () => {
  const { page, faults } = await open(browser, address("run"), { viewport: { width: 1280, height: 400 } });
  await drawn(page);
  await zoom(page);
  const [zoomed, ...others] = await shown(page);
  const last = page.locator("figure.chart").last();
  assert.equal(await last.locator("[data-drawn]").count(), 0, "the last chart waits");
  await last.scrollIntoViewIfNeeded();
  await last.locator("[data-drawn]").waitFor();
  const ranges = await shown(page);
  assert.ok(ranges.length > 1 + others.length);
  for (const range of ranges) assert.deepEqual(range, zoomed);
  assert.ok(await last.locator("button.reset").isVisible());
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

test("legends keep the colours of their lines in either theme", async () => {
  const { page } = await open(browser, address("diagnosis"), { colorScheme: "light" });
  await drawn(page);
  const colours = () => page.evaluate(() => {
    const painted = (colour) => Object.assign(document.body.appendChild(document.createElement("i")), { style: `color: ${colour}` });
    return window.idcCharts.filter((chart) => chart.plot).flatMap(({ plot }) => {
      const markers = [...plot.root.querySelectorAll(".u-marker")].slice(1);
      return markers.map((marker, which) => {
        const line = painted(plot.series[which + 1].stroke(plot, which + 1));
        return [getComputedStyle(marker).borderTopColor, getComputedStyle(line).color];
      });
    });
  });
  const light = await colours();
  await page.getByRole("button", { name: "Light or dark" }).click();
  const dark = await colours();
  for (const [marker, line] of [...light, ...dark]) assert.equal(marker, line);
  assert.notDeepEqual(light, dark);
  await page.context().close();
});

test("it prints light, with every chart, and whole", async () => {
  const { page } = await open(browser, address("diagnosis"), { colorScheme: "dark" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  const state = await page.evaluate(() => [document.documentElement.dataset.theme, window.idcCharts.every((chart) => chart.plot)]);
  assert.deepEqual(state, ["light", true]);
  await page.emulateMedia({ media: "print" });
  // A browser lays out for its paper, narrower than its window, without telling the page: so no frame passes between width and measurement.
  const charts = await page.evaluate(() => {
    document.body.style.width = "718px";
    return window.idcCharts.map(({ plot }) => {
      const [place, canvas] = [plot.root.parentElement, plot.root.querySelector("canvas")].map((element) => element.getBoundingClientRect());
      return { place: place.width, width: canvas.width, below: canvas.bottom - place.bottom, stretched: canvas.width / canvas.height / (plot.width / plot.height) };
    });
  });
  for (const { place, width, below, stretched } of charts) {
    assert.ok(place <= 718 && width <= place && width > 0.9 * place && below <= 0, `${width} px of ${place}, ${below} px below`);
    assert.ok(Math.abs(stretched - 1) < 0.01, `${stretched}`);
  }
  await page.evaluate(() => { document.body.style.width = ""; });
  await page.emulateMedia({ media: "screen" });
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 50_000, `${pdf.length} bytes`);
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  const after = await page.evaluate(() => [document.documentElement.dataset.theme, window.idcCharts.every(({ plot }) => plot.width === plot.root.parentElement.clientWidth)]);
  assert.deepEqual(after, ["dark", true]);
  await page.context().close();
});

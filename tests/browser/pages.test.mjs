// Twelve pages and pictures as a reader sees them: on a phone, a tablet and a wide screen, light and dark, and on paper. What is looked for stands in
// looks.mjs. With SCREENSHOTS=1, which takes long where there is no graphics card, there are screenshots in build/browser/pages.
import assert from "node:assert/strict";
import { cpSync, mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, made, open, project, results, run, unwrapped } from "./common.mjs";
import { lookedAt } from "./looks.mjs";

const WIDTHS = [390, 1024, 1920];
// A4 less its margins, at 96 dots an inch.
const PAPER = 718;
const shots = join(results, "pages");

let browser;
before(async () => {
  mkdirSync(shots, { recursive: true });
  browser = await launch("--disable-gpu", "--enable-unsafe-swiftshader");
});
after(() => browser.close());

const report = (name, ...words) => join(made(`pages_${name}`, ...words), "report.html");
const file = (name, ...words) => {
  const path = join(results, `pages_${name}`);
  run(...words, "--out", path, "--force");
  return path;
};
const simulated = (name) => report(name, "run", `scenarios/${name}.toml`, "--no-recording");
// A device that was recorded on two days.
const recorded = () => {
  for (const day of ["2026-03-01", "2026-03-05"]) cpSync(join(project, "assets/proof/cases/case-03"), join(results, "recorded/device-1", day), { recursive: true });
  return join(results, "recorded");
};

const PAGES = {
  plate: () => simulated("plate_edge"),
  deburred: () => simulated("deburred_edge"),
  bench: () => simulated("paper_step"),
  flange: () => simulated("acf_plate"),
  diagnosis: () => report("diagnosis", "diagnose", "assets/proof/cases/case-01"),
  fleet: () => report("fleet", "fleet", recorded(), "--scenario", "assets/proof/cases/case-03/rig.toml"),
  vary: () => report("vary", "vary", "scenarios/paper_step.toml", "--set", "bench.duration_s=8..9:3", "--set", "simulation.seed=1..2"),
  // As few designs as a study may have: what it finds is not looked at.
  design: () => report("design", "design", "scenarios/studies/device_design.toml", "--evaluations", "350"),
  compare: () => file("compare.html", "compare", join(results, "pages_plate_edge"), join(results, "pages_acf_plate")),
  edges: () => file("edges.html", "edges", "assets/bracket.stl"),
  place: () => file("place.svg", "place", "scenarios/plate_edge.toml", "--x-mm", "400..1100:4", "--y-mm=-300..300:4"),
  effect: () => file("effect.svg", "effects", "stribeck_friction"),
};

// A picture as a page of its own would show it.
const address = (path) => path.endsWith(".svg")
  ? `data:text/html;charset=utf-8,${encodeURIComponent(`<!DOCTYPE html><html lang="en"><meta name="viewport" content="width=device-width"><style>body { margin: 0; background: #fff; } svg { display: block; max-width: 100%; height: auto; }</style><body><main>${readFileSync(path, "utf8")}</main></body></html>`)}`
  : String(pathToFileURL(path));

// What is out of sight waits: charts and drawings are drawn when they are near.
const allDrawn = async (page) => {
  await page.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
  for (const place of await page.locator("figure.chart, .space").all()) {
    await place.scrollIntoViewIfNeeded();
    await place.locator("[data-drawn], canvas").first().waitFor();
  }
  await page.evaluate(() => scrollTo(0, 0));
};
const settled = (page) => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => setTimeout(done, 150)); }));

for (const [name, make] of Object.entries(PAGES)) {
  test(`${name}: nothing beyond its place, nothing cut, nothing pale, nothing without a name`, async () => {
    const { page, faults } = await open(browser, address(make()), { viewport: { width: WIDTHS[0], height: 900 }, colorScheme: "light" });
    await allDrawn(page);
    await unwrapped(page);
    const found = [];
    const look = async (state) => {
      await settled(page);
      if (process.env.SCREENSHOTS) await page.screenshot({ path: join(shots, `${name}_${state}.jpg`), fullPage: true, quality: 70 });
      for (const one of await page.evaluate(lookedAt)) found.push(`${state}: ${one}`);
    };
    for (const width of WIDTHS) {
      await page.setViewportSize({ width, height: 900 });
      for (const theme of ["light", "dark"]) {
        const button = page.locator("#theme");
        if (await button.count() === 0) { if (theme === "light") await look(`${width}`); continue; }
        if (await page.evaluate(() => document.documentElement.dataset.theme) !== theme) await button.click();
        await look(`${width}_${theme}`);
      }
    }
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    await page.setViewportSize({ width: PAPER, height: 1040 });
    await page.emulateMedia({ media: "print" });
    await look("print");
    assert.deepEqual(faults, []);
    assert.deepEqual(found, [], found.join("\n"));
    await page.context().close();
  });
}

test("a study's page is one that is read", async () => {
  const { page } = await open(browser, address(PAGES.design()), { viewport: { width: 1024, height: 900 } });
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  assert.ok(height < 6000, `${height} px`);
  const heads = await page.locator("h2").allTextContents();
  for (const head of ["Chosen design", "Trade-off", "What binds", "Limits", "What it was measured by"]) assert.ok(heads.includes(head), `${head} of ${heads}`);
  await page.locator("[data-drawn] canvas").first().waitFor();
  await page.context().close();
});

// Folders of results that somebody else sent, with a script in every picture and every name: nothing runs, and the pages work as they do. What each script would do stands in `ran`.
import assert from "node:assert/strict";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { drawing, launch, made, open, project, results, run } from "./common.mjs";

let browser;
let server;
const asked = [];
before(async () => {
  browser = await launch(...drawing);
  // Whatever a page would fetch.
  server = createServer((request, response) => { asked.push(request.url); response.end(); });
  await new Promise((done) => { server.listen(0, "127.0.0.1", done); });
});
after(async () => { await browser.close(); server.close(); });

const ran = (where) => `top.ran = (top.ran || '') + '${where} '; console.error('ran ${where}')`;
const away = (where) => `http://127.0.0.1:${server.address().port}/${where}`;
// A picture with all that is known to run or fetch in one.
const picture = (name) => `<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="640" height="440" onload="${ran(`${name} onload`)}">
<script>${ran(`${name} script`)}</script><script href="data:text/javascript,${encodeURIComponent(ran(`${name} data script`))}"/>
<style>@import url(${away(`${name}-import`)}); rect { fill: url(${away(`${name}-fill`)}#a); background: url(${away(`${name}-background`)}) }</style>
<foreignObject width="100" height="100"><body xmlns="http://www.w3.org/1999/xhtml"><img src="x" onerror="${ran(`${name} onerror`)}"/><iframe src="javascript:${ran(`${name} frame`)}"/><img src="${away(`${name}-img`)}"/></body></foreignObject>
<image href="${away(`${name}-image`)}" width="9" height="9"/><image href="javascript:${ran(`${name} image`)}" width="9" height="9"/><use href="${away(`${name}-use`)}#a"/>
<animate attributeName="x" dur="1s" onbegin="${ran(`${name} onbegin`)}"/><a href="javascript:${ran(`${name} link`)}"><rect width="640" height="440" fill="#0a0" onclick="${ran(`${name} onclick`)}"/></a></svg>`;
// A name that gets out of a text, an attribute, a script, a style, Markdown.
const name = (where) => `"'></title></style></textarea>--></script><script>${ran(`${where} script`)}</script><img src=x onerror="${ran(`${where} onerror`)}"><svg onload="${ran(`${where} onload`)}">[a](javascript:${ran(`${where} link`)})<base href="${away(`${where}-base`)}/"><style>@import url(${away(`${where}-import`)})</style>`;
// What a file may be called.
const fileName = (where) => `"'><img src=x onerror=top.ran='${where}'>&lt;`;

// Puts hostile words in place of those of a file of results, all of one key at a time, as far as it is still read.
const poisoned = (folder, file) => {
  const path = join(folder, file);
  const keys = new Set();
  const replaced = (value, key, wanted) => {
    if (typeof value === "string") { keys.add(key); return key === wanted ? name(`${file} ${key}`) : value; }
    if (Array.isArray(value)) return value.map((one) => replaced(one, key, wanted));
    if (value && typeof value === "object") return Object.fromEntries(Object.entries(value).map(([own, one]) => [own, replaced(one, own, wanted)]));
    return value;
  };
  let content = JSON.parse(readFileSync(path, "utf8"));
  replaced(content, "", null);
  const taken = [];
  for (const key of keys) {
    const tried = replaced(content, "", key);
    writeFileSync(path, JSON.stringify(tried));
    try {
      run("report", folder, "--quiet");
      content = tried;
      taken.push(key);
    } catch { /* one of few words: no place for another */ }
  }
  writeFileSync(path, JSON.stringify(content));
  return taken;
};
const copied = (from, to) => {
  const folder = join(results, to);
  rmSync(folder, { recursive: true, force: true });
  cpSync(from, folder, { recursive: true });
  return folder;
};

// Opens a page, scrolls through it, opens what is folded, clicks where a script would wait for it.
const survives = async (path) => {
  asked.length = 0;
  const { page, faults, requests } = await open(browser, String(pathToFileURL(path)), { viewport: { width: 1024, height: 900 } });
  await page.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
  await page.evaluate(async () => {
    for (const place of document.querySelectorAll("figure, .space")) {
      place.scrollIntoView({ behavior: "instant" });
      await new Promise((done) => { setTimeout(done, 50); });
    }
  });
  await page.evaluate(() => document.querySelectorAll(".sketches img").forEach((image) => { image.click(); }));
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => window.ran ?? document.title.match(/^ran/)), null);
  // Not even tried: a policy that keeps something back says so.
  assert.deepEqual(faults, []);
  assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), []);
  assert.deepEqual(asked, []);
  assert.equal(await page.locator("script").evaluateAll((all) => all.filter((one) => one.textContent.startsWith("top.ran")).length), 0);
  assert.equal(await page.locator(".sketches svg, base, iframe, object, embed, form, [onload], [onerror], [onclick], a[href^='javascript' i]").count(), 0);
  return page;
};
// What the pages do on their own: the theme, a chart that follows the pointer.
const works = async (page) => {
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  const first = await theme();
  await page.locator("#theme").click();
  assert.notEqual(await theme(), first);
  const chart = page.locator("figure.chart").first();
  if (await chart.count() === 0) return;
  await chart.scrollIntoViewIfNeeded();
  const over = chart.locator(".u-over");
  await over.waitFor();
  await page.evaluate(() => document.querySelector("figure.chart").scrollIntoView({ behavior: "instant" }));
  const box = await over.boundingBox();
  for (const along of [0.4, 0.5]) await page.mouse.move(box.x + along * box.width, box.y + 60);
  const values = await chart.locator(".u-value").allTextContents();
  assert.ok(values.some((value) => /\d/.test(value)), values.join());
};

for (const [what, words, ways] of [["picture", () => picture("own"), ["own onload", "own script", "own onerror"]], ["name", () => name("own"), ["own script", "own onerror"]]]) {
  test(`the same ${what} does run on a page that takes it in as it stands`, async () => {
    const path = join(results, `naive_${what}.html`);
    writeFileSync(path, `<!DOCTYPE html><meta charset="utf-8"><p>${words()}`);
    const page = await (await browser.newContext()).newPage();
    // What it loads may take for ever.
    await page.goto(String(pathToFileURL(path)), { waitUntil: "commit" });
    await page.waitForFunction((ways) => ways.every((way) => window.ran?.includes(way)), ways, { timeout: 120_000 });
    await page.context().close();
    assert.ok(asked.length > 0);
    asked.length = 0;
  });
}

test("a run: its pictures, its drawing, its numbers' names, an old page", async () => {
  const folder = copied(made("inert_run", "run", "scenarios/plate_edge.toml"), "inert_run_theirs");
  for (const file of ["cell.svg", "edge.svg", "lean.svg"]) writeFileSync(join(folder, file), picture(file));
  writeFileSync(join(folder, "report.html"), name("old page"));
  assert.ok(poisoned(folder, "summary.json").includes("title"));
  const space = poisoned(folder, "drawing.json");
  for (const key of ["id", "title", "name"]) assert.ok(space.includes(key), `${key} of ${space}`);
  run("report", folder, "--quiet");
  const page = await survives(join(folder, "report.html"));
  await page.locator(".space.live canvas").waitFor();
  await works(page);
  // Under the pointer, and in words beside the drawing.
  const box = await page.locator(".space canvas").boundingBox();
  for (let step = 0; step < 30; step += 1) await page.mouse.move(box.x + 20 + 20 * step, box.y + box.height / 2);
  for (const button of await page.locator(".space button").all()) await button.click();
  assert.equal(await page.evaluate(() => window.ran), undefined);
  await page.context().close();
  // Without the drawing the pictures stand in its place.
  rmSync(join(folder, "drawing.json"));
  run("report", folder, "--quiet");
  const flat = await survives(join(folder, "report.html"));
  assert.equal(await flat.locator(".sketches img:visible").count(), 3);
  await flat.context().close();
});

test("a bench, a diagnosis, a sweep, a fleet: every name that their files hold", async () => {
  const bench = copied(made("inert_bench", "run", "scenarios/paper_step.toml"), "inert_bench_theirs");
  for (const file of ["cell.svg", "figures.svg"]) writeFileSync(join(bench, file), picture(file));
  const diagnosis = copied(made("inert_diagnosis", "diagnose", "assets/proof/cases/case-01"), "inert_diagnosis_theirs");
  const sweep = copied(made("inert_vary", "vary", "scenarios/paper_step.toml", "--set", "bench.duration_s=8..9:3", "--set", "simulation.seed=1..2"), "inert_vary_theirs");
  const days = join(results, "inert_recorded", fileName("device"));
  for (const day of ["2026-03-01", "2026-03-05"]) cpSync(join(project, "assets/proof/cases/case-03"), join(days, day), { recursive: true });
  const fleet = copied(made("inert_fleet", "fleet", join(results, "inert_recorded"), "--scenario", "assets/proof/cases/case-03/rig.toml"), "inert_fleet_theirs");
  for (const [folder, file] of [[bench, "summary.json"], [diagnosis, "diagnosis.json"], [sweep, "vary.json"], [fleet, "fleet.json"]]) {
    // As the program wrote it from names of others, then with every word that its file takes.
    await (await survives(join(folder, "report.html"))).context().close();
    assert.ok(poisoned(folder, file).length > 0, file);
    run("report", folder, "--quiet");
    const page = await survives(join(folder, "report.html"));
    await works(page);
    await page.context().close();
  }
});

test("names of files and folders: of two runs that are compared, of a part, of a case", async () => {
  const [one, other] = ["one", "other"].map((which) => copied(made("inert_run", "run", "scenarios/plate_edge.toml"), fileName(which)));
  const compared = join(results, "inert_compared.html");
  run("compare", one, other, "--out", compared, "--force");
  const page = await survives(compared);
  await works(page);
  await page.context().close();
  const part = join(results, `${fileName("part")}.stl`);
  cpSync(join(project, "assets/bracket.stl"), part);
  const edges = join(results, "inert_edges.html");
  run("edges", part, "--out", edges, "--force");
  const drawn = await survives(edges);
  await drawn.locator("button.pick").first().click();
  assert.equal(await drawn.locator(".space .panel h3").count(), 1);
  await drawn.context().close();
  const diagnosed = join(results, "inert_case_found");
  const theirs = join(results, "inert_cases", fileName("case"));
  mkdirSync(theirs, { recursive: true });
  cpSync(join(project, "assets/proof/cases/case-01"), theirs, { recursive: true });
  run("diagnose", theirs, "--out", diagnosed, "--force");
  await (await survives(join(diagnosed, "report.html"))).context().close();
});

test("a picture goes with the page's theme", async () => {
  const folder = copied(made("inert_run", "run", "scenarios/plate_edge.toml"), "inert_theme");
  rmSync(join(folder, "drawing.json"));
  run("report", folder, "--quiet");
  const { page, faults } = await open(browser, String(pathToFileURL(join(folder, "report.html"))), { viewport: { width: 1024, height: 900 }, colorScheme: "light" });
  const image = page.locator(".sketches img").first();
  await image.scrollIntoViewIfNeeded();
  // Of its ground, at a corner.
  const ground = async () => page.evaluate(async (png) => {
    const shown = new Image();
    shown.src = `data:image/png;base64,${png}`;
    await shown.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: shown.width, height: shown.height });
    const context = canvas.getContext("2d");
    context.drawImage(shown, 0, 0);
    return context.getImageData(12, 12, 1, 1).data[0];
  }, (await image.screenshot()).toString("base64"));
  assert.ok(await ground() > 220);
  await page.locator("#theme").click();
  await image.scrollIntoViewIfNeeded();
  await page.waitForTimeout(200);
  assert.ok(await ground() < 60);
  assert.deepEqual(faults, []);
  await page.context().close();
});

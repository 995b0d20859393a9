// Drawings in space: the page on which an edge is picked and that at the top of a run's report, drawn by software.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { drawing, launch, made, open, project, results, run, unwrapped } from "./common.mjs";

let browser;
let pages;

before(async () => {
  browser = await launch(...drawing);
  const edges = (name) => {
    const page = join(results, `edges_of_${name}.html`);
    run("edges", `assets/${name}.stl`, "--out", page, "--force");
    return page;
  };
  pages = { plate: edges("plate"), bracket: edges("bracket"), run: join(made("drawn", "run", "scenarios/burred_edge.toml"), "report.html") };
});
after(() => browser.close());

const address = (name) => String(pathToFileURL(pages[name]));
const opened = async (name, options) => {
  const made = await open(browser, address(name), options);
  const { page } = made;
  await page.locator(".space").scrollIntoViewIfNeeded();
  await page.locator(".space.live canvas").waitFor();
  await page.waitForFunction(() => window.idcDrawings[0].labels.length > 0);
  return made;
};

// Colours of what is drawn on the canvas, and the share that they cover.
const pixels = (page) => page.evaluate(() => {
  const one = window.idcDrawings[0];
  one.draw();
  const canvas = Object.assign(document.createElement("canvas"), { width: one.canvas.width, height: one.canvas.height });
  const context = canvas.getContext("2d");
  context.drawImage(one.canvas, 0, 0);
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  const colours = new Map();
  let covered = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] < 128) continue;
    covered += 1;
    const colour = `${data[i]},${data[i + 1]},${data[i + 2]}`;
    colours.set(colour, (colours.get(colour) ?? 0) + 1);
  }
  return { share: (4 * covered) / data.length, colours: [...colours].filter(([, count]) => count > 20).map(([colour]) => colour) };
});
// Where on the screen a line is seen.
const place = (page, id) => page.evaluate((id) => {
  const one = window.idcDrawings[0];
  const line = one.lines.find((line) => line.id === id);
  const [x, y] = one.project(one.samples(line).find((sample) => one.seen(line, sample)));
  const box = one.canvas.getBoundingClientRect();
  return [box.left + x, box.top + y];
}, id);
const eye = (page) => page.evaluate(() => window.idcDrawings[0].camera.position.clone().sub(window.idcDrawings[0].controls.target).normalize().toArray());
const angle = (one, other) => Math.acos(Math.min(1, one.reduce((sum, value, axis) => sum + value * other[axis], 0)));

for (const name of ["plate", "bracket", "run"]) {
  test(`${name}: drawn on a phone, a tablet and a wide screen, light and dark, without a network or an error`, async () => {
    for (const width of [390, 1024, 1920]) {
      const seen = [];
      for (const colorScheme of ["light", "dark"]) {
        const { page, faults, requests } = await opened(name, { viewport: { width, height: 900 }, colorScheme });
        const { share, colours } = await pixels(page);
        assert.ok(share > 0.08 && share < 0.95, `${share} covered at ${width} px`);
        assert.ok(colours.length >= 4, `${colours.length} colours at ${width} px`);
        seen.push(colours.join(";"));
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        assert.ok(beyond <= 0, `${beyond} px beyond ${width}`);
        assert.ok(!(await page.locator(".space .sketches").isVisible()), "the picture is for paper");
        assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), []);
        assert.deepEqual(faults, []);
        await page.context().close();
      }
      assert.notEqual(seen[0], seen[1], "the part is of another colour in the dark");
    }
  });
}

test("numbers stand on what is seen, none on another, and those behind the part are away", async () => {
  const { page } = await opened("plate", { viewport: { width: 390, height: 844 } });
  const labels = () => page.evaluate(() => window.idcDrawings[0].labels.filter((label) => label.line).map((label) => [label.line.label, label.box]));
  const shown = await labels();
  // From a corner above 9 of 12 edges are seen.
  assert.ok(shown.length >= 6 && shown.length <= 9, shown.map(([name]) => name).join());
  for (const [which, [name, one]] of shown.entries()) {
    for (const [other, box] of shown.slice(which + 1)) assert.ok(one[2] <= box[0] || box[2] <= one[0] || one[3] <= box[1] || box[3] <= one[1], `${name} on ${other}`);
  }
  await page.evaluate(() => window.idcDrawings[0].look(0, [-0.6, 1, -0.7]));
  await page.waitForTimeout(400);
  const behind = (await labels()).map(([name]) => name);
  assert.notDeepEqual(behind, shown.map(([name]) => name));
  assert.ok(!behind.includes("1") && behind.includes("7"), behind.join());
  await page.context().close();
});

test("an edge under the pointer tells its numbers and its lines; picked, it stays", async () => {
  const { page, faults } = await opened("plate", { viewport: { width: 1024, height: 900 } });
  await page.mouse.move(...await place(page, "edge-1"));
  const tip = page.locator(".space .tip");
  await tip.waitFor();
  assert.equal(await tip.innerText(), "edge-1\n300 mm, 90.0°\n[workpiece.edge]\nedge = 1");
  const [before, heading] = [await pixels(page), page.locator(".space .panel h3")];
  assert.equal(await heading.textContent(), "edge-1");
  await page.mouse.down();
  await page.mouse.up();
  // Over to another and away: what is picked is described again.
  await page.mouse.move(...await place(page, "edge-3"));
  assert.equal(await heading.textContent(), "edge-3");
  await page.mouse.move(5, 5);
  assert.equal(await heading.textContent(), "edge-1");
  assert.ok(!(await tip.isVisible()));
  assert.ok(before.colours.length >= 4);
  assert.equal(await page.locator("tr.picked button").textContent(), "edge-1");
  await page.locator(".space .copy").click();
  await page.waitForFunction(() => document.querySelector(".space .copy").textContent === "Copied");
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a row of the table picks its edge and turns the part so that it is seen", async () => {
  const { page } = await opened("bracket", { viewport: { width: 1024, height: 900 } });
  for (const id of ["edge-3", "loop-2"]) {
    // By keyboard.
    await page.locator("button.pick", { hasText: new RegExp(`^${id}$`) }).focus();
    await page.keyboard.press("Enter");
    await page.waitForTimeout(400);
    assert.equal(await page.locator(".space .panel h3").textContent(), id);
    assert.ok(await page.evaluate((id) => { const one = window.idcDrawings[0]; const line = one.lines.find((line) => line.id === id); return one.samples(line).some((sample) => one.seen(line, sample)); }, id), `${id} is seen`);
  }
  assert.equal(await page.locator(".space .tools button[aria-pressed=true]").textContent(), "Outlines (loops)");
  await page.context().close();
});

test("the part turns by mouse, wheel and keys, and comes back", async () => {
  const { page, faults } = await opened("plate", { viewport: { width: 1024, height: 900 } });
  const box = await page.locator(".space canvas").boundingBox();
  const first = await eye(page);
  const zoom = () => page.evaluate(() => window.idcDrawings[0].camera.zoom);
  const whole = await zoom();
  // A page that is scrolled past the drawing does not zoom it.
  await page.mouse.move(box.x + 20, box.y + 20);
  await page.mouse.wheel(0, -200);
  await page.waitForTimeout(200);
  assert.equal(await zoom(), whole);
  await page.evaluate(() => document.querySelector(".space").scrollIntoView({ behavior: "instant" }));
  const moved = await page.locator(".space canvas").boundingBox();
  await page.mouse.move(moved.x + 60, moved.y + 60);
  await page.mouse.down();
  await page.mouse.move(moved.x + 260, moved.y + 90, { steps: 5 });
  await page.mouse.up();
  const turned = await eye(page);
  assert.ok(angle(first, turned) > 0.3, `${angle(first, turned)} rad`);
  assert.equal(await page.locator(".space .panel h3").count(), 0, "a drag picks nothing");
  await page.mouse.wheel(0, -200);
  await page.waitForFunction((whole) => window.idcDrawings[0].camera.zoom > 1.02 * whole, whole);
  await page.keyboard.press("ArrowLeft");
  assert.ok(angle(turned, await eye(page)) > 0.1);
  await page.getByRole("button", { name: "Reset view" }).click();
  assert.ok(angle(first, await eye(page)) < 1e-6);
  assert.equal(await zoom(), whole);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a finger turns the part, two zoom it, a tap picks", async () => {
  const { page, faults } = await opened("plate", { hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  await page.evaluate(() => document.querySelector(".space").scrollIntoView({ behavior: "instant" }));
  const box = await page.locator(".space canvas").boundingBox();
  const client = await page.context().newCDPSession(page);
  const touch = (type, places) => client.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ id, x: box.x + x, y: box.y + y })) });
  const [first, scrolled] = [await eye(page), await page.evaluate(() => scrollY)];
  await touch("touchStart", [[60, 60]]);
  for (const step of [30, 60, 90, 120]) await touch("touchMove", [[60 + step, 60 + step / 4]]);
  await touch("touchEnd", []);
  assert.ok(angle(first, await eye(page)) > 0.2, "turned");
  assert.equal(await page.evaluate(() => scrollY), scrolled, "the page does not move along");
  const zoom = () => page.evaluate(() => window.idcDrawings[0].camera.zoom);
  const whole = await zoom();
  await touch("touchStart", [[150, 150], [210, 150]]);
  for (const step of [10, 20, 30, 40]) await touch("touchMove", [[150 - step, 150], [210 + step, 150]]);
  await touch("touchEnd", []);
  await page.waitForFunction((whole) => window.idcDrawings[0].camera.zoom > 1.2 * whole, whole);
  await page.getByRole("button", { name: "Reset view" }).tap();
  await page.waitForTimeout(300);
  await page.touchscreen.tap(...await place(page, "edge-3"));
  assert.equal(await page.locator(".space .panel h3").textContent(), "edge-3");
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("the lines of a picked edge run", async () => {
  const { page } = await opened("plate", { viewport: { width: 1024, height: 900 } });
  await page.mouse.click(...await place(page, "edge-1"));
  const lines = await page.locator(".space .panel pre").textContent();
  await page.context().close();
  const scenario = readFileSync(join(project, "scenarios/plate_edge.toml"), "utf8").replaceAll("../", `${project}/`).split("[expect]")[0];
  for (const pasted of [lines, lines.replaceAll("# start_mm", "start_mm").replaceAll("# end_mm", "end_mm")]) {
    const own = scenario.replace(/\[workpiece\.edge\][^[]*/, `${pasted}\n`);
    assert.ok(own.includes("edge = 1\n") && !own.includes("start_mm = 10"));
    const file = join(results, "picked.toml");
    writeFileSync(file, own);
    run("check", file);
    const result = JSON.parse(run("run", file, "--no-recording", "--json", "--force", "--out", join(results, "picked")));
    assert.equal(result.stopped, null);
    assert.ok(Math.abs(result.summary.force_mean_n / 150 - 1) < 0.02, `${result.summary.force_mean_n} N`);
  }
});

test("a run's edge has the colours of its legend and tells the force error under the pointer", async () => {
  const { page, faults } = await opened("run", { viewport: { width: 1024, height: 900 } });
  const { colours } = await pixels(page);
  // Blue to white to vermilion: some of each side of the legend is seen, by which channel is larger.
  const sides = colours.map((colour) => colour.split(",").map(Number)).map(([red, , blue]) => blue - red);
  assert.ok(sides.some((side) => side > 25) && sides.some((side) => side < -25), colours.join(" "));
  await page.mouse.move(...await place(page, "followed edge"));
  const tip = page.locator(".space .tip");
  await tip.waitFor();
  assert.match(await tip.innerText(), /^followed edge\nat [\d.]+ mm: force error [+−][\d.]+ %$/);
  assert.match(await page.locator(".space .legend").innerText(), /force error\s+−[\d.]+ %\s+as desired\s+\+[\d.]+ %/);
  const words = () => page.locator(".space .over .word").allTextContents();
  assert.deepEqual(await words(), ["start"]);
  await page.getByRole("button", { name: "Whole cell" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".space .over .word").length === 2);
  assert.match((await words())[1], /^[\d.]+ N$/);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("without WebGL a sentence, a picture and the table", async () => {
  const plain = await launch("--disable-gpu", "--disable-3d-apis");
  const { page, faults } = await open(plain, address("plate"), { viewport: { width: 390, height: 844 } });
  assert.match(await page.locator(".space .hint").innerText(), /does not draw in 3D/);
  assert.ok(await page.locator(".space .sketches img").isVisible());
  await unwrapped(page);
  const numbers = await page.locator(".space .sketches text").allTextContents();
  assert.ok(numbers.includes("1") && numbers.includes("3"), numbers.join());
  assert.equal(await page.locator("tbody tr").count(), 18);
  assert.deepEqual(faults, []);
  await plain.close();
});

test("on paper the picture stands in the drawing's place", async () => {
  const { page } = await opened("bracket", { viewport: { width: 1024, height: 900 } });
  await page.emulateMedia({ media: "print" });
  assert.ok(await page.locator(".space .sketches img").isVisible());
  assert.ok(!(await page.locator(".space canvas").isVisible()));
  assert.ok(await page.getByText("edge-0", { exact: true }).isVisible(), "the table has its names");
  await page.context().close();
});

// The web viewer that `idc view` serves, on a run and on a diagnosis, until their plots are drawn.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { drawing, idc, launch, made, open, project, results } from "./common.mjs";

let browser;
before(async () => { browser = await launch(...drawing); });
after(() => browser.close());

// The address that `idc view` prints, and how to end it.
const serve = (file) => new Promise((resolve, reject) => {
  const server = spawn(idc, ["view", "--port", "0", file], { cwd: project });
  let said = "";
  server.stdout.on("data", (text) => {
    said += text;
    const address = said.match(/http:\/\/\S+/);
    if (address) resolve({ address: address[0], end: () => server.kill("SIGINT") });
  });
  server.on("error", reject);
  server.on("exit", (code) => reject(new Error(`idc view ended with ${code} after ${said}`)));
});

// Colours of a picture: how many there are, and how many pixels are as each of these.
const colours = async (page, png, wanted) => page.evaluate(async ([png, wanted]) => {
  const image = new Image();
  image.src = `data:image/png;base64,${png}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.width, image.height];
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const seen = new Set();
  const near = wanted.map(() => 0);
  for (let i = 0; i < data.length; i += 4) {
    seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    wanted.forEach((rgb, which) => { if (rgb.every((value, k) => Math.abs(value - data[i + k]) < 24)) near[which] += 1; });
  }
  return [seen.size, near];
}, [png.toString("base64"), wanted]);

const vermilion = [0xd5, 0x5e, 0x00];
const green = [0x00, 0x9e, 0x73];
const orange = [200, 132, 0];
const sky = [50, 150, 215];

for (const [name, words, file, wanted] of [
  ["run", ["run", "scenarios/plate_edge.toml"], "viewed/recording.rrd", [vermilion, green]],
  ["diagnosis", ["diagnose", "assets/proof/cases/case-02"], "viewed_diagnosis/diagnosis.rrd", [orange, sky]],
]) {
  test(`the plots of a ${name} are drawn`, { timeout: 180_000 }, async () => {
    made(file.split("/")[0], ...words);
    const { address, end } = await serve(join(results, file));
    try {
      assert.match(address, /^http:\/\/(127\.0\.0\.1|localhost)[:/]/);
      const blank = await (await browser.newContext()).newPage();
      const { page, faults } = await open(browser, address, { viewport: { width: 1400, height: 900 } });
      let picture;
      let seen = [0, []];
      const drawn = () => seen[0] > 1500 && seen[1].every((count) => count > 40);
      for (let second = 0; second < 120 && !drawn(); second += 3) {
        await page.waitForTimeout(3000);
        picture = await page.screenshot();
        seen = await colours(blank, picture, wanted);
      }
      writeFileSync(join(results, `viewer_${name}.png`), picture);
      assert.ok(drawn(), `${seen[0]} colours, ${seen[1]} pixels of the signals' colours; see build/browser/viewer_${name}.png; ${faults}`);
      // What the viewer would ask of its maker's hosts its page's policy keeps from being asked.
      const policy = (await page.request.get(address)).headers()["content-security-policy"];
      assert.match(policy, /default-src 'self'/);
      const asked = faults.filter((text) => /https?:\/\/(?!127\.0\.0\.1|localhost)/.test(text));
      assert.ok(asked.every((text) => /Content Security Policy/.test(text)), asked.join("\n"));
      await page.context().close();
    } finally { end(); }
  });
}

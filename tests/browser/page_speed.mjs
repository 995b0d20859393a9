// How long a page takes from navigation to its last drawing, and its size: `npm run speed --prefix tests/browser -- report.html [another.html]`.
// Nine navigations each in one running browser, as a reader has one; the first alone and the median are printed, and the page's size.
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { drawing, launch } from "./common.mjs";

const TIMES = 9;

// Notes the last time at which something was drawn, on a canvas in two dimensions or in three.
const noting = () => {
  window.lastDrawn = 0;
  const watch = (kind, names) => names.forEach((name) => {
    const own = kind.prototype[name];
    kind.prototype[name] = function drawn(...given) {
      const result = own.apply(this, given);
      window.lastDrawn = performance.now();
      return result;
    };
  });
  watch(WebGL2RenderingContext, ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"]);
  watch(CanvasRenderingContext2D, ["stroke", "fill", "fillText"]);
};

const once = async (browser, address) => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const page = await context.newPage();
  await page.addInitScript(noting);
  await page.goto(address);
  // Drawn to its end: nothing more for half a second.
  for (let last = -1; ;) {
    const [now, at] = await page.evaluate(() => [performance.now(), window.lastDrawn]);
    if (at === last && now - at > 500) break;
    last = at;
    await page.waitForTimeout(100);
  }
  const [last, parsed] = await page.evaluate(() => [window.lastDrawn, performance.getEntriesByType("navigation")[0].domInteractive]);
  await context.close();
  return { last, parsed };
};

const seconds = (milliseconds) => (milliseconds / 1000).toFixed(2);
for (const file of process.argv.slice(2).map((name) => resolve(process.env.INIT_CWD ?? ".", name))) {
  const browser = await launch(...drawing);
  // The browser's own start is not the page's.
  await once(browser, "data:text/html,<canvas></canvas><script>document.querySelector('canvas').getContext('webgl2').drawArrays(0, 0, 0)</script>");
  const times = [];
  for (let time = 0; time < TIMES; time += 1) times.push(await once(browser, String(pathToFileURL(file))));
  await browser.close();
  const [first] = times;
  times.sort((a, b) => a.last - b.last);
  const [least, median, most] = [0, (TIMES - 1) / 2, TIMES - 1].map((which) => times[which]);
  console.log(`${file}: ${(statSync(file).size / 1e6).toFixed(2)} MB; last drawing after ${seconds(median.last)} s (median of ${TIMES}, ${seconds(least.last)} to ${seconds(most.last)}; the first ${seconds(first.last)}), read to its end after ${seconds(median.parsed)} s`);
}

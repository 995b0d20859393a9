// Photographs a web page once it is drawn: its picture is large, and no longer changes from one look to the next two. Usage: web.mjs ADDRESS PICTURE.png
import { writeFileSync } from "node:fs";
import { drawing, launch, open } from "../../tests/browser/common.mjs";

const [address, picture] = process.argv.slice(2);
const browser = await launch(...drawing);
const { page } = await open(browser, address, { viewport: { width: 1600, height: 1000 } });
let last = 0;
let still = 0;
for (let second = 0; second < 150; second += 3) {
  await page.waitForTimeout(3000);
  const shot = await page.screenshot();
  still = shot.length > 60_000 && Math.abs(shot.length - last) < 0.005 * last ? still + 1 : 0;
  if (still > 1) {
    writeFileSync(picture, shot);
    break;
  }
  last = shot.length;
}
await browser.close();

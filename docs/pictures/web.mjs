// Photographs a web page once it is drawn: its picture is large, and no longer changes. Usage: web.mjs ADDRESS PICTURE.png
import { writeFileSync } from "node:fs";
import { drawing, launch, open } from "../../tests/browser/common.mjs";

const [address, picture] = process.argv.slice(2);
const browser = await launch(...drawing);
const { page } = await open(browser, address, { viewport: { width: 1600, height: 1000 } });
let last = 0;
for (let second = 0; second < 150; second += 3) {
  await page.waitForTimeout(3000);
  const shot = await page.screenshot();
  if (shot.length > 60_000 && Math.abs(shot.length - last) < 0.02 * last) {
    writeFileSync(picture, shot);
    break;
  }
  last = shot.length;
}
await browser.close();

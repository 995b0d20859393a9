// What the browser tests share: Debian's Chromium, the program, and pages with what they report.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const project = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
export const idc = process.env.IDC ?? join(project, "target/release/idc");
export const results = join(project, "build/browser");
mkdirSync(results, { recursive: true });

// Without these flags Chromium looks for its maker's hosts at every start.
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
export const drawing = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

export const launch = (...more) => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: [...quiet, ...more] });

export const run = (...words) => execFileSync(idc, words, { cwd: project, stdio: ["ignore", "pipe", "inherit"], maxBuffer: 1 << 28 }).toString();

// Results that several tests look at are made once. Files of tests run beside one another: each file has names of its own.
export const made = (name, ...words) => {
  const folder = join(results, name);
  if (!existsSync(join(folder, "report.html"))) run(...words, "--out", folder);
  return folder;
};

// Puts the pictures of a page into it, so that what is in them can be looked at: as images they keep it to themselves.
export const unwrapped = (page) => page.evaluate(() => {
  for (const image of document.querySelectorAll(".sketches img")) {
    const holder = document.createElement("div");
    holder.innerHTML = decodeURIComponent(image.src.slice(image.src.indexOf(",") + 1));
    const svg = holder.firstElementChild;
    const style = svg.querySelector("style");
    const [light, dark] = style.textContent.split("@media (prefers-color-scheme:dark){");
    const within = (text, place) => text.replaceAll(/(svg|text)\{/g, `${place} $1{`);
    style.textContent = within(light, ".sketches") + within(dark.slice(0, -1), "[data-theme=dark] .sketches");
    Object.assign(svg.style, { width: "100%", height: "auto", display: "block" });
    image.replaceWith(svg);
  }
});

// A page that notes what it asks for and what goes wrong.
export const open = async (browser, address, options = {}) => {
  const context = await browser.newContext(options);
  // How long it takes is printed, not judged.
  context.setDefaultTimeout(120_000);
  const page = await context.newPage();
  const faults = [];
  const requests = [];
  page.on("console", (message) => { if (message.type() === "error") faults.push(message.text()); });
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  const start = performance.now();
  await page.goto(address);
  const seconds = (performance.now() - start) / 1000;
  return { page, faults, requests, seconds };
};

// The libraries that stand in assets/ are npm's, to the byte.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { project } from "./common.mjs";

for (const name of ["dist/uPlot.iife.min.js", "dist/uPlot.min.css", "LICENSE"]) {
  test(`${name} is that of npm's uplot`, () => {
    const ours = readFileSync(join(project, "assets/page/uplot", name.split("/").at(-1)));
    const theirs = readFileSync(join(project, "tests/browser/node_modules/uplot", name));
    assert.ok(ours.equals(theirs));
  });
}

test("the bundle of three.js is what its README makes", () => {
  const three = join(project, "assets/page/three");
  const command = readFileSync(join(three, "README.md"), "utf8").match(/^ {4}(.*esbuild .*) --outfile=\S+$/m)[1];
  const made = execFileSync("bash", ["-c", command], { cwd: project, maxBuffer: 1 << 24 });
  assert.ok(made.equals(readFileSync(join(three, "three.iife.min.js"))));
  assert.ok(readFileSync(join(three, "LICENSE")).equals(readFileSync(join(project, "tests/browser/node_modules/three/LICENSE"))));
});

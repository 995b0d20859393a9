// The chart library that stands in assets/ is npm's, to the byte.
import assert from "node:assert/strict";
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

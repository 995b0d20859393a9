"""What `idc design` chooses beside the best point of an exhaustive grid: feed and force of the deburring study.

    python tests/studies/design_against_grid.py FOLDER [FEEDS [FORCES]]       IDC names the program (default target/release/idc)

FEEDS x FORCES runs of scenarios/studies/burred_plate.toml over the study's ranges (default 86 x 16), the limits of the study kept. Exits 1 where the design's
duration or feed is worse than the grid's best by more than 2 %.
"""

import json
import os
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pandas as pd

PROJECT = Path(__file__).resolve().parents[2]
IDC = os.environ.get("IDC", str(PROJECT / "target/release/idc"))
STUDY = PROJECT / "scenarios/studies/deburring.toml"
FEED, FORCE = "process.feed_mm_per_s", "process.force_n"


def timed(*words):
    begin = time.monotonic()
    subprocess.run([IDC, *map(str, words), "--quiet", "--force"], check=True)
    return time.monotonic() - begin


def main():
    folder = Path(sys.argv[1])
    counts = [int(word) for word in sys.argv[2:]] + [86, 16][len(sys.argv) - 2 :]
    study = tomllib.loads(STUDY.read_text())
    took = timed("design", STUDY, "--out", folder / "design")
    chosen = json.loads((folder / "design/design.json").read_text())["chosen"]
    ends = [study["variables"][key] for key in (FEED, FORCE)]
    sets = [
        word
        for key, end, count in zip((FEED, FORCE), ends, counts)
        for word in ("--set", f"{key}={end['min']}..{end['max']}:{count}")
    ]
    scenario = STUDY.parent / study["study"]["scenarios"][0]
    grid_took = timed("vary", scenario, *sets, "--out", folder / "grid")
    runs = pd.read_parquet(folder / "grid/runs.parquet")
    kept = runs["code"] == 0
    for metric, bounds in study["limits"].items():
        kept &= runs[metric].between(bounds.get("min", float("-inf")), bounds.get("max", float("inf")))
    objective = study["objective"]["minimise"]
    best = runs[kept].sort_values(objective).iloc[0]
    found = chosen["design"]
    print(f"design: {found[FEED]} mm/s, {found[FORCE]} N, {chosen['objective']} s; {took:.0f} s")
    print(f"grid:   {best[FEED]} mm/s, {best[FORCE]} N, {best[objective]} s; {len(runs)} runs, {kept.sum()} within the limits, {grid_took:.0f} s")
    longer = chosen["objective"] / best[objective] - 1
    slower = float(best[FEED]) / found[FEED] - 1
    print(f"design beside grid: cycle {100 * longer:+.2f} %, feed {-100 * slower:+.2f} %")
    sys.exit(longer > 0.02 or slower > 0.02)


if __name__ == "__main__":
    main()

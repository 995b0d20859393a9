#!/usr/bin/env python3
"""Each recorded run of a contact flange left out in turn and predicted by a fit to others: are its numbers inside the stated 90 % intervals?

    tests/studies/flange_left_out.py RECORDINGS OUT [RUN ...]

RECORDINGS is the folder acf_ur10e, OUT a new folder; needs target/release/idc (IDC=path). With RUN only runs whose name holds it are left out. Printed are,
of each run and number, what was recorded, what is predicted with its interval, and whether it is inside; then the share inside and the median width of the
intervals over their value.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
IDC = os.environ.get("IDC", str(ROOT / "target/release/idc"))
NUMBERS = ["peak_n", "ringing_hz", "settling_s", "sliding_spread_n"]


def idc(*arguments):
    subprocess.run([IDC, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def main(recordings, out, only):
    recordings, out = Path(recordings), Path(out)
    out.mkdir(parents=True)
    names = sorted(p.name.removesuffix("_force.csv") for p in recordings.glob("*_force.csv"))
    rig = (ROOT / "assets/rigs/contact_flange.toml").read_text()
    imported = out / "imported"
    logs = [recordings / f"{name}_{log}.csv" for name in names for log in ("force", "velocity")]
    idc("import", ROOT / "assets/import/contact_flange.toml", *logs, "--out", f"{imported}/", "--quiet")
    tables = sorted(imported.glob("*.parquet"))
    inside, widths = [], []
    for left in tables:
        if only and not any(word in left.name for word in only):
            continue
        case = out / left.stem
        case.mkdir()
        for table in tables:
            (case / table.name).symlink_to(table.resolve())
        fit = 'fit = ["*.parquet"]'
        (case / "rig.toml").write_text(rig.replace(fit, f'{fit}\npredict = "{left.name}"'))
        answer = out / f"{left.stem}.answer"
        idc("diagnose", case, "--out", answer, "--quiet")
        flange = json.loads((answer / "diagnosis.json").read_text())["flange"]
        for run in flange["runs"]:
            if run["fitted"] or run["recording"] != left.name:
                continue
            for number in NUMBERS:
                result = run.get(number)
                if not result:
                    continue
                holds = result["low"] <= result["recorded"] <= result["high"]
                inside.append(holds)
                widths.append((result["high"] - result["low"]) / result["simulated"])
                print(f"{left.stem:45s} {number:17s} recorded {result['recorded']:8.3f}, predicted {result['simulated']:8.3f} "
                      f"({result['low']:.3f} to {result['high']:.3f}) {'inside' if holds else 'OUTSIDE'}", flush=True)
    widths.sort()
    print(f"inside {sum(inside)} of {len(inside)}; median width {widths[len(widths) // 2]:.2f} of the value")


main(sys.argv[1], sys.argv[2], sys.argv[3:])

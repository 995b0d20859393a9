"""The same cell by Rapier (`idc run`) and by the plant of the diagnosis, without and with seals of 10 N and 60 N s/m that both know of.

    python tests/studies/running_and_replayed.py FOLDER       IDC names the program (default target/release/idc)

For each cell the worst of four recordings: 90th percentile of the difference of stroke and regulator pressure over their sensors' noise, and what the force's
error has beyond its sensor's noise (root of the mean square over the noise's, less 1): the true force along the slide is in no column.
"""

import json
import sys
from pathlib import Path

import pandas as pd

from diagnosed_cells import CELLS, NOISE, PROGRAMS, idc, scenario

SEALS = """[device.override]
seal_coulomb_force_n = 10
seal_static_force_n = 10
seal_viscous_coefficient_n_s_per_m = 60
"""
ATMOSPHERE = 101325.0


def text(cell, program, seals):
    nominal = scenario(cell, program)
    line = 'device.toml"\n'
    assert line in nominal
    return nominal.replace(line, line + SEALS, 1) if seals else nominal


def differences(compared, run):
    """Stroke and pressure as 90th percentiles, force as an excess, each over the noise."""
    both = [frame.assign(tick=(frame.time_s * 1e6).round().astype("int64")) for frame in (compared, run)]
    joined = both[0].merge(both[1], on="tick", suffixes=("", "_true"))
    stroke = joined[joined.measured_stroke_m.notna()]
    stroke = (stroke.believed_stroke_m - stroke.stroke_m).abs() / NOISE["measured_stroke_m"]
    pressure = joined.believed_regulator_pressure_pa - (joined.regulator_pressure_pa - ATMOSPHERE)
    pressure = pressure.abs() / NOISE["measured_regulator_pressure_pa"]
    force = ((joined.believed_force_n - joined.measured_force_n) / NOISE["measured_force_n"]).dropna()
    return stroke.quantile(0.9), pressure.quantile(0.9), max(0.0, (force**2).mean() - 1) ** 0.5


def main():
    folder = Path(sys.argv[1]).resolve()
    for cell in CELLS:
        for name, seals in (("nominal", False), ("seals", True)):
            case = folder / f"{cell}.{name}"
            case.mkdir(parents=True, exist_ok=True)
            for program in PROGRAMS[:4]:
                (case / "run.toml").write_text(text(cell, program, seals))
                idc("run", case / "run.toml", "--out", case / "runs" / program[0], "--quiet", "--force")
            (case / "nominal.toml").write_text(text(cell, PROGRAMS[0], seals))
            idc("diagnose", case / "runs", "--scenario", case / "nominal.toml", "--out", case / "out", "--quiet", "--force")
            compared = pd.read_parquet(case / "out/comparison.parquet")
            each = [
                differences(rows, pd.read_parquet(case / "runs" / recording / "samples.parquet"))
                for recording, rows in compared.groupby("recording")
            ]
            stroke, pressure, force = (max(values) for values in zip(*each))
            found = [e["name"] for e in json.loads((case / "out/diagnosis.json").read_text())["effects"]]
            print(f"{cell} {name}: stroke {stroke:.2f}, pressure {pressure:.2f}, force {force:.2f} sigma; found {found}", flush=True)


if __name__ == "__main__":
    main()

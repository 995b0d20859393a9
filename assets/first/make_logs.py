#!/usr/bin/env python3
"""Writes the recordings of assets/proof/cases/case-02 as a data logger in a workshop would: semicolons, decimal commas, bar, mm and ms.

    python3 assets/first/make_logs.py        (Python 3, standard library only; the same bytes each time)
"""

import csv
from decimal import Decimal
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASE = HERE.parent / "proof" / "cases" / "case-02"
# Column of the recording, heading in the log, how many of the log's unit make one of SI.
COLUMNS = [
    ("time_s", "t [ms]", "1000"),
    ("set_pressure_pa", "p_set [bar]", "0.00001"),
    ("solenoid", "valve", "1"),
    ("surface_m", "wall [mm]", "1000"),
    ("regulator_pressure_pa", "p_out [bar]", "0.00001"),
    ("stroke_m", "x [mm]", "1000"),
    ("force_n", "F [N]", "1"),
    ("acceleration_m_per_s2", "a [m/s2]", "1"),
]


def written(text, factor):
    """A number in the log's unit, with a comma, without zeros at its end; an empty field stays empty."""
    if not text:
        return ""
    number = format((Decimal(text) * Decimal(factor)).normalize(), "f")
    return number.replace(".", ",")


for name in ("stairs", "ride", "cycle"):
    with open(CASE / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = ["Workshop logger;channels 1-7;device under test: press-on slide"]
    lines.append(";".join(heading for _, heading, _ in COLUMNS))
    lines += [";".join(written(row[column], factor) for column, _, factor in COLUMNS) for row in rows]
    (HERE / f"{name}.csv").write_text("\n".join(lines) + "\n", newline="\n")

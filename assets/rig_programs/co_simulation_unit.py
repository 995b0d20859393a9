"""A co-simulation unit (FMI 2.0 or 3.0) as the rig of `idc investigate`: carries inputs out by FMPy and writes the recording.

    python co_simulation_unit.py UNIT.fmu RIG.toml IN.csv OUT.csv

RIG.toml is that of the case: its sensors' rate and noise are those of the recording, each inputs' noise their own. IN.csv has time_s [s], set_pressure_pa [Pa gauge],
solenoid (1: extends) and surface_m [m]. COLUMNS names outputs of units that `idc export fmu` writes; for a unit of another tool put its outputs and inputs there.
A rig is one program: `printf '#!/bin/sh\\nexec python co_simulation_unit.py device.fmu case/rig.toml "$@"\\n' > rig.sh; chmod +x rig.sh`.
"""

import csv
import hashlib
import sys
import tomllib
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu

# Column of the recording: output of the unit, and what stands in the atmosphere [Pa] in place of 0.
COLUMNS = {
    "regulator_pressure_pa": ("measured_regulator_pressure_pa", 1.0),
    "stroke_m": ("measured_stroke_m", 0.0),
    "force_n": ("measured_force_n", 0.0),
    "acceleration_m_per_s2": ("measured_acceleration_m_per_s2", 0.0),
}


def read(file):
    with open(file, newline="") as rows:
        table = list(csv.DictReader(rows))
    return {name: np.array([float(row[name]) for row in table]) for name in table[0]}


def number(value):
    """A number of a rig file, with or without its tolerance."""
    return value["value"] if isinstance(value, dict) else value


def main(unit, rig, asked, out):
    rig = tomllib.loads(Path(rig).read_text())
    asked_bytes = Path(asked).read_bytes()
    asked = read(asked)
    time, sensors = asked["time_s"], rig["sensors"]
    sample = 1.0 / number(sensors["rate_hz"])
    inputs = {
        "time": time,
        "set_pressure_gauge_pa": asked["set_pressure_pa"],
        "valve_extends": asked["solenoid"] > 0.5,
        "surface_position_m": asked["surface_m"],
        "surface_speed_m_per_s": np.append(np.diff(asked["surface_m"]) / np.diff(time), 0.0),
    }
    kinds = [(name, values.dtype) for name, values in inputs.items()]
    inputs = np.array(list(zip(*inputs.values())), dtype=kinds)
    there = {name: output for name, output in COLUMNS.items() if name in sensors}
    outputs = [output for output, _ in there.values()]
    found = simulate_fmu(unit, stop_time=time[-1], step_size=sample, output_interval=sample, input=inputs, output=outputs)
    at = found["time"]
    before = np.clip(np.searchsorted(time, at + 1e-9, side="right") - 1, 0, len(time) - 1)
    recording = {"time_s": at}
    for name in ("set_pressure_pa", "solenoid", "surface_m"):
        recording[name] = asked[name][before]
    atmosphere = number(rig.get("gas", {}).get("atmosphere_pa", 101325.0))
    noise = np.random.default_rng(list(hashlib.sha256(asked_bytes).digest()))
    for name, (output, above) in there.items():
        values = found[output] - above * atmosphere
        recording[name] = values + number(sensors[name]) * noise.standard_normal(len(at))
    with open(out, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(recording)
        rows.writerows(zip(*(values.tolist() for values in recording.values())))


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(f"{len(sys.argv) - 1} arguments, expected co_simulation_unit.py UNIT.fmu RIG.toml IN.csv OUT.csv")
    main(*sys.argv[1:])

"""Samples of every cell scenario, noise off, as it runs by default and with the mass matrix taken in each step, against a run at 0.05 ms.

    build/venv/bin/python tests/studies/arm_steps.py [--effects] [--scenario NAME ...] [--idc target/release/idc]

Error: 90th percentile of the difference over all samples, as a share of the noise of a usual sensor of that channel (NOISE); asked: at most 0.2. Peaks of the
contact force by phase: asked within 2 %. With --effects each effect of `idc effects` is put in, and the default is held against the mass matrix of each step alone.
Prints a line a run; exit code 1 if one departs by more. Needs pyarrow. Four minutes; with --effects half an hour.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.parquet

PROJECT = Path(__file__).resolve().parents[2]
FINE = 0.05
NOISE = {
    "joint_position_rad": 2e-6,
    "contact_force_n": 1.0,
    "device_force_n": 1.0,
    "stroke_m": 2e-5,
    "chamber_1_pressure_pa": 600.0,
    "regulator_pressure_pa": 600.0,
}
QUIET = ["arm.servo.encoder_noise_rad=0"]
# Of a scenario with sensors.
QUIET_SENSORS = [
    "sensing.regulator_pressure.standard_deviation_pa=0",
    "sensing.force.standard_deviation_n=0",
    "sensing.stroke.standard_deviation_mm=0",
    "sensing.acceleration.standard_deviation_m_per_s2=0",
]
PEAKS = ("force_peak_engage_n", "force_peak_follow_n", "force_peak_retract_n")


def scenarios(names):
    for file in sorted((PROJECT / "scenarios").glob("*.toml")):
        text = file.read_text()
        if 'kind = "bench"' not in text and "[arm]" in text and (not names or file.stem in names):
            yield file, "[sensing]" in text


def run(idc, file, sensed, settings, folder, effect=None):
    """Summary and samples of a run; a text where it is refused."""
    settings = [*QUIET, *(QUIET_SENSORS if sensed else []), *settings]
    command = [idc, "run", file, "--out", folder, "--force", "--no-recording", "--json", "--effort", "0"]
    command += [part for setting in settings for part in ("--set", setting)]
    command += ["--with", effect] if effect else []
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        message = done.stdout or done.stderr
        return f"exit code {done.returncode}: {message.strip().splitlines()[0][:100] if message.strip() else ''}"
    table = pyarrow.parquet.read_table(Path(folder) / "samples.parquet")
    return json.loads((Path(folder) / "summary.json").read_text()), table


def values(table, channel):
    if channel != "joint_position_rad":
        return [table[channel].to_numpy()]
    return [table[name].to_numpy() for name in table.column_names if name.startswith("joint_") and name.endswith("_position_rad")]


def departures(one, other, every):
    """Shares of the noise by which samples depart, and the largest departure of a phase's peak of the contact force [%]."""
    shares = {}
    for channel, noise in NOISE.items():
        off = []
        for coarse, fine in zip(values(one[1], channel), values(other[1], channel)):
            fine = fine[every - 1 :: every]
            count = min(len(coarse), len(fine))
            off.append(np.abs(coarse[:count] - fine[:count]))
        shares[channel] = float(np.quantile(np.concatenate(off), 0.9)) / noise
    coarse, fine = (np.array([run[0]["summary"][peak] for peak in PEAKS]) for run in (one, other))
    return shares, 100 * float(np.max(np.abs(coarse / fine - 1)))


def report(name, one, other, every):
    """Prints a line; whether it holds."""
    if isinstance(one, str) or isinstance(other, str):
        same = isinstance(one, str) and isinstance(other, str)
        print(f"{name:52} {one if isinstance(one, str) else 'runs'} | {other if isinstance(other, str) else 'runs'}", flush=True)
        return same
    shares, peak = departures(one, other, every)
    held = one[0].get("steps_per_mass_matrix") or 1.0
    worst = max(shares, key=shares.get)
    good = shares[worst] <= 0.2 and peak <= 2
    print(f"{name:52} {held:5.1f} steps/M  {worst:24} {shares[worst]:9.2g} of noise  peaks {peak:.3f} %{'' if good else '  DEPARTS'}", flush=True)
    return good


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--effects", action="store_true")
    arguments.add_argument("--scenario", nargs="*", default=[])
    arguments.add_argument("--idc", default=str(PROJECT / "target/release/idc"))
    given = arguments.parse_args()
    listed = subprocess.run([given.idc, "effects", "--json"], capture_output=True, text=True, check=True)
    effects = [effect["name"] for effect in json.loads(listed.stdout)["effects"]]
    good, each_step = True, ["simulation.arm_steps=1"]
    with tempfile.TemporaryDirectory() as folder:
        for file, sensed in scenarios(given.scenario):
            if given.effects:
                for effect in effects:
                    pair = [run(given.idc, file, sensed, more, f"{folder}/{i}", effect) for i, more in enumerate(([], each_step))]
                    good &= report(f"{file.stem} {effect}", *pair, 1)
                continue
            fine = run(given.idc, file, sensed, [f"simulation.step_ms={FINE}", *each_step], f"{folder}/fine")
            every = round(1.0 / FINE)
            good &= report(file.stem, run(given.idc, file, sensed, [], f"{folder}/coarse"), fine, every)
            good &= report(f"{file.stem}, each step", run(given.idc, file, sensed, each_step, f"{folder}/each"), fine, every)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())

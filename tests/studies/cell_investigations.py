#!/usr/bin/env python3
"""Investigations of cells (arm, part, device) whose rig is another engine, MuJoCo, its numbers drawn within the tolerances that the cell's file states.

    PYTHON tests/studies/cell_investigations.py IDC OUT [--cells 10] [--only N ..] [--share 0.5] [--runs 2] [--write FILE.json]

PYTHON has what docs/evidence/peers/requirements.txt names. Cells and their causes are those of `cell_arms/`, without drives and wrench: the first recording is a share of one ride, from where the device presses.
Printed for each cell: the truth, the probability on it before and after, what else is above 10 %, the largest force on the part beside the limit, seconds recorded. A cell counts where its cause alone is
above 10 % in the end.
"""
import argparse
import json
import os
import pathlib
import pickle
import subprocess
import sys
import zlib

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

# Causes that show in outlet, stroke and force; of arm, part and device in turn.
CAUSES = ("compliant_joint", "part_misplaced", "regulator_gain_error", "joint_encoder_offset", "burr", "coulomb_viscous_friction", "compliant_joint", "part_misplaced", "external_leakage", "nothing")
FIRST = 400  # Number of the first cell: those of the study of drives stay its own.
LONGEST_S = 15


def recorded(saved, program, seed):
    """What the cell records of a program, by MuJoCo: columns as a recording has them."""
    import numpy as np
    from cell_arms import plant

    time, path, command, pressure = program
    motion = plant.simulate(saved["arm"], saved["numbers"], saved["edge"], (time, path, command, pressure))
    device = plant.read(saved["numbers"], motion, saved["start"])["device"]
    rng = np.random.default_rng(seed)
    hold = (len(motion.motor[0]) - 1) // (len(time) - 1)
    columns = {"time_s": (time, 4), "path_m": (path, 6)}
    n = command.shape[1]
    columns.update({f"joint_{j + 1}_command_rad": (command[:, j], 8) for j in range(n)})
    columns.update({f"joint_{j + 1}_rad": (motion.motor[0][::hold, j] + saved["joint_noise"] * rng.normal(size=len(time)), 8) for j in range(n)})
    columns["set_pressure_pa"] = (pressure, 0)
    for k, (name, digits) in enumerate((("regulator_pressure_pa", 0), ("stroke_m", 6), ("force_n", 2))):
        columns[name] = (device[:, k] + saved["device_noise"][k] * rng.normal(size=len(time)), digits)
    return columns, float(motion.force.max())


def rig(saved_file, inputs, output):
    """The cell as a program: PROGRAM IN.csv OUT.csv."""
    import numpy as np
    from arms.case import write_csv

    saved = pickle.loads(pathlib.Path(saved_file).read_bytes())
    text = pathlib.Path(inputs).read_text().splitlines()
    names = text[0].split(",")
    rows = np.array([[float(x) for x in line.split(",")] for line in text[1:]])
    of = {name: rows[:, k] for k, name in enumerate(names)}
    joints = sorted(name for name in names if name.startswith("joint_"))
    program = of["time_s"], of["path_m"], np.column_stack([of[name] for name in joints]), of["set_pressure_pa"]
    # Other inputs have other noise, the same the same.
    columns, force = recorded(saved, program, zlib.crc32(pathlib.Path(inputs).read_bytes()))
    write_csv(pathlib.Path(output), columns)
    with open(pathlib.Path(saved_file).with_suffix(".forces.txt"), "a") as forces:
        forces.write(f"{force:.2f}\n")


def make(number, name, out, idc, share):
    """A cell of a number with a cause: folder with its files and the first recording, and what its rig needs."""
    from arms.case import write_csv
    from cell_arms.case import Case

    case = Case(number, name)
    case.write(idc, out / "made")
    made, folder = out / "made" / "cases" / case.label, out / "cases" / case.label
    (folder / "recordings").mkdir(parents=True, exist_ok=True)
    for own in made.iterdir():
        if own.suffix in (".urdf", ".stl") or own.name == "device.toml":
            (folder / own.name).write_bytes(own.read_bytes())
    text = (made / "cell.toml").read_text()
    numbers = case.cause.at(case.size)[0] if case.cause else case.cell.truth
    saved = {"arm": case.cell.arm, "numbers": numbers, "edge": case.cell.edge, "start": case.starts["a"], "joint_noise": case.cell.joint_noise, "device_noise": case.cell.device_noise}
    (folder / "rig.pickle").write_bytes(pickle.dumps(saved))
    time, path, command, pressure = case.cell.programs["a"]
    pressed = (pressure > 0).nonzero()[0]
    first, last = pressed[0], pressed[0] + int(share * (pressed[-1] - pressed[0]))
    cut = slice(max(0, first - 50), last)
    program = time[cut] - time[cut][0], path[cut], command[cut], pressure[cut]
    columns, force = recorded(saved, program, number)
    write_csv(folder / "recordings" / "a.csv", columns)
    limit = round(1.2 * force, 0)
    kept = "\n".join(line for line in text.splitlines() if not line.startswith("recorded_arm"))
    (folder / "cell.toml").write_text(f"{kept}\n\n[limits]\nforce_n = {limit}\nset_pressure_rate_pa_per_s = 1e8\n")
    script = folder / "rig"
    script.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{pathlib.Path(__file__).resolve()}" --rig "{folder / "rig.pickle"}" "$1" "$2"\n')
    script.chmod(0o755)
    truth = {"cause": name, "place": case.cause.place if case.cause else {}, "sigma": case.sigma, "limit": limit}
    (folder / "truth.json").write_text(json.dumps(truth, indent=1, default=float))


def wanted(truth):
    """The explanation that is right, as the program names it."""
    if truth["cause"] == "nothing":
        return "nothing is missing"
    joint = truth["place"].get("joint")
    return truth["cause"] + (f" (joint {joint})" if joint else "")


def investigated(folder, idc, runs):
    (folder / "rig.forces.txt").unlink(missing_ok=True)
    out = folder / "asked"
    words = [idc, "investigate", folder / "recordings", "--scenario", folder / "cell.toml", "--rig", folder / "rig", "--runs", runs, "--time", f"{LONGEST_S}s", "--out", out, "--force", "--quiet"]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    truth = json.loads((folder / "truth.json").read_text())
    row = {"cell": folder.name, **truth}
    if done.returncode not in (0, 1):
        return {**row, "error": done.stderr.strip()[-300:]}
    record = json.loads((out / "investigation.json").read_text())
    right = wanted(truth)
    of = lambda odds: sum(own["probability"] for own in odds["explanations"] if own["effects"] == right)  # noqa: E731
    last = record["odds"][-1]
    rest = [f"{own['effects']} {own['probability']:.2f}" for own in last["explanations"] if own["effects"] != right and own["probability"] > 0.1]
    if last["none_of_these"] > 0.1:
        rest.append(f"none of these {last['none_of_these']:.2f}")
    forces = folder / "rig.forces.txt"
    largest = max(map(float, forces.read_text().split()), default=0.0) if forces.is_file() else 0.0
    return {**row, "before": of(record["odds"][0]), "after": of(last), "others": rest, "seconds": sum(run["duration_s"] for run in record["asked"]), "largest_force_n": largest, "stop": record["stop"]}


def main():
    if len(sys.argv) > 1 and sys.argv[1] == "--rig":
        return rig(*sys.argv[2:5])
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("idc")
    ap.add_argument("out", type=pathlib.Path)
    ap.add_argument("--cells", type=int, default=10)
    ap.add_argument("--only", type=int, nargs="*")
    ap.add_argument("--share", type=float, default=0.5, help="of the ride in the first recording")
    ap.add_argument("--runs", type=int, default=2)
    ap.add_argument("--write", type=pathlib.Path)
    a = ap.parse_args()
    out, idc = a.out.resolve(), os.path.abspath(a.idc)
    rows = []
    for place in a.only if a.only is not None else range(a.cells):
        number = FIRST + place
        folder = out / "cases" / f"case-{number:02}"
        if not (folder / "truth.json").is_file():
            make(number, CAUSES[place % len(CAUSES)], out, idc, a.share)
        row = investigated(folder, idc, a.runs)
        rows.append(row)
        print(json.dumps(row), flush=True)
    alone = sum("error" not in row and not row["others"] and row["after"] > 0.5 for row in rows)
    kept = sum("error" in row or row["largest_force_n"] <= row["limit"] for row in rows)
    summary = {"cells": len(rows), "cause_alone": alone, "force_kept": kept}
    print(json.dumps(summary))
    if a.write:
        a.write.write_text(json.dumps({"rows": rows, "summary": summary}, indent=1))


if __name__ == "__main__":
    main()

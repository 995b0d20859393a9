#!/usr/bin/env python3
"""A real UR10e (../shared/recordings/ur10e_arm): currents of one free path predicted by the arm fitted to another; load; pushes. Standard library only.

    tests/studies/ur10e_arm.py IDC OUT [--fit free_12harm_30s.csv] [--predict free_14harm_50s.csv]

Writes a case into OUT, diagnoses it with the program IDC, and prints for each joint the RMS of the residual over the RMS of the current, both through a
zero-phase Butterworth low-pass of order four at 6 Hz, at 100 Hz, while any joint moves faster than 0.01 rad/s. Gains are free from a quarter below the lower to
a quarter above the higher published value.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import subprocess

RECORDINGS = pathlib.Path(__file__).resolve().parents[3] / "shared" / "recordings" / "ur10e_arm"
GAINS = [(10.0, 14.9), (10.7, 13.3), (8.5, 11.1), (9.0, 10.6), (9.5, 11.0), (10.1, 11.5)]
NOISE = [0.12, 0.12, 0.07, 0.025, 0.03, 0.025]
ASKED = [8.2, 5.1, 4.2, 10.8, 9.1, 7.6]


def write_log(source, target):
    """The recording's columns by their names, repeated stamps left out."""
    header = ["time_s", *(f"joint_{j}_rad" for j in range(1, 7)), *(f"joint_{j}_current_a" for j in range(1, 7))]
    first = last = None
    with open(source) as read, open(target, "w", newline="") as write:
        out = csv.writer(write)
        out.writerow(header)
        for row in csv.reader(read):
            values = [float(v) for v in row]
            first = values[0] if first is None else first
            if last is not None and values[0] <= last:
                continue
            last = values[0]
            out.writerow([f"{last - first:.6f}", *values[1:7], *values[13:19]])


def write_case(folder, fit, predict):
    folder.mkdir(parents=True, exist_ok=True)
    urdf = (RECORDINGS / "ur10e.urdf").read_text()
    (folder / "ur10e.urdf").write_text(urdf)
    joints = re.findall(r'<joint name="([^"]+)" type="revolute"', urdf)
    lines = ['kind = "recorded_arm"', "schema = 1", "", "[arm]", 'urdf = "ur10e.urdf"', 'flange = "tool0"', "gravity_m_per_s2 = [0, 0, -9.81]",
             "link_mass_tolerance = 0.05", "link_centre_tolerance_m = 0.01"]
    for joint, (low, high) in zip(joints, GAINS):
        low, high = 0.75 * low, 1.25 * high
        middle = 0.5 * (low + high)
        lines += ["", "[[drive]]", f'joint = "{joint}"', f"gain_n_m_per_a = {{ value = {middle:.4f}, tolerance = {(high - low) / 2 / middle:.4f} }}"]
    names = ", ".join(f'"{name}"' for name in fit)
    lines += ["", "[load]", "mass_kg = 0.0", "", "[sensors]", "rate_hz = 100", "joint_rad = 3e-5", "joint_rad_per_s = 1e-3", f"current_a = {NOISE}",
              "", "[recordings]", f"fit = [{names}]", f'predict = "{predict}"', ""]
    (folder / "arm.toml").write_text("\n".join(lines))
    for name in {*fit, predict}:
        write_log(RECORDINGS / name, folder / name)


def read(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def on_grid(time, values, grid):
    out, i = [], 0
    for t in grid:
        while i < len(time) - 2 and time[i + 1] < t:
            i += 1
        share = (t - time[i]) / (time[i + 1] - time[i])
        out.append(values[i] + share * (values[i + 1] - values[i]))
    return out


def low_pass(values, cut_off=6.0, rate=100.0):
    k = math.tan(math.pi * cut_off / rate)
    pad = int(3 * rate / cut_off)
    x = [2 * values[0] - v for v in values[pad:0:-1]] + values + [2 * values[-1] - v for v in values[-2:-pad - 2:-1]]
    for angle in (math.pi / 8, 3 * math.pi / 8):
        q = 0.5 / math.cos(angle)
        norm = 1 / (1 + k / q + k * k)
        b, a1, a2 = k * k * norm, 2 * (k * k - 1) * norm, (1 - k / q + k * k) * norm
        for _ in range(2):
            x1 = x2 = y1 = y2 = x[0]
            out = []
            for v in x:
                y = b * v + 2 * b * x1 + b * x2 - a1 * y1 - a2 * y2
                x2, x1, y2, y1 = x1, v, y1, y
                out.append(y)
            x = out[::-1]
    return x[pad:-pad]


def shares(measured, predicted):
    time = measured["time_s"]
    grid = [time[0] + 0.01 * i for i in range(int((time[-1] - time[0]) / 0.01))]
    joints = range(1, 7)
    angle = [low_pass(on_grid(time, measured[f"joint_{j}_rad"], grid)) for j in joints]
    moves = [0 < i < len(grid) - 1 and any(abs(q[i + 1] - q[i - 1]) / 0.02 > 0.01 for q in angle) for i in range(len(grid))]
    out = []
    for j in joints:
        column = f"joint_{j}_current_a"
        a = low_pass(on_grid(time, measured[column], grid))
        b = low_pass(on_grid(predicted["time_s"], predicted[column], grid))
        left = sum((x - y) ** 2 for x, y, m in zip(a, b, moves) if m)
        out.append(100 * math.sqrt(left / sum(x * x for x, m in zip(a, moves) if m)))
    return out


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("idc")
    ap.add_argument("out", type=pathlib.Path)
    ap.add_argument("--fit", default="free_12harm_30s.csv", help="recordings, with commas between")
    ap.add_argument("--predict", default="free_14harm_50s.csv")
    a = ap.parse_args()
    case, result = a.out / "case", a.out / "result"
    write_case(case, a.fit.split(","), a.predict)
    subprocess.run([a.idc, "diagnose", case, "--out", result, "--force"], check=True, stdout=subprocess.DEVNULL)
    answer = json.loads((result / "diagnosis.json").read_text())
    for effect in answer["effects"]:
        numbers = {k: v if not isinstance(v, dict) else [round(v[q], 4) for q in ("value", "low", "high")] for k, v in effect["parameters"].items()}
        print(f'{effect["confidence"]:.2f} {effect["name"]} {numbers} {(effect.get("law") or {}).get("is", "")}')
    found = shares(read(case / a.predict), read(result / "prediction.csv"))
    print("joint   " + " ".join(f"{j:6d}" for j in range(1, 7)))
    print("left, % " + " ".join(f"{s:6.1f}" for s in found))
    print("asked, %" + " ".join(f"{s:6.1f}" for s in ASKED))
    print(f'{answer["seconds"]:.1f} s')


if __name__ == "__main__":
    main()

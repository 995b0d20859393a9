"""Cells of one's own: effects of arm, part and contact put into robots and parts of several kinds by --with, recorded with noise, diagnosed and scored.

    python3 tests/studies/own_cells.py FOLDER [--count N] [--only CASE ..]       IDC names the program (default target/release/idc)

Ten cells as `idc new cell` writes them, of made robots (`made_robots.py`: other makers, lengths and masses) and of parts of the project and made ones, less what
a diagnosis finds itself (where the part lies, springs of the drives); the work is cut to 60 mm of the edge, three programs to fit and one to predict. Five effects
each. Their sizes are drawn by seed, and raised until the largest root mean square of what the effect changes, over one recording and channel without noise, is at
least five standard deviations of that sensor. An effect is named where it comes first, of the same joint, with 50 % at least and nothing else at 50 % beside it;
or where it stands in the answer or its alternatives at stated odds, and what comes first is a look-alike (`Confused with` of either effect's file). False and sure is another
name above 90 %. "Fully" is wrong where a channel of the recording to predict got worse than nominal by more than its noise. Needs pandas and numpy.
"""

import argparse
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd

import made_robots

PROJECT = Path(__file__).resolve().parents[2]
IDC = os.environ.get("IDC", str(PROJECT / "target/release/idc"))
SEED = 39
NOISE = {"measured_force_n": 0.8, "measured_stroke_m": 4e-5, "measured_regulator_pressure_pa": 400.0}
ENCODER = 2e-6
# Largest root mean square that is drawn, and the least that is asked, in standard deviations.
LARGEST, LEAST = 40.0, 5.0
# Torque of a drive has no noise of a sensor: friction is drawn as a share of what its drive is rated for.
FRICTION = (0.02, 0.06)
# Name, lean [deg], share of the cell's force, feed [mm/s], seed.
PROGRAMS = [("a", 0, 1.0, 40, 11), ("b", 12, 0.5, 60, 12), ("c", -9, 0.75, 50, 14), ("predict", 6, 0.9, 55, 13)]
# Name of a cell, made robot or the project's arm, part or the plate.
CELLS = [
    ("plate", None, None), ("abb_00", 0, None), ("fanuc_01", 1, None), ("kuka_02", 2, None), ("motoman_03", 3, None),
    ("staubli_04", 4, None), ("fanuc_11", 11, None), ("motoman_13", 13, None), ("bar", None, "bar"), ("bracket", None, "bracket"),
]
# Number that is raised, where it begins and where it ends as it is drawn; what else is drawn.
EFFECTS = {
    "compliant_joint": ("stiffness_n_m_per_rad", (4e5, 1e5), {}),
    "joint_encoder_offset": ("offset_rad", (3e-4, 1.5e-3), {}),
    "joint_backlash": ("play_rad", (4e-4, 2e-3), {}),
    "joint_friction": ("friction_n_m", None, {}),
    "servo_lag": ("bandwidth_hz", (20.0, 8.0), {}),
    "part_misplaced": ("shift_m", (3e-4, 1.2e-3), {"tilt_m_per_m": (-6e-3, 6e-3)}),
    "burr": ("height_m", (3e-4, 1e-3), {"width_m": (2e-3, 8e-3)}),
    "tool_runout": ("amplitude_m", (2e-5, 1e-4), {"frequency_hz": (14.0, 40.0)}),
    "surface_waviness": ("amplitude_m", (1e-4, 5e-4), {"frequency_hz": (1.5, 6.0)}),
    "contact_stiffness_error": ("stiffness_n_per_m", (5e4, 2e4), {}),
    "hertzian_contact": ("stiffness_n_per_m15", (3e6, 8e5), {}),
}


def idc(*words, fails=False):
    done = subprocess.run([IDC, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, 1, 3) and not fails:
        raise RuntimeError(f"idc {' '.join(map(str, words))}: {done.returncode}\n{done.stderr[-2000:]}")
    return done


def look_alikes():
    """Names that the effects' files say each may be confused with, either way."""
    pairs = set()
    for file in (PROJECT / "src/effects").rglob("*.rs"):
        text = file.read_text()
        if "//! Confused with:" in text:
            for other in re.findall(r"^//! - ([a-z_]+)", text.split("//! Confused with:")[1], re.M):
                pairs |= {(file.stem, other), (other, file.stem)}
    return pairs


def bar():
    """A bar of triangles: 240 mm long, its top edge between faces at 80 degrees."""
    lean = math.tan(math.radians(10.0))
    section = [(0.0, 0.0), (60.0, 0.0), (60.0, -40.0), (40.0 * lean, -40.0)]
    corners = [(x, *point) for x in (-120.0, 120.0) for point in section]
    count = len(section)
    faces = [(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6)]
    for i in range(count):
        j = (i + 1) % count
        faces += [(i, count + i, count + j), (i, count + j, j)]
    return corners, faces


def cell(folder, name, robot, part):
    """The file of a cell as its owner has it, as made by `idc new cell`, and less what a diagnosis finds."""
    file = folder / f"{name}.toml"
    if file.exists():
        return file
    words = ["new", "cell", file, "--quiet", "--force"]
    if robot is not None:
        words += ["--urdf", made_robots.make(folder / "robots", robot)[0]]
    if part == "bar":
        path = folder / "bar.stl"
        made_robots.write_mesh(path, bar(), 1.0)
        words += ["--part", path]
    elif part:
        words += ["--part", PROJECT / f"assets/{part}.stl"]
    idc(*words)
    kept, skipped = [], False
    for line in file.read_text().splitlines():
        if line.startswith("["):
            skipped = line.split("#")[0].strip() in ("[[arm.drives]]", "[workpiece.misplacement]", "[expect]")
        if not skipped:
            kept.append(line)
    text = "\n".join(kept) + "\n"
    if "encoder_noise_rad" not in text:
        text = text.replace("[device]\n", f"[arm.servo]\nencoder_noise_rad = {ENCODER}\n\n[device]\n", 1)
    begin = re.search(r"^start_mm = ([0-9.]+)", text, re.M)
    end = re.search(r"^end_mm = ([0-9.]+)", text, re.M)
    if begin and end:
        middle = 0.5 * (float(begin[1]) + float(end[1]))
        half = min(30.0, 0.5 * (float(end[1]) - float(begin[1])))
        text = text.replace(begin[0], f"start_mm = {middle - half:.1f}").replace(end[0], f"end_mm = {middle + half:.1f}")
    text = text.replace("[process]\n", "[process]\napproach_distance_mm = 10\nsettle_time_s = 0.4\n", 1)
    file.write_text(text)
    return file


def sets(file, program):
    _, lean, share, feed, seed = program
    force = float(re.search(r"^force_n = ([0-9.]+)", file.read_text(), re.M)[1])
    values = {"process.lean_deg": lean, "process.force_n": round(share * force, 2), "process.feed_mm_per_s": feed, "simulation.seed": seed}
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def quiet():
    keys = ["arm.servo.encoder_noise_rad", *(f"sensing.{s}" for s in (
        "force.standard_deviation_n", "stroke.standard_deviation_mm", "regulator_pressure.standard_deviation_pa"))]
    return [word for key in keys for word in ("--set", f"{key}=0")]


def run(file, program, out, effect, more=()):
    if (out / "samples.parquet").exists():
        return True
    put = ["--with", effect] if effect else []
    done = idc("run", file, *sets(file, program), *more, *put, "--out", out, "--effort", 0, "--no-recording", "--quiet", "--force", fails=True)
    return done.returncode in (0, 1)


def changes(there, here):
    """Largest root mean square between two runs over a channel, in standard deviations of its sensor."""
    one, other = (pd.read_parquet(folder / "samples.parquet") for folder in (there, here))
    count = min(len(one), len(other))
    noise = dict(NOISE) | {name: ENCODER for name in one.columns if name.endswith("_encoder_rad")}
    sizes = {}
    for name, sigma in noise.items():
        difference = (one[name][:count] - other[name][:count]) / sigma
        sizes[name] = math.sqrt(np.nanmean(np.square(difference.to_numpy())))
    name = max(sizes, key=sizes.get)
    return sizes[name], name


def text_of(name, values):
    return f"{name}:" + ",".join(f"{key}={value:.6g}" for key, value in values.items())


def drawn(folder, file, name, rng):
    """An effect with its numbers, and what it changes [1]: drawn, and its size raised until it shows enough."""
    number, span, others = EFFECTS[name]
    values = {key: rng.uniform(*ends) for key, ends in others.items()}
    text = file.read_text()
    if name == "burr":
        start = re.search(r"^start_mm = ([0-9.]+)", text, re.M)
        values["position_m"] = 1e-3 * (float(start[1]) if start else 0.0) + rng.uniform(0.015, 0.045)
    if name == "joint_friction":
        share = rng.uniform(*FRICTION)
        limits = re.findall(r"effort_n_m = ([0-9.]+)", text)
        values[number] = share * (float(limits[1]) if len(limits) > 1 else 400.0)
        values["joint"] = 2
        return text_of(name, values), None
    target = LEAST * (LARGEST / LEAST) ** rng.random()
    values[number] = span[0] * (span[1] / span[0]) ** rng.random()
    bare = folder / "bare" / file.stem
    run(file, PROGRAMS[0], bare, None, quiet())
    for _ in range(4):
        effect = text_of(name, values)
        out = folder / "shows"
        shutil.rmtree(out, ignore_errors=True)
        if not run(file, PROGRAMS[0], out, effect, quiet()):
            return None, None
        size, _ = changes(out, bare)
        if size >= LEAST:
            return effect, size
        step = min(max(1.2 * target / max(size, 0.1), 1.5), 6.0)
        values[number] *= step if span[1] > span[0] else 1 / step
    return None, None


def verdict(answer, planted, alike):
    """Whether the planted effect is named, whether another is named with certainty, and whether "fully" stands where a channel got worse."""
    name, joint = planted
    own = name + (f"_{joint}" if joint else "")
    found = []
    for effect in answer["effects"]:
        number = effect["parameters"].get("joint", {}).get("value")
        found.append((effect["name"] + (f"_{number:.0f}" if number else ""), effect["name"], effect["confidence"]))
    sure = [full for full, _, confidence in found if confidence > 0.9 and full != own]
    likely = [full for full, _, confidence in found if confidence >= 0.5]
    named = bool(found) and found[0][0] == own and likely == [own]
    stands = any(full == own for full, _, _ in found) or any(own in a["effects"] or name in a["effects"] for a in answer["alternatives"])
    odds = stands and bool(found) and not sure and ((name, found[0][1]) in alike or found[0][0] == own or found[0][1] == name)
    worse = [p["channel"] for p in answer["prediction"] if p["after"] > p["believed"] + 0.1 * (p["noise"] or 0.0)]
    fully = answer.get("explained") == "fully" and bool(worse)
    return named, odds, sure, fully, found, worse


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, help="this many of the fifty, spread evenly over them")
    parser.add_argument("--only", nargs="*", help="cases by name, or cells")
    parser.add_argument("--runs", action="store_true", help="make the recordings alone")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    alike = look_alikes()
    cases = []
    for index, (name, robot, part) in enumerate(CELLS):
        # Each effect comes in four or five of the ten cells.
        names = list(EFFECTS)
        cases += [(name, robot, part, names[(5 * index + k) % len(names)]) for k in range(5)]
    if arguments.count:
        step = len(cases) / arguments.count
        cases = [cases[int(step * i)] for i in range(arguments.count)]
    if arguments.only:
        cases = [c for c in cases if c[0] in arguments.only or f"{c[0]}.{c[3]}" in arguments.only]
    total = named = false = fully = 0
    for name, robot, part, effect in cases:
        case = f"{name}.{effect}"
        rng = random.Random(f"{SEED} {case}")
        try:
            file = cell(folder, name, robot, part)
            plan = folder / "drawn" / f"{case}.json"
            if plan.exists():
                put, size = json.loads(plan.read_text())
            else:
                put, size = drawn(folder, file, effect, rng)
                plan.parent.mkdir(exist_ok=True)
                plan.write_text(json.dumps([put, size]))
            if put is None:
                print(f"{case}: does not run, or does not show at any size", flush=True)
                continue
            runs = folder / "cases" / case
            ran = [program[0] for program in PROGRAMS if run(file, program, runs / program[0], put)]
            if len(ran) < len(PROGRAMS):
                print(f"  {case}: only {', '.join(ran)} run", flush=True)
            if arguments.runs:
                print(f"{case}: {put}{f', {size:.0f} sigma' if size else ''}", flush=True)
                continue
            out = folder / "out" / case
            if not (out / "diagnosis.json").exists():
                idc("diagnose", runs, "--scenario", file, "--out", out, "--quiet")
        except RuntimeError as error:
            print(f"{case}: {error}", flush=True)
            total += 1
            continue
        table = (runs / "a" / "varied.toml").read_text().split("[[effect]]")[1]
        joint = re.search(r"^joint = ([0-9]+)", table, re.M)
        answer = json.loads((out / "diagnosis.json").read_text())
        alone, odds, sure, wrong, found, worse = verdict(answer, (effect, int(joint[1]) if joint else None), alike)
        total += 1
        named += alone or odds
        false += bool(sure)
        fully += wrong
        word = "named" if alone else "at odds" if odds else "NOT NAMED"
        shown = ", ".join(f"{full} {100 * confidence:.3g} %" for full, _, confidence in found) or "nothing"
        others = "; ".join(f"{'+'.join(a['effects']) or 'nothing'} {a['odds']:.2g}" for a in answer["alternatives"][:4])
        marks = (" FALSE AND SURE" if sure else "") + (" FULLY THOUGH WORSE" if wrong else "")
        put = put + (f" (joint {joint[1]})" if joint else "")
        print(f"{case}: {word}{marks}: {put}{f', {size:.0f} sigma' if size else ''}: {shown}; or {others or 'none'}; {answer.get('explained')}, worse {worse}, {answer['seconds']:.0f} s", flush=True)
    print(f"named alone or at odds with its look-alike {named} of {total}; false and sure in {false}; fully though a channel got worse {fully}")
    sys.exit(0 if total == named else 1)


if __name__ == "__main__":
    main()

"""What is diagnosed runs: effects put into two cells by --with, recorded with noise, diagnosed, and the improved cell run beside the recording.

    python tests/studies/diagnosed_cells.py FOLDER [CASE ..]       IDC names the program (default target/release/idc)

For each cell fourteen effects and nothing at all. A case is named where the first effect of the answer is the one put in, of the same joint, and alone where
there is no other. The improved cell runs twice, without noise of its own and with the recording's; beside the recording of the same job the worst channel is
the largest 90th percentile of the difference over the noise that the sensors have (1.64 where the recording's noise alone is left).
"""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pandas as pd

PROJECT = Path(__file__).resolve().parents[2]
IDC = os.environ.get("IDC", str(PROJECT / "target/release/idc"))
NOISE = {
    "measured_force_n": 0.8,
    "measured_stroke_m": 4e-5,
    "measured_regulator_pressure_pa": 400.0,
}
ENCODER = 2e-6
RATE = 250.0
# Cell: part, what its file says and what the study has it say, where the burr stands [mm].
CELLS = {
    "plate_edge_ideal": (
        "plate.stl",
        [("start_mm = 10\n", "start_mm = 100\n"), ("end_mm = 290", "end_mm = 160"), ("force_n = 150", "force_n = FORCE")],
        35,
    ),
    "bracket_loop": (
        "bracket.stl",
        [
            ("start_mm = 60 ", "start_mm = 200\nend_mm = 300 "),
            ("force_n = 100", "force_n = FORCE"),
            ("corner_feed_mm_per_s = 5\n", ""),
        ],
        50,
    ),
}
# Name, lean [deg], force [N], feed [mm/s], seed.
PROGRAMS = [
    ("a", 0, 170, 40, 11),
    ("b", 14, 60, 60, 12),
    ("c", -9, 115, 50, 14),
    ("d", 0, 70, 50, 15),
    ("predict", 6, 150, 55, 13),
]
PROCESS = """feed_mm_per_s = FEED
lean_deg = LEAN
approach_distance_mm = 10
working_stroke_mm = 40
settle_time_s = 0.4

[controller]
kind = "proportional_integral"
period_ms = 20

[simulation]
seed = SEED
"""
SENSING = """
[sensing]
preset = "white"
sample_rate_hz = 250
[sensing.force]
standard_deviation_n = 0.8
[sensing.stroke]
standard_deviation_mm = 0.04
[sensing.regulator_pressure]
standard_deviation_pa = 400
"""


def effects(burr):
    """What is put in, by what --with takes."""
    return [
        "part_misplaced",
        f"burr:position_mm={burr},height_mm=0.4,width_mm=12",
        "compliant_joint:joint=2",
        "joint_backlash:joint=2",
        "joint_encoder_offset:joint=2",
        "joint_friction:joint=2",
        "servo_lag",
        "tool_runout:amplitude_mm=0.06,frequency_hz=27",
        "coulomb_viscous_friction",
        "transport_delay",
        "cross_piston_leakage",
        "moving_mass_error",
        "return_spring_load",
        "regulator_gain_error",
        None,
    ]


def scenario(cell, program):
    part, cuts, _ = CELLS[cell]
    text = (PROJECT / f"scenarios/{cell}.toml").read_text().split("[expect]")[0]
    _, lean, force, feed, seed = program
    edits = [
        ("../models/", f"{PROJECT}/models/"),
        ("../assets/", f"{PROJECT}/assets/"),
        *cuts,
        ("feed_mm_per_s = 20\n", PROCESS),
        ("[device]\n", f"[arm.servo]\nencoder_noise_rad = {ENCODER}\n\n[device]\n"),
        ("LEAN", str(lean)),
        ("FORCE", str(force)),
        ("FEED", str(feed)),
        ("SEED", str(seed)),
    ]
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return text + SENSING


def idc(*words):
    done = subprocess.run([IDC, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in (0, 1, 3):
        raise RuntimeError(f"idc {' '.join(map(str, words))}: {done.returncode}\n{done.stderr[-2000:]}")
    return done.stdout


def worst(recorded, improved):
    """Channel and size of the largest 90th percentile of the difference over the noise, sample by sample of the sensors."""
    step = max(1, round((1 / RATE) / (recorded["time_s"][1] - recorded["time_s"][0])))
    count = min(len(recorded), len(improved))
    noise = dict(NOISE)
    noise |= {name: ENCODER for name in recorded.columns if name.endswith("_encoder_rad")}
    sizes = {}
    for name, sigma in noise.items():
        error = (recorded[name][:count:step] - improved[name][:count:step]).abs() / sigma
        sizes[name] = error.dropna().quantile(0.9)
    name = max(sizes, key=sizes.get)
    return name, sizes[name]


def case(folder, cell, effect):
    name = f"{cell}.{(effect or 'nothing').split(':')[0]}"
    runs = folder / "cases" / name
    for program in PROGRAMS:
        file = folder / "run.toml"
        file.write_text(scenario(cell, program))
        out = runs / program[0]
        if not (out / "samples.parquet").exists():
            put = ["--with", effect] if effect else []
            idc("run", file, *put, "--out", out, "--quiet")
    nominal = folder / f"{cell}.toml"
    nominal.write_text(scenario(cell, PROGRAMS[0]))
    answer_file = folder / "out" / name / "diagnosis.json"
    if not answer_file.exists():
        idc("diagnose", runs, "--scenario", nominal, "--out", folder / "out" / name, "--quiet")
    answer = json.loads(answer_file.read_text())
    found = [(e["name"], e["parameters"].get("joint", {}).get("value")) for e in answer["effects"]]
    planted = None
    if effect:
        varied = (runs / "a" / "varied.toml").read_text()
        table = varied.split("[[effect]]")[1]
        joint = [line.split("=")[1] for line in table.splitlines() if line.startswith("joint ")]
        planted = (effect.split(":")[0], float(joint[0]) if joint else None)
    recorded = pd.read_parquet(runs / "a" / "samples.parquet")
    # With the recording's seed, so that the sensors' noise is the same and what is left is the model's.
    same = folder / "same" / name
    idc("run", folder / "out" / name / "improved.toml", "--out", same, "--quiet", "--force")
    improved = folder / "improved" / name
    idc(
        "run", folder / "out" / name / "improved.toml", "--out", improved, "--quiet", "--force",
        "--set", "arm.servo.encoder_noise_rad=0", "--set", "sensing.force.standard_deviation_n=0",
        "--set", "sensing.stroke.standard_deviation_mm=0", "--set", "sensing.regulator_pressure.standard_deviation_pa=0",
    )
    return (
        planted,
        found,
        worst(recorded, pd.read_parquet(improved / "samples.parquet")),
        worst(recorded, pd.read_parquet(same / "samples.parquet")),
    )


def main():
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    wanted = sys.argv[2:]
    named = alone = near = close = count = clean = nothing = 0
    for cell in CELLS:
        for effect in effects(CELLS[cell][2]):
            name = f"{cell}.{(effect or 'nothing').split(':')[0]}"
            if wanted and name not in wanted:
                continue
            planted, found, (channel, size), (other, model) = case(folder, cell, effect)
            if planted is None:
                nothing += 1
                clean += not found
                verdict = "nothing found" if not found else "FOUND SOMETHING"
            else:
                count += 1
                is_named = bool(found) and found[0] == planted
                named += is_named
                alone += found == [planted]
                near += size <= 2.0
                close += model <= 2.0
                verdict = "named" if is_named else "NOT NAMED"
            print(f"{name}: {verdict} {found}; {channel} {size:.2f} sigma, with the same noise {other} {model:.2f} sigma", flush=True)
    print(f"named {named} of {count}, alone {alone}; improved cell within 2.0 sigma {near} of {count}, with the same noise {close}; nothing found {clean} of {nothing}")


if __name__ == "__main__":
    main()

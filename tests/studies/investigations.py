"""Investigations of laboratory devices whose first recording leaves it open what is missing: by experiments of the program's own choice, and by the fixed
programme of stairs, ride and cycle repeated for the same recorded time.

    python tests/studies/investigations.py --idc target/release/idc --work build/investigations --list catalogue [--draw 11] [--wanted 10] [--devices 80]

Lists: catalogue (effects with others of their kind beside them), sheet (a number of the rig file off by more than its tolerance), sensors (sensors and clocks),
laws (laws that no list holds). The first recording is the beginning of the stairs, --first seconds of it. The first devices of a draw that leave two explanations
above 10 % are taken, "none of these" being one, and it is said of how many. Printed for each: the truth, the probability on it before and after, what else is above
10 %, seconds recorded. The summary compares both ways.
"""

import argparse
import json
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

RUNS = 2
LONGEST_S = 15

SENSORS = {
    "force_sensor_bias_drift",
    "force_sensor_gain_error",
    "force_sensor_lag",
    "force_sensor_saturation",
    "inertial_crosstalk",
    "stroke_sensor_gain_error",
    "channel_time_offset",
}
# Effects of one kind with others: laws of friction, of leaks and heat, of air's ways, of the regulator, of loads, of the contact.
CATALOGUE = {
    "coulomb_viscous_friction",
    "stribeck_friction",
    "presliding_hysteresis",
    "pressure_dependent_friction",
    "external_leakage",
    "cross_piston_leakage",
    "heat_transfer",
    "supply_restriction",
    "exhaust_restriction",
    "extra_dead_volume",
    "hose_volume",
    "supply_droop",
    "transport_delay",
    "regulator_hysteresis",
    "regulator_rate_limit",
    "regulator_second_order",
    "return_spring_load",
    "axial_force_offset",
    "moving_mass_error",
    "contact_stiffness_error",
    "hertzian_contact",
    "surface_offset",
    "end_cushioning",
    "solenoid_switching_delay",
}
# Numbers of the sheet, and what a diagnosis calls them.
SHEET = {
    "bore_m": "number_off (cylinder.bore_m)",
    "rod_m": "number_off (cylinder.rod_m)",
    "discharge_coefficient": "number_off (valve.discharge_coefficient)",
    "moving_mass_kg": "moving_mass_error",
    "gravity_along_axis_m_per_s2": "number_off (cylinder.gravity_along_axis_m_per_s2)",
    "temperature_k": "number_off (gas.temperature_k)",
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--idc", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--draw", type=int, default=11)
    parser.add_argument("--wanted", type=int, default=10)
    parser.add_argument("--devices", type=int, default=80)
    parser.add_argument("--list", choices=("catalogue", "sheet", "sensors", "laws"), default="catalogue")
    parser.add_argument("--first", type=float, default=0.48, help="seconds of the first recording")
    parser.add_argument("--conditions", default="laboratory")
    parser.add_argument("--duration", type=float, default=2.0)
    parser.add_argument("--smallest", type=float, default=0.02, help="smallest effect, as a share of the largest that is plausible")
    parser.add_argument("--largest", type=float, default=0.3)
    parser.add_argument("--healthy", type=int, default=0, help="instead, so many devices that lack nothing, each asked for two runs")
    return parser.parse_args()


class Study:
    def __init__(self, asked):
        self.asked = asked
        self.idc = asked.idc.resolve()
        self.work = asked.work.resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        kind = "--laws" if asked.list == "laws" else "--devices"
        self.draw = [kind, str(asked.devices), "--draw", str(asked.draw), "--duration-s", str(asked.duration)]
        if asked.list != "laws":
            self.draw += ["--conditions", asked.conditions, "--smallest", str(asked.smallest), "--largest", str(asked.largest)]

    def call(self, *words, codes=(0,)):
        done = subprocess.run([self.idc, *map(str, words)], capture_output=True, text=True)
        if done.returncode not in codes:
            raise SystemExit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")
        return done

    def cases(self):
        folder = self.work / "laboratory"
        if not folder.exists():
            self.call("laboratory", *self.draw, "--out", folder, "--quiet")
        for case in (folder / "cases").iterdir():
            self.first_recording_alone(case)
        cases = sorted((folder / "cases").iterdir(), key=lambda path: int(path.name.rsplit("-", 1)[1]))
        return [(case, json.loads((folder / "sealed" / f"{case.name}.json").read_text())) for case in cases]

    def first_recording_alone(self, case):
        """Of three recordings the first, stairs on a fixed surface, and the limits that all three went to."""
        rig = case / "rig.toml"
        text = rig.read_text()
        if "[limits]" in text:
            return
        stroke = float(re.search(r"^stroke_m = (?:\{ value = )?([0-9.e-]+)", text, re.M).group(1))
        pressures, forces = [], []
        for path in case.glob("*.csv"):
            rows = [row.split(",") for row in path.read_text().splitlines()]
            pressures += [float(row[rows[0].index("set_pressure_pa")]) for row in rows[1:]]
            if "force_n" in rows[0]:
                forces += [float(row[rows[0].index("force_n")] or 0) for row in rows[1:]]
        programmes = self.work / "programmes" / case.name
        programmes.mkdir(parents=True, exist_ok=True)
        for name in ("stairs.csv", "ride.csv", "cycle.csv"):
            shutil.copy(case / name, programmes / name)
        stairs = case / "stairs.csv"
        rows = stairs.read_text().splitlines()
        stairs.write_text("\n".join([rows[0], *(row for row in rows[1:] if float(row.split(",")[0]) <= self.asked.first)]) + "\n")
        if self.asked.list == "sheet":
            text = self.other_number(case, text)
        lines = ['fit = ["stairs.csv"]' if line.startswith("fit") else line for line in text.splitlines() if not line.startswith("predict")]
        limits = {
            "set_pressure_pa": max(pressures),
            "set_pressure_rate_pa_per_s": 1e9,
            "surface_least_m": round(0.2 * stroke, 4),
            "surface_most_m": round(0.8 * stroke, 4),
            "surface_speed_m_per_s": 0.2,
            "surface_acceleration_m_per_s2": 5,
            "solenoid": "true",
            "without_workpiece": "true",
            "force_n": round(1.1 * max(forces), 1),
        }
        rig.write_text("\n".join([*lines, "", "[limits]", *(f"{key} = {value}" for key, value in limits.items())]) + "\n")

    def other_number(self, case, text):
        """The rig file with one number off by 4 to 12 %."""
        chance = random.Random(f"{self.asked.draw} {case.name}")
        keys = [key for key in SHEET if re.search(rf"^{key} = ", text, re.M)]
        key = chance.choice(keys)
        factor = 1 + chance.choice((-1, 1)) * chance.uniform(0.04, 0.12)

        def other(found):
            return f"{found.group(1)}{float(found.group(2)) * factor:.6g}"

        (case / "off.txt").write_text(SHEET[key] + "\n")
        return re.sub(rf"^({key} = (?:{{ value = )?)([-0-9.e]+)", other, text, count=1, flags=re.M)

    def rig(self, case):
        """A program that is the device of a case."""
        script = self.work / f"rig-{case.name}"
        words = " ".join(self.draw)
        script.write_text(f'#!/bin/sh\nexec {self.idc} laboratory {words} --rig {case.name} "$1" "$2"\n')
        script.chmod(0o755)
        return script

    def investigated(self, case, runs):
        """Odds before and after, and seconds recorded, by experiments of its own choice."""
        out = self.work / "asked" / case.name
        self.call(
            "investigate", case, "--rig", self.rig(case), "--runs", runs, "--time", f"{LONGEST_S}s", "--out", out, "--force", "--quiet", codes=(0, 1)
        )
        record = json.loads((out / "investigation.json").read_text())
        return record["odds"], sum(run["duration_s"] for run in record["asked"]), record

    def repeated(self, case, seconds):
        """The same recorded time of the programmes that the case has."""
        folder = self.work / "repeated" / case.name
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(case, folder)
        rig = (folder / "rig.toml").read_text()
        names = [self.work / "programmes" / case.name / name for name in ("stairs.csv", "ride.csv", "cycle.csv")]
        recorded, turn = 0.0, 0
        new = []
        while recorded < seconds:
            own = names[turn % len(names)]
            rows = own.read_text().splitlines()
            # The same inputs give the same noise: a row less each time makes them others.
            rows = rows[: len(rows) - 1 - turn // len(names)]
            rows = rows[: max(60, int((seconds - recorded) * 250) + 1)]
            columns = rows[0].split(",")
            wanted = [columns.index(name) for name in ("time_s", "set_pressure_pa", "solenoid", "surface_m")]
            inputs = folder / "inputs.tmp"
            inputs.write_text("\n".join(",".join(row.split(",")[i] for i in wanted) for row in rows) + "\n")
            name = f"again-{turn + 1}.csv"
            subprocess.run([self.rig(case), inputs, folder / name], check=True)
            inputs.unlink()
            new.append(name)
            times = [float(row.split(",")[0]) for row in (rows[1], rows[-1])]
            recorded += times[1] - times[0]
            turn += 1
        listed = ", ".join(f'"{name}"' for name in ["stairs.csv", *new])
        lines = ["fit = [" + listed + "]" if line.startswith("fit") else line for line in rig.splitlines()]
        (folder / "rig.toml").write_text("\n".join(line for line in lines if not line.startswith("predict")) + "\n")
        odds, _, refused = self.odds_of(folder)
        if odds is None:
            print(f"{case.name}: {refused.strip()}", file=sys.stderr)
        return odds

    def odds_of(self, case):
        """Odds of a case as it stands: a proposal that looks at few programmes, which says them."""
        out = self.work / "odds" / case.name
        done = self.call("next", case, "--out", out, "--force", "--json", "--programmes", 12, codes=(0, 2))
        if done.returncode:
            return None, None, done.stderr
        document = json.loads(done.stdout)
        return document, None, None


def truth_of(case, sealed):
    off = case / "off.txt"
    if off.exists():
        return [off.read_text().strip()]
    return sorted(effect["name"] for effect in sealed["effects"])


def is_of(listed, truth, sealed):
    """Whether a device is of a list: those of the sheet lack nothing, but for the number that is off."""
    if listed == "sheet":
        return not sealed["effects"]
    kinds = {"catalogue": CATALOGUE, "sensors": SENSORS}.get(listed)
    return bool(truth) and (kinds is None or set(truth) <= kinds)


def effects_of(own):
    """Names of an explanation's effects, a formula without its text."""
    listed, formula, _ = own["effects"].partition("unlisted (")
    return " + ".join(sorted((listed + ("unlisted" if formula else "")).split(" + ")))


# What is the same by the equations: gravity along an axis that does not turn is a constant force; flow through an orifice goes with the discharge coefficient and with
# the root of the temperature, in the chambers' balance, alike.
SAME = {
    "number_off (cylinder.gravity_along_axis_m_per_s2)": "axial_force_offset",
    "number_off (gas.temperature_k)": "number_off (valve.discharge_coefficient)",
}


def right_names(truth):
    """Names of what is right: the truth's, and what is the same by the equations."""
    names = [" + ".join(truth) if truth else "nothing is missing"]
    return names + [SAME[name] for name in names if name in SAME]


def probability(odds, truth):
    """Probability of the explanations that are the truth: its effects and no other."""
    return sum(own["probability"] for own in odds["explanations"] if effects_of(own) in right_names(truth))


def others(odds, truth):
    if odds["none_of_these"] > 0.1:
        odds = {"explanations": [*odds["explanations"], {"effects": "none of these", "probability": odds["none_of_these"]}]}
    rest = [own for own in odds["explanations"] if effects_of(own) not in right_names(truth)]
    return [f"{own['effects']} {own['probability']:.2f}" for own in rest if own["probability"] > 0.1]


def stated_surely(row):
    """Of the explanation that is stated at 0.9 and more in the end whether it is right."""
    if row["after"] >= 0.9:
        return [True]
    return [False] if row["best"][1] >= 0.9 else []


def main():
    asked = arguments()
    study = Study(asked)
    rows, drawn = [], 0
    for case, sealed in study.cases():
        truth = [] if asked.healthy else truth_of(case, sealed)
        if sealed["effects"] if asked.healthy else not is_of(asked.list, truth, sealed):
            continue
        drawn += 1
        first, _, refused = study.odds_of(case)
        if first is None:
            print(f"{case.name}: {refused.strip()}", file=sys.stderr)
            continue
        above = [own for own in first["explanations"] if own["probability"] > 0.1]
        if not asked.healthy and len(above) + (first["none_of_these"] > 0.1) < 2:
            settled = above[0]["effects"] if above else "none of these"
            print(f"{case.name}: {'right' if probability(first, truth) > 0.1 else 'wrong'} at once: {settled}", flush=True)
            continue
        odds, seconds, record = study.investigated(case, RUNS)
        row = {
            "case": case.name,
            "truth": truth,
            "before": probability(first, truth),
            "after": probability(odds[-1], truth),
            "others": others(odds[-1], truth),
            "best": [[own["effects"], own["probability"]] for own in odds[-1]["explanations"][:1]][0],
            "seconds": seconds,
            "stop": record["stop"],
        }
        if seconds > 0 and not asked.healthy:
            again = study.repeated(case, seconds)
            row["repeated"] = None if again is None else probability(again, truth)
        rows.append(row)
        print(json.dumps(row), flush=True)
        if len(rows) >= (asked.healthy or asked.wanted):
            break
    count = len(rows)
    if not count:
        raise SystemExit("no case was taken")
    stated = [right for row in rows for right in stated_surely(row)]

    def mean(key):
        own = [row[key] if row.get(key) is not None else row["before"] for row in rows]
        return sum(own) / count

    summary = {
        "drawn": drawn,
        "taken": count,
        "probability_on_the_truth_before": round(mean("before"), 3),
        "after": round(mean("after"), 3),
        "repeated": round(mean("repeated"), 3),
        "without_others_above_10_percent": sum(not row["others"] for row in rows),
        "stated_at_0.9": len(stated),
        "of_these_right": sum(stated),
        "mean_seconds": round(sum(row["seconds"] for row in rows) / count, 1),
    }
    print(json.dumps(summary))
    (study.work / "summary.json").write_text(json.dumps({"rows": rows, "summary": summary}, indent=1))


if __name__ == "__main__":
    main()

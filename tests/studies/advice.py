#!/usr/bin/env python3
"""Jobs spoilt at random, and whether what `idc check` advises makes them possible.

    python3 tests/studies/advice.py [--count 300] [--from 0] [--seed 1] [--out runs/advice_study] [--robots arm10,ur5]

Takes target/release/idc and, of .ci/install_references, the robots of example-robot-data. Each job is the shipped plate_edge of one of six robots with one
thing spoilt (two in every fifth); of each refusal or stop the remedies of `--json` are applied by `--set`, each alone, and judged by the whole `idc check`
and the whole `idc run`. One line of results.jsonl a job; those that stand there are not done again. At the end the table: jobs spoilt, jobs with a remedy,
remedies that run (exit 0 or 1), and what the others added.
"""

import argparse
import json
import math
import os
import random
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
IDC = Path(os.environ.get("IDC", PROJECT / "target/release/idc"))
DATA = PROJECT / "build/references"

# URDF, base and flange, place of the plate before the robot and its rotation, force that its drives give; without a URDF the project's own arm.
ROBOTS = {
    "arm10": dict(urdf=None, base="base_link", flange="flange", place=[750, 0, 200], rotation=[0, 0, -90], force=150),
    "iiwa": dict(urdf="kuka_iiwa/model.urdf", base="lbr_iiwa_link_0", flange="lbr_iiwa_link_7", place=[500, 0, 200], rotation=[-30, 0, -90], force=150),
    "panda": dict(urdf="franka_panda/panda.urdf", base="panda_link0", flange="panda_link8", place=[400, 0, 200], rotation=[0, 0, -90], force=60),
    "xarm6": dict(urdf="xarm/xarm6_robot.urdf", base="link_base", flange="link6", place=[400, 0, 350], rotation=[-30, 0, -90], force=90),
    "ur5": dict(urdf="ur_description/urdf/ur5_robot.urdf", base="base_link", flange="tool0", place=[550, 0, 200], rotation=[0, 0, -90], force=150),
    "ur10": dict(urdf="ur_description/urdf/ur10_robot.urdf", base="base_link", flange="tool0", place=[700, 0, 200], rotation=[0, 0, -90], force=150),
}


def find(name):
    """A URDF of the packages of .ci/install_references, wherever they keep it."""
    hits = sorted(DATA.glob(f"venv/lib/python3*/site-packages/**/{Path(name).name}"))
    hits = [hit for hit in hits if str(hit).endswith(name)]
    return hits[0] if hits else None


def base_scenario(name, robot):
    """The nominal job of a robot, or None where the robot is not installed."""
    urdf = PROJECT / "models/arm/arm10.urdf" if robot["urdf"] is None else find(robot["urdf"])
    if urdf is None:
        return None
    packages = {parent.name: str(parent) for parent in urdf.parents if parent.name == "example-robot-data"}
    return {
        "urdf": str(urdf), "packages": packages, "base": robot["base"], "flange": robot["flange"],
        "position": list(robot["place"]), "rotation": list(robot["rotation"]), "edge": "edge = 1", "start": 90, "end": 210,
        "force": robot["force"], "feed": 20, "mass": 4.0, "lean": 0, "roll": None, "shift": 0.5,
        "overrides": {}, "limits": [], "obstacles": [], "process": {}, "mesh": str(PROJECT / "assets/plate.stl"),
        "mesh_unit": "mm", "tool_axis": None,
    }


def text(job):
    rows = ["schema = 2", 'title = "spoilt"', "[arm]", f'urdf = {json.dumps(job["urdf"])}', f'base_link = "{job["base"]}"', f'flange_link = "{job["flange"]}"']
    if job["packages"]:
        rows += ["[arm.packages]"] + [f"{json.dumps(k)} = {json.dumps(v)}" for k, v in job["packages"].items()]
    for limit in job["limits"]:
        rows += ["[[arm.limit_overrides]]"] + [f"{k} = {json.dumps(v)}" for k, v in limit.items()]
    rows += ["[device]", f'model = {json.dumps(str(PROJECT / "models/device.toml"))}', "[device.override]", f'moving_mass_kg = {job["mass"]}', "housing_mass_kg = 1.0"]
    rows += [f"{k} = {v}" for k, v in job["overrides"].items()]
    rows += ["[workpiece]", f'mesh = {json.dumps(job["mesh"])}', f'mesh_unit = "{job["mesh_unit"]}"', f'position_mm = {job["position"]}', f'rotation_deg = {job["rotation"]}']
    rows += ["[workpiece.edge]", job["edge"]]
    if job["start"] is not None:
        rows += [f'start_mm = {job["start"]}', f'end_mm = {job["end"]}']
    rows += ["[workpiece.misplacement]", f'shift_mm = {job["shift"]}']
    rows += ["[process]", f'force_n = {job["force"]}', f'feed_mm_per_s = {job["feed"]}']
    rows += [f"{k} = {v}" for k, v in job["process"].items()]
    if job["tool_axis"] is not None:
        rows += [f'tool_axis = {job["tool_axis"]}']
    elif job["lean"]:
        rows += [f'lean_deg = {job["lean"]}']
    if job["roll"] is not None:
        rows += [f'roll_deg = {job["roll"]}']
    rows += ["[controller]", 'kind = "proportional_integral"', "period_ms = 20"]
    for obstacle in job["obstacles"]:
        rows += ["[[obstacle]]"] + [f"{k} = {json.dumps(v)}" for k, v in obstacle.items()]
    return "\n".join(rows) + "\n"


# Spoilers: each takes the job and a generator, and says what it did.


def far(job, r):
    way = r.uniform(300, 2500)
    angle = r.uniform(-1, 1)
    job["position"] = [round(job["position"][0] + way * math.cos(angle), 1), round(way * math.sin(angle), 1), job["position"][2]]
    return f"part {way:.0f} mm farther"


def near(job, r):
    share = r.uniform(0.0, 0.5)
    job["position"] = [round(share * job["position"][0], 1), round(r.uniform(-60, 60), 1), job["position"][2]]
    return f"part at {share:.2f} of its distance"


def behind(job, r):
    job["position"][0] = -job["position"][0]
    return "part behind the robot"


def high(job, r):
    job["position"][2] += round(r.uniform(500, 1500), 1)
    return "part high up"


def low(job, r):
    job["position"][2] -= round(r.uniform(300, 900), 1)
    return "part low down"


def tilted(job, r):
    job["rotation"] = [round(r.uniform(-180, 180), 1) for _ in range(3)]
    return f'part turned to {job["rotation"]}'


def wall(job, r):
    x, y, z = job["position"]
    at = r.uniform(0.3, 0.9)
    job["obstacles"].append({"name": "wall", "box_mm": [20, 400, round(r.uniform(200, 900))], "position_mm": [round(at * x, 1), round(y + r.uniform(-200, 200), 1), round(z + 300, 1)]})
    return "a wall in the way"


def post(job, r):
    x, y, z = job["position"]
    job["obstacles"].append({"name": "post", "box_mm": [60, 60, 500], "position_mm": [round(x + r.uniform(-150, 60), 1), round(y + r.uniform(-120, 120), 1), round(z + 300, 1)]})
    return "a post beside the edge"


def roof(job, r):
    x, y, z = job["position"]
    job["obstacles"].append({"name": "roof", "box_mm": [600, 600, 30], "position_mm": [round(x, 1), round(y, 1), round(z + r.uniform(80, 350), 1)]})
    return "a roof over the part"


def fixture(job, r):
    x, y, z = job["position"]
    job["obstacles"].append({"name": "fixture", "box_mm": [80, 80, 80], "position_mm": [round(x + r.uniform(20, 100), 1), round(y + r.uniform(-80, 80), 1), z]})
    return "a fixture in the part"


def strong(job, r):
    job["force"] = round(job["force"] * r.uniform(4, 12), 1)
    return f'force {job["force"]} N'


def supply(job, r):
    job["overrides"]["supply_pressure_bar_gauge"] = round(r.uniform(0.15, 0.6) * job["force"] / 150, 2)
    return "weak supply"


def heavy(job, r):
    job["mass"] = round(r.uniform(1.5, 3.0) * job["force"] / 9.81 * 1.42, 1)
    return f'moving mass {job["mass"]} kg'


def light_force(job, r):
    job["force"] = round(job["mass"] * 9.81 * 0.7 * r.uniform(0.3, 0.9), 1)
    return f'force {job["force"]} N below the weight'


def fast(job, r):
    job["feed"] = round(r.uniform(600, 1000))
    job["process"]["acceleration_mm_per_s2"] = 20000
    job["process"]["jerk_mm_per_s3"] = 1000000
    job["process"]["settle_time_s"] = 0.5
    return f'feed {job["feed"]} mm/s'


def fast_approach(job, r):
    job["process"]["approach_speed_mm_per_s"] = 2000
    job["process"]["approach_distance_mm"] = 300
    job["process"]["acceleration_mm_per_s2"] = 20000
    job["process"]["jerk_mm_per_s3"] = 1000000
    return "approach 2000 mm/s"


def lean(job, r):
    job["lean"] = r.choice([-60, -55, 55, 60])
    return f'lean {job["lean"]} deg'


def roll(job, r):
    job["roll"] = round(r.uniform(-180, 180), 1)
    return f'roll {job["roll"]} deg'


def axis(job, r):
    job["tool_axis"] = r.choice([[1, 0, 0], [0, 0, -1], [0, 1, -1], [-1, 0, -1]])
    return f'tool axis {job["tool_axis"]}'


def ball(job, r):
    job["mesh"] = str(PROJECT / "assets/bracket.stl")
    job["edge"], job["start"] = "loop = 1", None
    job["overrides"]["tool_ball_radius_mm"] = round(r.uniform(28.5, 60), 1)
    job["overrides"]["tool_centre_mm"] = 180
    return f'ball of {job["overrides"]["tool_ball_radius_mm"]} mm in a bore of 20 mm'


def stroke(job, r):
    job["shift"] = r.choice([-1, 1]) * round(r.uniform(26, 45), 1)
    return f'shift {job["shift"]} mm'


def short_stroke(job, r):
    job["process"]["working_stroke_mm"] = round(r.uniform(0.5, 3), 1)
    job["shift"] = round(r.uniform(4, 12), 1)
    return "working stroke below the shift"


def wrong_edge(job, r):
    job["edge"] = f"edge = {r.randint(12, 60)}"
    return job["edge"]


def long_stretch(job, r):
    job["end"] = round(r.uniform(301, 900), 1)
    return f'end at {job["end"]} mm'


def other_edge(job, r):
    job["edge"], job["start"] = f"edge = {r.randint(0, 11)}", None
    return job["edge"]


def slow_joint(job, r):
    joints = movable(job["urdf"], job["flange"])
    job["limits"].append({"joint": r.choice(joints), "velocity_deg_per_s": round(r.uniform(1, 5), 2)})
    return f'slow {job["limits"][-1]}'


def weak_joint(job, r):
    joints = movable(job["urdf"], job["flange"])
    joint = r.choice(joints)
    effort = limit_of(job["urdf"], joint) or 50
    job["limits"].append({"joint": joint, "effort_n_m": round(effort * r.uniform(0.05, 0.4), 2)})
    return f'weak {job["limits"][-1]}'


def narrow(job, r):
    """A joint whose range is cut, in a copy of the URDF."""
    joints = movable(job["urdf"], job["flange"])
    name = r.choice(joints)
    tree = ET.parse(job["urdf"])
    for joint in tree.getroot().iter("joint"):
        limit = joint.find("limit")
        if joint.get("name") == name and limit is not None:
            middle = r.uniform(-1.5, 1.5)
            half = r.uniform(0.3, 1.2)
            limit.set("lower", f"{middle - half:.3f}")
            limit.set("upper", f"{middle + half:.3f}")
            if joint.get("type") == "continuous":
                joint.set("type", "revolute")
    copy = Path(job["folder"]) / "narrow.urdf"
    source = Path(job["urdf"]).parent
    for mesh in tree.getroot().iter("mesh"):
        file = mesh.get("filename")
        if "://" not in file and not os.path.isabs(file):
            mesh.set("filename", str((source / file).resolve()))
    tree.write(copy)
    job["urdf"] = str(copy)
    return f"joint {name} narrowed"


def movable(urdf, flange):
    root = ET.parse(urdf).getroot()
    by_child = {j.find("child").get("link"): j for j in root.iter("joint") if j.find("child") is not None}
    found = []
    link = flange
    while link in by_child:
        joint = by_child[link]
        if joint.get("type") in ("revolute", "continuous"):
            found.append(joint.get("name"))
        link = joint.find("parent").get("link")
    return found[::-1]


def limit_of(urdf, name):
    for joint in ET.parse(urdf).getroot().iter("joint"):
        if joint.get("name") == name and joint.find("limit") is not None:
            return float(joint.find("limit").get("effort", "0")) or None
    return None


SPOILERS = [far, near, behind, high, low, tilted, wall, post, roof, fixture, strong, supply, heavy, light_force, fast, fast_approach, lean, roll, axis,
            ball, stroke, short_stroke, wrong_edge, long_stretch, other_edge, slow_joint, weak_joint, narrow]


def idc(*words):
    done = subprocess.run([str(IDC), *map(str, words)], capture_output=True, text=True)
    return done.returncode, done.stderr


def refusal(stderr):
    for line in reversed(stderr.splitlines()):
        if line.startswith("{"):
            return json.loads(line)["error"]
    return {"message": stderr.strip().splitlines()[-1] if stderr.strip() else "", "remedies": []}


def settings(remedy):
    words = []
    for key, value in remedy["set"].items():
        value = value if isinstance(value, str) else json.dumps(value)
        words += ["--set", f"{key}={value}"]
    return words


def tried(index, seed, robots, folder, effort):
    r = random.Random(seed * 100003 + index)
    name = robots[index % len(robots)]
    here = folder / f"job{index:03}"
    shutil.rmtree(here, ignore_errors=True)
    here.mkdir(parents=True)
    for _ in range(40):
        job = base_scenario(name, ROBOTS[name])
        if job is None:
            return None
        job["folder"] = str(here)
        count = 2 if index % 5 == 4 else 1
        spoilt = [spoiler(job, r) for spoiler in r.sample(SPOILERS, count)]
        scenario = here / "scenario.toml"
        scenario.write_text(text(job))
        code, err = idc("check", scenario, "--json", "--effort", effort)
        stopped = False
        if code == 0:
            # Some are refused by their run alone.
            code, err = idc("run", scenario, "--json", "--no-recording", "--force", "--out", here / "spoilt")
            stopped = code == 3
        if code >= 2:
            break
    else:
        return None
    error = refusal(err)
    remedies = error.get("remedies", [])
    row = {"index": index, "robot": name, "spoilt": spoilt, "stopped": stopped, "message": error["message"], "remedies": []}
    for remedy in remedies:
        words = settings(remedy)
        run, ran = idc("run", scenario, *words, "--effort", 0, "--json", "--no-recording", "--force", "--out", here / "out")
        said = "" if run in (0, 1) else refusal(ran)["message"][:300]
        row["remedies"].append({"kind": remedy["kind"], "set": remedy["set"], "exit": run, "said": said})
    shutil.rmtree(here / "out", ignore_errors=True)
    shutil.rmtree(here / "spoilt", ignore_errors=True)
    return row


def report(rows):
    offered = [row for row in rows if row["remedies"]]
    remedies = [remedy for row in rows for remedy in row["remedies"]]
    works = [remedy for remedy in remedies if remedy["exit"] in (0, 1)]
    all_work = [row for row in offered if all(remedy["exit"] in (0, 1) for remedy in row["remedies"])]
    print(f"jobs spoilt              {len(rows)}")
    print(f"with a remedy            {len(offered)}")
    print(f"of these all remedies run {len(all_work)}")
    print(f"remedies                 {len(remedies)}")
    print(f"remedies that run        {len(works)}")
    print(f"refused by check         {sum(remedy['exit'] == 2 for remedy in remedies)}")
    kinds = {}
    for remedy in remedies:
        good = kinds.setdefault(remedy["kind"], [0, 0])
        good[0] += remedy["exit"] in (0, 1)
        good[1] += 1
    for kind, (good, all_of) in sorted(kinds.items()):
        print(f"  {kind:28} {good} of {all_of}")
    print("without a remedy:")
    for row in rows:
        if not row["remedies"]:
            print(f"  {row['index']:3} {row['robot']:6} {'; '.join(row['spoilt'])}: {row['message'][-240:]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=PROJECT / "runs/advice_study")
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--effort", type=float, default=1.0, help="of idc check; more where the computer is busy with other work")
    parser.add_argument("--report", action="store_true", help="the table of what stands, without a job more")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    results = arguments.out / "results.jsonl"
    rows = [json.loads(line) for line in results.read_text().splitlines()] if results.exists() else []
    done = {row["index"] for row in rows}
    robots = arguments.robots.split(",")
    for index in range(arguments.first, arguments.first + arguments.count):
        if index in done or arguments.report:
            continue
        row = tried(index, arguments.seed, robots, arguments.out, arguments.effort)
        if row is None:
            print(f"{index}: robot not installed, or nothing spoilt", file=sys.stderr)
            continue
        rows.append(row)
        with results.open("a") as file:
            file.write(json.dumps(row) + "\n")
        kinds = ", ".join(f"{remedy['kind']} {remedy['exit']}" for remedy in row["remedies"])
        print(f"{index} {row['robot']} {'; '.join(row['spoilt'])}: {kinds or 'no remedy'}", file=sys.stderr)
    report(rows)


if __name__ == "__main__":
    main()

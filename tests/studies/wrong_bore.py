#!/usr/bin/env python3
"""Real pistons (../shared/recordings/cylinder_friction) with the bore of the rig file set low: is the scale of force by pressure named, its members with their odds, and nothing else that the right bore does not have?

    wrong_bore.py PROGRAM RECORDINGS --out DIR [--seals A,B] [--only N]

Each seal, four pairs of pressures fitted (1+5, 1+7, 3+5, 3+7 bar), the bore 3, 5 and 7 % low at a tolerance of 2 %, beside the same with the right bore (at 12 %, which holds whatever the piston's area really is).
"""
import argparse, json, pathlib, shutil, subprocess, sys

PAIRS = [(1, 5), (1, 7), (3, 5), (3, 7)]
SCALE = {"number_off", "force_sensor_gain_error"}


def run(*arguments):
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    if done.returncode:
        print(done.stderr[-400:], file=sys.stderr)
    return done


def diagnosed(a, seal, pair, bore, tolerance, name):
    case, answer = a.out / "cases" / name, a.out / "answers" / name
    if not (answer / "diagnosis.json").exists():
        case.mkdir(parents=True, exist_ok=True)
        for p in pair:
            shutil.copy(a.out / "imported" / f"{seal}_{p}bar.parquet", case)
        (case / "rig.toml").write_text(f'schema = 2\n\n[rig]\nchain = "moved_piston"\n\n[cylinder]\ncount = 1\nbore_m = {{ value = {bore!r}, tolerance = {tolerance!r} }}\n\n[sensors]\nforce_n = 0.05\n\n[recordings]\nfit = ["*.parquet"]\n')
        run(a.program, "diagnose", case, "--out", answer, "--force", "--quiet")
    return json.loads((answer / "diagnosis.json").read_text())


def scale_of(d):
    """Force by pressure over that of a bore of 25 mm, as the answer has it."""
    gain, bore = 1.0, None
    for e in d["effects"]:
        if e["name"] == "number_off" and e.get("key") == "cylinder.bore_m":
            bore = e["parameters"]["value"]["value"]
        if e["name"] == "force_sensor_gain_error":
            gain = e["parameters"]["gain"]["value"]
    for n in d.get("tolerated", []):
        if bore is None and n["key"] == "cylinder.bore_m":
            bore = n["found"]["value"]
    return gain * ((bore or 0.025) / 0.025) ** 2


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program")
    p.add_argument("recordings", type=pathlib.Path)
    p.add_argument("--out", required=True, type=pathlib.Path)
    p.add_argument("--seals")
    p.add_argument("--only", type=int)
    a = p.parse_args()
    here = pathlib.Path(__file__).resolve().parents[2]
    (a.out / "imported").mkdir(parents=True, exist_ok=True)
    seals = a.seals.split(",") if a.seals else sorted({f.stem.rsplit("_", 1)[0] for f in a.recordings.glob("*bar.csv")})
    for seal in seals:
        for p in (1, 3, 5, 7):
            out = a.out / "imported" / f"{seal}_{p}bar.parquet"
            if not out.exists():
                run(a.program, "import", here / "assets/import/cylinder_friction.toml", a.recordings / f"{seal}_{p}bar.csv", "--out", out, "--quiet")
    good = total = 0
    for seal in seals:
        for pair in PAIRS:
            right = diagnosed(a, seal, pair, 0.025, 0.12, f"{seal}-{pair[0]}-{pair[1]}-right")
            allowed = {e["name"] for e in right["effects"]} | SCALE
            for low in (3, 5, 7):
                if a.only is not None and total >= a.only:
                    break
                d = diagnosed(a, seal, pair, 0.025 * (1 - low / 100), 0.02, f"{seal}-{pair[0]}-{pair[1]}-{low}")
                family = next((f for f in d.get("families", []) if f.get("name") == "force_by_pressure"), None)
                members = {e["name"]: round(e["confidence"], 3) for e in d["effects"] if e["name"] in SCALE}
                sure = family["probability"] if family else max(members.values(), default=0.0)
                off = scale_of(d) / scale_of(right) - 1
                beside = [e["name"] for e in d["effects"] if e["name"] not in allowed and e["confidence"] >= 0.5]
                ok = sure > 0.9 and abs(off) <= 0.01 and not beside
                good, total = good + ok, total + 1
                print(f"{seal} {pair[0]}+{pair[1]} bar, bore {low} % low: {'ok ' if ok else 'BAD'} family {sure:.3f} value {100 * off:+.2f} % members {family.get('members') if family else members} beside {beside} right {sorted(allowed - SCALE)} got {[(e['name'], round(e['confidence'], 2)) for e in d['effects']]}", flush=True)
    print(json.dumps(dict(cases=total, ok=good)))


main()

#!/usr/bin/env python3
"""Diagnoses of recorded cells whose arms log drive currents (or torques) and a raw wrist wrench, by another engine (MuJoCo) and friction law (Maxwell slip) than the tool's.

    PYTHON tests/studies/cell_arms.py IDC OUT [--cases 12] [--only N ..] [--jobs 2] [--again] [--write docs/evidence/CELL_ARMS.md] [--note TEXT]

PYTHON has what docs/evidence/peers/requirements.txt names: numpy, scipy, mujoco, numba. Makes the cells in OUT/cases with their sealed truths in OUT/truth, has IDC diagnose each into OUT/answers, on one
processor each, and goes on where it was stopped. `cell_arms/` is the generator: each cell drawn by its number; of a dozen four have an effect of the arm, three of the wrench sensor or its tool, two of the
part, two of the device, one none. Named is a case whose first effect is the true one, of the same joint or channel, with no other above a confidence of 0.5. `--check` recomputes torques, wrench and energy of
a cell without an effect by other means.
"""
import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from arms.scores import key  # noqa: E402

HERE = str(pathlib.Path(__file__).resolve().parent)
MAKE = "import sys; sys.path.insert(0, sys.argv[1]); from cell_arms.case import make; make(int(sys.argv[2]), sys.argv[3], sys.argv[4])"
LIKELY = 0.5


def run(idc, out, number, longest):
    """Makes and diagnoses one cell; what is there already stays."""
    case = f"case-{number:02}"
    folder, answer = out / "cases" / case, out / "answers" / case
    one = {**os.environ, "RAYON_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    if not (out / "truth" / f"{case}.json").is_file():
        subprocess.run([sys.executable, "-c", MAKE, HERE, str(number), str(out), idc], check=True, env=one, stdout=sys.stderr)
    if (answer / "cost.json").is_file():
        return
    began = time.monotonic()
    answer.mkdir(parents=True, exist_ok=True)
    with open(answer / "error.txt", "w+") as messages:
        words = [idc, "diagnose", folder, "--scenario", folder / "cell.toml", "--out", answer, "--force", "--quiet"]
        child = subprocess.Popen(words, env=one, stdout=subprocess.DEVNULL, stderr=messages, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (longest, longest)))
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode == 0:
        (answer / "error.txt").unlink()
    # Seconds of the processor: the wall's are those of whatever else runs.
    (answer / "cost.json").write_text(json.dumps({"processor_s": used.ru_utime + used.ru_stime, "wall_s": time.monotonic() - began, "exit": child.returncode}))
    for name in ("comparison.parquet", "balance.parquet", "diagnosis.rrd", "report.html"):
        (answer / name).unlink(missing_ok=True)
    print(f"{case} {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)


def scored(out, number):
    """One case: truth and answer by names with places, confidences, sizes and intervals."""
    case = f"case-{number:02}"
    truth = json.loads((out / "truth" / f"{case}.json").read_text())
    want = truth["effects"][0] if truth["effects"] else None
    r = {"case": case, "kind": truth["kind"], "sigma": truth["sigma"], "largest_in": truth["largest_in"], "want": key(want) if want else "nothing", "subsystem": want["subsystem"] if want else "-", "answer": None,
         "named": False, "false_and_sure": [], "sized": None, "covered": None, "seconds": None, "error": ""}
    cost = out / "answers" / case / "cost.json"
    r["seconds"] = json.loads(cost.read_text())["processor_s"] if cost.is_file() else None
    try:
        answer = json.loads((out / "answers" / case / "diagnosis.json").read_text())
    except (OSError, ValueError) as e:
        file = out / "answers" / case / "error.txt"
        return {**r, "error": (file.read_text() if file.is_file() else str(e)).strip()[:300]}
    effects = answer["effects"]
    r["verdict"] = answer["verdict"]
    r["answer"] = [(key(e), e["confidence"]) for e in effects]
    likely = [name for name, confidence in r["answer"] if confidence > LIKELY]
    r["false_and_sure"] = [name for name, confidence in r["answer"] if confidence > 0.9 and name != r["want"]]
    if not want:
        r["named"] = not likely and answer["verdict"] == "nothing_missing"
        return r
    r["named"] = bool(effects) and r["answer"][0][0] == r["want"] and set(likely) <= {r["want"]}
    own = next((e for e in effects if key(e) == r["want"]), None)
    if own:
        given = {k: own["parameters"].get(k) or {} for k in want["tolerance"]}
        true = want["parameters"]
        r["sized"] = [g.get("value") is not None and abs(g["value"] - true[k]) <= want["tolerance"][k] for k, g in given.items()]
        r["covered"] = [g.get("low") is not None and g.get("high") is not None and g["low"] <= true[k] <= g["high"] for k, g in given.items()]
    return r


def row(r):
    answer = "no answer: " + r["error"][:80].replace("\n", " ").replace("|", "/") if r["answer"] is None else ", ".join(f"{name} {confidence:.2f}" for name, confidence in r["answer"]) or "nothing"
    of = lambda flags: "-" if flags is None else f"{sum(flags)} of {len(flags)}"  # noqa: E731
    seconds = "-" if r["seconds"] is None else f"{r['seconds']:.0f}"
    return f"| {r['case']} | {r['kind']} | {r['want']} | {r['sigma']:.1f} | {r['largest_in'] or '-'} | {answer} | {'yes' if r['named'] else 'no'} | {of(r['sized'])} | {of(r['covered'])} | {seconds} |"


def table(cases, note):
    named = sum(r["named"] for r in cases)
    sure = [f"{r['case']}: {', '.join(r['false_and_sure'])}" for r in cases if r["false_and_sure"]]
    lines = ["# Recorded cells with drive currents and a raw wrench sensor", "",
             "Written by `tests/studies/cell_arms.py`. Six-axis arms with a pneumatic constant-force device behind a wrench sensor, riding a straight edge with a burr-free or burred part: MuJoCo for arm and slide,",
             "own equations of air and contact, Maxwell slip for friction of drives and seals. One effect in each case, or none; sizes from 3 standard deviations up (largest RMS of what it changes in one channel",
             "and recording, away from the slide's stops). Named: the first effect is the true one, of the same joint or channel, with nothing else above a confidence of 0.5.", "",
             f"Named {named} of {len(cases)}; another name above 0.9 in {len(sure)}{': ' + '; '.join(sure) if sure else ''}.", "",
             "| case | arm | effect | standard deviations | largest in | answer | named | parameters within tolerance | intervals that hold the truth | processor s |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    return "\n".join([*lines, *map(row, cases), *(["", note] if note else [])]) + "\n"


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("idc")
    ap.add_argument("out", type=pathlib.Path)
    ap.add_argument("--cases", type=int, default=12)
    ap.add_argument("--only", type=int, nargs="*")
    ap.add_argument("--jobs", type=int, default=2)
    ap.add_argument("--longest", type=int, default=900, help="seconds of processor after which a diagnosis is stopped, and is one without an answer")
    ap.add_argument("--again", action="store_true", help="diagnose anew what --only names, or all")
    ap.add_argument("--check", action="store_true", help="check the generator on a cell without an effect, and nothing else")
    ap.add_argument("--write", type=pathlib.Path, help="Markdown file for the table; its JSON is beside it")
    ap.add_argument("--note", default="")
    a = ap.parse_args()
    if a.check:
        from cell_arms.check import check
        sys.exit(0 if check(a.only[0] if a.only else 0) else 1)
    idc = shutil.which(a.idc) or a.idc
    numbers = a.only if a.only is not None else list(range(a.cases))
    if a.again:
        for number in numbers:
            shutil.rmtree(a.out / "answers" / f"case-{number:02}", ignore_errors=True)
    with ThreadPoolExecutor(a.jobs) as pool:
        list(pool.map(lambda number: run(idc, a.out, number, a.longest), numbers))
    cases = [scored(a.out, number) for number in numbers]
    text = table(cases, a.note)
    print(text)
    if a.write:
        a.write.write_text(text)
        a.write.with_suffix(".json").write_text(json.dumps(cases, indent=1))


if __name__ == "__main__":
    main()

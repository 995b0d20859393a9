#!/usr/bin/env python3
"""How sure diagnoses of recorded arms are, against how often they are right: arms of our own generator, by another engine (MuJoCo) and friction law (Maxwell slip) than the tool's.

    PYTHON tests/studies/recorded_arms.py IDC OUT [--cases 200] [--only 3 17] [--jobs 2] [--write docs/evidence/RECORDED_ARMS.md] [--note TEXT]

PYTHON has what docs/evidence/peers/requirements.txt names: numpy, scipy, mujoco, numba. Makes the arms in OUT/cases with their sealed truths in OUT/truth, has IDC diagnose each into OUT/answers, on one processor
each, and goes on where it was stopped. `arms/` is the generator: each arm drawn by its number, of 5 to 8 joints, with one cause over the vocabulary, none, or a law without a name.
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
from arms import scores  # noqa: E402

MAKE = "import sys; sys.path.insert(0, sys.argv[1]); from arms.case import make; make(int(sys.argv[2]), sys.argv[3])"


def run(idc, out, number, longest):
    """Makes and diagnoses one arm; what is there already stays."""
    case = f"case-{number:03}"
    folder, answer = out / "cases" / case, out / "answers" / case
    one = {**os.environ, "RAYON_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    if not (out / "truth" / f"{case}.json").is_file():
        subprocess.run([sys.executable, "-c", MAKE, str(pathlib.Path(__file__).resolve().parent), str(number), str(out)], check=True, env=one)
    if (answer / "cost.json").is_file():
        return
    begin = time.monotonic()
    answer.mkdir(parents=True, exist_ok=True)
    with open(answer / "error.txt", "w+") as said:
        child = subprocess.Popen([idc, "diagnose", folder, "--out", answer, "--force", "--quiet"], env=one, stdout=subprocess.DEVNULL, stderr=said, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (longest, longest)))
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode == 0:
        (answer / "error.txt").unlink()
    # Seconds of the processor: the wall's are those of whatever else runs.
    (answer / "cost.json").write_text(json.dumps({"processor_s": used.ru_utime + used.ru_stime, "wall_s": time.monotonic() - begin, "exit": child.returncode}))
    for name in ("comparison.parquet", "balance.parquet", "diagnosis.rrd", "report.html"):
        (answer / name).unlink(missing_ok=True)
    print(f"{case} {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("idc")
    ap.add_argument("out", type=pathlib.Path)
    ap.add_argument("--cases", type=int, default=200)
    ap.add_argument("--only", type=int, nargs="*")
    ap.add_argument("--jobs", type=int, default=2)
    ap.add_argument("--longest", type=int, default=120, help="seconds of processor after which a case is stopped, and is one without an answer")
    ap.add_argument("--again", action="store_true", help="diagnose those in --only anew")
    ap.add_argument("--write", type=pathlib.Path, help="Markdown file for the tables; its JSON stands beside it")
    ap.add_argument("--note", default="")
    a = ap.parse_args()
    numbers = a.only if a.only is not None else range(a.cases)
    if a.again:
        for number in numbers:
            shutil.rmtree(a.out / "answers" / f"case-{number:03}", ignore_errors=True)
    with ThreadPoolExecutor(a.jobs) as pool:
        list(pool.map(lambda number: run(a.idc, a.out, number, a.longest), numbers))
    cases = [scores.judged(a.out, number) for number in numbers]
    for case in cases:
        print(scores.line(case))
    print()
    text = scores.tables(cases, a.longest, a.note)
    print(text)
    if a.write:
        a.write.write_text(text)
        a.write.with_suffix(".json").write_text(json.dumps({"summary": scores.summary(cases), "cases": cases}, indent=1))


if __name__ == "__main__":
    main()

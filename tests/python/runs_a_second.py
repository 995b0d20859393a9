"""Processor time of runs of one loaded scenario by `set=`, and by path, beside that of the same points by `idc.vary` and by the program's `idc vary --jobs 1`.

    python tests/python/runs_a_second.py [NUMBER OF RUNS]
"""

import os
import subprocess
import sys
import tempfile
import time

import idc

SCENARIO = "scenarios/plate_edge.toml"
count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
forces = [100.0 + 0.5 * (run + 1) for run in range(count)]


def seconds(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


scenario = idc.load(SCENARIO)
loaded = seconds(lambda: [idc.run(scenario, set={"process.force_n": force}).metrics for force in forces])
by_path = seconds(lambda: [idc.run(SCENARIO, set={"process.force_n": force}).metrics for force in forces])
swept = seconds(lambda: idc.vary(scenario, {"process.force_n": forces}, jobs=1))
print(f"{count} runs: loaded {loaded:.2f} s, by path {by_path:.2f} s, idc.vary {swept:.2f} s")
print(f"loaded {100 * (loaded / swept - 1):+.1f} % of idc.vary, by path {(by_path - loaded) / count:+.4f} s a run")
program = os.environ.get("IDC")
if program:
    with tempfile.TemporaryDirectory() as folder:
        before = os.times()
        points = ",".join(map(str, forces))
        subprocess.run(
            [program, "vary", SCENARIO, f"--set=process.force_n={points}", "--jobs", "1", "--quiet", "--out", f"{folder}/out"], check=True
        )
        after = os.times()
        own = after.children_user + after.children_system - before.children_user - before.children_system
    print(f"the program {own:.2f} s: loaded {100 * (loaded / own - 1):+.1f} %")

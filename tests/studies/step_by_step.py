"""Peak of the contact force at random contact stiffnesses and steps, each beside the run at a tenth of its step: within 5 %, or refused.

    python3 tests/studies/step_by_step.py [--scenario FILE] [--count 30] [--seed 1] [--idc target/release/idc]

Prints a line a draw and what came of all; exit code 1 if any departs by more. Takes some minutes: the fine runs are long.
"""

import argparse
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PEAKS = ("force_peak_approach_n", "force_peak_engage_n")


def run(idc, scenario, step, stiffness, folder):
    """The peak [N], or the message of a refusal."""
    settings = [f"simulation.step_ms={step:.6g}", f"contact.stiffness_n_per_m={stiffness:.6g}", "process.settle_time_s=0.05"]
    command = [idc, "run", scenario, "--out", folder, "--force", "--no-recording", "--json"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 2:
        return json.loads(done.stdout or done.stderr)["error"]["message"]
    summary = json.loads(done.stdout)["summary"]
    return max(summary[key] for key in PEAKS if summary[key] is not None)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--scenario", default=str(PROJECT / "scenarios/plate_edge_ideal.toml"))
    arguments.add_argument("--count", type=int, default=30)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--idc", default=str(PROJECT / "target/release/idc"))
    given = arguments.parse_args()
    draws, departed, refused = random.Random(given.seed), [], 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(1, given.count + 1):
            stiffness = 10 ** draws.uniform(5.0, 9.0)
            step = 10 ** draws.uniform(-1.0, 1.0)
            coarse = run(given.idc, given.scenario, step, stiffness, folder)
            if isinstance(coarse, str):
                refused += 1
                print(f"{number:3}  {stiffness:10.3g} N/m  {step:7.3f} ms  refused: {coarse[:120]}", flush=True)
                continue
            fine = run(given.idc, given.scenario, step / 10, stiffness, folder)
            off = math.inf if isinstance(fine, str) else 100 * (coarse / fine - 1)
            if abs(off) > 5:
                departed.append(number)
            print(f"{number:3}  {stiffness:10.3g} N/m  {step:7.3f} ms  {coarse:8.1f} N  at a tenth {fine:8.1f} N  {off:+.2f} %", flush=True)
    print(f"{given.count} draws: {given.count - len(departed) - refused} within 5 %, {refused} refused, {len(departed)} beyond: {departed}")
    return 1 if departed else 0


if __name__ == "__main__":
    sys.exit(main())

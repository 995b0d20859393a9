"""What users write: checked by mypy --strict and pyright, and run."""

import idc

run = idc.run("scenarios/paper_step.toml", set={"bench.duration_s": 2.0}, effects=["stribeck_friction"])
stroke: float | None = run.metrics["stroke_max_mm"]
longest: float = run.samples.to_pandas()["time_s"].max()
scenario = idc.load("scenarios/paper_step.toml")
sweep = idc.vary(scenario, {"bench.duration_s": (1.5, 2.0)}, n=3)
assert len(sweep.to_pandas()) == 3
print(stroke, longest)

bench = idc.Bench(scenario)
seen = bench.reset(seed=1)
for _ in range(10):
    seen = bench.step(1.0e5 - 10.0 * seen.measured_force_n)
print(seen.contact_force_n)

try:
    idc.run({"kind": "bench", "title": "mine", "bench": {"duration_z": 1.0}})
except idc.Error as error:
    print(error.file, error.key, error.line, error.message)

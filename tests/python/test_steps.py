"""A cell and a bench step by step: the set pressures of a run, given again, give its samples again."""

import math

import pyarrow
import pytest

import idc

def replayed(steps, run, count):
    """Largest differences between a run and what is seen while its set pressures are given again [N, m]."""
    samples = pyarrow.table(run.samples)
    pressure, force, stroke, time = (samples[name].to_pylist() for name in ("set_pressure_pa", "contact_force_n", "stroke_m", "time_s"))
    seen = steps.reset()
    first = 1 if time[0] == 0.0 else 0
    # The recording has the atmosphere added.
    atmosphere = pressure[0] - seen.set_pressure_gauge_pa
    worst = [0.0, 0.0]
    for at in range(first, first + count):
        seen = steps.step(pressure[at] - atmosphere)
        assert math.isclose(seen.time_s, time[at], abs_tol=1e-9)
        worst = [max(worst[0], abs(seen.contact_force_n - force[at])), max(worst[1], abs(seen.stroke_m - stroke[at]))]
    return worst


def test_a_bench_under_the_pressures_of_its_run_gives_its_samples():
    path = "scenarios/paper_step.toml"
    force, stroke = replayed(idc.Bench(path), idc.run(path), 4000)
    assert force < 1e-6 and stroke < 1e-12


def test_a_cell_under_the_pressures_of_its_run_gives_its_samples():
    path = "scenarios/plate_edge_ideal.toml"
    force, stroke = replayed(idc.Cell(path), idc.run(path), 4000)
    assert force < 1e-3 and stroke < 1e-9


def test_a_controller_of_ones_own_keeps_its_force_and_ends_as_a_run():
    bench = idc.Bench("scenarios/paper_step.toml", set={"bench.duration_s": 12})
    seen, pressure = bench.reset(seed=1), 1.0e5
    while not bench.done:
        pressure = max(0.0, pressure + 0.3 * (200.0 - seen.measured_force_n))
        seen = bench.step(pressure)
    assert abs(seen.contact_force_n - 200.0) < 1.0
    done, total = bench.steps
    assert done == total
    with pytest.raises(idc.Error, match="the job is done"):
        bench.step(pressure)
    run = bench.finish()
    assert len(run.samples) == total + 1
    with pytest.raises(idc.Error, match="reset"):
        bench.observe()
    assert bench.reset().time_s == 0.0


def test_a_seed_is_that_of_the_noise():
    bench = idc.Bench("scenarios/paper_stairstep_sensed.toml")

    def course(seed):
        bench.reset(seed=seed)
        return [bench.step(1.0e5).values() for _ in range(200)]

    measured = idc.Observation.names.index("measured_force_n")
    first, again, other = ([row[measured] for row in course(seed)] for seed in (1, 1, 2))
    assert first == again != other


def test_what_is_no_set_pressure_or_no_bench_is_refused():
    bench = idc.Bench("scenarios/paper_step.toml")
    bench.reset()
    with pytest.raises(idc.Error, match="finite"):
        bench.step(math.nan)
    with pytest.raises(idc.Error, match="expected a cell; idc.Bench takes it") as refused:
        idc.Cell("scenarios/paper_step.toml")
    assert refused.value.key == "kind"

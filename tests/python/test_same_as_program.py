"""What the package gives is what the program writes: the same samples, bit by bit, and the same numbers, to the last digit of a number that was read back from JSON."""

import json
import math
from pathlib import Path

import pyarrow
import pyarrow.parquet
import pytest

import idc

CELL = "scenarios/plate_edge_ideal.toml"
BENCH = "scenarios/paper_step.toml"


def near(own, other):
    """Whether two lists are the same but for a number's last digit."""

    def same(one, another):
        numbers = isinstance(one, float) and isinstance(another, float)
        return math.isclose(one, another, rel_tol=1e-14) if numbers else one == another

    return all(same(*pair) for pair in zip(own, other, strict=True))


@pytest.mark.parametrize(
    ("scenario", "settings", "effects"),
    [
        (CELL, {}, []),
        (CELL, {"process.force_n": 120}, ["stribeck_friction"]),
        (BENCH, {"bench.duration_s": 3.0, "simulation.seed": 7}, []),
    ],
)
def test_a_run_has_the_numbers_and_samples_of_the_program(program, tmp_path, scenario, settings, effects):
    flags = [f"--set={key}={value}" for key, value in settings.items()] + [f"--with={name}" for name in effects]
    program("run", scenario, *flags, "--out", tmp_path / "run", "--quiet", "--no-recording")
    summary = json.loads((tmp_path / "run/summary.json").read_text())["summary"]
    run = idc.run(scenario, set=settings, effects=effects)
    numbers = {key: value for key, value in summary.items() if isinstance(value, (int, float))}
    shared = run.metrics.keys() & numbers.keys()
    assert len(shared) > 10
    # The time that it took differs from run to run.
    assert {key: run.metrics[key] for key in shared if run.metrics[key] is not None} == {
        key: numbers[key] for key in shared if run.metrics[key] is not None
    }
    samples = pyarrow.table(run.samples)
    written = pyarrow.parquet.read_table(tmp_path / "run/samples.parquet")
    assert samples.column_names == written.column_names
    for name in samples.column_names:
        if name != "phase":
            assert samples[name].to_pylist() == written[name].to_pylist(), name


def test_out_writes_what_the_program_writes_and_nothing_is_written_without(program, tmp_path, monkeypatch):
    settings = {"bench.duration_s": 2.0}
    program("run", BENCH, "--set=bench.duration_s=2", "--out", tmp_path / "own", "--mcap", "--quiet")
    idc.run(BENCH, set=settings, out=tmp_path / "package", mcap=True)
    names = sorted(path.name for path in (tmp_path / "own").iterdir())
    assert sorted(path.name for path in (tmp_path / "package").iterdir()) == names
    for name in ("samples.parquet", "varied.toml", "recording.mcap"):
        assert (tmp_path / "own" / name).read_bytes() == (tmp_path / "package" / name).read_bytes(), name
    with pytest.raises(idc.Error, match="holds results already"):
        idc.run(BENCH, set=settings, out=tmp_path / "package")
    scenario = idc.load(Path(BENCH).resolve())
    empty = tmp_path / "empty"
    empty.mkdir()
    monkeypatch.chdir(empty)
    done = idc.run(scenario, set=settings)
    assert "<html" in done.page()
    assert list(empty.iterdir()) == []


def test_a_sweep_has_the_numbers_of_the_program(program, tmp_path):
    program("vary", BENCH, "--set=bench.duration_s=1.5,2.0", "--set=simulation.seed=1..2", "--out", tmp_path / "vary", "--quiet")
    written = pyarrow.parquet.read_table(tmp_path / "vary/runs.parquet").drop_columns(["id"])
    sweep = idc.vary(BENCH, {"bench.duration_s": [1.5, 2.0], "simulation.seed": range(1, 3)})
    table = pyarrow.table(sweep)
    assert table.column_names == written.column_names
    for name in table.column_names:
        # The program's tasks hand their numbers over as JSON.
        assert near(table[name].to_pylist(), written[name].to_pylist()), name
    document = json.loads((tmp_path / "vary/vary.json").read_text())
    for own, other in zip(sweep.document["metrics"], document["metrics"], strict=True):
        assert own["name"] == other["name"]
        assert [q[1] for q in own["quantiles"]] == pytest.approx([q[1] for q in other["quantiles"]], rel=1e-12)


def test_a_dict_is_the_scenario_of_its_file():
    scenario = idc.load(BENCH)
    tables = scenario.to_dict()
    tables["bench"]["duration_s"] = 2.0
    made = idc.load(tables, folder="scenarios")
    assert made.kind == "bench"
    assert idc.run(made).metrics == idc.run(BENCH, set={"bench.duration_s": 2.0}).metrics


def test_a_diagnosis_finds_what_the_program_finds_and_its_model_predicts(program, tmp_path):
    case = "assets/proof/cases/case-03"
    program("diagnose", case, "--effort", 3000, "--out", tmp_path / "found", "--quiet")
    written = json.loads((tmp_path / "found/diagnosis.json").read_text())
    found = idc.diagnose(case, effort=3000)
    assert [effect.name for effect in found.effects] == [effect["name"] for effect in written["effects"]]
    assert found.probabilities == {effect["name"]: effect["confidence"] for effect in written["effects"]}
    delay = found.intervals["transport_delay"]["delay_s"]
    assert delay.low < delay.value < delay.high
    assert found.statements[0] == written["account"]["headline"]
    assert found.improved.text == (tmp_path / "found/improved.toml").read_text()
    assert "<html" in found.page()
    recording = min(Path(case).glob("*.csv"))
    program("predict", tmp_path / "found/improved.toml", recording, "--out", tmp_path / "p.csv", "--quiet")
    predicted = pyarrow.table(idc.predict(found.improved, recording))
    header, *rows = (tmp_path / "p.csv").read_text().splitlines()
    assert predicted.column_names == header.split(",")
    assert len(rows) == len(predicted)


def test_results_are_compared(program, tmp_path):
    for name, end in (("a", 1.5), ("b", 2.0)):
        idc.run(BENCH, set={"bench.duration_s": end}, out=tmp_path / name)
    printed = json.loads(program("compare", tmp_path / "a", tmp_path / "b", "--json").stdout)
    compared = idc.compare([tmp_path / "a", tmp_path / "b"])
    assert compared.document["numbers"] == printed["numbers"]
    runs = {name: idc.run(BENCH, set={"bench.duration_s": end}) for name, end in (("a", 1.5), ("b", 2.0))}
    of_runs = idc.compare(runs)
    assert of_runs.document["folders"] == ["a", "b"]
    assert of_runs.numbers.keys() == compared.numbers.keys()
    for key, values in of_runs.numbers.items():
        # Of folders they are read back from summary.json.
        assert near(values, compared.numbers[key]), key
    with pytest.raises(idc.Error, match="of one kind"):
        idc.compare([runs["a"], tmp_path / "a"])


def test_check_says_what_the_program_says(program):
    printed = json.loads(program("check", BENCH, "--json").stdout)
    assert idc.check(BENCH) == printed
    assert idc.check(idc.load(BENCH)) == printed

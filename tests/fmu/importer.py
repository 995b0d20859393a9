"""Units that `idc export fmu` writes, validated and simulated by FMPy, against `idc run` of the same benches.

    build/references/fmpy/bin/python tests/fmu/importer.py target/release/idc LIBRARY build/fmu

Prints each figure beside its bound; ends with 1 where one is missed.
"""

import csv
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

PROGRAM, LIBRARY, FOLDER = (Path(argument) for argument in sys.argv[1:4])
PROJECT = Path(__file__).resolve().parents[2]

FOUND = """
[[effect]]
name = "stribeck_friction"
coulomb_force_n = 9
static_force_n = 15
stribeck_velocity_m_per_s = 0.008
viscous_coefficient_n_s_per_m = 60
presliding_displacement_m = 3e-5

[[effect]]
name = "cross_piston_leakage"
orifice_area_m2 = 4e-8
"""

# What is written of a bench beside the project's scenario: other words in place of words, more at its end.
MOVED = [("force_n = 290", "set_pressure_bar_gauge = 1.8"), ("start_s = 4", "start_s = 2"), ("duration_s = 12", "duration_s = 5")]
BENCHES = {
    "step": ("paper_step", [], ""),
    "stairs": ("paper_stairstep", [], ""),
    "moved_surface": ("hand_push", MOVED, ""),
    "retract": ("retract", [], ""),
    "found_step": ("paper_step", [], FOUND),
    "found_moved_surface": ("hand_push", MOVED, FOUND),
}
SIGNALS = ["contact_force_n", "stroke_m"]
failed = []


def within(what, value, bound):
    passed = value <= bound
    print(f"{what}: {value:.2e}, at most {bound:.0e}{'' if passed else '  MISSED'}", flush=True)
    if not passed:
        failed.append(what)


def idc(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet", "--force"], check=True)


def scenario_of(name, device=""):
    source, edits, more = BENCHES[name]
    text = (PROJECT / f"scenarios/{source}.toml").read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    text = text.replace("../models", str(PROJECT / "models"))
    path = FOLDER / f"{name}.toml"
    path.write_text(text + more)
    return path


def run_of(path, *settings):
    """The columns of a run, and the program's own record of the inputs."""
    out = FOLDER / "runs" / path.stem
    idc("run", path, "--out", out, "--no-recording", *settings)
    import pyarrow.parquet

    columns = pyarrow.parquet.read_table(next(out.rglob("samples.parquet"))).to_pydict()
    return {name: np.array(values, dtype=float) for name, values in columns.items() if name != "phase"}


def inputs_of(name, run):
    """Inputs at each step of a bench, of its commands as it has recorded them and of the motion that its file states."""
    time = run["time_s"]
    # What a step is commanded stands in the sample at its end.
    atmosphere = 101325.0
    pressure = np.append(run["set_pressure_pa"][1:], run["set_pressure_pa"][-1]) - atmosphere
    extends = np.append(run["valve_extends_1"][1:], run["valve_extends_1"][-1]) > 0.5
    columns = [("time", time), ("set_pressure_gauge_pa", pressure), ("valve_extends", extends)]
    if "moved" in name:
        rate, since = 2 * math.pi * 0.5, time - 2.0
        moving = (since >= 0).astype(float)
        columns += [
            ("surface_position_m", 0.025 - moving * 0.01 * (1 - np.cos(rate * since))),
            ("surface_speed_m_per_s", -moving * 0.01 * rate * np.sin(rate * since)),
            ("surface_acceleration_m_per_s2", -moving * 0.01 * rate**2 * np.cos(rate * since)),
        ]
    kinds = [(key, np.bool_ if key == "valve_extends" else np.float64) for key, _ in columns]
    return np.array(list(zip(*(values for _, values in columns))), dtype=kinds)


def steps_of(unit, signals, step):
    """Outputs at each communication point, and the unit stepped by hand as importers do that set inputs as they are at each point."""
    duration = signals["time"][-1]
    names = signals.dtype.names[1:]
    every = round(step / (signals["time"][1] - signals["time"][0]))
    rows = signals[::every]
    found = [outputs(unit)]
    for index in range(round(duration / step)):
        give(unit, names, rows[index])
        advance(unit, index * step, step)
        found.append(outputs(unit))
    return np.array(found)


def open_unit(file):
    description = read_model_description(file)
    folder = extract(file)
    version = description.fmiVersion[0]
    kind = FMU2Slave if version == "2" else FMU3Slave
    token = description.guid if version == "2" else description.instantiationToken
    unit = kind(guid=token, unzipDirectory=folder, modelIdentifier=description.coSimulation.modelIdentifier, instanceName="unit")
    unit.instantiate()
    unit.references = {variable.name: variable.valueReference for variable in description.modelVariables}
    unit.version = version
    return unit


def give(unit, names, row):
    for name in names:
        reference, real = [unit.references[name]], unit.setReal if unit.version == "2" else unit.setFloat64
        if name == "valve_extends":
            unit.setBoolean(reference, [bool(row[name])])
        else:
            real(reference, [float(row[name])])


def advance(unit, time, step):
    unit.doStep(currentCommunicationPoint=time, communicationStepSize=step)


def outputs(unit, names=tuple(SIGNALS)):
    references = [unit.references[name] for name in names]
    return unit.getReal(references) if unit.version == "2" else unit.getFloat64(references)


def started(unit, names, row):
    if unit.version == "2":
        unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    give(unit, names, row)
    unit.exitInitializationMode()
    return unit


def differences(what, run, time, values, bound):
    """Largest difference of each signal over its largest value."""
    step = run["time_s"][1] - run["time_s"][0]
    rows = np.rint(np.asarray(time) / step).astype(int)
    for signal, own in zip(SIGNALS, np.transpose(values)):
        expected = run[signal][rows]
        largest = np.max(np.abs(run[signal]))
        if largest == 0.0:
            assert np.all(own == 0.0), (what, signal)
            continue
        within(f"{what}, {signal}", np.max(np.abs(own - expected)) / largest, bound)


def check_benches(version):
    for name in BENCHES:
        path = scenario_of(name)
        file = FOLDER / f"{name}_{version}.fmu"
        idc("export", "fmu", path, "--fmi", version, "--library", LIBRARY, "--out", file)
        problems = validate_fmu(str(file))
        for problem in problems:
            print(f"{file.name}: {problem}")
        within(f"FMI {version}, {name}: problems", len(problems), 0)
        run = run_of(path)
        signals = inputs_of(name, run)
        for step, bound in [(1e-3, 1e-6), (1e-2, 1e-3)]:
            unit = started(open_unit(str(file)), signals.dtype.names[1:], signals[0])
            values = steps_of(unit, signals, step)
            unit.terminate()
            unit.freeInstance()
            time = np.arange(len(values)) * step
            differences(f"FMI {version}, {name}, {1e3 * step:g} ms", run, time, values, bound)
        if name in ("step", "found_moved_surface"):
            # FMPy's own loop, which makes points of its own where inputs change.
            result = simulate_fmu(str(file), stop_time=signals["time"][-1], output_interval=1e-3, input=signals, output=SIGNALS)
            values = np.transpose([result[signal] for signal in SIGNALS])
            on_grid = np.abs(result["time"] * 1e3 - np.rint(result["time"] * 1e3)) < 1e-6
            differences(f"FMI {version}, {name}, simulate_fmu", run, result["time"][on_grid], values[on_grid], 1e-6)


def check_state(version):
    """A state that is saved, left, and restored."""
    name = "found_moved_surface"
    run = run_of(scenario_of(name))
    signals = inputs_of(name, run)
    unit = started(open_unit(str(FOLDER / f"{name}_{version}.fmu")), signals.dtype.names[1:], signals[0])

    def on(first, count):
        found = []
        for index in range(first, first + count):
            give(unit, signals.dtype.names[1:], signals[index])
            advance(unit, index * 1e-3, 1e-3)
            found.append(outputs(unit))
        return np.array(found)

    on(0, 2200)
    state = unit.getFMUstate() if version == "2" else unit.getFMUState()
    once = on(2200, 500)
    restore, free = (unit.setFMUstate, unit.freeFMUstate) if version == "2" else (unit.setFMUState, unit.freeFMUState)
    restore(state)
    again = on(2200, 500)
    free(state)
    unit.freeInstance()
    assert np.ptp(once[:, 0]) > 1.0
    within(f"FMI {version}, saved state: values that differ in a bit", np.count_nonzero(once.view(np.int64) != again.view(np.int64)), 0)


def check_tuned(version):
    """A number by start value, against the same number by the scenario's key."""
    path = scenario_of("step")
    run = run_of(path, "--set", "device.override.regulator_time_constant_s=0.3")
    signals = inputs_of("step", run)
    file = str(FOLDER / f"step_{version}.fmu")
    tuned = {"regulator.time_constant_s": 0.3}
    result = simulate_fmu(file, stop_time=signals["time"][-1], output_interval=1e-3, input=signals, output=SIGNALS, start_values=tuned)
    values = np.transpose([result[signal] for signal in SIGNALS])
    on_grid = np.abs(result["time"] * 1e3 - np.rint(result["time"] * 1e3)) < 1e-6
    differences(f"FMI {version}, tuned", run, result["time"][on_grid], values[on_grid], 1e-6)
    plain = run_of(path)
    assert np.max(np.abs(plain["contact_force_n"] - run["contact_force_n"])) > 10.0


def check_rig():
    """A unit as the rig of `idc investigate`, by assets/rig_programs/co_simulation_unit.py: what it records is what the unit's file predicts, but for the noise of the sensors, and not what another does."""
    case = PROJECT / "assets/proof/cases/case-03"
    nominal = case / "rig.toml"
    found, file = FOLDER / "rig.toml", FOLDER / "rig.fmu"
    found.write_text(nominal.read_text() + FOUND)
    idc("export", "fmu", found, "--library", LIBRARY, "--out", file)
    asked, recorded = FOLDER / "asked.csv", FOLDER / "recorded.csv"
    with open(case / "ride.csv", newline="") as ride, open(asked, "w", newline="") as rows:
        csv.writer(rows).writerows(row[:4] for row in csv.reader(ride))
    program = PROJECT / "assets/rig_programs/co_simulation_unit.py"
    subprocess.run([sys.executable, program, file, nominal, asked, recorded], check=True)

    def off(rig):
        arguments = [PROGRAM, "predict", rig, recorded, "--out", FOLDER / "predicted", "--json", "--force"]
        report = subprocess.run(arguments, check=True, capture_output=True, text=True).stdout
        return json.loads(report)["rms_in_standard_deviations_of_noise"]

    for column, rms in off(found).items():
        within(f"rig, {column}: standard deviations of noise but for 1", abs(rms - 1.0), 0.1)
    # Friction and a leak leave the regulator alone.
    within("rig, nominal file: columns that it predicts but for the regulator's", sum(rms < 1.5 for rms in off(nominal).values()) - 1, 0)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    check_rig()
    for version in ["2", "3"]:
        check_benches(version)
        check_state(version)
        check_tuned(version)
    if failed:
        sys.exit(f"missed: {', '.join(failed)}")


main()

"""Simulate a robot deburring cell with a pneumatic constant-force end effector, and find out why the real cell behaves otherwise.

Everything is done by the same functions as of the program `idc`, in this process. Units stand at the end of names: `force_mean_n` is in N.

>>> import idc
>>> run = idc.run("scenarios/paper_step.toml", set={"bench.duration_s": 2.0})
>>> "contact_force_n" in run.samples.columns
True

Bad input is an `idc.Error` with the file, the key and the line that it is about:

>>> idc.run("scenarios/paper_step.toml", set={"bench.duration_z": 2.0})
Traceback (most recent call last):
...
idc.Error: set bench.duration_z=2: scenarios/paper_step.toml: unknown key `bench.duration_z`; did you mean `bench.duration_s`?
"""

from idc._error import Error
from idc._finding import (
    Comparison,
    Diagnosis,
    Estimate,
    FoundEffect,
    Improved,
    Prediction,
    compare,
    diagnose,
    predict,
)
from idc._idc import Observation
from idc._run import Run, bench, check, run
from idc._scenario import Progress, Scenario, ScenarioLike, Settings, load
from idc._steps import Bench, Cell
from idc._sweep import Sweep, vary
from idc._table import Table

__all__ = [
    "Bench",
    "Cell",
    "Comparison",
    "Diagnosis",
    "Error",
    "Estimate",
    "FoundEffect",
    "Improved",
    "Observation",
    "Prediction",
    "Progress",
    "Run",
    "Scenario",
    "ScenarioLike",
    "Settings",
    "Sweep",
    "Table",
    "bench",
    "check",
    "compare",
    "diagnose",
    "load",
    "predict",
    "run",
    "vary",
]

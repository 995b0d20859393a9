"""Runs."""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from os import PathLike
from typing import Any

from idc import _idc
from idc._error import Error
from idc._scenario import Progress, ScenarioLike, Settings, edits, load, observer
from idc._table import Table


def framed(page: str) -> str:
    """A page within a notebook's cell: apart from it, with its own scripts."""
    return f'<iframe srcdoc="{html.escape(page)}" style="width:100%;height:70vh;border:0" sandbox="allow-scripts"></iframe>'


class Run:
    """A run that has ended, in memory."""

    __slots__ = ("_inner",)

    def __init__(self, inner: _idc.Run) -> None:
        self._inner = inner

    @property
    def metrics(self) -> dict[str, float | None]:
        """Its numbers by the names of docs/METRICS.md, units included (`force_mean_n` in N); None where the run does not determine one."""
        return self._inner.metrics

    @property
    def samples(self) -> Table:
        """Its recording: `time_s`, `phase`, and each signal in SI."""
        return Table(self._inner.samples())

    @property
    def stopped(self) -> str | None:
        """What stopped it before its end; None of a run that came to it."""
        return self._inner.stopped

    @property
    def outside(self) -> list[str]:
        """Results that lie outside the bounds that the scenario sets (`[expect]`), a sentence each."""
        return self._inner.outside

    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json holds: numbers, bounds, notes, and what it was made of."""
        document: dict[str, Any] = json.loads(self._inner.summary())
        return document

    def page(self) -> str:
        """Its page for a browser, with all charts: report.html."""
        return self._inner.page()

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        state = "stopped" if self.stopped else "ended"
        return f"<idc.Run that {state}, {sum(v is not None for v in self.metrics.values())} metrics>"


def run(
    scenario: ScenarioLike,
    *,
    set: Settings | None = None,
    effects: Sequence[str] = (),
    out: str | PathLike[str] | None = None,
    force: bool = False,
    recording: bool = True,
    mcap: bool = False,
    progress: Progress | None = None,
) -> Run:
    """Simulate a scenario: its recording and its numbers.

    scenario: a file, a dict, or what `load` gave.
    set: other values for keys by their dotted paths, in the units of their names.
    effects: physics to put in, by the names that `idc effects` lists; sizes as in "tool_runout:amplitude_mm=0.1".
    out: a folder for the files that `idc run` writes; nothing is written without.
    force: whether they take the place of old ones.
    recording: whether recording.rrd is among them.
    mcap: whether recording.mcap is: the samples as messages of ROS 2.
    progress: called with steps done and in all; or a bar of tqdm.

    >>> done = run("scenarios/paper_step.toml", set={"bench.duration_s": 2.0})
    >>> round(done.metrics["stroke_max_mm"])
    42
    """
    if isinstance(effects, str):
        effects = (effects,)
    folder = None if out is None else (out, force, recording, mcap)
    inner = _idc.run(load(scenario)._inner, edits(set), list(effects), folder, observer(progress))
    return Run(inner)


def bench(
    scenario: ScenarioLike,
    *,
    set: Settings | None = None,
    effects: Sequence[str] = (),
    out: str | PathLike[str] | None = None,
    force: bool = False,
    recording: bool = True,
    mcap: bool = False,
    progress: Progress | None = None,
) -> Run:
    """As `run`, of the device alone: the scenario of a cell is refused.

    >>> bench("scenarios/paper_step.toml", set={"bench.duration_s": 2.0}).stopped
    """
    loaded = load(scenario)
    if loaded.kind != "bench":
        raise Error(
            f"{loaded.path}: the scenario is a cell, expected a bench (kind = \"bench\"); idc.run takes both",
            str(loaded.path),
            "kind",
        )
    return run(loaded, set=set, effects=effects, out=out, force=force, recording=recording, mcap=mcap, progress=progress)


def check(scenario: ScenarioLike) -> dict[str, Any]:
    """What a file describes and what would be done with it: the document of `idc check --json`.

    scenario: a scenario as `run` takes it, or any file or folder that `idc check` explains.

    >>> check("scenarios/paper_step.toml")["numbers"]["step_s"]
    0.001
    """
    if isinstance(scenario, (str, PathLike)):
        text = _idc.check_file(scenario)
    else:
        text = _idc.check_scenario(load(scenario)._inner)
    document: dict[str, Any] = json.loads(text)
    return document

"""Sweeps."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

from idc import _idc
from idc._error import Error
from idc._run import framed
from idc._scenario import Progress, ScenarioLike, load, observer
from idc._table import Table

if TYPE_CHECKING:
    import pandas


class Sweep:
    """Many runs of a scenario with other values."""

    __slots__ = ("_inner",)

    def __init__(self, inner: _idc.Sweep) -> None:
        self._inner = inner

    @property
    def table(self) -> Table:
        """A row for each run: `run`, exit `code` and `reason`, the values of its keys, and its metrics."""
        return Table(self._inner.table())

    @property
    def document(self) -> dict[str, Any]:
        """What vary.json holds: quantiles of each number, and which key drives which."""
        document: dict[str, Any] = json.loads(self._inner.document())
        return document

    def to_pandas(self) -> pandas.DataFrame:
        """Its table as a data frame."""
        return self.table.to_pandas()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)

    def __len__(self) -> int:
        return len(self.table)

    def page(self) -> str:
        """Its page for a browser, with all charts: report.html."""
        return self._inner.page()

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        return f"<idc.Sweep of {len(self)} runs>"


def vary(
    scenario: ScenarioLike,
    values: Mapping[str, object],
    *,
    n: int | None = None,
    sampling: str | None = None,
    effects: Sequence[str] = (),
    seed: int = 1,
    jobs: int | None = None,
    out: str | PathLike[str] | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Sweep:
    """Run a scenario with many other values of its keys.

    scenario: a file, a dict, or what `load` gave.
    values: by dotted key, in its unit: a pair (low, high) for any number between, of a count each whole one; a list or a range for those in it.
    n: number of runs, as a Latin hypercube; without, every combination of the lists.
    sampling: "latin" or "random", with n.
    effects: physics that all runs have, as of `run`.
    seed: that of what is drawn.
    jobs: runs at a time; as many as there are processors if not given.
    out: a folder for runs.parquet, vary.json and report.html; nothing is written without.
    progress: called with runs done and in all; or a bar of tqdm.

    >>> sweep = vary("scenarios/paper_step.toml", {"bench.duration_s": [1.5, 2.0]})
    >>> len(sweep)
    2
    """
    if n is not None and n < 1:
        raise Error(f"vary: n is {n}, expected 1 or more runs")
    if n is None and sampling is not None:
        raise Error(f"vary: sampling is {sampling!r} without n, expected the number of runs as n")
    how = "grid" if n is None else f"{sampling or 'latin'}:{n}"
    if isinstance(effects, str):
        effects = (effects,)
    variables = [(key, _values(key, given)) for key, given in values.items()]
    folder = None if out is None else (out, force)
    points = (how, seed, jobs)
    return Sweep(_idc.vary(load(scenario)._inner, variables, list(effects), points, folder, observer(progress)))


def _values(key: str, given: object) -> list[str] | tuple[float, float]:
    expected = "expected a pair (low, high), or a list of values"
    if isinstance(given, range) and given.step == 1 and len(given) > 1:
        # Whole numbers, which the extension takes apart from other pairs.
        return given[0], given[-1]
    if isinstance(given, tuple):
        if len(given) != 2 or not all(isinstance(end, (int, float)) for end in given) or not given[0] < given[1]:
            raise Error(f"vary: {key} is {given!r}, {expected}; of a pair the first is the lower", key=key)
        return float(given[0]), float(given[1])
    if isinstance(given, (str, Mapping)) or not isinstance(given, Iterable):
        raise Error(f"vary: {key} is {given!r}, {expected}", key=key)
    texts = [_text(key, value) for value in given]
    if not texts:
        raise Error(f"vary: {key} has no value, {expected}", key=key)
    if len(set(texts)) < len(texts):
        raise Error(f"vary: {key} has a value twice, expected each once", key=key)
    return texts


def _text(key: str, value: object) -> str:
    item = getattr(value, "item", None)
    if item is not None:
        value = item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, PathLike)):
        return str(value)
    raise Error(f"vary: {key} has the value {value!r}, expected numbers, switches or texts", key=key)

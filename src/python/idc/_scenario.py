"""Scenarios as all functions take them."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Protocol, TypeAlias, runtime_checkable

from idc import _idc
from idc._error import Error

Settings: TypeAlias = Mapping[str, object]
"""Other values for keys of the scenario, by their dotted paths."""


@runtime_checkable
class Bar(Protocol):
    """A progress bar, such as `tqdm()` gives."""

    n: Any
    total: Any

    def update(self, n: Any = 1) -> Any: ...


Progress: TypeAlias = Callable[[int, int], object] | Bar
"""An observer of the progress: called with parts done and in all, or a bar such as `tqdm()`. An exception that it raises ends the work."""


class Scenario:
    """A scenario that was read and checked once, for any number of runs.

    `load` makes one of a file or of a dict.
    """

    __slots__ = ("_inner",)

    def __init__(self, inner: _idc.Scenario) -> None:
        self._inner = inner

    @property
    def path(self) -> Path:
        """Its file."""
        return Path(self._inner.path)

    @property
    def title(self) -> str:
        """Its name for people."""
        return self._inner.title

    @property
    def kind(self) -> Literal["cell", "bench"]:
        """What it describes: an arm that follows an edge, or the device alone."""
        return "bench" if self._inner.is_bench else "cell"

    @property
    def text(self) -> str:
        """It as a TOML file has it."""
        return self._inner.text

    def to_dict(self) -> dict[str, Any]:
        """Its tables and keys, in the units of their names."""
        return tomllib.loads(self.text)

    def __repr__(self) -> str:
        return f"<idc.Scenario of a {self.kind}: {self.title!r}, {self.path}>"


ScenarioLike: TypeAlias = str | PathLike[str] | Mapping[str, Any] | Scenario
"""A scenario: its file, its tables and keys as a dict, or one that was loaded."""


def load(scenario: ScenarioLike, *, folder: str | PathLike[str] = "") -> Scenario:
    """Read and check a scenario, for functions that take it in place of a path.

    scenario: its file, or its tables and keys as a dict, in the units of their names (`force_n` in N).
    folder: where the paths of a dict lead from; the current folder if not given.

    >>> scenario = load("scenarios/paper_step.toml")
    >>> scenario.kind
    'bench'
    """
    if isinstance(scenario, Scenario):
        return scenario
    if isinstance(scenario, Mapping):
        return Scenario(_idc.of_json(_json(scenario), folder))
    return Scenario(_idc.load(scenario))


def _plain(value: object) -> object:
    """A value of NumPy, or a path, as JSON has it."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, PathLike):
        return str(Path(value))
    for method in ("tolist", "isoformat"):
        convert = getattr(value, method, None)
        if convert is not None:
            return convert()
    raise TypeError(f"{type(value).__name__} is no value of a scenario")


def _json(value: object) -> str:
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as fault:
        raise Error(f"the scenario cannot be read: {fault}; expected numbers, texts, lists and dicts") from None


def edits(settings: Settings | None) -> list[_idc.SetKey]:
    """Settings as the extension takes them."""
    return [edit(key, value) for key, value in (settings or {}).items()]


def edit(key: str, value: object) -> _idc.SetKey:
    """One of them."""
    if isinstance(value, (bool, int, float, str)):
        return key, value, False
    if isinstance(value, PathLike):
        return key, str(Path(value)), False
    item = getattr(value, "item", None)
    if item is not None and getattr(value, "ndim", None) == 0:
        return edit(key, item())
    if isinstance(value, Mapping) or value is None:
        raise Error(
            f"set: {key} is {value!r}, expected a number, a text, a switch or a list; keys of a table are set one by one, as in {key}.name",
            key=key,
        )
    if not isinstance(value, Iterable):
        raise Error(f"set: {key} is {value!r}, expected a number, a text, a switch or a list", key=key)
    # A list of numbers, texts and switches reads the same in JSON as in a file.
    return key, _json(list(value)), True


def observer(progress: Progress | None) -> _idc.Progress | None:
    """The observer of the progress as the extension calls it."""
    if progress is None:
        return None
    if isinstance(progress, Bar):
        bar = progress

        def report(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        return report
    return progress

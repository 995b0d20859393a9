"""Diagnoses, predictions, and results side by side."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from idc import _idc
from idc._error import Error
from idc._run import Run, framed
from idc._scenario import Progress, observer
from idc._table import Table


@dataclass(frozen=True)
class Estimate:
    """A number with its 95 % interval, in the unit of its name."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class FoundEffect:
    """An effect that the nominal model lacks."""

    name: str
    """Its name in the catalogue (`idc effects`), or `unlisted`."""
    subsystem: str
    """Where it enters."""
    probability: float
    """Probability that it is at work."""
    intervals: Mapping[str, Estimate]
    """Its numbers by their names, units included."""
    document: Mapping[str, Any]
    """All that diagnosis.json says of it."""


@dataclass(frozen=True)
class Improved:
    """An improved model: a file's text, and where it stands or could stand."""

    path: Path
    text: str

    def __repr__(self) -> str:
        return f"<idc.Improved {self.path}>"


class Diagnosis:
    """What physics recordings contain that their nominal model leaves out."""

    __slots__ = ("_document", "_inner")

    def __init__(self, inner: _idc.Diagnosis) -> None:
        self._inner = inner
        self._document: dict[str, Any] = json.loads(inner.document())

    @property
    def document(self) -> dict[str, Any]:
        """What diagnosis.json holds."""
        return self._document

    @property
    def verdict(self) -> str:
        """`explained`, `nothing_missing` or `unlisted`."""
        return str(self._document["verdict"])

    @property
    def effects(self) -> list[FoundEffect]:
        """Effects that were found, the one that explains the most first, with their numbers and probabilities."""
        return [_effect(found) for found in self._document["effects"]]

    @property
    def intervals(self) -> dict[str, Mapping[str, Estimate]]:
        """Numbers of each effect with their 95 % intervals, by the effect's name."""
        return {effect.name: effect.intervals for effect in self.effects}

    @property
    def probabilities(self) -> dict[str, float]:
        """Probability that each effect is at work, by its name."""
        return {effect.name: effect.probability for effect in self.effects}

    @property
    def statements(self) -> list[str]:
        """The conclusion, and the account's sentences on what differs, is missing and is to be recorded next, a paragraph each."""
        account = self._document["account"]
        parts = [paragraph for section in account["sections"] for paragraph in section["paragraphs"]]
        return [account["headline"], *parts]

    @property
    def account(self) -> str:
        """The account as account.txt has it."""
        return self._inner.account()

    @property
    def improved(self) -> Improved:
        """The improved model, for `predict`."""
        path, text = self._inner.improved
        return Improved(Path(path), text)

    @property
    def comparison(self) -> Table:
        """Each recording beside the models: measured, nominal, within tolerances, improved, left out."""
        return Table(self._inner.comparison())

    def page(self) -> str:
        """Its page for a browser, with all charts: report.html."""
        return self._inner.page()

    def _repr_html_(self) -> str:
        return framed(self.page())

    def __repr__(self) -> str:
        found = ", ".join(f"{e.name} ({e.probability:.2f})" for e in self.effects)
        return f"<idc.Diagnosis: {self.verdict}{': ' if found else ''}{found}>"


def _effect(found: dict[str, Any]) -> FoundEffect:
    numbers = {
        name: Estimate(float(own["value"]), float(own["low"]), float(own["high"]))
        for name, own in found["parameters"].items()
        if isinstance(own, dict) and "value" in own
    }
    return FoundEffect(found["name"], found["subsystem"], float(found["confidence"]), numbers, found)


def diagnose(
    case: str | PathLike[str],
    *,
    scenario: str | PathLike[str] | None = None,
    tried: str | None = None,
    effort: int | None = None,
    limit_s: float | None = None,
    out: str | PathLike[str] | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Diagnosis:
    """Find what physics recordings contain that their model leaves out.

    case: a folder with rig.toml, arm.toml or postures.toml and the recordings that it names.
    scenario: the scenario of a recorded cell, whose folder holds recordings alone.
    tried: a law of one's own, tried beside the tool's, as `idc diagnose --try` takes it.
    effort: model evaluations after which the search stops, with the same answer each time.
    limit_s: time after which it stops [s].
    out: a folder for the files that `idc diagnose` writes; nothing is written without.
    force: whether they take the place of old ones.
    progress: called with the percents done (a guess) and 100; or a bar of tqdm.

    >>> found = diagnose("assets/proof/cases/case-03", effort=2000)
    >>> found.verdict
    'explained'
    """
    if effort is not None and limit_s is not None:
        raise Error("diagnose: effort and limit_s were given, expected one of the two")
    if effort is not None and effort < 1:
        raise Error(f"diagnose: effort is {effort}, expected 1 or more model evaluations")
    if limit_s is not None and not 0.0 < limit_s < 1e9:
        raise Error(f"diagnose: limit_s is {limit_s}, expected a time above zero [s]")
    folder = None if out is None else (out, force)
    return Diagnosis(_idc.diagnose(case, scenario, tried, (effort, limit_s), folder, observer(progress)))


class Prediction(Table):
    """Predicted columns with their 90 % bands (`.._low`, `.._high`)."""

    __slots__ = ("document",)

    document: dict[str, Any]
    """Notes, and how far the prediction is from what was measured: what `idc predict --json` prints."""

    def __init__(self, inner: _idc.Table, document: dict[str, Any]) -> None:
        super().__init__(inner)
        self.document = document


def predict(model: str | PathLike[str] | Improved, inputs: str | PathLike[str]) -> Prediction:
    """What a model predicts for the inputs of a recording; nothing is written.

    model: a rig file, nominal or improved, a recorded arm or still postures; or `Diagnosis.improved`.
    inputs: a recording, whose measured columns are compared where it has some.
    """
    if isinstance(model, Improved):
        table, document = _idc.predict(model.path, model.text, inputs)
    else:
        table, document = _idc.predict(model, None, inputs)
    return Prediction(table, json.loads(document))


class Comparison:
    """Results side by side."""

    __slots__ = ("_page", "document")

    document: dict[str, Any]
    """What `idc compare --json` prints: names, verdicts, numbers by key."""

    def __init__(self, document: dict[str, Any], page: str) -> None:
        self.document = document
        self._page = page

    @property
    def numbers(self) -> dict[str, list[float | None]]:
        """Each number of the results in their order, by its key; None where a result does not determine it."""
        return {number["key"]: number["values"] for number in self.document["numbers"]}

    def page(self) -> str:
        """Its page for a browser: numbers side by side, signals of runs over one another."""
        return self._page

    def _repr_html_(self) -> str:
        return framed(self._page)


Result = Run | Diagnosis | str | PathLike[str]
"""A result: a run, a diagnosis, or the folder of one."""


def compare(results: Sequence[Result] | Mapping[str, Run] | Mapping[str, Diagnosis]) -> Comparison:
    """Put runs, or diagnoses, side by side: two to seven of one kind.

    results: runs, diagnoses or folders; a dict gives them names.
    """
    named = list(results.items()) if isinstance(results, Mapping) else [(str(i + 1), own) for i, own in enumerate(results)]
    most = 7
    if not 2 <= len(named) <= most:
        raise Error(f"compare: {len(named)} results were given, expected two to {most}")
    runs = [(name, own._inner) for name, own in named if isinstance(own, Run)]
    diagnoses = [(name, own._inner) for name, own in named if isinstance(own, Diagnosis)]
    folders = [own for _, own in named if isinstance(own, (str, PathLike))]
    kinds = [kind for kind in (runs, diagnoses, folders) if kind]
    if len(kinds) != 1 or len(kinds[0]) != len(named):
        raise Error("compare: expected results of one kind: runs, diagnoses, or folders of either")
    document, page = _idc.compare(runs or diagnoses or folders)
    return Comparison(json.loads(document), page)

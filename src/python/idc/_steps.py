"""A cell or a bench step by step, under a controller of one's own."""

from __future__ import annotations

from collections.abc import Sequence

from idc import _idc
from idc._error import Error
from idc._idc import Observation
from idc._run import Run
from idc._scenario import ScenarioLike, Settings, edits, load


class _Steps:
    """What cell and bench have in common."""

    __slots__ = ("_inner",)
    _KIND = ""

    def __init__(self, scenario: ScenarioLike, *, set: Settings | None = None, effects: Sequence[str] = ()) -> None:
        loaded = load(scenario)
        if self._KIND and loaded.kind != self._KIND:
            raise Error(
                f"{loaded.path}: the scenario is a {loaded.kind}, expected a {self._KIND}; idc.{loaded.kind.capitalize()} takes it",
                str(loaded.path),
                "kind",
            )
        if isinstance(effects, str):
            effects = (effects,)
        self._inner = _idc.Steps(loaded._inner, edits(set), list(effects))

    @property
    def step_s(self) -> float:
        """Length of a step [s]."""
        return self._inner.step_s

    @property
    def supply_pa_gauge(self) -> float:
        """Supply pressure of the regulator [Pa gauge]."""
        return self._inner.supply_pa_gauge

    @property
    def full_stroke_m(self) -> float:
        """Stroke of the device [m]."""
        return self._inner.full_stroke_m

    @property
    def done(self) -> bool:
        """Whether the job is done, or was stopped by the physics."""
        return self._inner.done

    @property
    def stopped(self) -> str | None:
        """What stopped it before its end."""
        return self._inner.stopped

    @property
    def steps(self) -> tuple[int, int]:
        """Steps done and in all."""
        return self._inner.steps

    def reset(self, seed: int | None = None) -> Observation:
        """Begin anew, and give what is seen at rest.

        seed: that of the sensors' noise; the one before if not given.
        """
        return self._inner.reset(seed)

    def step(self, set_pressure_pa_gauge: float, count: int = 1) -> Observation:
        """Simulate so many steps under a set pressure [Pa gauge], and give what is seen then.

        It stops at the end of the job; a further step is refused.
        """
        return self._inner.step(set_pressure_pa_gauge, count)

    def observe(self) -> Observation:
        """What is seen now."""
        return self._inner.observe()

    def finish(self) -> Run:
        """What was done since `reset`, as a run with its numbers; `reset` begins anew."""
        return Run(self._inner.finish())


class Cell(_Steps):
    """A cell, simulated a step at a time.

    >>> cell = Cell("scenarios/plate_edge.toml")
    >>> seen = cell.reset(seed=1)
    >>> seen = cell.step(set_pressure_pa_gauge=1.0e5, count=10)
    >>> round(seen.time_s, 6) == round(10 * cell.step_s, 6)
    True
    """

    __slots__ = ()
    _KIND = "cell"


class Bench(_Steps):
    """A bench, simulated a step at a time.

    A controller of one's own, which corrects the set pressure by the load cell:

    >>> bench = Bench("scenarios/paper_step.toml", set={"bench.duration_s": 12})
    >>> seen, pressure = bench.reset(), 1.0e5
    >>> while not bench.done:
    ...     error_n = 200.0 - seen.measured_force_n
    ...     pressure = max(0.0, pressure + 0.3 * error_n)
    ...     seen = bench.step(pressure)
    >>> abs(seen.contact_force_n - 200.0) < 1.0
    True
    """

    __slots__ = ()
    _KIND = "bench"

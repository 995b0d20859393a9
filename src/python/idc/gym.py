"""Environments of Gymnasium: a controller that learns the set pressure.

An episode is the whole job of the scenario: a cell's pass over the edge, or the bench's programme.

- action: the set pressure, from -1 (none) to 1 (`max_pressure_bar`, gauge), held for `period_s`;
- observation: `FIELDS`, readings of the sensors and what is asked for, in the units of their names;
- reward: minus the error of the true contact force over the desired one, at most 1, for each period; in a cell while the tool engages and follows, otherwise 0.

`make(scenario)` gives one; `register()` makes them known to `gymnasium.make` as `idc/Cell-v0` and `idc/Bench-v0`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

try:
    import gymnasium
    import numpy as np
    from numpy.typing import NDArray
except ImportError as absent:
    raise ImportError(
        f"{absent.name} is not installed, and idc.gym needs it: pip install 'idc[gym]'", name=absent.name
    ) from absent

from idc import _idc
from idc._error import Error
from idc._run import Run
from idc._scenario import ScenarioLike, Settings, edits, load

__all__ = ["FIELDS", "BenchEnv", "CellEnv", "DeviceEnv", "make", "register"]

Array = NDArray[np.float32]

FIELDS: tuple[str, ...] = (
    "desired_force_n",
    "measured_force_n",
    "measured_stroke_mm",
    "set_pressure_bar_gauge",
    "measured_regulator_pressure_bar_gauge",
    "chamber_1_pressure_bar",
    "chamber_2_pressure_bar",
    "phase",
)
"""What an observation holds, in this order."""

# Of each: its name in the extension, its factor, and the bounds of the space.
_SOURCES: tuple[tuple[str, float, float, float], ...] = (
    ("desired_force_n", 1.0, 0.0, 2000.0),
    ("measured_force_n", 1.0, -2000.0, 2000.0),
    ("measured_stroke_m", 1e3, -50.0, 500.0),
    ("set_pressure_gauge_pa", 1e-5, 0.0, 20.0),
    ("measured_regulator_pressure_gauge_pa", 1e-5, -1.0, 20.0),
    ("chamber_1_pressure_pa", 1e-5, 0.0, 30.0),
    ("chamber_2_pressure_pa", 1e-5, 0.0, 30.0),
    ("phase", 1.0, -1.0, 3.0),
)
_DESIRED = FIELDS.index("desired_force_n")
_MOST_BAR = 10.0


class DeviceEnv(gymnasium.Env[Array, Array]):
    """A cell or a bench whose set pressure is the action.

    scenario: a file, a dict, or what `idc.load` gave.
    force_n: contact force to keep, of a bench that commands pressures; otherwise that of the scenario.
    period_s: time for which an action is held; the scenario's step if not given.
    max_pressure_bar: set pressure of the action 1, gauge; the supply if not given, at most 10 bar.
    set, effects: as of `idc.run`.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scenario: ScenarioLike,
        *,
        force_n: float | None = None,
        period_s: float | None = None,
        max_pressure_bar: float | None = None,
        set: Settings | None = None,
        effects: Sequence[str] = (),
    ) -> None:
        loaded = load(scenario)
        if isinstance(effects, str):
            effects = (effects,)
        self._steps = _idc.Steps(loaded._inner, edits(set), list(effects))
        step_s = self._steps.step_s
        self._count = 1 if period_s is None else round(period_s / step_s)
        if self._count < 1:
            raise Error(f"period_s is {period_s}, expected the scenario's step, {step_s} s, or a multiple of it")
        most = min(self._steps.supply_pa_gauge * 1e-5, _MOST_BAR) if max_pressure_bar is None else max_pressure_bar
        if not 0.0 < most <= 20.0:
            raise Error(f"max_pressure_bar is {most}, expected more than 0 and at most 20 bar, gauge")
        self._half_pa = 0.5e5 * most
        seen = self._steps.reset()
        if force_n is None and seen.desired_force_n != seen.desired_force_n:
            raise Error(
                f"{loaded.path}: the bench commands pressures, and says no force to keep; expected force_n=.., as force_n=200"
            )
        self._force_n = force_n
        self._is_bench = self._steps.is_bench
        names = _idc.Observation.names
        self._buffer: Array = np.zeros(len(FIELDS), dtype=np.float32)
        self._steps.watch(self._buffer, [(names.index(name), *rest) for name, *rest in _SOURCES])  # type: ignore[misc]
        low, high = (np.array([source[at] for source in _SOURCES], dtype=np.float32) for at in (2, 3))
        self.observation_space = gymnasium.spaces.Box(low, high, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)

    @property
    def period_s(self) -> float:
        """Time for which an action is held [s]."""
        return self._count * self._steps.step_s

    def set_pressure_pa_gauge(self, action: Array) -> float:
        """Set pressure of an action [Pa gauge]."""
        share = float(action[0])
        return self._half_pa * (1.0 + min(max(share, -1.0), 1.0))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begin an episode. The seed is that of the sensors' noise; without, a further episode has other noise."""
        super().reset(seed=seed)
        self._steps.reset(int(self.np_random.integers(2**31)))
        return self._seen(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Hold a set pressure for a period."""
        share = float(action[0])
        share = -1.0 if share < -1.0 else 1.0 if share > 1.0 else share
        contact, desired, phase, done = self._steps.step_watched(self._half_pa * (1.0 + share), self._count)
        if self._force_n is not None:
            desired = self._force_n
        reward = 0.0
        if desired > 0.0 and (self._is_bench or 1.0 <= phase <= 2.0):
            error = abs(contact - desired) / desired
            reward = -error if error < 1.0 else -1.0
        if not done:
            return self._seen(), reward, False, False, {}
        stopped = self._steps.stopped
        return self._seen(), reward, True, False, {} if stopped is None else {"stopped": stopped}

    def finish(self) -> Run:
        """What was done in this episode as a run, with its numbers; `reset` begins another."""
        return Run(self._steps.finish())

    def _seen(self) -> Array:
        seen = self._buffer.copy()
        if self._force_n is not None:
            seen[_DESIRED] = self._force_n
        return seen


class CellEnv(DeviceEnv):
    """A cell: an episode is its whole job."""


class BenchEnv(DeviceEnv):
    """A bench: an episode is its programme."""


def make(scenario: ScenarioLike, **options: Any) -> DeviceEnv:
    """The environment of a scenario, with the options of `DeviceEnv`.

    >>> env = make("scenarios/paper_step.toml", force_n=200.0)
    >>> seen, _ = env.reset(seed=1)
    >>> seen, reward, terminated, truncated, info = env.step(env.action_space.sample())
    >>> len(seen) == len(FIELDS)
    True
    """
    loaded = load(scenario)
    return (BenchEnv if loaded.kind == "bench" else CellEnv)(loaded, **options)


def register() -> None:
    """Make them known to `gymnasium.make`, which takes the options of `DeviceEnv`: `gymnasium.make("idc/Bench-v0", scenario=..)`."""
    for name, kind in (("Cell", CellEnv), ("Bench", BenchEnv)):
        if f"idc/{name}-v0" not in gymnasium.registry:
            gymnasium.register(f"idc/{name}-v0", entry_point=f"{kind.__module__}:{kind.__qualname__}")

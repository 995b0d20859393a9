"""The bench rig integrated by scipy at tight tolerance: golden files for the tests of the solver.

    python tests/reference/bench_reference.py SCENARIO.toml OUT.csv

The integration stops and starts anew at every discontinuity: commands that arrive, valve changes, the surface's start, and, found as
events, the borders between choked, subsonic and laminar flow and a contact that closes, loses its force (which damping brings about
while it is still pressed in) or opens. Between them the right-hand side (bench_model.py) keeps to one branch and is smooth.

The golden file is made with Radau at rtol 1e-10. Three other runs check it; how far they lie from it stands in the file's header.
"""

import math
import platform
import sys
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Callable

import numpy as np
import scipy
from scipy.integrate import OdeSolution, solve_ivp
from scipy.optimize import brentq

from bench_model import CHOKED_IN, CHOKED_OUT, OPEN, PUSHING, RELEASED, Bench, Modes, State, pressure_fall, read_bench

TOLERANCE = 1e-10
SAMPLES_PER_SECOND = 2000
COARSE = 20  # samples between two rows of the file: 10 ms
FINE_SECONDS = 0.03  # after a contact event every sample is written
ABSOLUTE_TOLERANCE = 1e-13  # of full scale, to which the states are scaled; below it rounding rules
JACOBIAN_STEP = 1e-7  # of full scale


class Event:
    """A zero of `value`, crossed upwards or downwards: ends the section and leads to other modes."""

    terminal = True

    def __init__(self, value: Callable[[float, State], float], direction: int, bench: Bench, successor: Modes) -> None:
        self.value = value
        self.direction = direction
        self.bench = bench
        self.successor = successor

    def __call__(self, time: float, y: np.ndarray) -> float:
        return self.value(time, self.bench.state(y))


def fall_at(bench: Bench, valve: str, chamber: int, bound: float) -> Callable[[float, State], float]:
    return lambda time, state: pressure_fall(bench.orifices(time, valve)[chamber][1], state.pressures[chamber]) - bound


def mode_changes(bench: Bench, valve: str, modes: Modes) -> list[Event]:
    events = []
    for chamber, regime in enumerate(modes.regimes):
        if regime > CHOKED_OUT:
            value = fall_at(bench, valve, chamber, bench.regime_bounds[regime - 1])
            events.append(Event(value, -1, bench, modes.with_regime(chamber, regime - 1)))
        if regime < CHOKED_IN:
            value = fall_at(bench, valve, chamber, bench.regime_bounds[regime])
            events.append(Event(value, 1, bench, modes.with_regime(chamber, regime + 1)))
    for index, (contact, mode) in enumerate(zip(bench.contacts, modes.contacts)):
        penetration = lambda time, state, contact=contact: contact.penetration(time, state.stroke)
        force = lambda time, state, contact=contact: contact.raw_force(time, state.stroke, state.speed)
        if mode == OPEN:
            events.append(Event(penetration, 1, bench, modes.with_contact(index, PUSHING)))
        elif mode == PUSHING:
            # Without damping the force is lost as the contact opens.
            after = RELEASED if contact.damping > 0.0 else OPEN
            events.append(Event(force, -1, bench, modes.with_contact(index, after)))
        else:
            events.append(Event(penetration, -1, bench, modes.with_contact(index, OPEN)))
            events.append(Event(force, 1, bench, modes.with_contact(index, PUSHING)))
    return events


@dataclass
class Run:
    """Samples on the grid, when a contact changed its mode [s], and for each chamber its air [kg] when its flow turned round [s]."""

    times: list[float]
    states: list[np.ndarray]
    contact_events: list[float]
    turns: tuple[list[tuple[float, float]], list[tuple[float, float]]]
    sections: int


def grid_between(start: float, end: float) -> list[float]:
    """Sample times in (start, end]."""
    first, last = math.floor(start * SAMPLES_PER_SECOND), math.ceil(end * SAMPLES_PER_SECOND)
    times = (index / SAMPLES_PER_SECOND for index in range(first, last + 1))
    return [time for time in times if start < time <= end]


def integrate(bench: Bench, method: str, tolerance: float, locate: bool) -> Run:
    """The whole scenario. Without `locate` no events are sought, and the branches are chosen inside the right-hand side."""
    y = bench.start()
    run = Run([0.0], [y], [], ([], []), 0)
    contacts = bench.modes(0.0, y, bench.valve(0.0)).contacts
    for begin, end in pairwise(bench.breaks):
        valve = bench.valve(begin)
        if bench.at_rest(begin, y, valve):
            for time in grid_between(begin, end):
                run.times.append(time)
                run.states.append(y)
            continue
        modes = replace(bench.modes(begin, y, valve), contacts=contacts)
        time = begin
        while time < end:
            time, y, modes = section(bench, run, (time, end), y, valve, modes, method, tolerance, locate)
        contacts = modes.contacts
    return run


def section(
    bench: Bench,
    run: Run,
    span: tuple[float, float],
    y: np.ndarray,
    valve: str,
    modes: Modes,
    method: str,
    tolerance: float,
    locate: bool,
) -> tuple[float, np.ndarray, Modes]:
    """From one discontinuity to the next; appends to `run` and returns where and in what modes it goes on."""
    begin, end = span
    grid = grid_between(begin, end)
    changes = mode_changes(bench, valve, modes) if locate else []
    branch = modes if locate else None

    def rates(time: float, y: np.ndarray) -> np.ndarray:
        return bench.rates(time, y, valve, branch)

    def jacobian(time: float, y: np.ndarray) -> np.ndarray:
        middle = rates(time, y)
        nudges = JACOBIAN_STEP * np.eye(len(y))
        return np.transpose([(rates(time, y + nudge) - middle) / JACOBIAN_STEP for nudge in nudges])

    solution = solve_ivp(
        rates,
        span,
        y,
        method=method,
        t_eval=grid if grid and grid[-1] == end else [*grid, end],
        events=changes,
        dense_output=True,
        rtol=tolerance,
        atol=ABSOLUTE_TOLERANCE,
        **({"jac": jacobian} if method == "Radau" else {}),
    )
    if not solution.success:
        raise SystemExit(f"bench_reference: {method} gave up at {solution.t[-1]} s: {solution.message}")
    on_grid = set(grid)
    samples = np.transpose(solution.y)
    for time, sample in zip(solution.t, samples):
        if time in on_grid:
            run.times.append(float(time))
            run.states.append(sample)
    for chamber in (0, 1):
        run.turns[chamber].extend(turns(bench, solution.sol, valve, chamber))
    run.sections += 1
    for change, times, states in zip(changes, solution.t_events, solution.y_events):
        if len(times):
            if change.successor.contacts != modes.contacts:
                run.contact_events.append(float(times[0]))
            return float(times[0]), states[0], change.successor
    return end, samples[-1], modes


def turns(bench: Bench, path: OdeSolution, valve: str, chamber: int) -> list[tuple[float, float]]:
    """When the flow of a chamber turns round [s] and its air then [kg].

    The law is smooth there, but air that entered is to be distinguished from air that left. Sought after the integration: near rest the flow
    is rounding errors of either sign, on which an event of solve_ivp fails and the quadrature of max(0, flow) makes no progress.
    """
    fall = fall_at(bench, valve, chamber, 0.0)

    def fall_on_path(time: float) -> float:
        return fall(time, bench.state(path(time)))

    found = []
    falls = [fall_on_path(time) for time in path.ts]
    for (begin, end), (first, last) in zip(pairwise(path.ts), pairwise(falls)):
        if first * last < 0.0:
            time = brentq(fall_on_path, begin, end)
            found.append((time, bench.state(path(time)).masses[chamber]))
    return found


def air_passed(bench: Bench, run: Run, chamber: int) -> np.ndarray:
    """Air that entered a chamber and air that left it until each sample [kg], two rows: its mass rises or falls between the turns."""
    marks = [(time, bench.state(y).masses[chamber], True) for time, y in zip(run.times, run.states)]
    marks += [(time, mass, False) for time, mass in run.turns[chamber]]
    marks.sort()
    changes = np.diff([mass for _, mass, _ in marks], prepend=marks[0][1])
    passed = np.cumsum([np.maximum(changes, 0.0), np.maximum(-changes, 0.0)], axis=1)
    return passed[:, [is_sample for _, _, is_sample in marks]]


def columns(bench: Bench, run: Run) -> dict[str, np.ndarray]:
    """The columns of the golden file, on the whole grid."""
    states = [bench.state(y) for y in run.states]
    forces = []
    for time, state in zip(run.times, states):
        modes = tuple(contact.mode(time, state.stroke, state.speed) for contact in bench.contacts)
        forces.append(bench.contact_forces(time, state, modes))
    entered, left = air_passed(bench, run, 0) + air_passed(bench, run, 1)
    table = {
        "time_s": run.times,
        "regulator_pressure_pa": [bench.atmosphere + bench.outlet(time) for time in run.times],
        "chamber_1_pressure_pa": [state.pressures[0] for state in states],
        "chamber_2_pressure_pa": [state.pressures[1] for state in states],
        "stroke_m": [state.stroke for state in states],
        "speed_m_per_s": [state.speed for state in states],
        "contact_force_n": [-sum(force[2:]) for force in forces],
        "gas_force_n": [bench.gas_force(state) for state in states],
        "stop_force_n": [sum(force[:2]) for force in forces],
        "mass_entered_kg": entered,
        "mass_left_kg": left,
    }
    if bench.wall_heat:
        table["chamber_1_temperature_k"] = [state.temperatures[0] for state in states]
        table["chamber_2_temperature_k"] = [state.temperatures[1] for state in states]
    return {name: np.array(values) + 0.0 for name, values in table.items()}


def differences(table: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> dict[str, float]:
    """For each column the largest difference between two runs, as a share of the column's range."""
    ranges = {name: float(np.ptp(values)) for name, values in table.items() if name != "time_s"}
    return {name: float(np.max(np.abs(table[name] - other[name]))) / span for name, span in ranges.items() if span > 0.0}


def rows_to_write(run: Run) -> list[int]:
    written = []
    for row, time in enumerate(run.times):
        after_contact = any(event < time <= event + FINE_SECONDS for event in run.contact_events)
        if after_contact or round(time * SAMPLES_PER_SECOND) % COARSE == 0:
            written.append(row)
    return written


def main() -> None:
    scenario, target = map(Path, sys.argv[1:])
    bench = read_bench(scenario)
    run = integrate(bench, "Radau", TOLERANCE, locate=True)
    table = columns(bench, run)
    header = [
        f"bench_reference.py: {scenario.name}, by another program than the one tested",
        f"scipy {scipy.__version__}, numpy {np.__version__}, Python {platform.python_version()}",
        f"solve_ivp Radau, rtol {TOLERANCE:g}, atol {ABSOLUTE_TOLERANCE:g} of full scale, in {run.sections} sections between discontinuities",
        "forces along extension, but contact_force_n is the tool's push on the load; pressures absolute; mass of both chambers together",
        "largest differences from other runs, as a share of the column's range, over all samples every 0.5 ms:",
    ]
    checks = [
        ("Radau, rtol 1e-12", "Radau", 1e-12, True),
        ("DOP853, rtol 1e-12", "DOP853", 1e-12, True),
        ("LSODA, rtol 1e-10, no discontinuity sought but commands and valve changes", "LSODA", TOLERANCE, False),
    ]
    for title, method, tolerance, locate in checks:
        shares = differences(table, columns(bench, integrate(bench, method, tolerance, locate)))
        header.append(f"  {title}: " + ", ".join(f"{name} {share:.1e}" for name, share in shares.items()))
    lines = ["# " + line for line in header] + [",".join(table)]
    for row in rows_to_write(run):
        lines.append(",".join(repr(float(values[row])) for values in table.values()))
    target.write_text("\n".join(lines) + "\n")
    print("\n".join([str(target), *header]))


if __name__ == "__main__":
    main()

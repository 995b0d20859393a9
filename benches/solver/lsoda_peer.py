"""LSODA of scipy, restarted every millisecond on the device of the bench rig, for benches/solver: its speed and its error.

    python benches/solver/lsoda_peer.py SCENARIO.toml GOLDEN.csv

Follows the scenario from START to END, from the state in the golden file that bench_reference.py made, and prints one line of JSON.
Each of scipy's ways of calling LSODA, at each pair of tolerances: microseconds a simulated millisecond, best of ROUNDS, and the largest
errors against the golden file, as shares of the column's range. The keys outside "runs" are those of the first pair, the cheapest at
rtol 1e-6; the last pair is about the cheapest that keeps every quantity within 1e-4.
The right-hand side is plain floats, nothing of numpy, eq. (10) with one power instead of two. Isothermal air only.
"""

import json
import math
import sys
import time
from pathlib import Path
from typing import Callable, Sequence

import numpy as np
import scipy
from scipy.integrate import ode, odeint, solve_ivp

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "reference"))
from bench_model import LAMINAR_RATIO, Bench, read_bench

START, END = 1.0, 2.5  # s: in paper_step the piston starts to move, meets the load cell and presses
STEP = 1e-3
ROUNDS = 5
TOLERANCES = [(1e-6, 1e-6), (1e-6, 1e-9), (1e-7, 1e-8)]  # rtol, and atol as a share of full scale

RightHandSide = Callable[[float, Sequence[float]], tuple[float, float, float, float]]
Step = Callable[[float, np.ndarray], np.ndarray]


def right_hand_side(bench: Bench) -> RightHandSide:
    """Rates of the masses, stroke and speed, in SI units, while no command arrives, the valve extends and the load stands still."""
    piece_begin, piece_outlet, target = [piece for piece in bench.outlet_pieces if piece[0] <= START][-1]
    if any(START < time < END for time in bench.breaks) or bench.valve(START) != "extend" or bench.wall_heat:
        raise SystemExit(f"lsoda_peer: between {START} and {END} s there must be no command or valve change, and no heat")
    time_constant, height = bench.time_constant, piece_outlet - target
    atmosphere = bench.atmosphere
    rt = bench.gas_constant * bench.temperature
    supply = bench.supply_conductance / math.sqrt(rt)
    exhaust = bench.exhaust_conductance / math.sqrt(rt)
    area_1, area_2, dead, length = bench.extending_area, bench.retracting_area, bench.dead_volume, bench.full_stroke
    rod_force = atmosphere * (area_1 - area_2)
    mass, gravity = bench.moving_mass, bench.gravity
    inner, outer, *loads = bench.contacts
    stop_stiffness, stop_damping = inner.stiffness, inner.damping
    load_place = loads[0].place(START)[0] if loads else math.inf
    load_stiffness, load_damping = (loads[0].stiffness, loads[0].damping) if loads else (0.0, 0.0)
    k = bench.heat_ratio
    exponent, factor = (k - 1) / k, 2 * k / (k - 1)
    critical, choked, laminar_slope = 1 + bench.regime_bounds[0], bench.choked, bench.laminar_slope
    exp, sqrt = math.exp, math.sqrt

    def flow(conductance: float, outside: float, inside: float) -> float:
        if outside >= inside:
            upstream, ratio, conductance = outside, inside / outside, conductance
        else:
            upstream, ratio, conductance = inside, outside / inside, -conductance
        if ratio > LAMINAR_RATIO:
            return conductance * upstream * laminar_slope * (1.0 - ratio)
        if ratio < critical:
            return conductance * upstream * choked
        power = ratio**exponent
        return conductance * upstream * ratio / power * sqrt(factor * (1.0 - power))

    def rates(time: float, y: Sequence[float]) -> tuple[float, float, float, float]:
        mass_1, mass_2, stroke, speed = y.tolist()
        pressure_1 = mass_1 * rt / (dead + area_1 * stroke)
        pressure_2 = mass_2 * rt / (dead + area_2 * (length - stroke))
        force = pressure_1 * area_1 - pressure_2 * area_2 - rod_force
        if stroke < 0.0:
            push = -stop_stiffness * stroke - stop_damping * speed
            if push > 0.0:
                force += push
        else:
            if stroke > length:
                push = stop_stiffness * (stroke - length) + stop_damping * speed
                if push > 0.0:
                    force -= push
            if stroke > load_place:
                push = load_stiffness * (stroke - load_place) + load_damping * speed
                if push > 0.0:
                    force -= push
        outlet = atmosphere + target + height * exp((piece_begin - time) / time_constant)
        return (
            flow(supply, outlet, pressure_1),
            flow(exhaust, atmosphere, pressure_2),
            speed,
            force / mass + gravity,
        )

    return rates


def callers(rates: RightHandSide, relative: float, absolute: np.ndarray) -> dict[str, Step]:
    """Ways of one restarted step of LSODA: from a time and a state to the state a STEP later."""

    def by_solve_ivp(begin: float, y: np.ndarray) -> np.ndarray:
        solution = solve_ivp(rates, (begin, begin + STEP), y, method="LSODA", rtol=relative, atol=absolute)
        return solution.y[:, -1]

    def by_odeint(begin: float, y: np.ndarray) -> np.ndarray:
        return odeint(rates, y, (begin, begin + STEP), rtol=relative, atol=absolute, tfirst=True)[1]

    integrator = ode(rates).set_integrator("lsoda", rtol=relative, atol=absolute)

    def by_ode(begin: float, y: np.ndarray) -> np.ndarray:
        return integrator.set_initial_value(y, begin).integrate(begin + STEP)

    return {"lsoda_solve_ivp": by_solve_ivp, "odeint": by_odeint, "ode": by_ode}


def read_golden(path: Path) -> dict[str, np.ndarray]:
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    values = np.array([[float(value) for value in line.split(",")] for line in lines[1:]])
    return dict(zip(lines[0].split(","), values.T))


def state_at(bench: Bench, golden: dict[str, np.ndarray], row: int) -> np.ndarray:
    stroke = golden["stroke_m"][row]
    rt = bench.gas_constant * bench.temperature
    pressures = (golden["chamber_1_pressure_pa"][row], golden["chamber_2_pressure_pa"][row])
    masses = [pressure * volume / rt for pressure, volume in zip(pressures, bench.volumes(stroke))]
    return np.array([*masses, stroke, golden["speed_m_per_s"][row]])


def follow(step: Step, y: np.ndarray) -> tuple[float, list[np.ndarray]]:
    """Seconds of the processor that the whole window took, and the state at each millisecond."""
    path = [y]
    # Of the process: what others take of the processor meanwhile does not count against scipy.
    begin = time.process_time()
    for index in range(round(START / STEP), round(END / STEP)):
        y = step(index * STEP, y)
        path.append(y)
    return time.process_time() - begin, path


def errors(bench: Bench, golden: dict[str, np.ndarray], path: list[np.ndarray]) -> dict[str, float]:
    """Largest error of each quantity at the golden file's rows on whole milliseconds."""
    largest = dict.fromkeys(["chamber_1_pressure_pa", "chamber_2_pressure_pa", "stroke_m", "speed_m_per_s", "contact_force_n"], 0.0)
    ranges = {name: float(np.ptp(golden[name])) for name in largest}
    first = round(START / STEP)
    for row, moment in enumerate(golden["time_s"]):
        index = round(moment / STEP)
        if not first <= index < first + len(path) or abs(index * STEP - moment) > 1e-9:
            continue
        state = bench.state(path[index - first] / bench.scale)
        modes = tuple(contact.mode(moment, state.stroke, state.speed) for contact in bench.contacts)
        contact_force = -sum(bench.contact_forces(moment, state, modes)[2:])
        values = [*state.pressures, state.stroke, state.speed, contact_force]
        for name, value in zip(largest, values):
            if ranges[name] > 0.0:
                largest[name] = max(largest[name], abs(value - golden[name][row]) / ranges[name])
    return largest


def main() -> None:
    scenario, golden_file = map(Path, sys.argv[1:])
    bench = read_bench(scenario)
    golden = read_golden(golden_file)
    start = state_at(bench, golden, int(np.searchsorted(golden["time_s"], START - 1e-9)))
    steps = round((END - START) / STEP)
    rates = right_hand_side(bench)
    runs = []
    for relative, share in TOLERANCES:
        for name, step in callers(rates, relative, share * bench.scale).items():
            rounds = [follow(step, start) for _ in range(ROUNDS)]
            runs.append({
                "call": name,
                "rtol": relative,
                "atol_of_full_scale": share,
                "us_per_ms": min(seconds for seconds, _ in rounds) * 1e6 / steps,
                "max_errors": errors(bench, golden, rounds[-1][1]),
            })
    report = {"scipy": scipy.__version__, "steps": steps}
    for run in runs:
        if (run["rtol"], run["atol_of_full_scale"]) == TOLERANCES[0]:
            report[f"{run['call']}_us_per_ms"] = run["us_per_ms"]
            report[f"max_error_{run['call']}"] = max(run["max_errors"].values())
    report["runs"] = runs
    print(json.dumps(report))


if __name__ == "__main__":
    main()

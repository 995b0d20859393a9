"""LSODA of scipy, restarted every millisecond on the device of the bench rig, for benches/solver: its speed and its error.

    python benches/solver/lsoda_peer.py SCENARIO.toml GOLDEN.csv

Follows the scenario from START to END (from the state in the golden file, which bench_reference.py made) by each way that scipy has of
calling LSODA, and prints one line of JSON: microseconds a simulated millisecond, median of ROUNDS, and the largest errors against the
golden file as shares of the column's range in the window. The right-hand side is plain floats, nothing of numpy, eq. (10) with one
power instead of two. Isothermal air only.
"""

import json
import math
import sys
import time
from pathlib import Path
from statistics import median
from typing import Callable, Sequence

import numpy as np
import scipy
from scipy.integrate import ode, odeint, solve_ivp

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "reference"))
from bench_model import LAMINAR_RATIO, Bench, read_bench

START, END = 1.0, 2.5  # s: in paper_step the piston starts to move, meets the load cell and presses
STEP = 1e-3
ROUNDS = 5
RELATIVE = 1e-6
ABSOLUTE = 1e-6  # of full scale

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

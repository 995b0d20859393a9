"""PySINDy and gplearn on the balance of forces of the twelve cases in which physics without a name acts (shared/concealed/beyond/practice).

    beyond.py [--concealed ../shared/concealed/beyond] [--answers DIR] [--jobs 2] [--table-only] [case-02 ...]

For every sample off the end stops and in motion, the force that the nominal model lacks:
    left = m (a - g) - (p1 A1 - p2 A2 - p_air (A1 - A2)) + f       a, f measured; p1, p2: the nominal chambers along measured outlet and stroke
Both peers are asked for left = law(variables), VARIABLES below; PySINDy by sparse regression over four libraries, gplearn by
genetic programming over the same variables. Both deliver one expression in Python's syntax, which is judged and predicted with alike.
Results go to results_beyond.json, seconds apart from the rest (the rest is the same on a second run), the table to PEERS.md.
`--answers` scores our own answers of DIR/case-NN beside them; `--table-only` runs no peer and takes both from results_beyond.json.
"""
import argparse
import copy
import itertools
import json
import os
import pathlib
import re
from concurrent.futures import ProcessPoolExecutor

os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy: threads on matrices this small only burn time

import numpy as np
import pysindy as ps
from gplearn.genetic import SymbolicRegressor
from scipy.optimize import minimize_scalar
from scipy.signal import lfilter

import nominal
import beyond_judge as judge
import data
from pysindy_fit import SLOW, STEP, Channels, Equation, between_stops, sign_of

RESULTS = data.HERE / "results_beyond.json"
PAGE = data.HERE.parent / "PEERS.md"
TOLERANCES = {"supply": nominal.SUPPLY, "exhaust": nominal.EXHAUST, "dead": nominal.DEAD}  # nominal values that the balance feels
VARIABLES = ("x", "v", "dir", "t", "p1", "p2", "set", "f", "surface")
FUNCTIONS = {
    "abs": np.abs, "sin": np.sin, "max": np.maximum, "min": np.minimum,
    "div": lambda a, b: np.where(np.abs(b) > 0.001, a / np.where(np.abs(b) > 0.001, b, 1.0), 1.0),  # gplearn's protected division
    "box": lambda x, low, high: np.where((x >= low) & (x < high), 1.0, 0.0),
}


def scaled(rig, t, x, v, p1, p2, command, f, surface):
    """The variables of a law, of order one: stroke and surface in full strokes, velocity in 0.1 m/s, its direction, time in 10 s, gauge pressures
    in bar, contact force in 100 N. Where there is no workpiece the surface is put at the full stroke."""
    length, air = rig["cylinder"]["stroke_m"], rig["gas"]["atmosphere_pa"]
    return {"x": x / length, "v": v / 0.1, "dir": sign_of(v), "t": t / 10, "p1": (p1 - air) * 1e-5, "p2": (p2 - air) * 1e-5,
            "set": command * 1e-5, "f": f / 100, "surface": np.minimum(surface, length) / length}


def calibrated(rig, recordings):
    """The rig with the nominal values that channels tell by themselves fitted to them, no further than their tolerance allows: the regulator's gain
    and time constant along outlet and command, the contact's stiffness along force and penetration."""
    rig = copy.deepcopy(rig)

    def bounded(value, fitted):
        return float(np.clip(fitted, value["value"] * (1 - value["tolerance"]), value["value"] * (1 + value["tolerance"])))

    def outlet(tau):  # of gain 1; the command is held from sample to sample
        for r in recordings:
            decay = np.exp(-np.mean(np.diff(r["time_s"])) / tau)
            yield lfilter([0, 1 - decay], [1, -decay], r["set_pressure_pa"])

    def regulator(tau):
        model, measured = np.concatenate([*outlet(tau)]), np.concatenate([r["regulator_pressure_pa"] for r in recordings])
        gain = bounded(rig["regulator"]["gain"], model @ measured / (model @ model))
        return data.rms(measured - gain * model), gain

    tau = rig["regulator"]["time_constant_s"]
    low, high = bounded(tau, 0.0), bounded(tau, np.inf)
    tau["value"] = float(minimize_scalar(lambda q: regulator(q)[0], bounds=(low, high), method="bounded").x)
    rig["regulator"]["gain"]["value"] = regulator(tau["value"])[1]
    depths, forces, damping = [], [], rig["contact"]["damping_n_s_per_m"]["value"]
    for c in (Channels(rig, r) for r in recordings):
        touching = (c.surface < 1.0) & (c.force > 5 * rig["sensors"]["force_n"])
        depths.append((c.x - c.surface)[touching])
        forces.append((c.force - damping * (c.v - c.surface_rate))[touching])
    depth, force = np.concatenate(depths), np.concatenate(forces)
    rig["contact"]["stiffness_n_per_m"]["value"] = bounded(rig["contact"]["stiffness_n_per_m"], depth @ force / (depth @ depth))
    return rig


class Law:
    """A force [N] as an expression in VARIABLES, and nominal values moved by a factor beside it (PySINDy's terms of TOLERANCES)."""

    def __init__(self, expression, factors=None):
        self.expression, self.factors = expression, factors or {}
        self._code = compile(expression, "law", "eval")

    def __call__(self, z):
        with np.errstate(all="ignore"):
            return eval(self._code, FUNCTIONS, z) + 0.0 * z["x"]


class Lack:
    """What the nominal balance lacks in one recording: variables `z`, the force `left` [N], and among the variables what it would lack if one of
    TOLERANCES were 1 % larger than nominal [N]."""

    def __init__(self, rig, recording):
        c, p = Channels(rig, recording), nominal.pneumatic_parameters(rig)
        p[[nominal.GAIN, nominal.TAU]] = 1.0, 1e-6  # the chambers see the measured outlet

        def air(p):
            chambers = nominal.along(c.t, c.p, c.solenoid, c.x, c.v, p, 20)
            return chambers, chambers[:, 1] * p[nominal.AREA1] - chambers[:, 2] * p[nominal.AREA2] - p[nominal.AIR] * (p[nominal.AREA1] - p[nominal.AREA2])

        chambers, force = air(p)
        kept = between_stops(rig, c) & (np.abs(c.v) > SLOW)  # stops outweigh all else, and at rest friction takes any value
        z = scaled(rig, c.t, c.x, c.v, chambers[:, 1], chambers[:, 2], c.set, c.force, c.surface)
        for name, row in TOLERANCES.items():
            moved = p.copy()
            moved[row] *= 1.01
            z[name] = air(moved)[1] - force
        self.z = {name: column[kept] for name, column in z.items()}
        mass, gravity = rig["cylinder"]["moving_mass_kg"]["value"], rig["cylinder"]["gravity_along_axis_m_per_s2"]
        self.left = (mass * (c.a - gravity) - force + c.force)[kept]


# PySINDy ------------------------------------------------------------------------------------------------------------------

SMALL = ["1", "x", "v", "dir", "v*abs(v)"]
LOADED = [*SMALL, "abs(v)", "x*dir", "x*v", "f", "f*dir", "t", "t*dir", "(p1-p2)", "abs(p1-p2)*dir", *TOLERANCES]
PRODUCTS = ["*".join(pair) for pair in itertools.combinations_with_replacement(VARIABLES, 2)]
LIBRARIES = {
    "small": SMALL,
    "loaded": LOADED,
    "loaded, and boxes of a twentieth of the stroke": [*LOADED, *(f"box(x,{i / 20},{(i + 1) / 20})" for i in range(20))],
    "loaded, and all products of two": [*LOADED, "p1", "set", "surface", *(p for p in PRODUCTS if p not in LOADED and p != "dir*dir")],
}
BETTER = 0.95  # of the error in cross-validation of what was taken so far, below which a larger library is taken


def by_pysindy(lacks):
    """The law by sparse regression, and its account."""
    chosen = None
    for name, terms in LIBRARIES.items():
        columns = [np.column_stack([Law(term)(lack.z) for term in terms]) for lack in lacks]
        equation = Equation(terms, ps.IdentityLibrary)
        equation.discover([(c[:, :1], c[:, 1:], lack.left[:, None]) for c, lack in zip(columns, lacks)])
        if chosen is None or equation.error < BETTER * chosen[1].error:
            chosen = name, equation
    library, equation = chosen
    weights = {term: value["value"] for term, value in equation.terms.items()}
    factors = {name: 1 + 0.01 * weights.pop(name) for name in TOLERANCES if name in weights}
    expression = " + ".join(f"{w:.5g}*{term}" for term, w in weights.items()) or "0.0"
    return Law(expression, factors), {"library": library, "optimizer": equation.row()["optimizer"], "cross_validated_rms_n": float(np.sqrt(equation.error))}


# gplearn ------------------------------------------------------------------------------------------------------------------

OPERATORS = {"add": "+", "sub": "-", "mul": "*"}
TRIED = list(itertools.product((0.001, 0.005), (0, 1)))  # parsimony, random_state
HELD_OUT = 0.2  # the last part of every recording


def written(program, factor):
    """A gplearn program as an expression of ours, times `factor`; str(program) rounds its constants to three decimals."""
    nodes = iter(program)

    def part():
        node = next(nodes)
        if isinstance(node, (int, np.integer)):
            return VARIABLES[node]
        if isinstance(node, float):
            return f"{node:.5g}" if node >= 0 else f"({node:.5g})"
        inner = [part() for _ in range(node.arity)]
        return f"({inner[0]} {OPERATORS[node.name]} {inner[1]})" if node.name in OPERATORS else f"{node.name}({', '.join(inner)})"

    return f"{factor:.5g}*{part()}"


def by_gplearn(lacks):
    """The law by genetic programming, and its account."""
    def gathered(span):
        z = [np.column_stack([lack.z[name] for name in VARIABLES])[span(len(lack.left))] for lack in lacks]
        return np.concatenate(z), np.concatenate([lack.left[span(len(lack.left))] for lack in lacks])

    (x, y), (judged_x, judged_y) = gathered(lambda n: slice(0, int((1 - HELD_OUT) * n))), gathered(lambda n: slice(int((1 - HELD_OUT) * n), n))
    scale, found = float(np.std(y)), []
    for parsimony, seed in TRIED:
        regressor = SymbolicRegressor(
            population_size=2000, generations=20, metric="rmse", function_set=("add", "sub", "mul", "div", "max", "min", "sin", "abs"),
            const_range=(-2.0, 2.0), parsimony_coefficient=parsimony, random_state=seed,
        ).fit(x, y / scale)
        error = data.rms(judged_y - scale * regressor.predict(judged_x))
        found.append((error, regressor._program.length_, parsimony, seed, written(regressor._program.program, scale)))
    best = min(found)[0]
    error, _, parsimony, seed, expression = min((row for row in found if row[0] <= best / BETTER), key=lambda row: (row[1], row[0]))
    return Law(expression), {"parsimony": parsimony, "random_state": seed, "held_out_rms_n": error}


# Prediction ---------------------------------------------------------------------------------------------------------------


def predicted(rig, law, recording):
    """The four channels of a recording from its inputs: the nominal model with `law` as one more force on the piston."""
    par = nominal.pneumatic_parameters(rig)
    for name, factor in law.factors.items():
        par[TOLERANCES[name]] *= min(max(factor, 0.2), 5.0)
    mass, gravity = rig["cylinder"]["moving_mass_kg"]["value"], rig["cylinder"]["gravity_along_axis_m_per_s2"]
    k, damping = rig["contact"]["stiffness_n_per_m"]["value"], rig["contact"]["damping_n_s_per_m"]["value"]
    stop_k, stop_c, length = rig["end_stop"]["stiffness_n_per_m"], rig["end_stop"]["damping_n_s_per_m"], par[nominal.STROKE]
    t = recording["time_s"]
    grid = np.arange(0.0, t[-1] + STEP / 2, STEP)
    held = np.searchsorted(t, grid + 1e-9, side="right") - 1
    command, solenoid = recording["set_pressure_pa"][held], recording["solenoid"][held]
    surface = np.interp(grid, t, np.where(np.isnan(recording["surface_m"]), 1.0, recording["surface_m"]))
    surface_rate = np.gradient(surface, grid)
    state, x, v = nominal.at_rest(par), min(0.0, mass * gravity / stop_k), 0.0
    out = np.empty((len(grid), 4))
    for i, now in enumerate(grid):
        depth = x - surface[i]
        touch = max(k * depth + damping * (v - surface_rate[i]), 0.0) if depth > 0 else 0.0
        stop = max(-stop_k * x - stop_c * v, 0.0) if x < 0 else -max(stop_k * (x - length) + stop_c * v, 0.0) if x > length else 0.0
        z = scaled(rig, now, x, v, state[1], state[2], command[i], touch, surface[i])
        known = nominal.force(state, par) + mass * gravity - touch + stop

        def velocity(direction):
            lacking = float(law(z | {"dir": direction}))
            lacking = min(max(lacking, -1e4), 1e4) if np.isfinite(lacking) else 0.0  # a law that runs away is held
            return v + STEP * (known + lacking) / mass

        # what changes with the direction is dry friction where it brakes, and holds: a direction is taken that the step ends in, else rest
        forth = velocity(1.0)
        back = velocity(-1.0) if forth <= 0 else forth
        new = forth if forth > 0 else back if back < 0 else 0.0
        out[i] = touch, x, state[0], (new - v) / STEP
        v = min(max(new, -20.0), 20.0)
        x = min(max(x + STEP * v, -0.1), length + 0.1)
        nominal.step(state, command[i], solenoid[i], x, v, STEP, par, 2)
    return {name: np.interp(t, grid, out[:, i]) for i, name in enumerate(data.CHANNELS)}


# Cases --------------------------------------------------------------------------------------------------------------------


def one_case(concealed, case):
    """(case, its row without our answer, seconds of both peers)."""
    nominal_rig = data.rig(concealed, case)
    fit, predict = data.case_recordings(concealed, case)
    with data.Clock() as preparing:
        rig = calibrated(nominal_rig, [*fit.values()])
        lacks = [Lack(rig, recording) for recording in fit.values()]
    unseen = lambda law: data.judged(concealed, case, predicted(rig, law, predict))
    true, seconds = judge.true_force(judge.truth_of(concealed, case)), {}
    row = {"rows": sum(len(lack.left) for lack in lacks), "left_rms_n": data.rms(np.concatenate([lack.left for lack in lacks])), "without": unseen(Law("0.0"))}
    if true:
        row["acts_in_balance"], row["true_numbers"] = true[0], true[2]
        row["with_true_term"] = unseen(type("True", (), {"factors": {}, "__call__": lambda _, z: true[3](z, true[2])})())
    for peer, discover in (("pysindy", by_pysindy), ("gplearn", by_gplearn)):
        with data.Clock() as clock:
            law, account = discover(lacks)
            prediction = unseen(law)
        seconds[peer] = {"cpu_s": round(clock.cpu + preparing.cpu, 1), "wall_s": round(clock.wall + preparing.wall, 1)}
        row[peer] = account | {"law_n": law.expression, "factors": law.factors} | judge.judged_law(law, lacks, true) | prediction
        print(f"{case} {peer} {seconds[peer]}: {json.dumps(data.significant(row[peer]))}", flush=True)
    return case, row, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--concealed", type=pathlib.Path, default=data.HERE / "../../../../shared/concealed/beyond")
    parser.add_argument("--answers", type=pathlib.Path, help="folder of our answers")
    parser.add_argument("--jobs", type=int, default=1, help="cases at a time")
    parser.add_argument("--table-only", action="store_true", help="run no peer")
    parser.add_argument("cases", nargs="*")
    args = parser.parse_args()
    cases = args.cases or sorted(p.stem for p in (args.concealed / "practice/truth").glob("case-??.json"))
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {"cases": {}, "seconds": {}}

    def keep():
        RESULTS.write_text(json.dumps(data.significant(results), indent=1, sort_keys=True) + "\n")

    if not args.table_only:
        with ProcessPoolExecutor(args.jobs) as pool:
            for case, row, seconds in pool.map(one_case, [args.concealed] * len(cases), cases):
                results["cases"].setdefault(case, {}).update(row)
                results["seconds"].setdefault(case, {}).update(seconds)
                keep()
    for case in cases if args.answers else []:
        if (args.answers / case / "prediction.csv").exists() and case in results["cases"]:
            results["cases"][case]["ours"], results["seconds"][case]["ours"] = judge.our_answer(args.concealed, args.answers, case)
    keep()
    results = json.loads(RESULTS.read_text())
    rows = "\n".join(judge.table(args.concealed, results))
    filled = f"<!-- beyond: by peers/beyond.py -->\n\n{rows}\n\n<!-- end of beyond -->"
    page, places = re.subn("<!-- beyond: .*?<!-- end of beyond -->", lambda _: filled, PAGE.read_text(), flags=re.S)
    assert places == 1, "PEERS.md has no place for the table"
    PAGE.write_text(page)


if __name__ == "__main__":
    main()

"""PySINDy on the recordings that docs/EVIDENCE.md judges our tool by.

    pysindy_fit.py [--recordings DIR] [--concealed DIR] [--table FILE] [emps cylinder concealed]

Used as its documentation advises ("Practical tips", examples 1, 4, 5 and 13): derivatives by its SmoothedFiniteDifference, inputs as
control variables `u`, a small library of polynomials grown by what the user's field knows (signs, for dry friction), columns normalised,
STLSQ first and SR3 as the alternative with the threshold by cross-validation over contiguous spans of time, the final model unbiased by
its own last step, and EnsembleOptimizer (bagging) for the spread of each coefficient and how often it is chosen.
Of the thresholds the sparsest model within one standard error of the best is taken: the usual rule where a model is to be read.
Rows go to results.json: the equation found, its terms with their spread, error on unseen data, wall and processor seconds.
"""
import math
import warnings

import numpy as np
import pysindy as ps

import nominal
import data

FOLDS = 5
THRESHOLDS = np.logspace(-4, -0.3, 16)  # of a term's share of the target's norm
MODELS = 50  # in the bag
SEED = 20261122


def smoothed(window):
    """PySINDy's own smoother and difference: a Savitzky-Golay of third order over `window` samples."""
    return ps.SmoothedFiniteDifference(smoother_kws={"window_length": window, "polyorder": 3})


def pieces(length, folds=FOLDS):
    """Contiguous spans of an array of `length`."""
    edges = np.linspace(0, length, folds + 1).astype(int)
    return [slice(a, b) for a, b in zip(edges[:-1], edges[1:])]


class Equation:
    """One equation, target = sparse combination of library(x, u), fitted on a list of trajectories.

    `trajectories`: (x, u, target) arrays of shape (n, 1), (n, m), (n, 1). PySINDy takes the target as `x_dot`, its documented door for
    derivatives computed elsewhere; each trajectory is cut into FOLDS spans that serve as test data in turn."""

    def __init__(self, names, library):
        self.names, self.library = names, library

    def _model(self, kind, threshold, norm, bag=False):
        if kind == "STLSQ":
            optimizer = ps.STLSQ(threshold=threshold * norm, alpha=1e-6, normalize_columns=True)
        else:  # SR3's L0 weight for the same threshold: lambda = threshold^2 / (2 nu)
            optimizer = ps.SR3(reg_weight_lam=(threshold * norm) ** 2 / 2, regularizer="L0", normalize_columns=True, unbias=True, max_iter=300)
        if bag:
            optimizer = ps.EnsembleOptimizer(optimizer, bagging=True, n_models=MODELS)
        return ps.SINDy(optimizer=optimizer, feature_library=self.library())

    def _fit(self, model, trajectories):
        x, u, target = (list(part) for part in zip(*trajectories))
        return model.fit(x, t=1.0, x_dot=target, u=u, feature_names=self.names)

    def discover(self, trajectories):
        """Cross-validates both optimizers, keeps the better, fits it on everything, bags it."""
        norm_of = lambda rows: np.sqrt(sum(np.sum(np.square(r[2])) for r in rows))
        spans = [[tuple(part[s] for part in row) for s in pieces(len(row[0]))] for row in trajectories]
        said = set()
        tried = []
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            for kind in ("STLSQ", "SR3"):
                for threshold in THRESHOLDS:
                    errors, size = [], 0
                    for k in range(FOLDS):
                        train = [s for row in spans for i, s in enumerate(row) if i != k]
                        model = self._fit(self._model(kind, threshold, norm_of(train)), train)
                        test = [row[k] for row in spans]
                        errors.append(np.mean(np.concatenate([np.square(s[2] - np.asarray(model.predict(s[0], s[1]))).ravel() for s in test])))
                        size += np.count_nonzero(model.coefficients())
                    tried.append((np.mean(errors), np.std(errors, ddof=1) / np.sqrt(FOLDS), size / FOLDS, kind, threshold))
            best = min(tried, key=lambda row: row[0])
            allowed = [row for row in tried if row[0] <= best[0] + best[1]]
            self.error, _, _, self.kind, self.threshold = min(allowed, key=lambda row: (row[2], row[0]))
            self.model = self._fit(self._model(self.kind, self.threshold, norm_of(trajectories)), trajectories)
            np.random.seed(SEED)
            bag = self._fit(self._model(self.kind, self.threshold, norm_of(trajectories), bag=True), trajectories)
            coefficients = np.array(bag.optimizer.coef_list)[:, 0, :]
            said = {str(w.message).splitlines()[0] for w in heard}
        self.terms = {
            name: {"value": float(value), "spread": float(1.96 * np.std(column)), "chosen": float(np.mean(column != 0))}
            for name, value, column in zip(self.model.get_feature_names(), self.model.coefficients()[0], coefficients.T)
            if value != 0
        }
        self.warnings = sorted(said)
        return self

    def predict(self, x, u):
        return np.asarray(self.model.predict(x, u))

    def row(self):
        target = self.names[0] if not hasattr(self, "target") else self.target
        right = " + ".join(f"{v['value']:.4g} {k}" for k, v in self.terms.items()) or "0"
        return {
            "equation": f"{target} = {right}",
            "terms": self.terms,
            "optimizer": f"{self.kind}, threshold {self.threshold:.2g} of the target's norm",
            "warnings": self.warnings,
        }


def signs(*functions):
    """A CustomLibrary of the given (function, name) pairs, applied to the inputs that GeneralizedLibrary hands it."""
    return ps.CustomLibrary(library_functions=[f for f, _ in functions], function_names=[n for _, n in functions])


SIGN = (lambda v: np.sign(v), lambda v: f"sign({v})")
QUADRATIC = (lambda v: v * np.abs(v), lambda v: f"{v}|{v}|")

# emps: v' = f(v, q, F) ------------------------------------------------------------------------------------------------


def emps(args):
    t, _, position, force = data.emps(args.recordings)
    _, judged_v, judged_a = data.emps_motion(t, position)
    half = len(t) // 2
    differentiate = smoothed(21)  # third order over 21 samples at 1 kHz passes some 70 Hz, as the filter of the judging does
    velocity = np.asarray(differentiate(position[:, None], t))
    acceleration = np.asarray(differentiate(velocity, t))
    libraries = {
        "polynomials": lambda: ps.PolynomialLibrary(degree=2),
        "polynomials and signs": lambda: ps.GeneralizedLibrary(
            [ps.PolynomialLibrary(degree=2), signs(SIGN, QUADRATIC)], inputs_per_library=[[0, 1, 2], [0]]
        ),
    }
    for use, library in libraries.items():
        row = {}
        for span, fitted, judged in (("all", slice(None), slice(None)), ("first_half", slice(0, half), slice(half, None))):
            with data.Clock() as clock:
                u = np.column_stack([position, force])
                equation = Equation(["v", "q", "F"], library)
                equation.target = "v'"
                equation.discover([(velocity[fitted], u[fitted], acceleration[fitted])])

            def accelerated(f):
                return equation.predict(judged_v[judged, None], np.column_stack([position[judged], f]))[:, 0]

            needed = force[judged].copy()  # the force for which the equation gives the measured acceleration, by Newton's method
            for _ in range(4):
                slope = (accelerated(needed + 1.0) - accelerated(needed - 1.0)) / 2
                needed += (judged_a[judged] - accelerated(needed)) / slope
            row[f"fitted_on_{span}"] = {
                **clock.seconds(), **equation.row(),
                "judged_on": "in sample" if span == "all" else "second half",
                "relative_force_error": data.relative_force_error(force[judged], needed),
            }
        data.record(args.table, "pysindy", "emps", use, row)


# cylinder_friction: F = f(p, s, v), an output and not a rate: PySINDy's sparse regression, its target handed over as x_dot --------------


def cylinder(args):
    libraries = {
        "polynomials": (["p_bar", "x_mm", "v_mm_per_s"], lambda: ps.PolynomialLibrary(degree=2)),
        # no squares: two pressures cannot bear p^2, sign^2 is the constant
        "products and sign": (["p_bar", "x_mm", "v_mm_per_s", "sign_v"], lambda: ps.PolynomialLibrary(degree=2, interaction_only=True)),
    }
    for seal in data.SEALS:
        for use, (names, library) in libraries.items():

            def trajectory(bar):
                _, x, v, p, f = data.cylinder(args.recordings, seal, bar)
                inputs = np.column_stack([x * 1e3, v * 1e3, np.sign(v)])[:, : len(names) - 1]
                return p[:, None] * 1e-5, inputs, f[:, None]

            with data.Clock() as clock:
                equation = Equation(names, library)
                equation.target = "F_n"
                equation.discover([trajectory(bar) for bar in data.FITTED_BAR])
            row = {**clock.seconds(), **equation.row()}
            for bar in (*data.FITTED_BAR, *data.JUDGED_BAR):
                x, u, target = trajectory(bar)
                row[f"rms_{bar}_bar_n"] = data.rms(target - equation.predict(x, u))
            data.record(args.table, "pysindy", f"cylinder_friction {seal}", use, row)


# Concealed cases: what is not measured (chamber pressures) is no state, so candidates are computed beforehand (IdentityLibrary). ------------
#
#   data alone   every equation from the channels: p' from set pressure and outlet, v' from outlet, solenoid, stroke, velocity, penetration,
#                the force from penetration, its rate and the force's own rate
#   discrepancy  the nominal model is kept, and PySINDy asked for what it leaves over in each of its three equations: "learning discrepancy
#                models" (Kaheman et al. 2019, one of PySINDy's authors). The nominal chambers run along the measured outlet and stroke.

STEP = 0.0005  # of a prediction [s]
SLOW = 0.005  # sign(v) is tanh(v / SLOW), so that it neither chatters at rest nor on the noise of a differentiated stroke [m/s]
BEYOND = 1e6  # a prediction that runs away is held here


class Channels:
    """A recording's channels, smoothed and differentiated by PySINDy's own method: stroke over 40 ms, for its velocity is a candidate and
    noise in a candidate biases; pressure and force over 10 ms, for they are targets, where noise does not bias but smoothing does."""

    def __init__(self, rig, recording):
        self.t = recording["time_s"]
        column = lambda name: recording[name][:, None]

        def smooth_and_rate(name, seconds):
            rate = smoothed(max(5, 2 * round(seconds / 2 * rig["sensors"]["rate_hz"]) + 1))
            derivative = np.asarray(rate(column(name), self.t))[:, 0]
            return np.asarray(rate.smoothed_x_)[:, 0], derivative

        self.x, self.v = smooth_and_rate("stroke_m", 0.04)
        self.a = recording["acceleration_m_per_s2"]
        self.p, self.p_rate = smooth_and_rate("regulator_pressure_pa", 0.01)
        self.force, self.force_rate = recording["force_n"], smooth_and_rate("force_n", 0.01)[1]
        self.set, self.solenoid = recording["set_pressure_pa"], recording["solenoid"]
        self.surface = np.where(np.isnan(recording["surface_m"]), 1.0, recording["surface_m"])
        self.surface_rate = np.gradient(self.surface, self.t)


def contact_candidates(x, v, surface, surface_rate):
    """Penetration [mm], its square, and the rate while in contact [mm/s]."""
    depth = np.maximum(x - surface, 0.0) * 1e3
    return depth, depth**2, np.where(depth > 0, (v - surface_rate) * 1e3, 0.0)


def sign_of(v):
    return np.tanh(v / SLOW)


class Law:
    """One discovered equation over named candidates; calling it with their values gives its right side."""

    def __init__(self, target, candidates):
        self.equation = Equation(list(candidates), ps.IdentityLibrary)
        self.equation.target = target

    def learn(self, rows):
        self.equation.discover([(z[:, :1], z[:, 1:], y[:, None]) for z, y in rows])
        self.weights = np.array([self.equation.terms.get(name, {"value": 0.0})["value"] for name in self.equation.names])
        return self

    def __call__(self, *candidates):
        return float(np.dot(self.weights, candidates))


REGULATOR = ("1", "set", "p", "|set-p|", "sign(set-p)", "v")
SENSOR = ("1", "depth", "depth^2", "depth_rate", "F'", "t")
BALANCE_ALONE = ("1", "x", "v", "sign(v)", "v|v|", "p sol", "p (1-sol)", "sol", "p x sol", "depth", "depth_rate")
BALANCE_LEFT = ("1", "x", "v", "sign(v)", "v|v|", "|dp| sign(v)", "dp")  # not v': its noise is in the target too


def regulator_candidates(c):
    """Pressures in bar."""
    return np.column_stack([np.ones_like(c.t), c.set * 1e-5, c.p * 1e-5, np.abs(c.set - c.p) * 1e-5, np.tanh((c.set - c.p) / 2e3), c.v])


def sensor_candidates(c):
    return np.column_stack([np.ones_like(c.t), *contact_candidates(c.x, c.v, c.surface, c.surface_rate), c.force_rate, c.t])


def between_stops(rig, c):
    """Samples off the end stops, whose impacts would outweigh all else; a prediction keeps the nominal stops."""
    return (c.x > 1e-3) & (c.x < rig["cylinder"]["stroke_m"] - 1e-3)


def alone(rig, channels):
    """The three equations from the channels alone."""
    def balance(c):
        depth, _, depth_rate = contact_candidates(c.x, c.v, c.surface, c.surface_rate)
        p = c.p * 1e-5
        return np.column_stack([
            np.ones_like(c.t), c.x, c.v, sign_of(c.v), c.v * np.abs(c.v), p * c.solenoid, p * (1 - c.solenoid), c.solenoid, p * c.x * c.solenoid,
            depth, depth_rate,
        ])[between_stops(rig, c)]

    return {
        "regulator": Law("p' [bar/s]", REGULATOR).learn([(regulator_candidates(c), c.p_rate * 1e-5) for c in channels]),
        "balance": Law("v' [m/s2]", BALANCE_ALONE).learn([(balance(c), c.a[between_stops(rig, c)]) for c in channels]),
        "sensor": Law("F [N]", SENSOR).learn([(sensor_candidates(c), c.force) for c in channels]),
    }


def left_over(rig, channels):
    """The three equations of what the nominal model leaves over."""
    p = nominal.pneumatic_parameters(rig)
    mass, gravity = rig["cylinder"]["moving_mass_kg"]["value"], rig["cylinder"]["gravity_along_axis_m_per_s2"]
    k, damping = rig["contact"]["stiffness_n_per_m"]["value"], rig["contact"]["damping_n_s_per_m"]["value"]
    regulator, balance, sensor = [], [], []
    outlet = p.copy()
    outlet[[nominal.GAIN, nominal.TAU]] = 1.0, 1e-6  # the chambers see the measured outlet
    for c in channels:
        regulator.append((regulator_candidates(c), (c.p_rate - (p[nominal.GAIN] * c.set - c.p) / p[nominal.TAU]) * 1e-5))
        chambers = nominal.along(c.t, c.p, c.solenoid, c.x, c.v, outlet, 20)
        dp = (chambers[:, 1] - chambers[:, 2]) * 1e-5
        air = chambers[:, 1] * p[nominal.AREA1] - chambers[:, 2] * p[nominal.AREA2] - p[nominal.AIR] * (p[nominal.AREA1] - p[nominal.AREA2])
        left = mass * (c.a - gravity) - air + c.force
        moving = between_stops(rig, c) & (np.abs(c.v) > SLOW)
        z = np.column_stack([np.ones_like(c.t), c.x, c.v, sign_of(c.v), c.v * np.abs(c.v), np.abs(dp) * sign_of(c.v), dp])
        balance.append((z[moving], left[moving]))
        depth, _, depth_rate = contact_candidates(c.x, c.v, c.surface, c.surface_rate)
        sensor.append((sensor_candidates(c), c.force - np.maximum(k * depth * 1e-3 + damping * depth_rate * 1e-3, 0)))
    return {
        "regulator": Law("p' left over [bar/s]", REGULATOR).learn(regulator),
        "balance": Law("force left over [N]", BALANCE_LEFT).learn(balance),
        "sensor": Law("F left over [N]", SENSOR).learn(sensor),
    }


def predicted(rig, laws, recording, discrepancy):
    """The recording's four channels, stepped through the discovered equations (and the nominal ones where they were kept)."""
    par = nominal.pneumatic_parameters(rig)
    mass, gravity = rig["cylinder"]["moving_mass_kg"]["value"], rig["cylinder"]["gravity_along_axis_m_per_s2"]
    k, damping = rig["contact"]["stiffness_n_per_m"]["value"], rig["contact"]["damping_n_s_per_m"]["value"]
    stop_k, stop_c, length = rig["end_stop"]["stiffness_n_per_m"], rig["end_stop"]["damping_n_s_per_m"], par[nominal.STROKE]
    t = recording["time_s"]
    grid = np.arange(0.0, t[-1] + STEP / 2, STEP)
    held = np.searchsorted(t, grid + 1e-9, side="right") - 1
    command, solenoid = recording["set_pressure_pa"][held], recording["solenoid"][held]
    surface = np.interp(grid, t, np.where(np.isnan(recording["surface_m"]), 1.0, recording["surface_m"]))
    surface_rate = np.gradient(surface, grid)
    outlet = par.copy()
    outlet[[nominal.GAIN, nominal.TAU]] = 1.0, 1e-6
    state, x, v, p, force = nominal.at_rest(par), min(0.0, mass * gravity / stop_k), 0.0, 0.0, 0.0
    lag = -laws["sensor"].weights[SENSOR.index("F'")]  # F = rest - lag F'
    weights = laws["sensor"].weights.copy()
    weights[SENSOR.index("F'")] = 0.0
    reaction_weights = weights[1:4]
    out = np.empty((len(grid), 4))
    for i, now in enumerate(grid):
        gap_rate = v - surface_rate[i]
        depth = max(x - surface[i], 0.0) * 1e3
        candidates = np.array([depth, depth**2, gap_rate * 1e3 if depth > 0 else 0.0])
        steady = weights[0] + weights[5] * now + reaction_weights @ candidates
        sign = sign_of(v)
        stop = max(-stop_k * x - stop_c * v, 0.0) if x < 0 else -max(stop_k * (x - length) + stop_c * v, 0.0) if x > length else 0.0
        if discrepancy:
            touch = max(k * depth * 1e-3 + damping * candidates[2] * 1e-3, 0.0)
            steady += touch
            touch = max(touch + reaction_weights @ candidates, 0.0) if depth > 0 else 0.0
            dp = (state[1] - state[2]) * 1e-5
            known = nominal.force(state, par) + mass * gravity - touch + stop
            a = (known + laws["balance"](1.0, x, v, sign, v * abs(v), abs(dp) * sign, dp)) / mass
        else:
            bar = p * 1e-5
            on = solenoid[i]
            a = laws["balance"](1.0, x, v, sign, v * abs(v), bar * on, bar * (1 - on), on, bar * x * on, depth, candidates[2])
            a += stop / mass
        force = steady if lag <= STEP else force + (steady - force) * (1 - math.exp(-STEP / lag))
        out[i] = force, x, p, a
        ahead = command[i] - p
        p_rate = laws["regulator"](1.0, command[i] * 1e-5, p * 1e-5, abs(ahead) * 1e-5, math.tanh(ahead / 2e3), v) * 1e5
        if discrepancy:
            p_rate += (par[nominal.GAIN] * command[i] - p) / par[nominal.TAU]
        p = min(max(p + STEP * p_rate, -1e5), 2e6)
        v = min(max(v + STEP * a, -20.0), 20.0)
        x = min(max(x + STEP * v, -BEYOND), BEYOND)
        if discrepancy:
            nominal.step(state, p, solenoid[i], x, v, STEP, outlet, 2)
    return {name: np.interp(t, grid, out[:, i]) for i, name in enumerate(data.CHANNELS)}


def concealed(args):
    for kind, case in data.six_cases(args.concealed).items():
        one_case(args, kind, case)


def one_case(args, kind, case):
    rig = data.rig(args.concealed, case)
    fit, predict = data.case_recordings(args.concealed, case)
    for use, learn in (("data alone", alone), ("discrepancy", left_over)):
        with data.Clock() as clock:
            laws = learn(rig, [Channels(rig, recording) for recording in fit.values()])
            by_name = predicted(rig, laws, predict, use == "discrepancy")
        row = {**clock.seconds(), "kind": kind, "truth": data.truth_of(args.concealed, case)}
        row["equations"] = {name: law.equation.row() for name, law in laws.items()}
        data.record(args.table, "pysindy", case, use, row | data.judged(args.concealed, case, by_name))


SUBJECTS = {"emps": emps, "cylinder": cylinder, "concealed": concealed}

if __name__ == "__main__":
    args = data.arguments(__doc__, list(SUBJECTS))
    for subject in args.subjects:
        SUBJECTS[subject](args)

"""PySINDy on the recordings that docs/EVIDENCE.md judges our tool by.

    pysindy_fit.py [--recordings DIR] [--concealed DIR] [--table FILE] [emps cylinder concealed]

Used as its documentation advises ("Practical tips", examples 1, 4, 5 and 13): derivatives by its SmoothedFiniteDifference, inputs as
control variables `u`, a small library of polynomials grown by what the user's field knows (signs, for dry friction), columns normalised,
STLSQ first and SR3 as the alternative with the threshold by cross-validation over contiguous spans of time, the final model unbiased by
its own last step, and EnsembleOptimizer (bagging) for the spread of each coefficient and how often it is chosen.
Of the thresholds the sparsest model within one standard error of the best is taken: the usual rule where a model is to be read.
Rows go to results.json: the equation found, its terms with their spread, error on unseen data, wall and processor seconds.
"""
import warnings

import numpy as np
import pysindy as ps

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


SUBJECTS = {"emps": emps, "cylinder": cylinder}

if __name__ == "__main__":
    args = data.arguments(__doc__, list(SUBJECTS))
    for subject in args.subjects:
        SUBJECTS[subject](args)

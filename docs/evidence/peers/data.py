"""What both peers share: the recordings as arrays, the measures they are judged by, and the table they write.

Nothing here knows MuJoCo or PySINDy. All values SI, angles none. The folders are given on the command line:
    --recordings ../shared/recordings    emps/, cylinder_friction/ (their README.md names the public sources)
    --concealed  ../shared/concealed     practice/cases/, practice/truth/
The truth of a practice case is read for choosing the six cases and for judging an answer, never by a fit.
"""
import argparse
import json
import math
import pathlib
import resource
import time
import tomllib

import numpy as np
from scipy.signal import butter, medfilt, sosfiltfilt

HERE = pathlib.Path(__file__).resolve().parent

# The six concealed cases are the lowest-numbered practice case whose only effect has the name, fixed before any result was looked at.
KINDS = {
    "friction": "coulomb_viscous_friction",
    "hose": "hose_volume",
    "regulator delay": "transport_delay",
    "sensor lag": "force_sensor_lag",
    "contact stiffness": "contact_stiffness_error",
    "unlisted": "unlisted",
}
CHANNELS = ("force_n", "stroke_m", "regulator_pressure_pa", "acceleration_m_per_s2")


def arguments(doc, names):
    """The command line common to both scripts: folders, and which subjects to run."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--recordings", type=pathlib.Path, default=HERE / "../../../../shared/recordings")
    parser.add_argument("--concealed", type=pathlib.Path, default=HERE / "../../../../shared/concealed")
    parser.add_argument("--table", type=pathlib.Path, default=HERE / "results.json")
    parser.add_argument("subjects", nargs="*", default=names, help=f"of: {' '.join(names)} (default: all)")
    return parser.parse_args()


class Clock:
    """Wall and processor seconds of a `with` block [s]."""

    def __enter__(self):
        self._wall, self._cpu = time.perf_counter(), self._processor()
        return self

    def __exit__(self, *_):
        self.wall, self.cpu = time.perf_counter() - self._wall, self._processor() - self._cpu

    @staticmethod
    def _processor():
        used = resource.getrusage(resource.RUSAGE_SELF)
        return used.ru_utime + used.ru_stime

    def seconds(self):
        return {"wall_s": round(self.wall, 2), "cpu_s": round(self.cpu, 2)}


def significant(value, digits=4):
    """`value` with its floats rounded to `digits` significant digits, for a table that reads and compares well."""
    if isinstance(value, dict):
        return {k: significant(v, digits) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [significant(v, digits) for v in value]
    if isinstance(value, (float, np.floating)):
        return float(f"{value:.{digits}g}") if math.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value


def record(table, tool, subject, use, row):
    """Puts one row into the JSON table beside those that are there already."""
    rows = json.loads(table.read_text()) if table.exists() else {}
    rows.setdefault(tool, {}).setdefault(subject, {})[use] = significant(row)
    part = table.with_suffix(".part")
    part.write_text(json.dumps(rows, indent=1, sort_keys=True) + "\n")
    part.replace(table)
    print(f"{tool} / {subject} / {use}: {json.dumps(significant(row))}", flush=True)


# emps ---------------------------------------------------------------------------------------------------------------

EMPS_MASS = 95.11  # nominal moving mass [kg]
EMPS_FORCE_PER_VOLT = 35.15065  # motor force per volt of controller output [N/V]
EMPS_KP, EMPS_KV = 160.18, 243.45  # the known loop: position gain [1/s], velocity gain [V/(m/s)]
EMPS_DROPPED = 50  # samples left out at each end


def emps(recordings):
    """time, reference, position, force of the EMPS axis [s, m, m, N], 1 kHz."""
    rows = np.genfromtxt(recordings / "emps/emps_train.csv", delimiter=",", skip_header=1)
    return rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 4]


def emps_motion(t, position):
    """Position, velocity, acceleration through a zero-phase fourth-order Butterworth at 80 Hz and central differences.
    With it plain regressions give the README's 69.6, 17.1, 4.4 and 3.5 %, so this is the filter that its table used or its equal."""
    smooth = sosfiltfilt(butter(4, 80, fs=1000, output="sos"), position)
    velocity = np.gradient(smooth, t)
    return smooth, velocity, np.gradient(velocity, t)


def relative_force_error(force, predicted):
    """norm(residual) / norm(force), EMPS_DROPPED samples dropped at each end."""
    inner = slice(EMPS_DROPPED, -EMPS_DROPPED)
    return float(np.linalg.norm((force - predicted)[inner]) / np.linalg.norm(force[inner]))


# cylinder_friction --------------------------------------------------------------------------------------------------

BORE_AREA = math.pi / 4 * 0.025**2  # nominal piston area [m2]
SEALS = {"O-ring": "O-ring", "KDN": "KDN"}
FITTED_BAR, JUDGED_BAR = (1, 7), (3, 5)


def cylinder(recordings, seal, bar):
    """time [s], position as smoothed for direction [m], its velocity [m/s], pressure [Pa gauge], force [N]; first 15 rows dropped.
    Position: spikes out by a median of 5 samples, then zero-phase 1 Hz on a 10 ms grid, because its direction decides the sign of friction."""
    rows = np.loadtxt(recordings / f"cylinder_friction/{seal}_{bar}bar.csv")[15:]
    t = rows[:, 0] * 1e-3
    keep = np.concatenate([[True], np.diff(np.maximum.accumulate(t)) > 0])
    t, rows = t[keep] - t[keep][0], rows[keep]
    grid = np.arange(0.0, t[-1] + 0.01, 0.01)
    smooth = sosfiltfilt(butter(2, 1.0, fs=100, output="sos"), np.interp(grid, t, medfilt(rows[:, 4] * 1e-3, 5)))
    velocity = np.gradient(smooth, grid)
    return t, np.interp(t, grid, smooth), np.interp(t, grid, velocity), rows[:, 5] * 1e5, rows[:, 6]


def rms(residual):
    return float(np.sqrt(np.mean(np.square(residual))))


# concealed cases ----------------------------------------------------------------------------------------------------


def six_cases(concealed):
    """{kind: case name}, by the rule above KINDS."""
    chosen = {}
    for path in sorted((concealed / "practice/truth").glob("case-*.json")):
        effects = json.loads(path.read_text())["effects"]
        for kind, name in KINDS.items():
            if kind not in chosen and len(effects) == 1 and effects[0]["name"] == name:
                chosen[kind] = path.stem
    return {kind: chosen[kind] for kind in KINDS}


def rig(concealed, case):
    return tomllib.loads((concealed / f"practice/cases/{case}/rig.toml").read_text())


def columns(path):
    """{column: array} of a recording, lost samples NaN."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    return {name: table[name] for name in table.dtype.names}


def case_recordings(concealed, case):
    folder = concealed / f"practice/cases/{case}"
    fit = {p.removesuffix(".csv"): columns(folder / p) for p in rig(concealed, case)["recordings"]["fit"]}
    return fit, columns(folder / "predict.csv")


def judged(concealed, case, predicted):
    """90th percentile of |residual| / noise by channel, as score.py measures it: {channel: p90}, and the worst."""
    truth = json.loads((concealed / f"practice/truth/{case}.json").read_text())
    measured = columns(concealed / f"practice/truth/{case}.predict.csv")
    by_channel = {}
    for channel, noise in truth["noise"].items():
        error = np.abs(predicted[channel] - measured[channel])[~np.isnan(measured[channel])] / noise
        error = np.sort(np.where(np.isfinite(error), error, 1e6))
        by_channel[channel] = float(error[int(0.9 * (len(error) - 1))])
    return {"p90_by_channel": by_channel, "worst_p90": max(by_channel.values())}


def truth_of(concealed, case):
    """What was concealed, for judging: its name and parameters."""
    effects = json.loads((concealed / f"practice/truth/{case}.json").read_text())["effects"]
    return {e["truth"]: e["parameters"] for e in effects}

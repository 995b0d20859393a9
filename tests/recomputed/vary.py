"""Sweeps a scenario and works out anew what vary.json says of its table: quantiles, rank correlations, and each variable's share of each number's variance."""

import json
import re
import math
import sys

import numpy as np
import pandas as pd

import common
from common import Checked

KEYS = ["process.force_n", "contact.stiffness_n_per_m", "workpiece.misplacement.shift_mm", "simulation.seed"]
SWEEP = ["vary", "scenarios/plate_edge_ideal.toml", "--sample", "latin:40", "--set", "process.force_n=120..180", "--set", "contact.stiffness_n_per_m=1e5..3e5",
         "--set", "workpiece.misplacement.shift_mm=-1..1", "--set", "simulation.seed=1..200", "--set", "workpiece.edge.end_mm=40"]
DEGREES, TURNS = (1, 2, 3, 4, 6, 8), 1000


def scores(x):
    """Ranks from -1 to 1; those of equal values are their mean."""
    return (2 * (pd.Series(x).rank() - 0.5) / len(x) - 1).to_numpy()


def groups(x):
    values, place, counts = np.unique(x, return_inverse=True, return_counts=True)
    if len(values) < 2:
        return None
    if len(values) <= 30 and len(x) >= 2 * len(values):
        return place
    before = np.concatenate([[0], np.cumsum(counts)[:-1]])
    many = min(max(len(x) // 5, 2), 20)
    return ((before + counts // 2) * many // len(x))[place]


def within(z, group):
    counts = np.bincount(group)
    means = np.bincount(group, z) / np.maximum(counts, 1)
    return ((z - means[group]) ** 2).sum() / (len(z) - np.count_nonzero(counts))


def parted(columns, y):
    """The number less what the others do, by variable, and less what all do: a sum of Legendre polynomials of ranks, each run predicted by the others."""
    n, count = len(y), len(columns)
    least, best = (((y - y.mean()) * n / (n - 1)) ** 2).sum(), None
    for degree in DEGREES:
        own = [min(degree, len(np.unique(x)) - 1) for x in columns]
        if (1 + sum(own)) * 4 > n:
            break
        basis = [np.ones((n, 1))] + [np.polynomial.legendre.legvander(scores(x), d)[:, 1:] for x, d in zip(columns, own)]
        rows = np.hstack(basis)
        inverse = np.linalg.inv(rows.T @ rows + 1e-9 * n * np.eye(rows.shape[1]))
        fit = inverse @ (rows.T @ y)
        left_out = (y - rows @ fit) / (1 - np.einsum("ij,jk,ik->i", rows, inverse, rows))
        if (left_out**2).sum() < least:
            # Coefficients of each run without it.
            each = fit - (rows @ inverse) * left_out[:, None]
            starts = np.cumsum([1] + own)
            does = np.stack([(rows[:, a:b] * each[:, a:b]).sum(1) for a, b in zip(starts[:-1], starts[1:])], 1) if count else None
            rest = y - (rows * each).sum(1)
            least, best = (left_out**2).sum(), ([rest + does[:, k] for k in range(count)], rest)
    return best or ([y] * count, y)


def shares(columns, y):
    """Share, interval and what a shuffled variable gets, by variable."""
    random = np.random.default_rng(1)
    without, rest = parted(columns, y)
    found = []
    for x, z in zip(columns, without):
        group = groups(x)
        if group is None:
            found.append(None)
            continue
        r = rest if within(rest, group) < within(z, group) else z

        def index(rows, r=r, z=z, group=group):
            return (z[rows].var(ddof=1) - within(r[rows], group[rows])) / y[rows].var(ddof=1)

        value = index(np.arange(len(y)))
        turns = np.array([index(random.integers(0, len(y), len(y))) for _ in range(TURNS)])
        shuffled = [(z.var(ddof=1) - within(z, random.permutation(group))) / y.var(ddof=1) for _ in range(TURNS)]
        low, high = np.quantile(turns, [0.025, 0.975]) - turns.mean() + value
        found.append([float(np.clip(v, 0, 1)) for v in (value, low, high, np.quantile(shuffled, 0.95))])
    together = sum(share[0] for share in found if share)
    return [share and [v / max(together, 1.0) for v in share] for share in found]


def main():
    folder, checked = common.RESULTS / "vary", Checked("vary")
    printed = common.run(*SWEEP, "--out", folder, "--force")
    table = pd.read_parquet(folder / "runs.parquet")
    result = json.loads((folder / "vary.json").read_text())
    columns = [table[key].to_numpy(float) for key in KEYS]
    for key, x in zip(KEYS, columns):
        variable = next(v for v in result["variables"] if v["key"] == key)
        checked.fact(f"{key}: ends", variable["ends"], [x.min(), x.max()])
        whole = key == "simulation.seed"
        checked.fact(f"{key}: whole numbers", (variable["which"], bool((x == np.round(x)).all())), ("whole numbers" if whole else "any number between", whole))
    ranks = np.corrcoef(np.argsort(np.argsort(columns[:3], axis=1), axis=1))
    checked.fact("ranks of the points do not correlate", bool(np.abs(ranks - np.eye(3)).max() < 0.1), True)
    for metric in result["metrics"]:
        name, y = metric["name"], table[metric["name"]].to_numpy(float)
        known = np.isfinite(y)
        checked.fact(f"{name}: runs", metric["runs"], int((~np.isnan(y)).sum()))
        for share, value in metric["quantiles"]:
            checked.exact(f"{name}: {share}", value, float(np.quantile(y[~np.isnan(y)], share)), relative=1e-7)
        if not metric["drivers"]:
            spread = y[known].max() - y[known].min() if known.any() else 0.0
            checked.fact(f"{name}: stands still, or few runs", known.sum() < 10 or spread <= 1e-12 * np.abs(y[known]).max(), True)
            continue
        found = dict(zip(KEYS, shares([x[known] for x in columns], y[known])))
        together = sum(driver["share"] for driver in metric["drivers"])
        checked.fact(f"{name}: together at most 1", together <= 1 + 1e-9, True)
        for driver in metric["drivers"]:
            if driver["key"] not in found:
                continue
            where, x = f"{name}: {driver['key']}", columns[KEYS.index(driver["key"])]
            value, low, high, shuffled = found[driver["key"]]
            checked.exact(f"{where}: share", driver["share"], value, relative=1e-5) if value > 1e-6 else checked.fact(where, driver["share"] < 1e-5, True)
            # Drawn at random by either program: to what 400 turns tell.
            for what, one, other in (("low", driver["interval"][0], low), ("high", driver["interval"][1], high), ("shuffled", driver["shuffled"], shuffled)):
                checked.fact(f"{where}: {what}, {one:.3f} where {other:.3f} is worked out", abs(one - other) < 0.02 + 0.25 * abs(high - low) + 0.25 * shuffled, True)
            correlation = pd.Series(x[known]).rank().corr(pd.Series(y[known]).rank())
            checked.exact(f"{where}: rank correlation", driver["rank_correlation"], None if math.isnan(correlation) else float(correlation), relative=1e-7)
            if driver["key"] == "simulation.seed":
                # The ideal device has no noise: the seed does nothing.
                checked.fact(f"{where}: is named", driver["interval"][0] > driver["shuffled"], False)
    mean = next(m for m in result["metrics"] if m["name"] == "force_mean_n")
    checked.fact("force: named first in the text", re.search(r"Force, mean: .*?driven by (\w+)", " ".join(printed.split()))[1] == "force", True)
    checked.fact("force drives its mean", (mean["drivers"][0]["key"], mean["drivers"][0]["share"] > 0.98), ("process.force_n", True))
    for line in checked.wrong:
        print(line, file=sys.stderr)
    print(f"vary: {checked.compared} numbers, {len(checked.wrong)} wrong")
    return 1 if checked.wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""How the laws and answers of beyond.py are judged against the truth, and the table of PEERS.md. No fit reads anything here.

The rule for a law of a peer, where something acts in the balance of forces:
    form right      no variable but the truth's carries more than SHARE of the law's variance, each of the truth's carries at least half of what
                    it carries in the true force, and the law's squared correlation with that force is at least ALIKE; all this over the samples
                    that the law was fitted to. "With others beside it": the same, but for other variables that carry more; on these samples they
                    cancel, or the correlation would not be there
    numbers right   the truth's form, fitted to the law by least squares beside a constant, has each of its numbers within NUMBER of the true one
An answer of ours is judged as score.py does: effects, links and variables right; its numbers are compared one by one, by OURS.
"""
import json
import re

import numpy as np
from scipy.optimize import least_squares

import data

SHARE, ALIKE, NUMBER = 0.1, 0.9, 0.1
GROUPS = {"x": "stroke_m", "v": "velocity", "dir": "velocity", "t": "time", "p1": "p1", "p2": "p2", "set": "set_pressure", "f": "contact_force",
          "surface": "surface"}  # what an expression's variable is to a reader; dir, the direction, is a function of the velocity


def ramp(x, at, width):
    return np.clip((x - at) / width + 0.5, 0.0, 1.0)


# Truths that are forces on the piston: variables, numbers as (unit, its text in the formula or key of the parameters), law(z, numbers).
IN_BALANCE = {
    "friction_grows_outwards": (
        {"stroke_m", "velocity"}, {"f": ("N", r"f = ([\d.]+)")}, lambda z, n, c=1.5: -(c + n["f"] * z["x"]) * z["dir"],
    ),
    "snag": (
        {"stroke_m"}, {"f": ("N", r"f = ([\d.]+)"), "from": ("m", r"([\d.]+) m <"), "to": ("m", r"stroke < ([\d.]+)")},
        lambda z, n: -n["f"] * (ramp(z["x"], n["from"] / 0.05, 0.012) - ramp(z["x"], n["to"] / 0.05, 0.012)),
    ),
    "drag_of_extension": ({"velocity"}, {"c": ("N s/m", r"c = ([\d.]+)")}, lambda z, n: -n["c"] * 0.1 * np.maximum(z["v"], 0)),
    "coulomb_viscous_friction": (
        {"velocity"}, {"coulomb": ("N", "coulomb_force_n"), "viscous": ("N s/m", "viscous_coefficient_n_s_per_m")},
        lambda z, n: -(n["coulomb"] * z["dir"] + n["viscous"] * 0.1 * z["v"]),
    ),
}


def true_force(truth):
    """(name, variables, numbers, law) of what in a case acts in the balance of forces; None where nothing does."""
    for effect in truth["effects"]:
        if effect["truth"] in IN_BALANCE:
            variables, numbers, law = IN_BALANCE[effect["truth"]]
            value = lambda key: effect["parameters"][key] if key in effect["parameters"] else float(re.search(key, effect["formula"])[1])
            return effect["truth"], variables, {name: value(key) for name, (_, key) in numbers.items()}, law
    return None


def judged_law(law, lacks, true):
    """The variables that the law rests on; beside the true force, if there is one, whether its form is right and its numbers are."""
    z = {name: np.concatenate([lack.z[name] for lack in lacks]) for name in GROUPS}
    order = np.random.default_rng(0).permutation(len(z["x"]))

    def shares(law):
        """Total effect of each variable on a law: half the mean square of what its shuffling changes, over the law's variance."""
        value = law(z)
        moved = {g: law(z | {name: z[name][order] for name in GROUPS if GROUPS[name] == g}) for g in dict.fromkeys(GROUPS.values())}
        return {g: float(np.mean((shuffled - value) ** 2) / 2 / max(np.var(value), 1e-9)) for g, shuffled in moved.items()}

    value, found = law(z), shares(law)
    row = {"rests_on": {g: share for g, share in sorted(found.items(), key=lambda s: -s[1]) if share > SHARE}}
    if true:
        _, variables, numbers, form = true
        truth, due = form(z, numbers), shares(lambda z: form(z, numbers))
        row["alike"] = float(np.corrcoef(value, truth)[0, 1] ** 2) if np.var(value) > 0 else 0.0
        row["lacks"] = sorted(g for g in variables if found[g] < due[g] / 2)
        row["form_right"] = set(row["rests_on"]) <= variables and not row["lacks"] and row["alike"] >= ALIKE
        row["share_of_truth"] = float(1 - np.mean((value - truth) ** 2) / np.mean(truth**2))
        start = np.array([*numbers.values()])
        fit = least_squares(lambda q: form(z, dict(zip(numbers, q[1:] * start))) + q[0] - value, [0.0, *np.ones(len(start))], diff_step=0.01)
        row["numbers"] = dict(zip(numbers, fit.x[1:] * start))
        row["numbers_right"] = bool(np.all(np.abs(fit.x[1:] - 1) <= NUMBER))
    return row


# Numbers of a truth -> how an answer of ours has them: parameter, factor to the truth's. Not compared where the answer has other parameters.
OURS = {
    "friction_grows_outwards": {r"f = ([\d.]+)": ("gain", 0.05)},
    "snag": {r"f = ([\d.]+)": ("height", -1), r"([\d.]+) m <": ("from", 1), r"stroke < ([\d.]+)": ("to", 1)},
    "drag_of_extension": {r"c = ([\d.]+)": ("gain", -1)},
    "stroke_bends": {r"a = ([\d.e-]+)": ("height", 1)},
    "outlet_jumps": {r"a = ([\d.]+)": ("height", 1), r"t0 = ([\d.]+)": ("threshold", 1)},
    "part_warms": {r"r = ([\d.e-]+)": ("gain", 1)},
    "dead_zone": {r"d = ([\d.]+)": ("limit", 1)},
    "load_cell_dead_band": {r"d = ([\d.]+)": ("limit", 1)},
    "regulator_ripple": {r"a = ([\d.]+)": ("height", 1), r"f = ([\d.]+)": ("frequency", 1)},
    "worn_bore": {r"a = ([\d.e-]+)": ("height", 1), r"x0 = ([\d.]+)": ("threshold", 1)},
}


def truth_of(concealed, case):
    truth = json.loads((concealed / f"practice/truth/{case}.json").read_text())
    del truth["mismatch"]
    return truth


def our_answer(concealed, answers, case):
    """Our answer, judged by score.py's rule for names, link and variables; numbers within a tenth of the truth's."""
    truth = truth_of(concealed, case)
    answer = json.loads((answers / case / "diagnosis.json").read_text())
    found = {e["name"]: e for e in answer["effects"]}
    row = {"says": "; ".join(e.get("formula") or e["name"] + ": " + ", ".join(f"{k} = {v['value']:.4g}" for k, v in e["parameters"].items()) for e in answer["effects"])}
    row["form_right"] = sorted(found) == sorted(e["name"] for e in truth["effects"]) and all(
        found[e["name"]]["subsystem"] == e["subsystem"]
        and (e["name"] != "unlisted" or set(e["parameters"]["depends_on"]) <= set(found["unlisted"]["depends_on"]) and len(found["unlisted"]["depends_on"]) <= 3)
        for e in truth["effects"]
    )
    numbers = []
    for effect in truth["effects"] if row["form_right"] else []:
        got = found[effect["name"]]["parameters"]
        if effect["name"] == "unlisted":
            sought = {name: (factor, float(re.search(key, effect["formula"])[1])) for key, (name, factor) in OURS[effect["truth"]].items()}
        else:
            sought = {name: (1, value) for name, value in effect["parameters"].items()}
        numbers += [abs(got[name]["value"] * factor / value - 1) if name in got else None for name, (factor, value) in sought.items()]
    row["largest_error_of_numbers"] = None if None in numbers else max(numbers, default=None)
    return row | data.judged(concealed, case, data.columns(answers / case / "prediction.csv")), {"wall_s": round(answer["seconds"], 1)}


def worst(row):
    channel = max(row["p90_by_channel"], key=row["p90_by_channel"].get)
    return f"{row['worst_p90']:.3g} ({channel.split('_')[0]})"


def peer_cell(row, true, true_numbers):
    law = re.sub(r"\*1(?= |$)", "", row["law_n"]).replace("+ -", "- ")
    law = law if len(law) <= 130 else law[:127] + "..."
    factors = "".join(f"; {name} orifice times {factor:.3g}" if name != "dead" else f"; dead volume times {factor:.3g}" for name, factor in row["factors"].items())
    if true is None:
        return f"`{law}`{factors}: not in the balance"
    others = [variable for variable in row["rests_on"] if variable not in IN_BALANCE[true][0]]
    if row["form_right"]:
        verdict = "form **right**"
    elif row["alike"] >= ALIKE and not row["lacks"]:
        verdict = f"form **right, with others beside it** ({', '.join(others)})"
    else:
        verdict = f"form not right (alike {row['alike']:.2f}; rests on {', '.join(row['rests_on']) or 'nothing'})"
    numbers = ", ".join(f"{name} {value:.4g} for {true_numbers[name]:.4g}" for name, value in row["numbers"].items())
    return f"`{law}`{factors}: {verdict}" + (f"; numbers {'right' if row['numbers_right'] else 'not right'}: {numbers}" if row["alike"] >= ALIKE else "")


def our_cell(row):
    error = row["largest_error_of_numbers"]
    numbers = "" if not row["form_right"] else "; numbers not compared: other parameters" if error is None else f"; numbers {'right' if error <= NUMBER else 'not right'}, to {100 * error:.2g} %"
    return f"`{row['says']}`: form {'**right**' if row['form_right'] else 'not right'}{numbers}"


def table(concealed, results):
    """The table of PEERS.md: what acts in the balance first."""
    yield "| case: truth | without, *with the true term* | PySINDy finds | unseen | s CPU | gplearn finds | unseen | s CPU | ours finds | unseen | s wall |"
    yield "| --- " * 11 + "|"
    rows, seconds = results["cases"], results["seconds"]
    for case in sorted(rows, key=lambda c: ("acts_in_balance" not in rows[c], c)):
        row, in_balance = rows[case], "acts_in_balance" in rows[case]
        effects = truth_of(concealed, case)["effects"]
        said = "; ".join(e.get("formula") or e["truth"] + ": " + ", ".join(f"{k} = {v:.4g}" for k, v in e["parameters"].items()) for e in effects)
        cells = [f"{case}: {said}", worst(row["without"]) + (f", *{worst(row['with_true_term'])}*" if in_balance else "")]
        for peer in ("pysindy", "gplearn"):
            cells += [peer_cell(row[peer], row.get("acts_in_balance"), row.get("true_numbers")), worst(row[peer]), f"{seconds[case][peer]['cpu_s']:.0f}"]
        cells += [our_cell(row["ours"]), worst(row["ours"]), f"{seconds[case]['ours']['wall_s']:.0f}"] if "ours" in row else ["", "", ""]
        yield "| " + " | ".join(cells) + " |"

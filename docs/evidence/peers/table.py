"""Writes the two tables of PEERS.md, between its `<!-- ... -->` lines, from results.json. Standard library only.

Neither peer says by itself what is missing; what a reader takes from it is read off by one rule for all:
    MuJoCo    a parameter whose 95 % interval lies wholly outside the tolerance nominal; of the extras one whose interval excludes its
              neutral value and that is not lost in the sensors' noise (SMALL)
    PySINDy   a term of the discovered equation whose bagged 95 % spread leaves its sign sure, in the equations of what is left over
A name is right when it is the concealed effect's own (NAMES), and every other name beside it is counted as false.
"""
import contextlib
import io
import json
import pathlib
import re

# What in each tool's own words is the concealed effect; empty where the tool has no word for it.
NAMES = {
    "friction": ({"frictionloss_n", "damping_n_s_per_m"}, {"balance: v", "balance: sign(v)", "balance: v|v|"}),
    "hose": (set(), set()),
    "regulator delay": ({"command_delay_s"}, set()),
    "sensor lag": ({"force_delay_s"}, {"sensor: F'"}),
    "contact stiffness": ({"contact_stiffness"}, {"sensor: depth"}),
    "unlisted": (set(), set()),
}

# Below these an extra is nothing to a reader: 0.8 N of load cell noise (at 0.1 m/s, over 50 mm of stroke), one sample of 4 ms, 1 %.
SMALL = {
    "frictionloss_n": 0.8, "force_bias_n": 0.8, "damping_n_s_per_m": 8.0, "spring_n_per_m": 16.0,
    "command_delay_s": 0.004, "force_delay_s": 0.004, "force_gain": 0.01,
}


def half_width(p):
    """Half the 95 % interval; infinite where the toolbox says so (null in JSON)."""
    return float("inf") if p["half_width_95"] is None else p["half_width_95"]


def departures(row, nominal):
    """Names of the parameters of `row` that depart from what the row of the first use was allowed."""
    found = []
    for name, p in row["parameters"].items():
        low, high = p["value"] - half_width(p), p["value"] + half_width(p)
        if name in nominal["parameters"]:
            stated = nominal["parameters"][name]
            if low > stated["high"] or high < stated["low"]:
                found.append(name)
        else:
            neutral = 1.0 if name == "force_gain" else 0.0
            if not low <= neutral <= high and abs(p["value"] - neutral) >= SMALL[name]:
                found.append(name)
    return found


def verdict(named, right):
    hits, false = [n for n in named if n in right], [n for n in named if n not in right]
    if hits:
        return "right" + (f", with {len(false)} false" if false else "")
    return f"not named; {len(false)} false" if false else "nothing named"


def sure_terms(equations):
    return [f"{name}: {term}" for name, e in equations.items() for term, v in e["terms"].items() if abs(v["value"]) > v["spread"]]


def seconds(row):
    return f"{row['wall_s']:.0f} / {row['cpu_s']:.0f}"


def named_list(names):
    return ", ".join(f"`{n}`" for n in names) or "nothing"


def numbers(parameters):
    return ", ".join(f"{k} {v['value']:.4g} ± {half_width(v):.2g}" for k, v in parameters.items())


def case_row(results, tool, case, use):
    """(what it names, verdict, worst p90 with its channel) of one use on one case."""
    row = results[tool][case][use]
    named = departures(row, results["mujoco"][case]["nominal"]) if tool == "mujoco" else sure_terms(row["equations"])
    bound = [i.split("Parameter ")[1].split(" ")[0] for i in row.get("insights", []) if "Bound Hit" in i]
    said = named_list(named) + (f"; at its bound: {named_list(bound)}" if bound else "")
    right = "" if use == "data alone" else verdict(named, NAMES[row["kind"]][tool == "pysindy"])
    worst = max(row["p90_by_channel"], key=row["p90_by_channel"].get)
    return said, right, f"{row['worst_p90']:.3g} ({worst.split('_')[0]})"


def main():
    here = pathlib.Path(__file__).resolve().parent
    results = json.loads((here / "results.json").read_text())
    cases = sorted((c for c in results["mujoco"] if c.startswith("case")), key=lambda c: list(NAMES).index(results["mujoco"][c]["nominal"]["kind"]))
    page = (here.parent / "PEERS.md").read_text()
    for name, table in (("side", side_by_side), ("all", every_use)):
        with contextlib.redirect_stdout(io.StringIO()) as rows:
            table(results, cases)
        rows = re.sub(r"(?<=[\w(])\|(\w+)\|", r"\\|\1\\|", re.sub(r"(?<=[` ])\|dp\| sign", r"\\|dp\\| sign", rows.getvalue()))  # v|v| and |dp| are no columns
        filled = f"<!-- {name}: by peers/table.py -->\n\n{rows}\n<!-- end of {name} -->"
        page, found = re.subn(f"<!-- {name}: .*?<!-- end of {name} -->", lambda _: filled, page, flags=re.S)
        assert found == 1, f"PEERS.md has no place for the table `{name}`"
    (here.parent / "PEERS.md").write_text(page)


def side_by_side(results, cases):
    """The best use of each tool, one row a subject; the last three columns are for ours."""
    mujoco, pysindy, empty = results["mujoco"], results["pysindy"], " | | | |"
    print("| subject | MuJoCo sysid names | error on unseen data | s CPU | PySINDy names | error on unseen data | s CPU | ours names | error on unseen data | time |")
    print("| --- " * 10 + "|")
    m, p = mujoco["emps"]["mjcf"], pysindy["emps"]["polynomials and signs"]
    half = lambda r: f"{100 * r['fitted_on_first_half']['relative_force_error']:.2f} % ({100 * r['fitted_on_all']['relative_force_error']:.2f} % in sample)"
    print(f"| emps | {READ['mujoco', 'emps']} | {half(m)} | {m['fitted_on_all']['cpu_s']:.0f} | {READ['pysindy', 'emps']} | {half(p)} | {p['fitted_on_all']['cpu_s']:.0f}{empty}")
    for subject in ("cylinder_friction O-ring", "cylinder_friction KDN"):
        m, p = mujoco[subject]["mjcf"], pysindy[subject]["products and sign"]
        bars = lambda r: f"{r['rms_3_bar_n']:.2f}, {r['rms_5_bar_n']:.2f} N"
        print(f"| {subject} | {READ['mujoco', subject]} | {bars(m)} | {m['cpu_s']:.0f} | {READ['pysindy', subject]} | {bars(p)} | {p['cpu_s']:.0f}{empty}")
    for case in cases:
        row = mujoco[case]["mjcf"]
        cells = [f"{case}: {', '.join(row['truth'])}"]
        for tool, use in (("mujoco", "mjcf"), ("pysindy", "discrepancy")):
            said, right, error = case_row(results, tool, case, use)
            cells += [f"{said}: **{right}**", error, f"{results[tool][case][use]['cpu_s']:.0f}"]
        print("| " + " | ".join(cells) + empty)


def every_use(results, cases):
    """All uses with all figures."""
    print("| subject | tool, use | parameters with 95 % half widths, or the equation | in sample / unseen | the tool's own messages | wall / CPU s |")
    print("| --- " * 6 + "|")
    for tool in ("mujoco", "pysindy"):
        for use, uses in results[tool]["emps"].items():
            for span, row in uses.items():
                said = row.get("equation") or numbers(row["parameters"])
                print(f"| emps, {span.replace('_', ' ')} | {tool}, {use} | {said} | {100 * row['relative_force_error']:.2f} % {row['judged_on']} | {messages(row)} | {seconds(row)} |")
    for tool in ("mujoco", "pysindy"):
        for subject in sorted(s for s in results[tool] if s.startswith("cylinder")):
            for use, row in results[tool][subject].items():
                said = row.get("equation") or numbers(row["parameters"])
                bars = ", ".join(f"{row[f'rms_{bar}_bar_n']:.2f}" for bar in (1, 7, 3, 5))
                print(f"| {subject} | {tool}, {use} | {said} | {bars} N at 1, 7 / 3, 5 bar | {messages(row)} | {seconds(row)} |")
    for case in cases:
        for tool in ("mujoco", "pysindy"):
            for use, row in sorted(results[tool][case].items()):
                said = numbers(row["parameters"]) if tool == "mujoco" else "; ".join(e["equation"] for e in row["equations"].values())
                p90 = ", ".join(f"{k.split('_')[0]} {v:.3g}" for k, v in row["p90_by_channel"].items())
                print(f"| {case} | {tool}, {use} | {said} | {p90} | {messages(row)} | {seconds(row)} |")


def messages(row):
    """Insights and warnings as the tool printed them; PySINDy's are the one about SR3 in every row, so they are left out there."""
    return "; ".join(row.get("insights", []) + (row.get("warnings", []) if "insights" in row else []) + ([row["terminated"]] if "terminated" in row else [])).replace("|", " ")


# What a reader takes from the figures of the recordings, where no truth is on file.
READ = {
    ("mujoco", "emps"): "dry, viscous friction and offset, because they were set free; not that viscous friction differs by direction",
    ("pysindy", "emps"): "offset, `sign(v)`, `v` and, for the direction, `v^2`; beside them `q`, `q^2`, `v|v|`",
    ("mujoco", "cylinder_friction O-ring"): "dry, viscous friction and offset, because they were set free; no growth with pressure",
    ("mujoco", "cylinder_friction KDN"): "dry, viscous friction and offset, because they were set free; no growth with pressure",
    ("pysindy", "cylinder_friction O-ring"): "`sign(v)` and, for the growth, `p v`",
    ("pysindy", "cylinder_friction KDN"): "`sign(v)` and, for the growth, `p v`; `p sign(v)` of the wrong sign, five more",
}


if __name__ == "__main__":
    main()

"""Prints the table of PEERS.md from results.json: `table.py > rows.md`. Standard library only.

Neither peer says by itself what is missing; what a reader takes from it is read off by one rule for all:
    MuJoCo    a parameter whose 95 % interval lies wholly outside what was believed (for an extra: off its neutral value)
    PySINDy   a term of the discovered equation whose bagged 95 % spread leaves its sign sure, in the equations of what is left over
A name is right when it is the concealed effect's own (NAMES), and every other name beside it is counted as false.
"""
import json
import pathlib

# What in each tool's own words is the concealed effect; empty where the tool has no word for it.
NAMES = {
    "friction": ({"frictionloss_n", "damping_n_s_per_m"}, {"balance: v", "balance: sign(v)", "balance: v|v|"}),
    "hose": (set(), set()),
    "regulator delay": ({"command_delay_s"}, set()),
    "sensor lag": ({"force_delay_s"}, {"sensor: F'"}),
    "contact stiffness": ({"contact_stiffness"}, {"sensor: depth"}),
    "unlisted": (set(), set()),
}


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


def main():
    results = json.loads((pathlib.Path(__file__).parent / "results.json").read_text())
    print("| subject | tool, use | what it names | right? | error on unseen data | wall / CPU s |\n| --- | --- | --- | --- | --- | --- |")
    for tool in ("mujoco", "pysindy"):
        for use, row in results[tool]["emps"].items():
            whole, half = row["fitted_on_all"], row["fitted_on_first_half"]
            said = whole.get("equation") or ", ".join(f"{k} {v['value']:.4g} ± {v['half_width_95']:.2g}" for k, v in whole["parameters"].items())
            print(f"| emps | {tool}, {use} | {said} | | {100 * whole['relative_force_error']:.2f} % in sample, "
                  f"{100 * half['relative_force_error']:.2f} % second half from first | {seconds(whole)} |")
    for tool in ("mujoco", "pysindy"):
        for subject in sorted(results[tool]):
            if subject.startswith("cylinder"):
                for use, row in results[tool][subject].items():
                    said = row.get("equation") or ", ".join(f"{k} {v['value']:.4g} ± {v['half_width_95']:.2g}" for k, v in row["parameters"].items())
                    print(f"| {subject} | {tool}, {use} | {said} | | {row['rms_3_bar_n']:.2f} N at 3 bar, {row['rms_5_bar_n']:.2f} N at 5 bar | {seconds(row)} |")
    for case in sorted((c for c in results["mujoco"] if c.startswith("case")), key=lambda c: list(NAMES).index(results["mujoco"][c]["believed"]["kind"])):
        for tool, index in (("mujoco", 0), ("pysindy", 1)):
            for use, row in sorted(results[tool].get(case, {}).items()):
                named = row["departures"] if tool == "mujoco" else sure_terms(row["equations"])
                bound = [i.split("Parameter ")[1].split(" ")[0] for i in row.get("insights", []) if "Bound Hit" in i]
                said = named_list(named) + (f"; at its bound: {named_list(bound)}" if bound else "")
                right = "" if use == "data alone" else verdict(named, NAMES[row["kind"]][index])
                worst = max(row["p90_by_channel"], key=row["p90_by_channel"].get)
                print(f"| {case} ({row['kind']}: {', '.join(row['truth'])}) | {tool}, {use} | {said} | {right} | {row['worst_p90']:.3g} ({worst}) | {seconds(row)} |")


if __name__ == "__main__":
    main()

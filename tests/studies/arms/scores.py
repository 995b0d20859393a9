"""Answers held against truths, and the tables made of that."""
import json
import math
import statistics

WHICH = ("joint", "link", "channel", "source", "target", "recording")
BANDS = ((0, 0.5), (0.5, 0.8), (0.8, 0.9), (0.9, 0.95), (0.95, 1.01))


def plain(v):
    v = v.get("value") if isinstance(v, dict) else v
    return int(v) if isinstance(v, float) and v == int(v) else str(v).removesuffix(".csv") if isinstance(v, str) else v


def key(effect):
    """Name and place; of a law without a name its subsystem and joint."""
    p = effect.get("parameters") or {}
    if effect["name"] == "unlisted":
        return f"unlisted {effect.get('subsystem')} joint={plain(effect.get('joint', p.get('joint')))}"
    return " ".join([effect["name"], *(f"{k}={plain(p[k])}" for k in WHICH if k in p)])


def judged(out, number):
    """One case: what was wanted, what was said, how sure, and its intervals."""
    case = f"case-{number:03}"
    truth = json.loads((out / "truth" / f"{case}.json").read_text())
    r = {"case": case, "kind": truth["kind"], "sigma": truth["sigma"], "cause": truth["effects"][0]["truth"] if truth["effects"] else "nothing",
         "want": [key(e) for e in truth["effects"]], "said": None, "named": False, "covered": [], "half_widths": [], "errors": {}, "seconds": None, "error": ""}
    try:
        answer = json.loads((out / "answers" / case / "diagnosis.json").read_text())
    except (OSError, ValueError) as e:
        file = out / "answers" / case / "error.txt"
        return {**r, "error": file.read_text() if file.is_file() else str(e)}
    effects = answer["effects"]
    cost = out / "answers" / case / "cost.json"
    r["seconds"] = json.loads(cost.read_text())["processor_s"] if cost.is_file() else None
    r["said"] = [{"name": key(e), "confidence": e["confidence"], "right": key(e) in r["want"], "depends_on": e.get("depends_on")} for e in effects]
    r["named"], r["verdict"] = sorted(map(key, effects)) == sorted(r["want"]), answer["verdict"]
    for e in truth["effects"]:
        own = next((x for x in effects if key(x) == key(e)), None)
        if own is None:
            continue
        if e["name"] == "unlisted":
            said = set(own.get("depends_on") or [])
            r["variables"] = set(e["parameters"]["depends_on"]) <= said and len(said) <= 3
            continue
        for k, tolerance in e["tolerance"].items():
            g = own["parameters"].get(k) or {}
            low, high, value, true = (g.get("low"), g.get("high"), g.get("value"), e["parameters"][k])
            bounded = low is not None and high is not None
            r["covered"].append(bool(bounded and low <= true <= high))
            r["half_widths"].append((high - low) / 2 / tolerance if bounded else math.inf)
            r["errors"][k] = abs(value - true) / tolerance if value is not None else math.inf
    return r


def line(r):
    said = "NO ANSWER " + r["error"][:200].replace("\n", " ") if r["said"] is None else " + ".join(f"{s['name']} {s['confidence']:.2f}" for s in r["said"]) or "nothing"
    sure = any(s["confidence"] > 0.9 and not s["right"] for s in r["said"] or [])
    off = " ".join(f"{k}={v:.1f}" for k, v in r["errors"].items() if v > 1)
    want = " + ".join(r["want"]) or "nothing"
    law = f" ({r['cause']})" if want.startswith("unlisted") else ""
    return f"{r['case']} {'ok  ' if r['named'] else 'SURE' if sure else 'miss'} {r['kind']} {r['sigma']:.0f} sigma, want {want}{law}: said {said}, {r['seconds'] or 0:.0f} s{', off, in tolerances: ' + off if off else ''}"


def summary(cases):
    stated = [s for r in cases for s in r["said"] or []]
    sure = [s["right"] for s in stated if s["confidence"] > 0.9]
    covered = [c for r in cases if r["named"] for c in r["covered"]]
    widths = [w for r in cases if r["named"] for w in r["half_widths"]]
    seconds = [r["seconds"] for r in cases if r["seconds"]]
    groups = {"listed": [r for r in cases if r["want"] and not r["want"][0].startswith("unlisted")], "nothing": [r for r in cases if not r["want"]],
              "unlisted": [r for r in cases if r["want"] and r["want"][0].startswith("unlisted")]}
    return {"cases": len(cases), "without_answer": sum(r["said"] is None for r in cases), **{f"{k}_named": f"{sum(r['named'] for r in g)} of {len(g)}" for k, g in groups.items()},
            "unlisted_with_its_variables": sum(bool(r.get("variables")) for r in groups["unlisted"]),
            "stated_above_90_percent": len(sure), "of_those_right": sum(sure) / len(sure) if sure else None,
            "interval_coverage": sum(covered) / len(covered) if covered else None, "intervals": len(covered), "half_width_in_tolerances_median": statistics.median(widths) if widths else None,
            "seconds_median": statistics.median(seconds) if seconds else None, "seconds_largest": max(seconds, default=None)}


def number(v, digits=2):
    return "-" if v is None else f"{v:.{digits}f}"


def tables(cases, longest, note):
    s = summary(cases)
    lines = ["# Recorded arms of our own generator", "",
             "Written by `tests/studies/recorded_arms.py`. Arms by another engine (MuJoCo's inverse dynamics and force sensor) and another friction law (generalised Maxwell slip with a Stribeck curve",
             "and a lag) than the tool's; five to eight joints, prismatic ones too; one cause in each, sizes from 3 standard deviations up (largest RMS of what it changes in one channel and recording).",
             "Right is a name with its place that is in the truth; of a law without a name, its subsystem and joint.", "", "| what | asked | found |", "| --- | --- | --- |",
             f"| named with place, none beside: listed, nothing, unlisted | - | {s['listed_named']}, {s['nothing_named']}, {s['unlisted_named']} |",
             f"| of names stated above 90 %, right | 0.95 | {number(s['of_those_right'], 3)} of {s['stated_above_90_percent']} |",
             f"| 95 % intervals that hold the truth, of causes named | 0.88 to 0.99 | {number(s['interval_coverage'])} of {s['intervals']} |",
             f"| median half-width, in tolerances | 1 | {number(s['half_width_in_tolerances_median'])} |",
             f"| seconds of processor of an answered case: median, largest | 20, 60 (two processors) | {number(s['seconds_median'], 1)}, {number(s['seconds_largest'], 1)} |",
             f"| without an answer after {longest} s of processor | 0 | {s['without_answer']} |", "", "## Reliability", "", "| stated | names | right | share right |", "| --- | --- | --- | --- |"]
    stated = [x for r in cases for x in r["said"] or []]
    for low, high in BANDS:
        own = [x["right"] for x in stated if low < x["confidence"] <= high]
        lines.append(f"| {100 * low:.0f} to {min(100 * high, 100):.0f} % | {len(own)} | {sum(own)} | {number(sum(own) / len(own) if own else None)} |")
    lines += ["", "## By cause", "", "| cause | arms | named | its name among what is stated | stated above 90 % and wrong | intervals hold | median half-width | median s |", "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for cause in sorted({r["cause"] for r in cases}):
        own = [r for r in cases if r["cause"] == cause]
        covered, widths = [c for r in own if r["named"] for c in r["covered"]], [w for r in own if r["named"] for w in r["half_widths"]]
        wrong = sum(x["confidence"] > 0.9 and not x["right"] for r in own for x in r["said"] or [])
        among = sum(any(x["right"] for x in r["said"] or []) for r in own) if cause != "nothing" else "-"
        seconds = [r["seconds"] for r in own if r["seconds"]]
        lines.append(f"| {cause} | {len(own)} | {sum(r['named'] for r in own)} | {among} | {wrong} | {f'{sum(covered)} of {len(covered)}' if covered else '-'} | "
                     f"{number(statistics.median(widths) if widths else None)} | {number(statistics.median(seconds) if seconds else None, 1)} |")
    lines += ["", "## By size", "", "| largest RMS of what it changes, in standard deviations | arms | named |", "| --- | --- | --- |"]
    for low, high in ((3, 6), (6, 12), (12, 25), (25, 1e9)):
        own = [r for r in cases if r["want"] and low <= r["sigma"] < high]
        lines.append(f"| {low} to {high} | {len(own)} | {sum(r['named'] for r in own)} |" if high < 1e9 else f"| above {low} | {len(own)} | {sum(r['named'] for r in own)} |")
    return "\n".join(lines + ([""] + [note] if note else [])) + "\n"

#!/usr/bin/env python3
"""How sure diagnoses are against how often they are right (standard library only).

    calibration.py ANSWERS=TRUTH [ANSWERS=TRUTH ..] [--out docs/evidence/CALIBRATION.md] [--note TEXT]

ANSWERS/<case>/diagnosis.json are answers, TRUTH/<case>.json the sealed truth of each case, in the forms of the concealed cases (score.py, score_abroad.py). Cases without an answer are
counted, and are in no figure. The names of the sets in the tables are those of the folders of answers.

Right is a name that is in the truth: an effect of the list by its name, a number that is off by `number_off` with its key or by the vocabulary's effects that say the same, an unlisted
effect in its subsystem, a fault of the data that is an effect of the vocabulary as well, and what a rough device also has (`also_there`).

True cause of a case: each of its effects and numbers that are off; where there is none, that nothing is missing. Stated probability of it: that of its name; of an effect that is not
named that of the alternatives which have it, or of its family's law; of nothing the share of the explanation without effects among those not ruled out.
"""
import json, math, pathlib, sys

GAIN_NAMES = {"force_n": "force_sensor_gain_error", "stroke_m": "stroke_sensor_gain_error"}


def load(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return None


def allowed(truth):
    """Names that are right, as (name, key or subsystem or None)."""
    right = {(e["name"], e["subsystem"] if e["name"] == "unlisted" else None) for e in truth["effects"]}
    for n in truth.get("numbers") or []:
        right.add(("number_off", n["key"]))
        right |= {(name, None) for s in n["instead"] for name in s}
    for f in truth.get("data_faults") or []:
        if f["kind"] == "gain" and f["channel"] in GAIN_NAMES:
            right.add((GAIN_NAMES[f["channel"]], None))
        if f["kind"] == "clock_offset" and f["channel"] == "force_n":
            right.add(("channel_time_offset", None))
    right |= {(name, None) for name in truth.get("also_there") or []}
    return right


def is_right(effect, right):
    name = effect["name"]
    if name == "unlisted":
        return (name, effect.get("subsystem")) in right
    return (name, None) in right or (name == "number_off" and (name, effect.get("key")) in right)


def weights(answer):
    """Share of the answer and of each alternative among all that are not ruled out."""
    odds = [a["odds"] for a in answer.get("alternatives") or []]
    whole = 1.0 + sum(odds)
    return 1.0 / whole, [(a["effects"], a["odds"] / whole) for a in answer.get("alternatives") or []]


def stated_of(answer, names):
    """Stated probability of a cause that any of `names` (name, key or subsystem) says; the largest."""
    found = [0.0]
    for name, more in names:
        for e in answer["effects"]:
            if e["name"] == name and (more is None or more in (e.get("key"), e.get("subsystem"))):
                found.append(e["confidence"])
        if not any(e["name"] == name for e in answer["effects"]) and name != "unlisted":
            display_name = f"{name} ({more})" if more else name
            found.append(sum(share for effects, share in weights(answer)[1] if display_name in effects))
        for family in answer.get("families") or []:
            found += [m["probability"] for m in family["members"] if m["name"] == name and (more is None or m.get("key") == more)]
    return max(found)


def stated_of_nothing(answer):
    own, others = weights(answer)
    none = sum(share for effects, share in others if not effects)
    return own if not answer["effects"] else max(none, math.prod(1.0 - e["confidence"] for e in answer["effects"]))


def causes(answer, truth):
    """Stated probability on each true cause."""
    found = []
    for e in truth["effects"]:
        more = e["subsystem"] if e["name"] == "unlisted" else None
        found.append((e["name"], stated_of(answer, [(e["name"], more)])))
    for n in truth.get("numbers") or []:
        names = [[("number_off", n["key"])]] + [[(x, None) for x in s] for s in n["instead"]]
        found.append((n["key"], max(min(stated_of(answer, [name]) for name in s) for s in names)))
    return found or [("nothing", stated_of_nothing(answer))]


def figures(cases):
    stated = [(e["confidence"], is_right(e, allowed(t)), e["name"]) for a, t in cases for e in a["effects"]]
    on_cause = [c for a, t in cases for c in causes(a, t)]
    sure = [right for p, right, _ in stated if p > 0.9]
    names = [p for name, p in on_cause if name != "nothing"]
    return stated, dict(
        cases=len(cases),
        sure=len(sure), sure_right=sum(sure),
        true=len(names), true_sure=sum(p > 0.9 for p in names),
        mean=sum(p for _, p in on_cause) / len(on_cause) if on_cause else math.nan,
    )


def share(part, whole):
    return f"{part / whole:.3f} ({part} of {whole})" if whole else "-"


def main():
    args = sys.argv[1:]
    out = pathlib.Path(args.pop(args.index("--out") + 1)) if "--out" in args else None
    note = args.pop(args.index("--note") + 1) if "--note" in args else None
    pairs = [a.split("=", 1) for a in args if a not in ("--out", "--note")]
    if not pairs or any(len(p) != 2 for p in pairs):
        sys.exit(__doc__)
    sets, every, lost = {}, [], {}
    for answers, truth in pairs:
        name = pathlib.Path(answers).name
        cases = []
        for file in sorted(pathlib.Path(truth).glob("case-*.json")):
            answer = load(pathlib.Path(answers) / file.stem / "diagnosis.json")
            if answer is None:
                lost[name] = lost.get(name, 0) + 1
            else:
                cases.append((answer, load(file)))
        sets[name] = cases
        every += cases
    lines = ["# How sure, against how often right", "",
             "Written by `tests/studies/calibration.py`; what counts as right and as the stated probability of a cause stands in its first lines. Asked: of names stated above 90 % at least",
             "0.95 right, at least 0.60 of the true names stated so, a mean probability of at least 0.85 on the true cause.", "",
             "| set | cases answered (not run) | stated above 90 %: right | true names stated above 90 % | mean probability on the true cause |", "| --- | --- | --- | --- | --- |"]
    for name, cases in [*sets.items(), ("all", every)]:
        _, f = figures(cases)
        missing = sum(lost.values()) if name == "all" else lost.get(name, 0)
        lines.append(f"| {name} | {f['cases']} ({missing}) | {share(f['sure_right'], f['sure'])} | {share(f['true_sure'], f['true'])} | {f['mean']:.3f} |")
    stated, _ = figures(every)
    lines += ["", "## Reliability", "", "Every name stated in any answer, by tenths of its probability.", "", "| stated | names | right | share right | mean stated |", "| --- | --- | --- | --- | --- |"]
    for tenth in range(10):
        own = [(p, right) for p, right, _ in stated if tenth == min(9, math.ceil(10 * p) - 1 if p > 0 else 0)]
        right = sum(r for _, r in own)
        lines.append(f"| {10 * tenth} to {10 * tenth + 10} % | {len(own)} | {right} | {f'{right / len(own):.2f}' if own else '-'} | {f'{sum(p for p, _ in own) / len(own):.3f}' if own else '-'} |")
    wrong = [(name, case, e["name"], e.get("key"), e["confidence"]) for name, cases in sets.items() for a, t in cases for case in [a.get("case", "?")] for e in a["effects"]
             if e["confidence"] > 0.9 and not is_right(e, allowed(t))]
    lines += ["", "Stated above 90 % and not right: " + ("; ".join(f"{s} {c} {n}{f' ({k})' if k else ''} {p:.4f}" for s, c, n, k, p in wrong) or "none") + "."]
    low = [(name, a.get("case", "?"), cause, p) for name, cases in sets.items() for a, t in cases for cause, p in causes(a, t) if p < 0.5]
    lines += ["", "True causes stated below 50 %: " + ("; ".join(f"{s} {c} {n} {p:.2f}" for s, c, n, p in low) or "none") + "."]
    if note:
        lines += ["", note]
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if out:
        out.write_text(text)


main()

"""Diagnoses: every number that is printed recomputed from comparison.parquet and balance.parquet, every statement held to its definition.

    diagnosis.py                     three diagnoses of what the project holds: the README's log with a recording kept back, two effects at once, nothing missing
    diagnosis.py FOLDER [CASES]      a diagnosis, or a folder of them; `CASES`: the folder of their cases, for the tolerances of their rig files

The definitions are those of docs/DIAGNOSIS.md, "Words and what they rest on"; nothing here is taken from the program.
"""

import json
import math
import re
import shutil
import sys
import tomllib
from pathlib import Path

import numpy
import pandas

from common import PROJECT, RESULTS, Checked, Page, markdown_tables, run, viewer_text

# Words, unit and what a value in SI is multiplied by.
CHANNELS = {
    "regulator_pressure_pa": ("regulator's pressure", "mbar", 1e-2),
    "stroke_m": ("stroke", "mm", 1e3),
    "force_n": ("force", "N", 1.0),
    "acceleration_m_per_s2": ("acceleration", "m/s2", 1.0),
}
# Units of numbers by the end of their name, longer ends first.
UNITS = {
    "_1_per_pa_s": ("1/(bar s)", 1e5), "_1_per_pa": ("1/bar", 1e5), "_1_per_s": ("1/s", 1.0), "_1_per_m": ("1/m", 1.0), "_1": ("", 1.0),
    "_j_per_kg_k": ("J/(kg K)", 1.0), "_pa_s_per_kg": ("bar s/kg", 1e-5), "_n_s_per_m": ("N s/m", 1.0), "_n_per_m15": ("N/mm^1.5", 10**-4.5),
    "_m_per_s2": ("m/s2", 1.0), "_n_m_per_rad": ("N m/rad", 1.0), "_n_m": ("N m", 1.0), "_m_per_m": ("mm/m", 1e3), "_rad_per_s": ("rad/s", 1.0),
    "_kg_per_s": ("g/s", 1e3), "_pa_per_s": ("bar/s", 1e-5), "_n_per_pa": ("N/bar", 1e5), "_n_per_m": ("N/mm", 1e-3), "_n_per_s": ("N/s", 1.0),
    "_w_per_k": ("W/K", 1.0), "_m_per_s": ("mm/s", 1e3), "_rad": ("mrad", 1e3), "_m2": ("mm2", 1e6), "_m3": ("cm3", 1e6), "_pa": ("bar", 1e-5),
    "_kg": ("kg", 1.0), "_hz": ("Hz", 1.0), "_n": ("N", 1.0), "_m": ("mm", 1e3), "_s": ("ms", 1e3), "_k": ("K", 1.0), "_j": ("J", 1.0), "_w": ("W", 1.0),
}  # fmt: skip
HUBER = 4.0
NOISE_ALONE = 1.15
LEAST_ODDS = -2.0
IN_TURN = "left out in turn"
RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"
# Sections that the files of a diagnosis cannot recompute, and why.
ELSEWHERE = {
    "The recordings": "what was set aside of the logs, which are not among a diagnosis' files",
    "The arm": "encoders and torques are not in comparison.parquet",
    "Where on the path": "the simulation without the effects is not in comparison.parquet",
}
# What was once said whatever the numbers were.
FIXED = ["tried comes near", "explanation comes near", "No known effect explains", "within the sensors' noise", "Beside what was found, may", "What is left\n  Noise"]


def words_of(name):
    """A number's words, unit and factor, by the end of its name."""
    if name in CHANNELS:
        return CHANNELS[name]
    for end, (unit, factor) in UNITS.items():
        if name.endswith(end):
            return name.removesuffix(end).split(".")[-1].replace("_", " "), unit, factor
    return name.split(".")[-1].replace("_", " "), "", 1.0


def last_digit(text):
    """The size of the last digit that is meant: zeros at the end of a whole number hold its place."""
    front, _, power = text.partition("·10")
    whole, _, decimals = front.lstrip("+-").partition(".")
    digit = 10.0 ** -len(decimals) if decimals else 10.0 ** (len(whole) - len(whole.rstrip("0")))
    return digit * 10.0 ** int(power.translate(RAISED) or 0)


def value_of(text):
    front, _, power = text.partition("·10")
    return float(front) * 10.0 ** int(power.translate(RAISED) or 0)


def agrees(text, value):
    if text.startswith("<"):
        return abs(value) < float(text[1:])
    near = 0.5 * last_digit(text) * (1 + 1e-6) + 1e-4 * abs(value)
    return value is not None and math.isfinite(value) and abs(value_of(text) - value) <= near


def rms(values):
    values = values[numpy.isfinite(values)]
    return math.sqrt(numpy.mean(values**2)) if len(values) else math.nan


def robust(sigmas):
    """Root of the mean of Huber's loss."""
    size = numpy.abs(sigmas[numpy.isfinite(sigmas)])
    loss = numpy.where(size <= HUBER, size**2, HUBER * (2 * size - HUBER))
    return math.sqrt(numpy.mean(loss)) if len(size) else math.nan


class Diagnosis:
    def __init__(self, folder):
        self.folder = folder
        self.json = json.loads((folder / "diagnosis.json").read_text())
        self.table = pandas.read_parquet(folder / "comparison.parquet")
        self.balance = pandas.read_parquet(folder / "balance.parquet")
        self.noise = {n["channel"]: n["standard_deviation"] for n in self.json["noise"]}
        self.fitted = self.table[self.table.kept == "fitted"]
        self.kept = self.table[self.table.kept == "unseen"]
        self.is_flange = bool(self.json.get("runs"))

    def channels(self):
        return [c for c in CHANNELS if f"measured_{c}" in self.table]

    def left(self, rows, model, channel):
        return (rows[f"measured_{channel}"] - rows[f"{model}_{channel}"]).to_numpy(dtype=float)

    def size(self, rows, model, channel):
        """True and robust root mean square, the second in standard deviations of the noise."""
        left = self.left(rows, model, channel)
        return rms(left), robust(left / self.noise[channel])

    def percentile_90(self, recording, channel):
        """Of what the improved model leaves of a recording fitted to, in standard deviations of the noise."""
        rows = self.fitted[self.fitted.recording == recording]
        sizes = numpy.sort(numpy.abs(self.left(rows, "improved", channel) / self.noise[channel]))
        sizes = sizes[numpy.isfinite(sizes)]
        return sizes[int(0.9 * (len(sizes) - 1))] if len(sizes) else 0.0

    def errors(self):
        """What the improved model leaves of each channel of each recording, the largest beside its noise first."""
        found = []
        for rows, kept in ((self.fitted, False), (self.kept, True)):
            for recording in rows.recording.unique():
                own = rows[rows.recording == recording]
                for channel in self.channels():
                    size, sigmas = self.size(own, "improved", channel)
                    if math.isfinite(size):
                        found.append((sigmas, size, channel, recording, kept))
        return sorted(found, reverse=True)


class Examination:
    """Checks of one diagnosis."""

    def __init__(self, folder, case):
        self.of = Diagnosis(folder)
        self.check = Checked(str(folder))
        self.case = case

    def number(self, where, text, value):
        self.check.compared += 1
        if not agrees(text, value):
            self.check.wrong.append(f"{self.check.name}: {where}: {text} is printed, {value!r} recomputed")

    def run(self):
        self.statements()
        if self.of.is_flange:
            return self.check
        self.file()
        for section in self.of.json["account"]["sections"]:
            if section["title"] not in ELSEWHERE:
                for paragraph in section["paragraphs"]:
                    self.paragraph(section["title"], paragraph)
        self.page()
        self.viewer()
        return self.check

    # diagnosis.json

    def file(self):
        of = self.of
        for m in of.json["misfit"]:
            rows = of.fitted[of.fitted.recording == m["recording"]]
            for model in ("believed", "tolerated", "improved"):
                size, sigmas = of.size(rows, model, m["channel"])
                where = f"misfit {m['recording']} {m['channel']} {model}"
                self.check.exact(where, m[f"{model}_rms"], size, 1e-3)
                self.check.exact(where, m[f"{model}_sigmas"], sigmas, 1e-3)
            if m.get("left_out_sigmas") is not None:
                self.check.exact(f"misfit {m['recording']} left out", m["left_out_sigmas"], of.size(rows, "left_out", m["channel"])[1], 1e-3)
        for e in of.json["prediction"]:
            if e["channel"] not in of.channels():
                continue
            in_turn = e["recording"] == IN_TURN
            rows = of.fitted if in_turn else of.kept
            after = "left_out" if in_turn else "improved"
            for key, model in (("believed", "believed"), ("before", "tolerated"), ("after", after)):
                size, sigmas = of.size(rows, model, e["channel"])
                self.check.exact(f"prediction {e['channel']} {key}", e[key], size, 1e-3)
                if f"{key}_sigmas" in e:
                    self.check.exact(f"prediction {e['channel']} {key}", e[f"{key}_sigmas"], sigmas, 1e-3)
        for recording in of.table.recording.unique():
            time = of.table[of.table.recording == recording].time_s
            for span in of.json["mismatch"] + of.json["differences"]:
                if span["recording"] == recording:
                    inside = time.min() - 1e-9 <= span["start_s"] <= span["end_s"] <= time.max() + 1e-9
                    self.check.fact(f"{recording}: {span['start_s']} to {span['end_s']} s lies within it", inside, True)

    # account.txt

    def take(self, where, text, pattern, values):
        """Takes what a pattern matches out of a text, each of its numbers compared; `values` makes them of the match."""

        def compare(match):
            for key, value in values(match).items():
                self.number(f"{where}: {key} of `{match.group(0)}`", match.group(key), value)
            return " "

        return re.sub(pattern, compare, text)

    def paragraph(self, title, text):
        of = self.of
        where = f"account: {title}"
        names = sorted(of.table.recording.unique(), key=len, reverse=True)
        name = "|".join(map(re.escape, names))
        words = {w: (c, u, f) for c, (w, u, f) in CHANNELS.items()}
        channel = "|".join(map(re.escape, words))
        next_one = of.json.get("next_experiment") or {}
        text = text.replace("\u00a0", " ").replace(next_one.get("instruction", "\0"), " ")

        # An effect's numbers, and the rig file's.
        estimates = [(p, e) for effect in of.json["effects"] for p, e in effect["parameters"].items()]
        for parameter, estimate in estimates:
            words_, unit, factor = words_of(parameter)
            pattern = rf"(?i:{re.escape(words_)}) (?P<value>{NUMBER}){unit and ' ' + re.escape(unit)} \((?P<low>{NUMBER}) to (?P<high>{NUMBER})\)"
            text = self.take(where, text, pattern, lambda _: {k: factor * estimate[k] for k in ("value", "low", "high")})
        for tolerated in of.json["tolerated"]:
            words_, unit, factor = words_of(tolerated["key"])
            pattern = rf"{re.escape(words_)} (?P<value>{NUMBER}){unit and ' ' + re.escape(unit)}(?: \((?P<change><?{NUMBER}) %\))?"
            found = tolerated["found"]["value"]
            change = 100 * (found / tolerated["believed"] - 1) if tolerated["believed"] else math.nan
            text = self.take(
                where, text, pattern, lambda m: {"value": factor * found} | ({"change": change} if m.group("change") else {})
            )
        # What stood in the rig file, which is none of a diagnosis' files.
        text = re.sub(rf"[a-z_.0-9]+ = {NUMBER}( [^ ,]+)?(?=[ ,.])", " ", text)
        # Sizes of errors, each with the recording, the channel and the time that it is of.
        def between(match, model, rows=of.fitted):
            rows = rows[rows.recording == match.group("recording")]
            if "from" in match.groupdict():
                half = 0.5 * last_digit(match.group("from")) + 1e-9
                spans = [p for p in of.json["differences"] if p["recording"] == match.group("recording") and p["channel"] == words[match.group("channel")][0]]
                start, end = min(p["start_s"] for p in spans), max(p["end_s"] for p in spans)
                self.check.fact(f"{where}: from", abs(float(match.group("from")) - start) <= half, True)
                self.check.fact(f"{where}: to", abs(float(match.group("to")) - end) <= half, True)
                rows = rows[(rows.time_s >= start) & (rows.time_s <= end)]
            column, _, factor = words[match.group("channel")]
            return factor * rms(of.left(rows, model, column))

        unit = r"(?:mbar|mm|N|m/s2)"
        text = self.take(
            where, text,
            rf"Between (?P<from>{NUMBER}) and (?P<to>{NUMBER}) s of (?P<recording>{name}) the (?P<channel>{channel}) .*?by (?P<rms>{NUMBER}) {unit} RMS, where .*? is (?P<noise>{NUMBER}) {unit}\.",
            lambda m: {"rms": between(m, "tolerated"), "noise": words[m.group("channel")][2] * of.noise[words[m.group("channel")][0]]},
        )  # fmt: skip
        text = self.take(
            where, text,
            rf"the (?P<channel>{channel}) of (?P<recording>{name}) from (?P<from>{NUMBER}) to (?P<to>{NUMBER}) s \((?P<rms>{NUMBER}) {unit} RMS\)",
            lambda m: {"rms": between(m, "tolerated")},
        )  # fmt: skip

        def remaining(match):
            rows = of.table[of.table.recording == match.group("recording")]
            column, _, factor = words[match.group("channel")]
            size, sigmas = of.size(rows, "improved", column)
            return {"rms": factor * size, "sigmas": sigmas}

        text = self.take(
            where, text,
            rf"(?P<rms>{NUMBER}) {unit} RMS in the (?P<channel>{channel}) of (?P<recording>{name})(?:, which was kept back)? \(robust, (?P<sigmas>{NUMBER}) times [a-z' ]+\)",
            remaining,
        )  # fmt: skip

        def predicted(match):
            column, _, factor = words[match.group("channel")]
            in_turn = "each recording" in match.group(0)
            rows, after = (of.fitted, "left_out") if in_turn else (of.kept, "improved")
            sizes = of.size(rows, "tolerated", column)[0], of.size(rows, after, column)[0]
            self.check.fact(f"{where}: falls", "falls" in match.group(0), sizes[1] < sizes[0])
            return {"before": factor * sizes[0], "after": factor * sizes[1], "noise": factor * of.noise[column]}

        text = self.take(
            where, text,
            rf"the prediction error on .*? (?:falls|goes) from (?P<before>{NUMBER}) {unit} to (?P<after>{NUMBER}) {unit} RMS in the (?P<channel>{channel}), where .*? is (?P<noise>{NUMBER}) {unit}",
            predicted,
        )  # fmt: skip
        worst = rf"the worst channel, the (?P<channel>{channel}) of (?P<recording>{name}), departs by (?P<sigmas>{NUMBER}) times [a-z' ]+ \(robust RMS\)"
        text = self.take(where, text, worst, lambda m: {"sigmas": remaining(m)["sigmas"]})
        counts = r"More than [a-z' ]+ in (?P<count>\d+) of (?P<all>\d+) channels"
        errors = of.errors()
        beyond = [e for e in errors if e[0] > NOISE_ALONE]
        text = self.take(where, text, counts, lambda _: {"count": len(beyond), "all": len(errors)})
        text = self.take(where, text, r"and in (?P<more>\d+) more", lambda _: {"more": len(beyond) - 3})
        largest = of.json.get("departure")
        at_worst = rf"at worst, in the (?P<channel>{channel}) of (?P<recording>{name})(?P<predicted>, predicted by a fit to the others)?, 90 % of the samples lie within (?P<p90>{NUMBER}) standard deviations of the prediction, where noise alone gives 1\.6"

        def departure(match):
            column = words[match.group("channel")][0]
            self.check.fact(f"{where}: channel of the largest departure", (column, match.group("recording")), (largest["channel"], largest["recording"]))
            self.check.fact(f"{where}: left out", bool(match.group("predicted")), largest["left_out"])
            # Within no more than what the fit leaves, and by the bound that `explained` stands for.
            self.check.fact(f"{where}: explained fully", "explained fully" in text, of.json["explained"] == "fully")
            self.check.fact(f"{where}: fully is near the noise", of.json["explained"] == "fully" and largest["p90_sigmas"] > (2.5 if largest["left_out"] else 2.0), False)
            fitted = max(of.percentile_90(r, c) for r in of.fitted.recording.unique() for c in of.channels())
            self.check.fact(f"{where}: no channel fitted to is worse", fitted <= largest["p90_sigmas"] * 1.001, True)
            if not largest["left_out"]:
                self.number(f"{where}: 90th percentile", match.group("p90"), fitted)
            return {"p90": largest["p90_sigmas"]}

        text = self.take(where, text, at_worst, departure)
        # What the links lack.
        for link, start in (("regulator", "The regulator"), ("piston", "(?:Chambers and piston|Along its measured motion)"), ("contact", "The contact")):
            own = self.of.balance[self.of.balance.link == link]
            report = next((r for r in of.json["links"] if r["link"] == link), None)
            if report is None or not re.match(start, text):
                continue
            factor = 1e-2 if link == "regulator" else 1.0
            size = factor * rms(own.before.to_numpy(dtype=float)) if len(own) else math.nan
            text = self.take(where, text, rf"(?P<rms>{NUMBER}) (?:mbar|N) RMS", lambda _: {"rms": size})
            text = self.take(where, text, rf"(?P<sigmas>{NUMBER}) times", lambda _: {"sigmas": report["sigmas"]})
            shares = {r["variable"].removesuffix("_m").replace("_", " "): 100 * r["share"] for r in report["regimes"]}
            for variable, share in shares.items():
                text = self.take(where, text, rf"{variable} \((?P<share>{NUMBER}) %\)", lambda _: {"share": share})
        self.shares(where, text, next_one)

    def shares(self, where, text, next_one):
        """Probabilities, shares, odds: those of diagnosis.json."""
        if "How to run" in where:
            return  # Commands and paths.
        of = self.of
        considered = {" and ".join(c["effects"]): c for c in of.json["considered"]}
        share = of.json["explained_share"]
        text = text.replace("more than 99.9 % of the mismatch", " ") if share and share >= 0.9995 else text
        for chance in [e["confidence"] for e in of.json["effects"]]:
            if chance > 0.999:
                text = text.replace("above 99.9 %", " ")
            text = self.take(where, text, rf"Probability (?P<chance>{NUMBER}) %", lambda m: {"chance": min((100 * e["confidence"] for e in of.json["effects"]), key=lambda c: abs(c - float(m.group("chance"))))})
        text = re.sub(r"[A-Z][^.:]*: probability [^.]*?\d+\.\d %, whichever of its laws it is; of these .*? %\.(?= |$)", lambda m: self.family(where, m.group(0)), text)
        if share is not None:
            known = [share] + [n.get("share_explained") for e in of.json["effects"] for n in (e.get("nearest") or {}).get("effects", [])]
            nearest = lambda m: min((100 * s for s in known if s is not None), key=lambda s: abs(s - float(m.group("share"))))
            text = self.take(where, text, rf"(?P<share>{NUMBER}) % of the mismatch", lambda m: {"share": nearest(m)})
            text = self.take(where, text, rf"the term (?P<share>{NUMBER}) %", lambda m: {"share": nearest(m)})
            text = re.sub(r"(?:the term )?more than 99\.9 %", " ", text)
        text = self.take(where, text, rf"stand (?P<sigmas>{NUMBER}) standard deviations", lambda _: {"sigmas": next_one["sigmas"]})
        powers = [c["log10_odds"] for c in considered.values()] + [math.log10(a["odds"]) for a in of.json["alternatives"]]
        near = lambda value: min(powers, key=lambda p: abs(p - value), default=math.nan)
        if "below 1 to 10^6" in text:
            self.check.fact(f"{where}: odds below 1 to 10^6", max(powers) <= -6, True)
            text = text.replace("below 1 to 10^6", " ")
        if "above 10^6 to 1" in text:
            self.check.fact(f"{where}: odds above 10^6 to 1", min(powers) <= -6 or max(powers) >= 6, True)
            text = text.replace("above 10^6 to 1", " ")
        text = self.take(where, text, rf"(?P<odds>{NUMBER}) to 1\b(?!\.)", lambda m: {"odds": 10 ** near(math.log10(float(m.group("odds"))))})
        text = self.take(where, text, rf"1 to (?P<odds>{NUMBER})", lambda m: {"odds": 10 ** -near(-math.log10(float(m.group("odds"))))})
        # Counts of what was tried stand in no file; 95 % is the level of every interval.
        for known in (r"those of 95 %", r"at no more than 90 %", r"95 % interval", r"chambers? [12]", r"of \d+ other explanations", r"none of the \d+ effects", r"of the \d+ experiments", r"joint \d", r"all \d+ recordings", r"in \d+ stretches that make [\d.]+ s", r"m/s2|mm2|cm3"):
            text = re.sub(known, " ", text)
        if self.of.json["remaining"] or any(e["name"] == "unlisted" for e in of.json["effects"]):
            return  # A part of the device or a model discrepancy: its own numbers are those of diagnosis.json.
        if re.search(r"(?<![A-Za-z_])\d", re.sub(r"\w+_\w+", " ", text)):
            self.check.uncovered(where, text)

    def family(self, where, sentence):
        """A family's sentence: its probability, those of its laws, none of them above the family's."""
        family = next(f for f in self.of.json.get("families", []) if sentence.lower().startswith(f"{f['words'].lower()}:"))
        known = [family["probability"]] + [m["probability"] for m in family["members"]]
        printed = re.findall(rf"above 99\.9 %|{NUMBER} %", sentence)
        self.check.fact(f"{where}: probabilities of `{sentence}`", len(printed), len(known))
        for text, value in zip(printed, known):
            if text.startswith("above"):
                self.check.fact(f"{where}: {text}", value > 0.999, True)
            else:
                self.number(f"{where}: `{sentence}`", text.removesuffix(" %"), 100 * value)
        self.check.fact(f"{where}: no law is surer than its family", max(known) <= known[0] + 1e-12, True)
        self.check.fact(f"{where}: laws of a family exclude one another", sum(known[1:]) <= known[0] + 1e-9, True)
        return " "

    # report.html, diagnosis.rrd

    def page(self):
        page = Page((self.of.folder / "report.html").read_text())
        for table in page.tables:
            self.document_table("page", table["rows"])

    def document_table(self, where, rows_):
        """A table of the document, on the page or in the viewer."""
        of = self.of
        head = [h.strip() for h in rows_[0]] if rows_ else []
        if "nominal, σ" in head:
            for row in rows_[1:]:
                cells = dict(zip(head, row))
                column = next(c for c, (w, *_) in CHANNELS.items() if w == cells["channel"])
                rows = of.fitted[of.fitted.recording == cells["recording"]]
                factor = CHANNELS[column][2]
                for model, shown, sigma in (("believed", "nominal", "nominal, σ"), ("improved", "improved", "improved, σ"), ("tolerated", None, "within tolerances, σ")):
                    size, sigmas = of.size(rows, model, column)
                    if shown:
                        self.number(f"{where}: {row}", cells[shown].split()[0], factor * size)
                    self.number(f"{where}: {row}", cells[sigma], sigmas)
                if cells.get("not fitted to, σ", "–") != "–":
                    self.number(f"{where}: {row}", cells["not fitted to, σ"], of.size(rows, "left_out", column)[1])
        if "within tolerances" in head:
            for row in rows_[1:]:
                cells = dict(zip(head, row))
                column = next((c for c, (w, *_) in CHANNELS.items() if w == cells["channel"]), None)
                if column is None:
                    continue  # A joint's: not in comparison.parquet.
                in_turn = cells["recording"] == IN_TURN
                rows, after = (of.fitted, "left_out") if in_turn else (of.kept, "improved")
                for shown, model in (("nominal", "believed"), ("within tolerances", "tolerated"), ("improved", after)):
                    size, sigmas = of.size(rows, model, column)
                    self.number(f"{where}: {row}", cells[shown].split()[0], CHANNELS[column][2] * size)
                self.number(f"{where}: {row}", cells["improved, σ"], sigmas)
        if "odds" in head:
            for row, considered in zip(rows_[1:], of.json["considered"]):
                close = considered["log10_odds"] >= LEAST_ODDS
                judged = "not ruled out" if close else "ruled out" if considered["in_full"] else "fell behind"
                self.check.fact(f"{where}: {row}", row[1], judged)


    def viewer(self):
        of = self.of
        text = viewer_text(of.folder / "diagnosis.rrd")
        tables, others = markdown_tables(text)
        flat = " ".join(" ".join(others).split())
        for section in of.json["account"]["sections"]:
            for paragraph in section["paragraphs"]:
                self.check.fact(f"viewer: {section['title']}", " ".join(paragraph.replace("\\", "").split()) in flat.replace("\\", ""), True)
        self.check.fact("viewer: tables", len(tables) > 0, True)
        for rows in tables:
            self.document_table("viewer", rows)

    # Statements

    def statements(self):
        of, fact = self.of, self.check.fact
        account = of.json["account"]
        text = " ".join(p for s in account["sections"] for p in s["paragraphs"]).replace("\u00a0", " ")
        page = (of.folder / "report.html").read_text()
        for fixed in FIXED:
            fact(f"`{fixed}` is not said", fixed in text or fixed in page, False)
        if of.is_flange:
            return
        beyond = [e for e in of.errors() if e[0] > NOISE_ALONE]
        left = " ".join(p for s in account["sections"] if s["kind"] == "remaining" for p in s["paragraphs"])
        fact("`no more than noise is left` agrees with every channel, the kept-back ones too", bool(re.search(r"\bNo more than", left)), not beyond)
        fact("`more than noise` agrees", bool(re.search(r"More than .* in \d+ of", left)), bool(beyond))
        if of.json["effects"]:
            fact("a share explained comes with what it leaves", bool(re.search(r"of the mismatch, and leaves? no more than", text)), not beyond and of.json["explained_share"] is not None)
        else:
            fact("`nothing is missing`", account["headline"] == "nothing is missing", not beyond and not of.json["remaining"])
            fact("`Nowhere.`", "Nowhere." in text, not any(e[0] > NOISE_ALONE and not e[4] for e in of.errors()))
        close = [c for c in of.json["considered"] if c["log10_odds"] >= LEAST_ODDS] or of.json["alternatives"]
        if "No further recording is needed" in text:
            fact("`no further recording is needed` beside rivals that are not ruled out", bool(close), False)
        for alternative in of.json["alternatives"]:
            fact("an alternative at least at odds of 1 to 100", alternative["odds"] >= 10**LEAST_ODDS, True)
        for link in of.json["links"]:
            own = of.balance[of.balance.link == link["link"]]
            if len(own):
                fact(f"{link['link']} explains its recording", link["explained"], link["sigmas"] <= NOISE_ALONE)
        self.limits(text)

    def limits(self, text):
        """Numbers that stand at the end of their tolerance are said to."""
        rig = self.case / self.of.folder.name / "rig.toml" if self.case else None
        if rig is None or not rig.exists():
            return
        nominal = tomllib.loads(rig.read_text())
        for tolerated in self.of.json["tolerated"]:
            entry = nominal
            for key in tolerated["key"].split("."):
                entry = entry.get(key, {}) if isinstance(entry, dict) else {}
            if not isinstance(entry, dict) or "tolerance" not in entry:
                continue
            half = entry["tolerance"] * abs(entry["value"])
            at = abs(tolerated["found"]["value"] - entry["value"]) > 0.981 * half
            words, unit, factor = words_of(tolerated["key"])
            said = re.search(rf"{re.escape(words)} {NUMBER}[^;]*? at the (lower|upper) end", text)
            self.check.fact(f"{tolerated['key']} stands at the end of its tolerance", bool(said), at)


def folders(path):
    return [path] if (path / "diagnosis.json").exists() else sorted(p.parent for p in path.glob("*/diagnosis.json"))


def examine(path, case=None):
    return [Examination(folder, case).run() for folder in folders(Path(path))]


def three():
    """Diagnoses of cases that the project holds, and the folder of those cases."""
    cases, found = RESULTS / "cases", RESULTS / "diagnoses"
    own = cases / "first"
    logs = sorted((PROJECT / "assets/first").glob("*.csv"))
    run("import", "assets/first/map.toml", *logs, "--out", f"{own}/", "--force")
    run("new", "rig", own / "rig.toml", "--force")
    rig = (own / "rig.toml").read_text()
    kept_back = rig.replace('# predict = "unseen.parquet"', 'predict = "cycle.parquet"')
    assert kept_back != rig, "the rig file's line of the recording to be predicted has changed"
    (own / "rig.toml").write_text(kept_back)
    for name in ("case-06", "case-09"):
        shutil.copytree(PROJECT / "assets/proof/cases" / name, cases / name, dirs_exist_ok=True)
    run("diagnose", cases, "--all", "--out", found, "--force")
    return found, cases


if __name__ == "__main__":
    where, cases = (sys.argv[1:] + [None])[:2] if len(sys.argv) > 1 else three()
    done = examine(where, cases and Path(cases))
    wrong = [line for check in done for line in check.wrong]
    print("\n".join(wrong))
    print(f"{len(done)} diagnoses, {sum(check.compared for check in done)} numbers and statements compared, {len(wrong)} wrong")
    sys.exit(bool(wrong) or not done)

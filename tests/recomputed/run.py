"""Runs every scenario and recomputes from its samples what summary.json, the printed table, report.html and the viewer's text say of it."""

import base64
import hashlib
import json
import re
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd

import common
from common import Checked, Page
from definitions import BenchRun, CellRun

# What is not recomputed, and why.
NOT_RECOMPUTED = {
    "timing (wall_time_s, real_time_factor)": "differs from run to run",
    "length of the scale in a picture": "follows from the drawing's projection, tested in src/drawing",
    "samples that a chart keeps": "a choice of the drawing; that they are the recording's is checked",
    "corners of bodies and the arrow's tip in a drawing in space": "follow from poses that samples do not hold, tested in src/drawing and tests/edges.rs",
    "shades of a drawing in space": "a choice of the drawing; the values that they stand for are recomputed",
    "seed": "is not a result",
}
TIMING = {"wall_time_s", "real_time_factor"}

CELL_LABELS = {
    "desired_force_n": ("desired force", "N"), "force_mean_n": ("mean", "N"), "force_standard_deviation_n": ("standard deviation", "N"),
    "coefficient_of_variation_percent": ("coefficient of variation", "%"), "force_rms_error_n": ("RMS error", "N"),
    "force_rms_error_percent": ("RMS error", "%"), "largest_deviation_n": ("largest deviation", "N"),
    "within_5_percent_share_percent": ("within 5 % of desired", "%"), "within_10_percent_share_percent": ("within 10 % of desired", "%"),
    "loss_of_contact_share_percent": ("contact lost", "%"), "friction_force_mean_n": ("friction, mean", "N"),
    "force_peak_approach_n": ("largest, approach", "N"), "force_peak_engage_n": ("largest, engage", "N"),
    "force_peak_follow_n": ("largest, follow", "N"), "force_peak_retract_n": ("largest, retract", "N"),
    "engagement_peak_n": ("peak", "N"), "engagement_overshoot_percent": ("overshoot", "%"), "settling_time_s": ("settling time", "s"),
    "stroke_used_mm": ("stroke used", "mm"), "stroke_min_mm": ("smallest stroke", "mm"), "stroke_max_mm": ("largest stroke", "mm"),
    "stroke_margin_mm": ("stroke margin", "mm"), "path_error_rms_um": ("lateral error, RMS", "µm"), "path_error_max_um": ("lateral error, largest", "µm"),
    "path_lag_rms_um": ("lag, RMS", "µm"), "path_lag_max_um": ("lag, largest", "µm"), "drives_saturated_s": ("drives at their limit", "s"),
    "ends_chamfer_leg_min_mm": ("ends, leg, least", "mm"), "ends_chamfer_leg_max_mm": ("ends, leg, largest", "mm"),
    "ends_residual_burr_max_mm": ("ends, highest burr", "mm"), "ends_out_of_tolerance_share_percent": ("ends, out of tolerance", "%"),
    "whole_edge_out_of_tolerance_share_percent": ("out of tolerance, whole", "%"), "ends_length_mm": ("ends, length of each", "mm"),
    "path_length_mm": ("length followed", "mm"), "feed_mean_mm_per_s": ("feed, mean", "mm/s"), "follow_duration_s": ("time of following", "s"),
    "joint_torque_share_percent": ("joint torque / limit", "%"), "air_mass_balance_relative": ("air balance, largest gap", ""), "duration_s": ("cycle time", "s"),
    "wall_time_s": ("wall time", "s"), "real_time_factor": ("real-time factor", ""), "burr_before_max_mm": ("burr before, highest", "mm"),
    "chamfer_leg_mean_mm": ("chamfer leg, mean", "mm"), "chamfer_leg_standard_deviation_mm": ("chamfer leg, spread", "mm"), "chamfer_leg_min_mm": ("chamfer leg, least", "mm"),
    "chamfer_leg_max_mm": ("chamfer leg, largest", "mm"), "residual_burr_max_mm": ("burr left, highest", "mm"), "residual_burr_share_percent": ("burr left", "%"),
    "out_of_tolerance_share_percent": ("out of tolerance", "%"), "section_removed_mean_mm2": ("section removed, mean", "mm2"), "section_variation_percent": ("section, variation", "%"),
    "removed_volume_mm3": ("volume removed", "mm3"), "removal_rate_mean_mm3_per_s": ("removal rate, mean", "mm3/s"), "spindle_power_max_w": ("spindle power, largest", "W"),
    "spindle_energy_kj": ("spindle energy", "kJ"), "tool_wear_kj": ("tool wear", "kJ"), "air_used_g": ("air used", "g"),
}
BENCH_LABELS = {
    "desired_force_n": ("desired force", "N"), "force_mean_n": ("mean", "N"), "force_rms_error_n": ("RMS error", "N"), "force_rms_error_percent": ("RMS error", "%"),
    "force_largest_error_percent": ("largest error", "%"), "coefficient_of_variation_percent": ("coefficient of variation", "%"), "force_peak_n": ("largest", "N"),
    "regulator_delay_s": ("regulator's delay", "s"), "force_settling_time_s": ("settling time", "s"), "force_overshoot_percent": ("overshoot", "%"),
    "force_slope_n_per_bar": ("force over pressure", "N/bar"), "force_linearity_percent": ("linearity error", "%"), "first_contact_s": ("first contact", "s"),
    "impact_peak_n": ("impact peak", "N"), "stroke_min_mm": ("smallest stroke", "mm"), "stroke_max_mm": ("largest stroke", "mm"), "stroke_margin_mm": ("stroke margin", "mm"),
    "measured_force_error_percent": ("load cell's error", "%"), "measured_force_noise_n": ("load cell's noise", "N"),
    "estimated_force_rms_error_percent": ("estimator's RMS error", "%"), "estimated_force_coverage_percent": ("estimator's coverage", "%"),
    "air_consumed_normal_litres": ("air consumed", "l"), "air_mass_balance_relative": ("air balance, largest gap", ""), "duration_s": ("simulated time", "s"),
    "wall_time_s": ("wall time", "s"), "real_time_factor": ("real-time factor", ""),
}
LEVELS = [("at", "s", "start_s"), ("set", "bar", "set_pressure_bar_gauge"), ("outlet", "bar", "regulator_pressure_bar_gauge"), ("delay", "s", "regulator_delay_s"),
          ("force", "N", "force_mean_n"), ("read", "N", "measured_force_mean_n"), ("settled", "s", "force_settling_time_s"), ("stroke", "mm", "stroke_mm")]
# Numbers within fixed words, which define rather than tell.
FIXED = ["touch until it stays in ±5 %", "first command to 63 % of its change", "last command until within 5 %", "first 50 ms of contact",
         "mean of reading over truth, less 1", "truth inside its 95 % band, in contact", "drawn in, at 20 °C and 1 bar"]
FAR = [f"{word} the desired force: {{desired_force_n}} N desired, {{force_mean_n}} N on average ({{off_percent}} %), RMS error {{force_rms_error_percent}} %" for word in ("Off", "Far from")]
NOTES = {
    "force_mean_n": ["desired {desired_force_n} N ({off_percent} %)"],
    "force_rms_error_n": ["{force_rms_error_percent} % of the desired force"],
    "engagement_peak_n": ["{engagement_overshoot_percent} % above desired", "not above the desired force"],
    "stroke_used_mm": ["from {stroke_min_mm} to {stroke_max_mm} mm"],
    "path_length_mm": ["at {feed_mean_mm_per_s} mm/s on average"],
    "chamfer_leg_mean_mm": ["from {chamfer_leg_min_mm} to {chamfer_leg_max_mm} mm"],
    "out_of_tolerance_share_percent": ["with its ends {whole_edge_out_of_tolerance_share_percent} %"],
    "ends_out_of_tolerance_share_percent": ["{ends_length_mm} mm at either end"],
    "ends_chamfer_leg_max_mm": ["from {ends_chamfer_leg_min_mm} to {ends_chamfer_leg_max_mm} mm"],
    "residual_burr_max_mm": ["too much of it on {residual_burr_share_percent} %"],
    "removed_volume_mm3": ["at {removal_rate_mean_mm3_per_s} mm3/s while cutting"],
    "duration_s": ["following {follow_duration_s} s of it"],
}


# Words beside the drawing in space.
SPACE = ["The whole cell is that in the middle of following; its arrow is the contact force with its friction."]
SPACE.append(f"{SPACE[0]} The finished edge is that after all passes, ends and all, each piece in the colour of the leg that is farthest out of tolerance: green within it, blue too little, orange too much.")


def floats(text):
    """Numbers as a page packs them."""
    return np.frombuffer(base64.b64decode(text), "<f4")


def full_label(key, label):
    """As a label stands alone: `force, mean`."""
    subject = next((subject for subject in ("force", "engagement") if key.startswith(subject) and subject not in label), None)
    return f"{subject}, {label}" if subject else label


class Job:
    """A scenario, what was written of it, and what it should say."""

    def __init__(self, scenario):
        self.checked = Checked(scenario.stem)
        self.folder = common.RESULTS / scenario.stem
        self.printed = common.run("run", scenario.relative_to(common.PROJECT), "--out", self.folder, "--force", codes=(0, 1))
        samples = pd.read_parquet(self.folder / "samples.parquet")
        self.document = json.loads((self.folder / "summary.json").read_text())
        self.is_bench = self.document.get("kind") == "bench"
        self.run = (BenchRun if self.is_bench else CellRun)(scenario, samples, self.folder)
        if not self.is_bench:
            # The edge is the mesh's: tested in src/workpiece.
            stated = json.loads(common.run("check", scenario.relative_to(common.PROJECT), "--json"))
            self.run.edge_length = stated["numbers"]["edge_length_mm"] / 1e3
        self.numbers = self.run.numbers()
        self.labels = BENCH_LABELS if self.is_bench else CELL_LABELS
        n = self.numbers
        n["off_percent"] = None
        if n.get("desired_force_n") and n.get("force_mean_n") is not None:
            n["off_percent"] = 100 * (n["force_mean_n"] - n["desired_force_n"]) / n["desired_force_n"]
        self.units = {key: unit for key, (_, unit) in self.labels.items()}

    def check(self):
        self.summary()
        if not self.is_bench:
            self.of_the_arm()
        self.table()
        self.viewer()
        self.page()
        return self.checked

    def of_the_arm(self):
        """What joint angles and the URDF say of the samples: lateral error and lag, and the torques that hold arm, housing, slide and force."""
        off, compared = self.run.path_errors()
        self.checked.fact("samples: lateral error and lag are those of the joint angles, to a tenth of a micrometre", bool(off < 1e-7 and compared > 100), True)
        recorded, held = self.run.holding()
        allowed = 0.2 + 0.005 * np.abs(held).max()
        self.checked.fact("samples: torques at rest are those that hold arm, housing, slide and force", bool(np.abs(recorded - held).max() < allowed), True)
        flange = self.run.device.get("housing_mass_kg", 0.0) + self.run.device["moving_mass_kg"]
        stated = json.loads(common.run("check", self.run.path.relative_to(common.PROJECT), "--json"))["numbers"]
        self.checked.exact("idc check: load on the flange", stated["flange_load_kg"], flange, relative=1e-9)

    # summary.json

    def summary(self):
        def compare(where, found, value):
            if isinstance(found, dict):
                for key in found:
                    compare(f"{where}.{key}", found[key], (value or {}).get(key))
            elif isinstance(found, list):
                self.checked.fact(f"{where}, entries", len(found), len(value or []))
                for index, entry in enumerate(found[: len(value or [])]):
                    compare(f"{where}[{index}]", entry, value[index])
            elif isinstance(found, str):
                self.checked.fact(where, found, value)
            elif where.endswith("air_mass_balance_relative") and found is not None:
                # A difference of rounding errors: of its size, not to its digits.
                self.checked.fact(where, abs(found) < 1e-9 and abs(value) < 1e-9 and (found == value or abs(found - value) < 1e-12), True)
            else:
                self.checked.exact(where, found, value, relative=1e-7)

        stated = {key: value for key, value in self.document["summary"].items() if key != "timing"}
        for key, value in stated.items():
            if key not in self.numbers and value is not None:
                self.checked.uncovered("summary.json", key)
            else:
                compare(f"summary.json: {key}", value, self.numbers.get(key))
        missing = [key for key, value in self.numbers.items() if key not in stated and key != "off_percent" and value is not None]
        self.checked.fact("summary.json: keys that are missing", missing, [])
        self.checked.fact("summary.json: samples", self.document["samples"], len(self.run.samples))
        bounds = self.run.scenario.get("expect", {})
        self.checked.fact("summary.json: bounds", sorted(e["metric"] for e in self.document["expectations"]), sorted(bounds))
        for e in self.document["expectations"]:
            value, bound = self.numbers[e["metric"]], bounds[e["metric"]]
            self.checked.exact(f"bound {e['metric']}", e["value"], value, relative=1e-7)
            kept = value is not None and bound.get("min", -np.inf) <= value <= bound.get("max", np.inf)
            self.checked.fact(f"bound {e['metric']}: kept", e["kept"], bool(kept))
            self.checked.fact(f"bound {e['metric']}: ends", (e["min"], e["max"]), (bound.get("min"), bound.get("max")))

    # The text in the terminal: the same document as the viewer's, so the same numbers

    def table(self):
        def numbers(text):
            return sorted(re.findall(common.NUMBER, re.sub(r"\\(.)", r"\1", text)))

        printed = self.printed[: self.printed.rindex("written to ")]
        viewer = common.viewer_text(self.folder / "recording.rrd").partition("## The edge before and after")[0]
        missing = [n for n in numbers(printed) if n not in numbers(viewer)] + [n for n in numbers(viewer) if n not in numbers(printed)]
        self.checked.fact("terminal: numbers that the viewer's text has not, or the other way round", missing, [])
        self.checked.fact("terminal: longest line", max(map(len, printed.splitlines())) <= 80, True)

    # Tables of the document, on a page and in the viewer

    def document_table(self, where, head, rows):
        """A table that page and viewer share; whether it is one."""
        by_label = {}
        for key, (label, unit) in self.labels.items():
            by_label.setdefault((label, unit), key)
        if head == ["verdict", "number", "value", "bounds"]:
            for word, label, printed, ends in rows:
                passed = re.fullmatch(r"(?:pass \d+: )?(.*)", label)[1]
                value, _, unit = printed.partition(" ")
                key = next(k for k, (own, u) in self.labels.items() if full_label(k, own) == passed and u == unit)
                self.bound(f"{where}: {label}", word, key, value, ends)
        elif head == ["part", "number", "value", "remark"]:
            for _, label, printed, note in rows:
                value, _, unit = printed.partition(" ")
                key = by_label.get((label, unit))
                if key is None:
                    self.checked.uncovered(where, f"{label} {printed}")
                    continue
                self.value(f"{where}: {key}", key, value)
                self.note(f"{where}: {key}", key, note)
        elif head[0] == "from, mm":
            for number, row in enumerate(rows):
                for printed, key in zip(row, ["from_mm", "to_mm", "force_mean_n", "force_standard_deviation_n"], strict=True):
                    self.checked.number(f"{where}: tenth {number + 1}, {key}", printed, self.numbers["force_by_tenth"][number][key])
        elif head[0] == "pass":
            self.checked.fact(f"{where}: heads", head[1:], [f"{name} [{unit}]" for name, unit, _ in self.PASSES])
            for row in rows:
                self.pass_row(f"{where}: pass {row[0]}", int(row[0]), row[1:])
        elif head[0] == "command":
            self.checked.fact(f"{where}: heads", head[1:], [f"{name} [{unit}]" for name, unit, _ in LEVELS])
            for number, row in enumerate(rows):
                for printed, (name, _, key) in zip(row[1:], LEVELS, strict=True):
                    self.checked.number(f"{where}: level {number + 1}, {name}", printed, self.numbers["levels"][number][key])
        else:
            return False
        return True

    def sentence(self, where, text):
        """A sentence of the document: verdict, remark, caption; whether it is one."""
        if text == self.document["title"] or text.startswith(("In report.html: ", "Contact force by tenths", "Each pass along the edge", "Steady values of each command", "Not determined by this run: ")):
            return True
        if found := re.fullmatch(r"(\d+) of (\d+) bounds? kept\.", text):
            self.tally(where, found)
        elif text.startswith("Note: "):
            self.checked.fact(where, text.removeprefix("Note: ").removesuffix("."), next((n for n in self.document["notes"] if n in text), None))
        elif text.startswith("Tolerance: "):
            chamfer = self.run.scenario["workpiece"].get("chamfer", {})
            stated = {"low": chamfer.get("leg_min_mm", 0.0), "high": chamfer.get("leg_max_mm"), "burr": chamfer.get("residual_burr_max_mm", 0.02)}
            leg = "{low} to {high} mm" if stated["high"] else "at least {low} mm"
            self.checked.sentence(where, text, [f"Tolerance: chamfer leg {leg}, burr at most {{burr}} mm."], stated)
        elif text.startswith("Drives at their limit: "):
            for joint, start, time in re.findall(rf"([^ ,]+) from ({common.PRINTED}) s on for ({common.PRINTED}) s", text):
                own = next(j for j in self.numbers["joints"] if j["joint"] == joint)
                self.checked.number(f"{where}: start", start, own["saturated_from_s"])
                self.checked.number(f"{where}: time", time, own["saturated_s"])
        elif "the desired force:" in text and not text.endswith("kept."):
            self.far(where, text.rstrip("."))
        else:
            return False
        return True

    def bound(self, where, word, metric, printed, ends):
        bound = self.run.scenario["expect"][metric]
        self.checked.number(where, printed, self.numbers[metric])
        low, high = bound.get("min"), bound.get("max")
        expected = [float(end) for end in (low, high) if end is not None]
        self.checked.fact(f"{where}: ends", [float(end) for end in re.findall(r"-?[\d.]+(?:e-?\d+)?", ends)], expected)
        value = self.numbers[metric]
        kept = value is not None and (low is None or value >= low) and (high is None or value <= high)
        self.checked.fact(f"{where}: kept", word.strip("*") == "ok", kept)

    def tally(self, where, found):
        kept = sum(e["kept"] for e in self.document["expectations"])
        self.checked.fact(where, found.groups(), (str(kept), str(len(self.document["expectations"]))))

    def far(self, where, text):
        """A force far from the desired one is said so, and only then."""
        off = self.numbers.get("force_rms_error_percent") if self.numbers.get("desired_force_n") else None
        self.checked.fact(f"{where}: said", off is not None and off > 5.0, True)
        self.checked.fact(f"{where}: word", text.startswith("Far from"), off is not None and off > 10.0)
        self.checked.sentence(where, text, FAR, self.numbers)

    def value(self, where, key, printed):
        if key not in TIMING:
            self.checked.number(where, printed, self.numbers.get(key))

    # Columns of the table of passes.
    PASSES = [("desired", "N", "desired_force_n"), ("mean", "N", "force_mean_n"), ("SD", "N", "force_standard_deviation_n"), ("RMS error", "%", "force_rms_error_percent"),
              ("in 5 %", "%", "within_5_percent_share_percent"), ("largest", "N", "force_peak_follow_n"), ("feed", "mm/s", "feed_mean_mm_per_s")]

    def pass_row(self, where, number, printed):
        row = next(row for row in self.numbers["passes"] if row["pass"] == number)
        for text, (_, _, key) in zip(printed, self.PASSES, strict=True):
            self.checked.number(f"{where}: {key}", text, row[key])

    def note(self, where, key, note):
        note = note.replace("\u00a0", " ")
        if key in TIMING or note in FIXED:
            return
        if key == "joint_torque_share_percent":
            self.checked.fact(where, note, f"largest, at {self.numbers['most_loaded_joint']}")
            return
        self.checked.sentence(f"{where}: note", note, NOTES.get(key, []), self.numbers)

    # The viewer's text

    def viewer(self):
        tables, others = common.markdown_tables(common.viewer_text(self.folder / "recording.rrd"))
        verdict, sections = None, ("Along the edge", "Passes", "Commands", "Bounds", "Numbers", "Finished edge", "Signals", "Cell and edge", "The bench", "The arm", "The edge before and after")
        for line in others:
            where, marks, line = f"viewer: `{line}`", line.startswith("## "), line.strip("#* ")
            if self.sentence(where, line) or line in sections:
                continue
            if marks and verdict is None:
                verdict = line
                self.verdict(where, line)
            elif found := re.fullmatch(r"Drawn (\d+) times as large as it is\.", line):
                self.checked.fact(where, int(found[1]), self.enlarged())
            elif line == "Force, peaks, touch, stroke and path are those of the first pass.":
                # The numbers themselves are recomputed from its phase alone.
                self.checked.fact(where, len(self.numbers["passes"]) > 1, True)
            else:
                self.checked.uncovered("viewer", line)
        for head, *rows in tables:
            self.viewer_table(head, rows)

    def enlarged(self):
        """The largest of 1, 2, 5, 10, .. by which neither burr nor chamfer is drawn larger than 6 % of the edge, which is straight here."""
        profile = pd.read_csv(self.folder / "edge_profile.csv")
        largest = max(profile.burr_before_mm.max(), profile.chamfer_leg_mm.max())
        length = profile.position_mm.iloc[-1] - profile.position_mm.iloc[0]
        fits = [step * 10**power for power in range(4) for step in (1, 2, 5) if step * 10**power * largest <= 0.06 * length]
        return max(fits, default=1)

    def legend(self, where, row):
        chamfer = self.run.scenario["workpiece"].get("chamfer", {})
        if row[0].strip("`") == "/cell/edge/after":
            least, most = (chamfer.get(key) for key in ("leg_min_mm", "leg_max_mm"))
            ends = [float(end) for end in (least, most) if end]
            printed = re.search(r"within the tolerance, ([^.]*(?:\.\d[^.]*)*)\. Blue", row[1])[1]
            self.checked.fact(where, [float(end) for end in re.findall(r"[\d.]+", printed)], ends)
        elif row[0].strip("`") == "/cell/edge/residual_burr":
            self.checked.fact(where, float(re.search(r"more than ([\d.]+) mm", row[1])[1]), float(chamfer.get("residual_burr_max_mm", 0.02)))

    def viewer_table(self, head, rows):
        rows = [[cell.strip("*") for cell in row] for row in rows]
        if self.document_table("viewer", head, rows):
            return
        for row in rows:
            where = f"viewer: {' | '.join(row)}"
            if head[0] == "entity":
                self.legend(where, row)
            elif head == ["", "", ""]:
                self.key_fact(where, *row)
            else:
                self.checked.uncovered("viewer", " | ".join(row))

    # report.html

    def page(self):
        page = Page((self.folder / "report.html").read_text())
        for table in page.tables:
            self.page_table(table)
        self.facts(page)
        for tag, kind, text in page.texts:
            if text.strip() and tag not in ("dt", "dd", "small"):
                self.page_text(tag, kind, " ".join(text.split()))
        for data in map(json.loads, page.charts):
            if "bodies" in data:
                self.space(data)
            else:
                self.chart(data)

    def page_text(self, tag, kind, text):
        where = f"page: {tag} {kind}"
        if text == self.document["title"] or kind == "hint":
            return
        if kind.startswith("verdict"):
            self.verdict(where, text)
        elif kind == "lead" and self.sentence(where, text):
            pass
        elif tag == "text":
            self.picture(where, text)
        elif text.startswith("Scenario "):
            self.checked.fact(where, text, f"Scenario {self.document['scenario']}, {len(self.run.samples)} samples.")
        elif text.startswith("Made by idc"):
            pass
        elif tag == "figcaption" and ("400 pieces" in text or "with its friction" in text):
            pass
        elif kind == "" and (found := re.search(r"\((\d+) of (\d+) samples: the extremes of each stretch\)", text)):
            whole = (len(self.run.samples), len(self.run.phase("follow")) if not self.is_bench else 0)
            self.checked.fact(where, int(found[2]) in whole, True)
        elif text.startswith("These numbers rest on values"):
            judged = self.document["judged"]
            keys = [value["key"] for value in judged if not value["key"].startswith("device.")]
            self.checked.fact(f"{where}: keys", sorted(re.findall(r"(?:removal|workpiece)\.[\w.]*\w", text)), sorted(keys))
            many = re.search(r"(\d+) values? that the device model marks", text)
            self.checked.fact(f"{where}: values of the device", int(many[1]) if many else 0, len(judged) - len(keys))
        elif text.endswith(": 0 throughout."):
            # A chart of nothing: a test of src/document plants one.
            pass
        elif re.search(r"\d", text):
            self.checked.uncovered(where, text)

    def verdict(self, where, text):
        bounds = len(self.document["expectations"])
        text = text.removesuffix(".")
        kept = {0: "", 1: ". Its bound is kept"}.get(bounds, f". All {bounds} bounds are kept")
        if text.startswith("Stopped early"):
            self.checked.fact(where, text, f"Stopped early: {self.document['stopped']}")
        elif text.startswith("Outside its bounds: "):
            broken = [e for e in self.document["expectations"] if not e["kept"]]
            parts = text.removeprefix("Outside its bounds: ").split("; ")
            for part, bound in zip(parts, broken, strict=True):
                unit = self.units[bound["metric"]]
                self.checked.number(where, re.search(rf" is ({common.PRINTED})", part)[1], self.numbers[bound["metric"]])
                ends = [float(end) for end in re.findall(r"(?:least|most) (-?[\d.]+)", part)]
                self.checked.fact(where, (ends, unit in part), ([e for e in (bound["min"], bound["max"]) if e is not None], True))
        elif "the desired force:" in text:
            self.checked.fact(where, text.endswith(kept), True)
            self.far(where, text.removesuffix(kept) if kept else text)
        else:
            edge = "of {chamfer_leg_mean_mm} mm on average, {out_of_tolerance_share_percent} % of the edge out of tolerance, in {duration_s} s"
            said = ["Burr of up to {burr_before_max_mm} mm before, {residual_burr_max_mm} mm after; chamfer " + edge, "Chamfer " + edge,
                    "{force_mean_n} N on average where {desired_force_n} N is desired, standard deviation {force_standard_deviation_n} N",
                    "{force_mean_n} N on average where {desired_force_n} N is desired", "{force_mean_n} N in contact", "Done"]
            self.checked.fact(where, text.endswith(kept), True)
            self.checked.sentence(where, text.removesuffix(kept) if kept else text, said, self.numbers)
            off = self.numbers.get("force_rms_error_percent") if self.numbers.get("desired_force_n") else None
            self.checked.fact(f"{where}: a force that is off is said so", off is not None and off > 5.0 and "chamfer_leg_mean_mm" not in self.numbers, False)

    def facts(self, page):
        texts = page.texts
        for index, (tag, _, name) in enumerate(texts):
            if tag == "dt":
                remark = texts[index + 2][2] if index + 2 < len(texts) and texts[index + 2][0] == "small" else ""
                self.key_fact(f"page: {name}", name, texts[index + 1][2], remark)

    def key_fact(self, where, name, value, remark):
        printed, _, unit = value.strip().partition(" ")
        # Two numbers may share a name; the unit tells them apart.
        key = next((k for k, (label, own) in self.labels.items() if full_label(k, label) == name and own == unit), None)
        if key is None:
            self.checked.uncovered(where, f"{name}: {value}")
            return
        self.value(where, key, printed)
        self.note(where, key, remark)

    def page_table(self, table):
        head, *rows = table["rows"]
        if head[:2] == ["number", "value"]:
            for name, printed, unit, bound, meaning, key in rows:
                where = f"page: {key}"
                self.checked.fact(where, (name, unit), (full_label(key, self.labels[key][0]), self.labels[key][1]))
                self.value(where, key, printed)
                own = self.run.scenario.get("expect", {}).get(key, {})
                ends = [float(own[end]) for end in ("min", "max") if end in own]
                self.checked.fact(f"{where}: bounds", [float(end) for end in re.findall(r"(?:least|most) (-?[\d.]+)", bound)], ends)
                if meaning not in FIXED:
                    self.checked.sentence(where, meaning, [], self.numbers)
        elif self.document_table("page", head, rows):
            caption = table["caption"]
            if caption and not self.sentence("page", caption):
                self.checked.uncovered("page", caption)
        elif head[0] == "file":
            for name, size, digest in rows:
                data = (common.PROJECT / name).read_bytes()
                self.checked.fact(f"page: {name}", (size, digest), (str(len(data)), hashlib.sha256(data).hexdigest()))
        else:
            self.checked.uncovered("page", f"table {head}")

    def picture(self, where, text):
        if found := re.fullmatch(rf"at ({common.PRINTED}) s", text):
            self.checked.number(where, found[1], self.run.moment())
        elif found := re.fullmatch(rf"({common.PRINTED}) N", text):
            self.checked.number(where, found[1], self.force_shown())
        elif found := re.fullmatch(r"[−+]([\d.]+) %", text):
            self.checked.exact(where, float(found[1]), self.run.colour_scale(), relative=1e-6)
        elif found := re.fullmatch(rf"lean_deg = ({common.PRINTED}), towards the (left|right) face", text):
            lean = self.run.scenario["process"].get("lean_deg", 0.0)
            self.checked.number(where, found[1], lean)
            self.checked.fact(f"{where}: side", found[2], "left" if lean > 0 else "right")
        elif text == "along the bisector":
            self.checked.fact(where, self.run.scenario["process"].get("lean_deg", 0.0), 0.0)
        elif not re.fullmatch(r"[\d.]+ mm", text):
            self.checked.sentence(where, text, [], self.numbers)

    def force_shown(self):
        """The force on the part, with its friction, at the frame nearest to the moment; frames come every 20 ms."""
        times = self.run.time
        frames = np.unique(np.searchsorted(times, np.arange(0, times[-1] + 0.02, 0.02) - 1e-9))
        frames = frames[frames < len(times)]
        nearest = frames[np.argmin(np.abs(times[frames] - self.run.moment()))]
        if self.is_bench:
            return float(self.run.column("contact_force_n")[nearest])
        return float(np.linalg.norm([self.run.column(f"contact_force_{axis}_n")[nearest] for axis in "xyz"]))

    def space(self, stated):
        """The drawing in space: each piece of the edge has the mean force error of its samples, its legend their scale, its arrow the force."""
        where = "page, in space"
        errors = self.run.piece_errors()
        # Lines of the finished edge have views of their own: tests/drawn.rs.
        (edge,) = [line for line in stated["lines"] if line["view"] is None or not stated["views"][line["view"]]["name"].startswith("Finished")]
        values = floats(edge["values"])
        self.checked.fact(f"{where}: pieces", len(values), len(errors))
        for number, (value, error) in enumerate(zip(values, errors)):
            known = [float(v) if np.isfinite(v) else None for v in (value, 100 * error)]
            self.checked.exact(f"{where}: error of piece {number + 1}", *known, relative=1e-6)
        points = floats(edge["points"]).reshape(-1, 3)
        self.checked.fact(f"{where}: ends of pieces", len(points), len(errors) + 1)
        # The path is followed to its end.
        self.checked.fact(f"{where}: edge followed", abs(np.nanmax(self.run.column("path_length_m")) - self.run.edge_length) < 1e-5, True)
        self.checked.sentence(f"{where}: {edge['facts'][0][0]}", edge["facts"][0][1], ["{edge} mm"], {"edge": 1e3 * self.run.edge_length})
        self.checked.fact(f"{where}: facts", len(edge["facts"]), 1)
        scale = self.run.colour_scale()
        for printed, end in zip(stated["legend"]["ends"], (-scale, None, scale), strict=True):
            if end is None:
                self.checked.fact(f"{where}: legend", printed, "as desired")
            else:
                self.checked.sentence(f"{where}: legend", printed, ["{end} %"], {"end": end})
        self.checked.fact(f"{where}: pieces without contact are in the legend", bool(stated["legend"]["none"]), bool(np.isnan(errors).any()))
        self.checked.sentence(f"{where}: arrow", stated["arrow"]["label"], ["{force} N"], {"force": self.force_shown()})
        self.checked.exact(f"{where}: arrow, length", float(np.linalg.norm(stated["arrow"]["along"])), 1.0, relative=1e-6)
        self.checked.sentence(f"{where}: words", stated["words"], [f"The mean force error of each of {{pieces}} pieces of the edge while following. {words}" for words in SPACE], {"pieces": len(errors)})

    def chart(self, stated):
        """All that a chart draws is in the samples, or of a finished edge in edge_profile.csv."""
        if stated["y"] in ("leg [mm]", "height [mm]"):
            known = np.sort(pd.read_csv(self.folder / "edge_profile.csv").to_numpy().ravel())
            for series in stated["series"]:
                drawn = floats(series["values"])
                drawn = drawn[np.isfinite(drawn)].astype(float)
                after = np.clip(np.searchsorted(known, drawn), 1, len(known) - 1)
                off = np.minimum(np.abs(drawn - known[after]), np.abs(drawn - known[after - 1])) > 1e-6 * np.maximum(1.0, drawn)
                self.checked.fact(f"chart {stated['y']}: {series['label']}: values that no station has", int(off.sum()), 0)
            return
        factor = {"force [N]": 1.0, "stroke [mm]": 1e3, "pressure [bar absolute]": 1e-5, "error [µm]": 1e6, "torque [N m]": 1.0}.get(stated["y"])
        if factor is None:
            self.checked.uncovered("chart", stated["y"])
            return
        for series in stated["series"]:
            drawn = floats(series["values"])
            drawn = drawn[np.isfinite(drawn)]
            known = self.run.samples.select_dtypes("number").to_numpy() * factor
            fits = np.isin(drawn, known.astype("f4"))
            self.checked.fact(f"chart {stated['y']}: {series['label']}: values that no sample has", int((~fits).sum()), 0)


# Scenarios that show what is refused: they leave nothing to recompute.
REFUSED = {"weak_supply": "its force is beyond the supply"}


def main():
    scenarios = sorted((common.PROJECT / "scenarios").glob("*.toml"))
    wanted = sys.argv[1:]
    scenarios = [scenario for scenario in scenarios if scenario.stem not in REFUSED and (not wanted or scenario.stem in wanted)]
    for name in REFUSED:
        common.run("run", f"scenarios/{name}.toml", "--out", common.RESULTS / name, "--force", codes=(2,))
    wrong, compared = [], 0
    with ThreadPoolExecutor(2) as pool:
        for checked in pool.map(lambda scenario: Job(scenario).check(), scenarios):
            print(f"{checked.name}: {checked.compared} numbers, {len(checked.wrong)} wrong")
            wrong += checked.wrong
            compared += checked.compared
    for what, why in (NOT_RECOMPUTED | REFUSED).items():
        print(f"not recomputed: {what}: {why}")
    for line in wrong:
        print(line, file=sys.stderr)
    print(f"{compared} numbers of {len(scenarios)} scenarios, {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

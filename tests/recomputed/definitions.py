"""The numbers of docs/METRICS.md, worked out anew from samples.parquet and the files that a scenario names."""

import math
import tomllib
import xml.etree.ElementTree as xml

import numpy as np
import pandas as pd

from arm import Arm, path_errors

ATMOSPHERE = 101_325.0
REFERENCE_DENSITY = 1.185


def finite(values):
    return values is not None and len(values) > 0 and np.isfinite(values).all()


class Run:
    """A run's samples, its scenario, and what both tell."""

    def __init__(self, scenario, samples, folder):
        self.path, self.samples, self.folder = scenario, samples, folder
        self.scenario = tomllib.loads(scenario.read_text())
        device = self.scenario.get("device", {})
        model = scenario.parent / device.get("model", "../models/device.toml")
        self.device = {**tomllib.loads(model.read_text())["device"], **device.get("override", {})}
        self.time = samples.time_s.to_numpy()

    def column(self, name, rows=slice(None)):
        return self.samples[name].to_numpy()[rows] if name in self.samples else None

    def air_balance(self):
        first, second, entered, left = (self.column(f"{name}_kg") for name in ("chamber_1_mass", "chamber_2_mass", "mass_entered", "mass_left"))
        if not all(map(finite, (first, second, entered, left))):
            return None
        held = first + second
        hose = self.column("hose_mass_kg")
        if finite(hose):
            held = held + hose
        gap = ((entered - entered[0]) - (left - left[0]) - (held - held[0])) / held
        return float(np.abs(gap).max())

    def stroke_ends(self):
        return 0.0, 1e-3 * self.device["stroke_mm"]


class CellRun(Run):
    """Numbers of a cell."""

    PEAKS = ("approach", "engage", "follow", "retract")

    def phase(self, name):
        phase = self.samples.phase.to_numpy() if "phase" in self.samples else np.array([])
        return np.flatnonzero(phase == name)

    def numbers(self):
        s, desired = {}, float((self.scenario.get("pass") or [{}])[0].get("force_n", self.scenario["process"]["force_n"]))
        s["desired_force_n"] = desired
        s["duration_s"] = self.time[-1] - self.time[0]
        force, follow = self.column("contact_force_n"), self.phase("follow")
        peaks = self.column("contact_force_peak_n")
        for name in self.PEAKS:
            rows = self.phase(name)
            s[f"force_peak_{name}_n"] = peaks[rows].max() if len(rows) else None
        self.touch(s, force, desired, follow)
        if len(follow):
            self.following(s, force[follow], desired, follow)
        s["passes"] = self.passes()
        self.joints(s)
        s["air_mass_balance_relative"] = self.air_balance()
        if "tool" in self.scenario:
            s.update(self.finished_edge())
        return s

    # What a row of a pass has of the numbers of the run.
    OF_PASS = ("force_mean_n", "force_standard_deviation_n", "coefficient_of_variation_percent", "force_rms_error_n", "force_rms_error_percent", "largest_deviation_n",
               "within_5_percent_share_percent", "within_10_percent_share_percent", "loss_of_contact_share_percent", "path_error_rms_um", "path_error_max_um",
               "path_lag_rms_um", "path_lag_max_um", "path_length_mm", "feed_mean_mm_per_s", "follow_duration_s")

    def passes(self):
        process = self.scenario["process"]
        listed = self.scenario.get("pass") or [{}] * process.get("passes", 1)
        rows = []
        for number, own in enumerate(listed, start=1):
            follow = self.phase("follow" if number == 1 else f"follow_{number}")
            if not len(follow):
                continue
            desired, s = float(own.get("force_n", process["force_n"])), {}
            self.following(s, self.column("contact_force_n", follow), desired, follow)
            row = {key: s[key] for key in self.OF_PASS}
            rows.append(dict(row, **{"pass": number}, desired_force_n=desired, force_peak_follow_n=self.column("contact_force_peak_n", follow).max()))
        return rows

    def angles(self, signal, rows):
        columns = []
        while f"joint_{len(columns) + 1}_{signal}_rad" in self.samples:
            columns.append(self.column(f"joint_{len(columns) + 1}_{signal}_rad", rows))
        return np.column_stack(columns)

    def path_errors(self):
        """Largest distance [m] of the recorded lateral error and lag from what the joint angles and the URDF give, while following; and the samples compared."""
        arm, rows = Arm(self.path, self.scenario, self.device), self.phase("follow")
        stroke = self.column("stroke_m", rows)
        lateral, lag, known = path_errors(arm, self.scenario["process"], self.angles("position", rows), self.angles("reference", rows), stroke)
        off = [np.abs(own - self.column(name, rows))[known].max() for own, name in ((lateral, "path_error_m"), (lag, "path_lag_m"))]
        return max(off), int(known.sum())

    def holding(self):
        """The drives' torques [N m] at the end of the dwell on the edge, where all stands still, and those that hold arm, housing, slide and force."""
        arm, row = Arm(self.path, self.scenario, self.device), self.phase("engage")[-1:]
        force = -np.array([self.column(f"contact_force_{axis}_n", row)[0] for axis in "xyz"])
        held = arm.holding_torques(self.angles("position", row), self.column("stroke_m", row), force)
        recorded = np.array([self.column(f"joint_{number}_torque_n_m", row)[0] for number in range(1, len(held) + 1)])
        return recorded, held

    def finished_edge(self):
        """Chamfer and burr from edge_profile.csv, what the spindle did from the samples."""
        edge = pd.read_csv(self.folder / "edge_profile.csv")
        chamfer = self.scenario["workpiece"].get("chamfer", {})
        ends = self.scenario.get("removal", {}).get("contact_length_mm", 1.0 if "removal" in self.scenario else 0.0)
        place = edge.position_mm.to_numpy()
        between = (place >= place[0] + ends) & (place <= place[-1] - ends)
        judged, at_ends = edge[between], edge[~between]
        is_out = (edge.chamfer_leg_mm < chamfer.get("leg_min_mm", 0.0)) | (edge.chamfer_leg_mm > chamfer.get("leg_max_mm", math.inf))
        is_out |= edge.burr_after_mm > chamfer.get("residual_burr_max_mm", 0.02)
        leg, burr, section = judged.chamfer_leg_mm, judged.burr_after_mm, judged.section_removed_mm2
        left = burr > chamfer.get("residual_burr_max_mm", 0.02)
        outside = (leg < chamfer.get("leg_min_mm", 0.0)) | (leg > chamfer.get("leg_max_mm", math.inf)) | left
        step = np.diff(self.time)
        power, rate = self.column("spindle_power_w")[1:], self.column("removal_rate_m3_per_s")[1:]
        return {
            "burr_before_max_mm": judged.burr_before_mm.max(),
            "chamfer_leg_mean_mm": leg.mean(),
            "chamfer_leg_standard_deviation_mm": leg.std(ddof=0),
            "chamfer_leg_min_mm": leg.min(),
            "chamfer_leg_max_mm": leg.max(),
            "residual_burr_max_mm": burr.max(),
            "residual_burr_share_percent": 100 * left.mean(),
            "out_of_tolerance_share_percent": 100 * outside.mean(),
            "ends_chamfer_leg_min_mm": at_ends.chamfer_leg_mm.min() if len(at_ends) else None,
            "ends_chamfer_leg_max_mm": at_ends.chamfer_leg_mm.max() if len(at_ends) else None,
            "ends_residual_burr_max_mm": at_ends.burr_after_mm.max() if len(at_ends) else None,
            "ends_out_of_tolerance_share_percent": 100 * is_out[~between].mean() if len(at_ends) else None,
            "whole_edge_out_of_tolerance_share_percent": 100 * is_out.mean(),
            "ends_length_mm": ends,
            "section_removed_mean_mm2": section.mean(),
            "section_variation_percent": 100 * section.std(ddof=0) / section.mean(),
            "removed_volume_mm3": edge.section_removed_mm2.sum() * (place[-1] - place[0]) / (len(place) - 1),
            "removal_rate_mean_mm3_per_s": 1e9 * (step * rate).sum() / step[rate > 0].sum(),
            "spindle_power_max_w": power.max(),
            "spindle_energy_kj": 1e-3 * (step * power).sum(),
            "tool_wear_kj": 1e-3 * self.column("tool_wear_j")[-1],
            "air_used_g": 1e3 * self.column("mass_entered_kg")[-1],
        }

    def touch(self, s, force, desired, follow):
        end = follow[0] if len(follow) else len(force)
        peaks = self.column("contact_force_peak_n", slice(0, end))
        touching = np.flatnonzero(peaks > 0.01 * desired)
        s.update(engagement_peak_n=None, engagement_overshoot_percent=None, settling_time_s=None)
        if not len(touching):
            return
        window = slice(touching[0], end)
        peak = peaks[touching[0]:].max()
        s["engagement_peak_n"] = peak
        s["engagement_overshoot_percent"] = max(0.0, 100 * (peak - desired) / desired)
        outside = np.flatnonzero(np.abs(force[window] - desired) > 0.05 * desired)
        settled = 0 if not len(outside) else outside[-1] + 1
        if len(follow) and settled < end - touching[0]:
            s["settling_time_s"] = self.time[window][settled] - self.time[touching[0]]

    def following(self, s, force, desired, follow):
        mean, deviation = force.mean(), force.std(ddof=0)
        error = force - desired
        rms = math.sqrt((error**2).mean())
        s.update(
            force_mean_n=mean,
            force_standard_deviation_n=deviation,
            coefficient_of_variation_percent=100 * deviation / mean if mean > 0 else None,
            force_rms_error_n=rms,
            force_rms_error_percent=100 * rms / desired,
            largest_deviation_n=np.abs(error).max(),
            friction_force_mean_n=self.column("friction_force_n", follow).mean(),
        )
        place = self.column("path_length_m", follow)
        steps = np.abs(np.diff(place))
        weight = np.zeros(len(place))
        weight[1:] += 0.5 * steps
        weight[:-1] += 0.5 * steps
        total = steps.sum()

        def share(holds):
            return 100 * weight[holds].sum() / weight.sum()

        for percent in (5, 10):
            s[f"within_{percent}_percent_share_percent"] = share(np.abs(error) <= percent / 100 * desired)
        s["loss_of_contact_share_percent"] = share(force <= 0.01 * desired)
        self.tenths(s, force, steps, total)
        stroke = self.column("stroke_m", follow)
        low, high = self.stroke_ends()
        path_error, lag = self.column("path_error_m", follow), self.column("path_lag_m", follow)
        duration = self.time[follow[-1]] - self.time[follow[0]]
        s.update(
            stroke_used_mm=1e3 * (stroke.max() - stroke.min()),
            stroke_min_mm=1e3 * stroke.min(),
            stroke_max_mm=1e3 * stroke.max(),
            stroke_margin_mm=1e3 * min(stroke.min() - low, high - stroke.max()),
            path_error_rms_um=1e6 * math.sqrt((path_error**2).mean()),
            path_error_max_um=1e6 * np.abs(path_error).max(),
            path_lag_rms_um=1e6 * math.sqrt((lag**2).mean()),
            path_lag_max_um=1e6 * np.abs(lag).max(),
            path_length_mm=1e3 * total,
            feed_mean_mm_per_s=1e3 * total / duration,
            follow_duration_s=duration,
        )

    def tenths(self, s, force, steps, total):
        travelled = np.concatenate([[0.0], np.cumsum(steps)])
        which = np.minimum((10 * travelled / total).astype(int), 9)
        s["force_by_tenth"] = [
            dict(
                from_mm=100 * total * i,
                to_mm=100 * total * (i + 1),
                force_mean_n=force[which == i].mean() if (which == i).any() else None,
                force_standard_deviation_n=force[which == i].std(ddof=0) if (which == i).any() else None,
            )
            for i in range(10)
        ]

    def joints(self, s):
        urdf = xml.parse(self.path.parent / self.scenario["arm"]["urdf"]).getroot()
        moved = {joint.get("name"): joint for joint in urdf.iter("joint") if joint.get("type") in ("revolute", "continuous", "prismatic")}
        children = {joint.find("child").get("link"): joint for joint in urdf.iter("joint")}
        link, chain = self.scenario["arm"]["flange_link"], []
        while link in children:
            joint = children[link]
            if joint.get("name") in moved:
                chain.insert(0, joint)
            link = joint.find("parent").get("link")
        shares, any_at_limit = [], np.zeros(len(self.time), dtype=bool)
        for number, joint in enumerate(chain, start=1):
            torque = self.column(f"joint_{number}_torque_n_m")
            limit = joint.find("limit")
            effort = float(limit.get("effort")) if limit is not None else math.inf
            known = torque is not None and math.isfinite(effort)
            at_limit = np.abs(torque) >= effort * (1 - 1e-9) if known else np.zeros(len(self.time), dtype=bool)
            any_at_limit |= at_limit
            share = dict(joint=joint.get("name"), torque_share_percent=100 * np.abs(torque).max() / effort if known else None)
            share["saturated_s"] = np.diff(self.time)[at_limit[1:]].sum()
            if at_limit.any():
                share["saturated_from_s"] = self.time[np.argmax(at_limit)]
            shares.append(share)
        s["joints"] = shares
        s["drives_saturated_s"] = np.diff(self.time)[any_at_limit[1:]].sum()
        known = [joint for joint in shares if joint["torque_share_percent"] is not None]
        most = max(known, key=lambda joint: joint["torque_share_percent"], default=None)
        s["joint_torque_share_percent"] = most and most["torque_share_percent"]
        s["most_loaded_joint"] = most and most["joint"]

    def moment(self):
        """The middle of following [s], where the picture is taken; the end of a run that does not follow."""
        follow = self.phase("follow")
        if not len(follow):
            return self.time[-1]
        after = follow[-1] + 1
        end = self.time[after] if after < len(self.time) else self.time[-1]
        return 0.5 * (self.time[follow[0]] + end)

    PIECES = 400

    # Length of the edge [m], not in the samples.
    edge_length = None

    def piece_errors(self):
        """Mean relative error of the force over each piece of the edge while following [1]; NaN where nothing touched."""
        follow, desired = self.phase("follow"), self.scenario["process"]["force_n"]
        force, place = self.column("contact_force_n", follow), self.column("path_length_m", follow)
        piece = np.minimum((place / self.edge_length * self.PIECES + 1e-9).astype(int), self.PIECES - 1)
        touching = force > 0
        sums = np.bincount(piece[touching], (force[touching] - desired) / desired, self.PIECES)
        counts = np.bincount(piece[touching], minlength=self.PIECES)
        return np.divide(sums, counts, out=np.full(self.PIECES, np.nan), where=counts > 0)

    def colour_scale(self):
        """End of the colours of the force error along the edge [%]: of its pieces 95 % lie within."""
        if not len(self.phase("follow")):
            return None
        errors = self.piece_errors()
        errors = np.sort(np.abs(errors[np.isfinite(errors)]))
        size = errors[math.ceil(0.95 * len(errors)) - 1] if len(errors) else 0.0
        ends = [step * 10.0**power for power in range(-3, 2) for step in (1, 2, 5)]
        return 100 * next((end for end in ends if size <= end * (1 + 1e-9)), 10.0)


class BenchRun(Run):
    """Numbers of a bench."""

    TOUCH = 1.0

    def commands(self):
        return [(command["at_s"], command) for command in self.scenario.get("command", [])]

    def disturbed_from(self):
        load, starts = self.scenario.get("load", {}), []
        if "peak_to_peak_mm" in load:
            starts.append(load["start_s"])
        if "hand" in self.scenario:
            starts.append(self.scenario["hand"]["start_s"])
        return min(starts, default=math.inf)

    def between(self, start, end):
        return np.flatnonzero((self.time >= start - 1e-9) & (self.time <= end + 1e-9))

    def numbers(self):
        s = dict(duration_s=self.time[-1] - self.time[0], air_mass_balance_relative=self.air_balance())
        entered, self.force = self.column("mass_entered_kg"), self.column("contact_force_n")
        s["air_consumed_normal_litres"] = (entered[-1] - entered[0]) / REFERENCE_DENSITY * 1e3 if finite(entered) else None
        times = [at for at, _ in self.commands()]
        s["levels"] = [self.level(start, end) for start, end in zip(times, [*times[1:], self.time[-1]])]
        s["regulator_delay_s"] = s["levels"][0]["regulator_delay_s"]
        responded = [level for level in s["levels"] if level["force_settling_time_s"] is not None]
        for key in ("force_settling_time_s", "force_overshoot_percent"):
            s[key] = responded[-1][key] if responded else None
        s["force_peak_n"] = self.force.max() if finite(self.force) else None
        self.line(s)
        self.contact(s)
        self.uniformity(s, times)
        self.sensors(s)
        return s

    def level(self, start, end):
        moved = self.disturbed_from() <= start
        end = end if moved else min(end, self.disturbed_from())
        rows = self.between(start, end - 1e-6)
        steady = self.between(end - min(0.2 * (end - start), 1.0), end - 1e-6)
        regulator, force = self.column("regulator_pressure_pa"), self.force
        outlet = regulator[steady].mean()
        change = outlet - regulator[rows[0]]
        there = np.flatnonzero((regulator[rows] - regulator[rows[0]]) / change >= 0.632) if change else []
        level = dict(
            start_s=start,
            set_pressure_bar_gauge=(self.column("set_pressure_pa")[rows[-1]] - ATMOSPHERE) / 1e5,
            regulator_pressure_bar_gauge=(outlet - ATMOSPHERE) / 1e5,
            regulator_delay_s=self.time[rows[there[0]]] - start if len(there) and abs(change) > 1 else None,
            stroke_mm=1e3 * self.column("stroke_m")[steady].mean(),
        )
        level.update(dict.fromkeys(["force_mean_n", "force_standard_deviation_n", "measured_force_mean_n", "force_settling_time_s", "force_overshoot_percent"]))
        mean = force[steady].mean() if finite(force) else 0.0
        if mean > self.TOUCH:
            level["force_mean_n"], level["force_standard_deviation_n"] = mean, force[steady].std(ddof=0)
            measured = self.column("measured_force_n")
            level["measured_force_mean_n"] = measured[steady].mean() if finite(measured) else None
            if not moved:
                level["force_settling_time_s"], level["force_overshoot_percent"] = self.response(rows, mean)
        return level

    def response(self, rows, mean):
        force, change = self.force[rows], mean - self.force[rows[0]]
        outside = np.flatnonzero(np.abs(force - mean) > 0.05 * abs(change))
        settled = min(outside[-1] + 1, len(rows) - 1) if len(outside) else 0
        beyond = max(0.0, ((force - mean) * np.sign(change)).max())
        return self.time[rows[settled]] - self.time[rows[0]], 100 * beyond / abs(change) if change else 0.0

    def line(self, s):
        s.update(force_slope_n_per_bar=None, force_linearity_percent=None)
        points = [(level["regulator_pressure_bar_gauge"], level["force_mean_n"]) for level in s["levels"] if level["force_mean_n"] is not None]
        if len(points) < 2 or np.var([x for x, _ in points]) * len(points) < 1e-6:
            return
        x, y = np.array(points).T
        slope, offset = np.polyfit(x, y, 1)
        s["force_slope_n_per_bar"] = slope
        if len(points) > 2:
            s["force_linearity_percent"] = 100 * np.abs(y - slope * x - offset).max() / y.max()

    def contact(self, s):
        touch = np.flatnonzero(self.force > self.TOUCH) if finite(self.force) else []
        s.update(first_contact_s=None, impact_peak_n=None)
        if len(touch):
            start = self.time[touch[0]]
            s["first_contact_s"], s["impact_peak_n"] = start, np.abs(self.force[self.between(start, start + 0.05)]).max()
        stroke, (low, high) = self.column("stroke_m")[touch[0] if len(touch) else 0 :], self.stroke_ends()
        s["stroke_min_mm"], s["stroke_max_mm"] = 1e3 * stroke.min(), 1e3 * stroke.max()
        s["stroke_margin_mm"] = 1e3 * min(stroke.min() - low, high - stroke.max())

    def uniformity(self, s, times):
        keys = ["desired_force_n", "force_mean_n", "force_rms_error_n", "force_rms_error_percent", "force_largest_error_percent", "coefficient_of_variation_percent"]
        s.update(dict.fromkeys(keys))
        load = self.scenario.get("load", {})
        if "peak_to_peak_mm" in load:
            rows = self.between(load["start_s"] + 1 / load["frequency_hz"], self.scenario["bench"]["duration_s"])
        else:
            rows = self.between(self.time[-1] - min(0.2 * (self.time[-1] - times[-1]), 1.0), self.time[-1])
        force = self.force[rows]
        if not len(force) or force.mean() <= self.TOUCH:
            return
        desired = self.column("desired_force_n", rows)
        desired = desired if finite(desired) and finite(self.column("desired_force_n")) else None
        error = force - (force.mean() if desired is None else desired)
        reference = force.mean() if desired is None else desired.mean()
        rms = math.sqrt((error**2).mean())
        s.update(
            desired_force_n=None if desired is None else reference,
            force_mean_n=force.mean(),
            force_rms_error_n=rms,
            force_rms_error_percent=100 * rms / reference,
            force_largest_error_percent=100 * np.abs(error).max() / reference,
            coefficient_of_variation_percent=100 * force.std(ddof=0) / force.mean(),
        )

    def sensors(self, s):
        s.update(dict.fromkeys(["measured_force_error_percent", "measured_force_noise_n", "estimated_force_rms_error_percent", "estimated_force_coverage_percent"]))
        pressed = np.flatnonzero(self.force > self.TOUCH)
        if not len(pressed):
            return
        mean = self.force[pressed].mean()
        measured = self.column("measured_force_n")
        if finite(measured):
            error = measured[pressed] - self.force[pressed]
            s["measured_force_error_percent"], s["measured_force_noise_n"] = 100 * error.mean() / mean, error.std(ddof=0)
        estimated, deviation = self.column("estimated_force_n"), self.column("estimated_force_deviation_n")
        if finite(estimated) and finite(deviation):
            error = estimated[pressed] - self.force[pressed]
            s["estimated_force_rms_error_percent"] = 100 * math.sqrt((error**2).mean()) / mean
            s["estimated_force_coverage_percent"] = 100 * (np.abs(error) <= 1.959964 * deviation[pressed]).mean()

    def moment(self):
        return self.time[-1]

"""One cell by its number: drawn, sized, written with its sealed truth."""
import itertools
import json
import pathlib
import subprocess
import time

import numpy as np

from arms.causes import CHANNELS
from arms.case import write_csv

from . import effects, plant
from .cell import Cell

SEED = 20261201
LEAST, MOST = 3.0, 40.0  # Sizes: largest RMS of what the effect changes in one channel and recording [standard deviations of its sensor].
# Channels by which effects of a subsystem are sized, others by the device's: a contact some milliseconds earlier moves a wrench by more than any of them, once.
SIZED_BY = {"joints": "drive", "load": "drive", "wrench_sensor": "wrench"}
DEVICE = (("regulator_pressure_pa", 0), ("stroke_m", 6), ("force_n", 2))
FIT = ("a", "b")


class Case:
    """A cell, what is concealed in it, and its recordings."""

    def __init__(self, number, name):
        self.number, self.name = number, name
        for attempt in range(10):
            self.rng = rng = np.random.default_rng([SEED, number, attempt])
            self.cell = cell = Cell(rng)
            self.plain = self.simulate(cell.truth, cell.programs)
            cell.drives(self.plain)
            if name == "drive_gain_error" and not cell.logs_currents:
                continue
            self.starts = {key: rng.uniform(-0.7, 0.7, 6) for key in cell.programs}
            self.noise = {"drive": cell.noise, "wrench": np.repeat(cell.sensor["noise"], 3), "device": cell.device_noise}
            self.cause, self.size, self.sigma, self.seen = None, None, 0.0, ""
            if name == "nothing" or self.conceal(rng):
                return
        raise RuntimeError(f"case {number}: no cell in which {name} shows")

    def simulate(self, numbers, programs):
        return {key: plant.simulate(self.cell.arm, numbers, self.cell.edge, program) for key, program in programs.items()}

    def is_read_alone(self, numbers):
        """Whether arm and slide move as without the effect."""
        return all(getattr(numbers, key) is getattr(self.cell.truth, key) for key in vars(numbers) if key not in plant.READ_ALONE)

    def motions(self, numbers):
        if self.is_read_alone(numbers):
            return {key: self.plain[key] for key in FIT}
        return self.simulate(numbers, {key: self.cell.programs[key] for key in FIT})

    def changed(self, cause, size, without):
        """Largest RMS of what the effect changes [standard deviations], and where."""
        numbers, _ = cause.at(size)
        largest, seen = 0.0, ""
        for key, motion in self.motions(numbers).items():
            there, gone = plant.read(numbers, motion, self.starts[key]), plant.read(cause.without, without[key], self.starts[key])
            apart = ~(self.bangs(motion) | self.bangs(without[key]))
            if self.name == "burr":
                # A burr is felt for a moment: of the whole recording it would be little at any height.
                apart &= np.abs(motion.path - numbers.device["burr_position"]) < 2 * numbers.device["burr_half_length"]
            for channel, noise in self.noise.items():
                if channel != SIZED_BY.get(cause.subsystem, "device"):
                    continue
                rms = np.sqrt(np.mean(((there[channel] - gone[channel])[apart] / noise) ** 2, axis=0))
                if rms.max() > largest:
                    largest, seen = float(rms.max()), f"{key} {self.column(channel, int(rms.argmax()))}"
        return largest, seen

    def bangs(self, motion):
        """Samples about which the slide hits a stop: a shift of that in time says little of a size."""
        x, v = motion.stroke[:, 0], np.abs(motion.stroke[:, 1])
        hit = ((x < 1e-4) | (x > self.cell.device["stroke"] - 1e-4)) & (v > 0.01)
        return np.convolve(hit, np.ones(41), "same") > 0

    def conceal(self, rng):
        """The cause at its size: where even its largest natural size is below the least, another place is drawn, then another cell."""
        b = self.cell.nominal_for_effects()
        b.no_friction_keys = self.cell.no_friction_keys
        for _ in range(4):
            cause = effects.draw(rng, b, self.name)
            without = self.motions(cause.without)
            most, _ = self.changed(cause, 1.0, without)
            if most >= LEAST:
                break
        else:
            return False
        if cause.belief:
            cause.belief()
        aim = np.exp(rng.uniform(np.log(LEAST), np.log(min(MOST, most))))
        low, high = 1e-3, 1.0
        for _ in range(5):
            middle = (low * high) ** 0.5
            low, high = (middle, high) if self.changed(cause, middle, without)[0] < aim else (low, middle)
        self.cause, self.size = cause, high
        self.sigma, self.seen = self.changed(cause, high, without)
        return True

    def column(self, channel, k):
        if channel == "device":
            return DEVICE[k][0]
        if channel == "wrench":
            return f"wrench_{CHANNELS[k]}_{'n' if k < 3 else 'n_m'}"
        return f"joint_{k + 1}_{'current_a' if self.cell.logs_currents else 'torque_n_m'}"

    def columns(self, motion, reading):
        """Inputs and measured channels with noise, by name."""
        rng, n, count = self.rng, self.cell.arm.n, len(motion.time)
        hold = (len(motion.motor[0]) - 1) // (count - 1)
        inputs = {"time_s": (motion.time, 4), "path_m": (motion.path, 6)}
        inputs.update({f"joint_{j + 1}_command_rad": (motion.command[:, j], 8) for j in range(n)})
        inputs.update({f"joint_{j + 1}_rad": (motion.motor[0][::hold, j] + self.cell.joint_noise * rng.normal(size=count), 8) for j in range(n)})
        inputs["set_pressure_pa"] = (motion.set_pressure, 0)
        measured = {}
        for channel in ("drive", "device", "wrench"):
            for k in range(reading[channel].shape[1]):
                digits = DEVICE[k][1] if channel == "device" else 4
                measured[self.column(channel, k)] = (reading[channel][:, k] + self.noise[channel][k] * rng.normal(size=count), digits)
        return inputs, measured

    def truth(self):
        cell, found = self.cell, []
        numbers = cell.truth
        if self.cause:
            numbers, values = self.cause.at(self.size)
            found = [{"name": self.name, "truth": self.name, "subsystem": self.cause.subsystem, "parameters": {**self.cause.place, **{k: float(v) for k, v in values.items()}},
                      "tolerance": {k: float(v) for k, v in self.cause.tolerance(values).items()}}]
        mass, centre, inertia = plant.tool(numbers.housing, numbers.moving, cell.height)
        true = {"link_mass_kg": numbers.mass, "link_centre_m": numbers.centre, "joint_stiffness_n_m_per_rad": numbers.gear, "joint_damping_time_s": numbers.damping_time, "gain_n_m_per_a": numbers.gain,
                "motor_inertia_kg_m2": numbers.motor_inertia, "coulomb_friction_n_m": numbers.coulomb, "viscous_friction_n_m_s_per_rad": numbers.viscous, "device": numbers.device, "housing": numbers.housing,
                "moving": numbers.moving, "tool": {"mass_kg": mass, "centre_m": centre, "inertia_kg_m2": inertia}, "wrench_sensor": numbers.sensor}
        noise = {self.column(channel, k): float(x) for channel, values in self.noise.items() for k, x in enumerate(values)}
        return {"case": self.label, "kind": cell.arm.kind, "effects": found, "sigma": self.sigma, "largest_in": self.seen, "noise": noise, "mismatch": [], "nominal_values_in_truth": listed(true)}

    @property
    def label(self):
        return f"case-{self.number:02}"

    def write(self, idc, out):
        began = time.monotonic()
        cell, folder, truths = self.cell, out / "cases" / self.label, out / "truth"
        folder.mkdir(parents=True, exist_ok=True)
        truths.mkdir(parents=True, exist_ok=True)
        urdf = f"{cell.arm.kind}.urdf"
        (folder / urdf).write_text(cell.arm.urdf(2.5 * cell.peak + 5 * cell.coulomb))
        (folder / "part.stl").write_text(cell.mesh())
        project = pathlib.Path(__file__).resolve().parents[3]
        (folder / "device.toml").write_text((project / "models/device.toml").read_text())
        (folder / "arm.toml").write_text(cell.arm_toml(urdf))
        (folder / "cell.toml").write_text(cell.cell_toml(urdf, *self.edge(idc, folder / "part.stl")))
        numbers = self.cause.at(self.size)[0] if self.cause else cell.truth
        motions = self.plain if self.is_read_alone(numbers) else self.simulate(numbers, cell.programs)
        for key, motion in motions.items():
            inputs, measured = self.columns(motion, plant.read(numbers, motion, self.starts[key]))
            if key == "predict":
                write_csv(folder / "predict.csv", inputs)
                write_csv(truths / f"{self.label}.predict.csv", {"time_s": inputs["time_s"], **measured})
            else:
                write_csv(folder / f"{key}.csv", {**inputs, **measured})
        (truths / f"{self.label}.json").write_text(json.dumps(self.truth(), indent=1))
        return time.monotonic() - began

    def edge(self, idc, mesh):
        """Number of the edge as the program counts them, and whether it goes the other way."""
        found = json.loads(subprocess.run([idc, "edges", mesh, "--unit", "m", "--json"], check=True, capture_output=True, text=True).stdout)["edges"]
        first, last = 1e3 * self.cell.corners[0], 1e3 * self.cell.corners[4]
        for k, edge in enumerate(found):
            ends = np.array(edge["start_mm"]), np.array(edge["end_mm"])
            for reversed_, (a, b) in enumerate((ends, ends[::-1])):
                if np.abs(a - first).max() < 1e-2 and np.abs(b - last).max() < 1e-2:
                    return k, bool(reversed_)
        raise RuntimeError(f"{mesh}: no edge from {first} to {last}")


def listed(value):
    """Plain lists and numbers in place of arrays."""
    if isinstance(value, dict):
        return {k: listed(v) for k, v in value.items()}
    return value.tolist() if isinstance(value, np.ndarray) else float(value) if isinstance(value, (float, np.floating)) else value


def make(number, out, idc):
    """Makes the cell of a number below a folder."""
    name = next(itertools.islice(effects.deck(SEED), number, None))
    case = Case(number, name)
    case.write(idc, pathlib.Path(out))
    print(f"{case.label} {case.cell.arm.kind} {name}: {case.sigma:.1f} standard deviations in {case.seen or 'nothing'}", flush=True)
    return case

"""What an owner states of an arm, with tolerances, and what it really is: anywhere within them."""
import mujoco
import numpy as np

from . import motion
from .plant import Numbers, Plant


def rounded(value, digits=3):
    return float(f"{value:.{digits}g}")


def inside(rng, value, tolerance):
    """A true value: anywhere within the box."""
    return np.asarray(value) * (1 + tolerance * rng.uniform(-0.98, 0.98, np.shape(value)))


class Nominal:
    """Values and tolerances of arm.toml, and `truth`, the numbers that the arm has where nothing is concealed."""

    def __init__(self, rng, arm, with_sensor, with_link_encoders):
        self.arm, self.with_link_encoders = arm, with_link_encoders
        exact = rng.random() < 0.15
        self.mass_tolerance = 0.0 if exact else [0.02, 0.03, 0.05][rng.integers(3)]
        self.centre_tolerance = 0.0 if exact else [0.003, 0.005, 0.01][rng.integers(3)]
        self.tolerance = {"gain": 0.1, "inertia": [0.2, 0.3][rng.integers(2)], "friction": [0.2, 0.3][rng.integers(2)]}
        mass = inside(rng, arm.masses, self.mass_tolerance)
        centre = arm.centres + self.centre_tolerance * rng.uniform(-0.98, 0.98, (arm.n, 3))
        self.load = None
        load_mass, load_centre = 0.0, np.zeros(3)
        if rng.random() < 0.3:
            self.load = {"mass": rounded(arm.total_mass * rng.uniform(0.015, 0.06)), "tolerance": 0.02,
                         "centre": np.round(np.array([*rng.uniform(-0.04, 0.04, 2), rng.uniform(0.03, 0.12)]), 3), "centre_tolerance": 0.003}
            load_mass = float(inside(rng, self.load["mass"], 0.02))
            load_centre = self.load["centre"] + rng.uniform(-0.003, 0.003, 3)
        self.sensor = self._sensor(rng) if with_sensor else None
        ones = np.ones(arm.n)
        self.truth = Numbers(mass, centre, ones, ones * 0.1, ones, ones, load_mass, load_centre, self._true_sensor(rng) if with_sensor else None)
        self._drives(rng)
        self.no_friction_keys = np.zeros(arm.n, bool)

    def _sensor(self, rng):
        mass = rounded(max(0.4, self.arm.total_mass * rng.uniform(0.02, 0.07)))
        height, length = rng.uniform(0.03, 0.06), rng.uniform(0.1, 0.2)
        centre = np.array([*rng.uniform(-0.02, 0.02, 2), 0.5 * length])
        inertia = mass * length**2 / 12 * np.array([1.0, 1.2, 0.6])
        return {"height": round(height, 3), "rotation": [0.0, 0.35, 0.7854, -1.5708, 0.5236][rng.integers(5)], "zero_tolerance": [0.5, 0.02], "mass": mass, "mass_tolerance": 0.02,
                "centre": np.round(centre, 3), "centre_tolerance": 0.003, "inertia": np.array([rounded(v) for v in inertia]), "tip": round(1.3 * length, 3),
                "noise": [rounded(rng.uniform(0.1, 0.25), 2), rounded(rng.uniform(0.006, 0.012), 2)]}

    def _true_sensor(self, rng):
        s = self.sensor
        mass = float(inside(rng, s["mass"], s["mass_tolerance"]))
        zero = np.concatenate([rng.uniform(-0.98, 0.98, 3) * s["zero_tolerance"][k] for k in range(2)])
        return {"height": s["height"], "rotation": s["rotation"], "zero": zero, "mass": mass, "centre": s["centre"] + s["centre_tolerance"] * rng.uniform(-0.98, 0.98, 3),
                "inertia": s["inertia"] * mass / s["mass"], "tip": s["tip"]}

    def _drives(self, rng):
        """Drives that fit the arm: friction, rotors and gains by what a brisk path asks of each joint."""
        arm, truth = self.arm, self.truth
        plant = Plant(arm, truth)
        path = motion.fourier(rng, arm, 10.0, 1.4)
        speed = np.gradient(path, motion.STEP, axis=0)
        grid = np.arange(0, len(path), 40)
        asked, _ = plant.inverse(path[grid], speed[grid], np.gradient(speed, motion.STEP, axis=0)[grid])
        self.peak = np.abs(asked).max(axis=0)
        matrix = np.zeros((arm.n, arm.n))
        mujoco.mj_fullM(plant.model, plant.data, matrix)
        mass = np.diag(matrix)
        turns = ~arm.prismatic
        friction = rng.uniform(0.06, 0.13, arm.n) * self.peak
        friction[turns] = np.maximum(friction[turns], rng.uniform(0.1, 0.15, turns.sum()) * friction[turns].max())
        friction[arm.prismatic] = np.maximum(rng.uniform(0.3, 0.6, arm.prismatic.sum()) * friction[arm.prismatic], 0.02 * 9.81 * mass[arm.prismatic])
        viscous = friction * rng.uniform(1.0, 1.8, arm.n) / np.where(arm.prismatic, 0.5, 1.0)
        inertia = np.where(arm.prismatic, 0.2 * mass, np.maximum(rng.uniform(0.4, 1.1, arm.n) * mass, 0.09 * friction))
        gain = np.where(arm.prismatic, rng.uniform(120, 300, arm.n), rng.uniform(8, 13, arm.n)) if arm.logs_currents else np.ones(arm.n)
        self.gain, self.inertia = np.array([rounded(g) for g in gain]), np.array([rounded(v) for v in inertia])
        self.coulomb, self.viscous = np.array([rounded(v) for v in friction]), np.array([rounded(v) for v in viscous])
        self.noise = np.array([rounded(v, 2) for v in rng.uniform(0.035, 0.05, arm.n) * friction / gain])
        # A finer encoder where the mass behind it is large: its noise twice differentiated, through 25 Hz, stays below the current's.
        shaken = (mass + inertia) * (2 * np.pi * 25) ** 2 * 0.35
        self.position_noise = rounded(min(1.3e-6, float(np.min(0.6 * self.noise * gain / shaken))), 2)
        truth.gain = inside(rng, self.gain, self.tolerance["gain"]) if arm.logs_currents else np.ones(arm.n)
        truth.motor_inertia = inside(rng, self.inertia, self.tolerance["inertia"])
        truth.coulomb = inside(rng, self.coulomb, self.tolerance["friction"])
        truth.viscous = inside(rng, self.viscous, self.tolerance["friction"])

    def toml(self, urdf, rate, fit, press):
        """arm.toml in the form of ../shared/arm/README.md."""
        arm, t = self.arm, self.tolerance

        def row(v):
            return "[" + ", ".join(f"{x:.6g}" for x in v) + "]"
        lines = ['kind = "recorded_arm"', "schema = 1", "", "[arm]", f'urdf = "{urdf}"', 'flange = "flange"', f"gravity_m_per_s2 = {row(arm.gravity)}",
                 f"link_mass_tolerance = {self.mass_tolerance}", f"link_centre_tolerance_m = {self.centre_tolerance}"]
        for j in range(arm.n):
            lines += ["", "[[drive]]", f'joint = "{arm.joint_names[j]}"']
            if arm.logs_currents:
                lines.append(f"gain_n_m_per_a = {{ value = {self.gain[j]:.6g}, tolerance = {t['gain']} }}")
            lines.append(f"motor_inertia_kg_m2 = {{ value = {self.inertia[j]:.6g}, tolerance = {t['inertia']} }}")
            if not self.no_friction_keys[j]:
                lines += [f"coulomb_friction_n_m = {{ value = {self.coulomb[j]:.6g}, tolerance = {t['friction']} }}",
                          f"viscous_friction_n_m_s_per_rad = {{ value = {self.viscous[j]:.6g}, tolerance = {t['friction']} }}"]
        load = self.load or {"mass": 0.0, "tolerance": 0.0}
        lines += ["", "[load]", f"mass_kg = {{ value = {load['mass']}, tolerance = {load['tolerance']} }}"]
        if self.load:
            lines.append(f"centre_m = {{ value = {row(load['centre'])}, tolerance_m = {load['centre_tolerance']} }}")
        if self.sensor:
            s = self.sensor
            lines += ["", "[wrench_sensor]", f"height_m = {s['height']}", f"rotation_z_rad = {s['rotation']}", f"zero_force_n = {{ value = [0.0, 0.0, 0.0], tolerance_n = {s['zero_tolerance'][0]} }}",
                      f"zero_torque_n_m = {{ value = [0.0, 0.0, 0.0], tolerance_n_m = {s['zero_tolerance'][1]} }}", f"tool_mass_kg = {{ value = {s['mass']}, tolerance = {s['mass_tolerance']} }}",
                      f"tool_centre_m = {{ value = {row(s['centre'])}, tolerance_m = {s['centre_tolerance']} }}", f"tool_inertia_kg_m2 = {row(s['inertia'])}"]
            lines += [f"tip_m = {s['tip']}"] if press else []
        lines += ["", "[sensors]", f"rate_hz = {rate}", f"joint_rad = {self.position_noise}", "joint_rad_per_s = 0.0005", f"{'current_a' if arm.logs_currents else 'torque_n_m'} = {row(self.noise)}"]
        lines += ["link_rad = 2e-5"] if self.with_link_encoders else []
        lines += [f"wrench_force_n = {self.sensor['noise'][0]}", f"wrench_torque_n_m = {self.sensor['noise'][1]}"] if self.sensor else []
        lines += ["", "[recordings]", "fit = [" + ", ".join(f'"{name}.csv"' for name in fit) + "]", 'predict = "predict.csv"', ""]
        return "\n".join(lines)

"""A cell drawn by its number: arm, part, device, wrench sensor and drives as its owner states them, and what they really are."""
import types

import mujoco
import numpy as np

from arms.bodies import Arm, rotation
from arms.nominal import inside, rounded

from . import plant, ride
from .plant import Numbers

KINDS = ("industrial_6", "cobot_6")
LEVEL = 0.004  # Largest departure of device's and contact's numbers from nominal, a share.


class Cell:
    """Nominal numbers, the truth without an effect, the part, and three programs."""

    def __init__(self, rng):
        while True:
            arm = Arm(rng)
            if arm.kind in KINDS and arm.gravity[2] < -9.8 and 0.95 < arm.reach < 1.7:
                break
        self.arm, self.rng = arm, rng
        self._device(rng)
        self._links(rng)
        for _ in range(60):
            self._part(rng)
            try:
                self._programs(rng)
                return
            except ride.Unreachable:
                continue
        raise ride.Unreachable

    def _device(self, rng):
        bore, rod = [(25, 10), (32, 12), (40, 16)][rng.choice(3, p=[0.4, 0.4, 0.2])]
        count = 2 if bore < 40 else 1
        pi = np.pi / 4 * 1e-6
        d = {"bore_mm": bore, "rod_mm": rod, "cylinder_count": count, "stroke": float(rng.choice([0.04, 0.05, 0.06])), "dead_volume": rounded(rng.uniform(1.2e-5, 3e-5), 2),
             "supply": rounded(rng.uniform(1.8e-6, 3.2e-6), 2), "exhaust": rounded(rng.uniform(1.5e-6, 2.8e-6), 2), "discharge": float(rng.choice([0.9, 0.95, 0.85])), "gain": 1.0,
             "time_constant": rounded(rng.uniform(0.08, 0.18), 2), "stop_stiffness": 1e6, "stop_damping": 2e3, "stiffness": rounded(rng.uniform(1.0e5, 2.5e5), 2), "damping": rounded(rng.uniform(300, 600), 2),
             "friction": rounded(rng.uniform(0.1, 0.25), 2), "radius": float(rng.choice([0.004, 0.005, 0.006, 0.008]))}
        d["area_1"], d["area_2"] = count * pi * bore**2, count * pi * (bore**2 - rod**2)
        d["rod_area"] = d["area_1"] - d["area_2"]
        self.device = d
        true = dict(d)
        for key in ("dead_volume", "supply", "exhaust", "gain", "time_constant", "stiffness", "damping", "friction"):
            true[key] = d[key] * (1 + LEVEL * rng.uniform(-1, 1))
        self.true_device = true
        mass = rounded(rng.uniform(2.0, 4.5), 2)
        length = rounded(rng.uniform(0.13, 0.18), 2)
        self.moving = {"mass": mass, "centre": rounded(length * rng.uniform(0.6, 0.75), 2), "gyration": round(rng.uniform(0.035, 0.05), 3), "ball": length}
        housing = rounded(rng.uniform(1.5, 3.0), 2)
        self.housing = {"mass": housing, "centre": np.round([*rng.uniform(-0.004, 0.004, 2), rng.uniform(0.05, 0.07)], 4), "inertia": np.array([rounded(housing * k) for k in (0.0021, 0.0019, 0.0015)])}
        self.height = round(rng.uniform(0.02, 0.035), 3)
        mass, centre, inertia = plant.tool(self.housing, self.moving, self.height)
        self.sensor = {"height": self.height, "rotation": [0.0, 0.7854, -1.5708, 0.5236, 3.1416][rng.integers(5)], "zero_tolerance": [0.5, 0.02], "mass": round(mass, 3), "mass_tolerance": 0.02, "centre": np.round(centre, 4),
                       "centre_tolerance": 0.003, "inertia": np.array([rounded(x) for x in np.diag(inertia)]), "noise": [rounded(rng.uniform(0.1, 0.25), 2), rounded(rng.uniform(0.006, 0.012), 2)]}

    def true_housing(self, mass, centre, moving):
        """Housing such that all beyond the sensor has a mass and a centre from the sensor's origin."""
        own = mass - moving["mass"]
        at = (mass * (np.asarray(centre) + [0, 0, self.height]) - moving["mass"] * np.array([0, 0, moving["centre"]])) / own
        return {"mass": own, "centre": at, "inertia": self.housing["inertia"] * own / self.housing["mass"]}

    def _links(self, rng):
        arm, s = self.arm, self.sensor
        self.mass_tolerance, self.centre_tolerance = [0.02, 0.03, 0.05][rng.integers(3)], [0.003, 0.005, 0.01][rng.integers(3)]
        self.tolerance = {"gain": 0.1, "inertia": [0.2, 0.3][rng.integers(2)], "friction": [0.2, 0.3][rng.integers(2)]}
        self.damping_time, self.damping_tolerance = 0.0015, 0.0005
        scale = (arm.reach / 1.2) ** 2
        self.spring = np.array([rounded(x * scale, 2) for x in rng.uniform(0.8, 1.4, 6) * [3e6, 3e6, 2.5e6, 2.5e5, 2.5e5, 5e4]])
        moving = {**self.moving, "mass": self.moving["mass"] * (1 + LEVEL * rng.uniform(-1, 1))}
        mass = float(inside(rng, s["mass"], s["mass_tolerance"]))
        centre = s["centre"] + s["centre_tolerance"] * rng.uniform(-0.98, 0.98, 3)
        self.true_tool = {"mass": mass, "centre": centre}
        zero = np.concatenate([rng.uniform(-0.98, 0.98, 3) * s["zero_tolerance"][k] for k in range(2)])
        ones = np.ones(6)
        self.truth = Numbers(inside(rng, arm.masses, self.mass_tolerance), arm.centres + self.centre_tolerance * rng.uniform(-0.98, 0.98, (6, 3)), self.spring,
                             self.damping_time + self.damping_tolerance * rng.uniform(-0.9, 0.9), ones, ones, 0 * ones, 0 * ones, self.true_device, self.true_housing(mass, centre, moving), moving,
                             {"height": self.height, "rotation": s["rotation"], "zero": zero})

    def _part(self, rng):
        """A bar with a square edge: where it begins, its direction, its bisector."""
        arm = self.arm
        self.length = rounded(rng.uniform(0.24, 0.34), 2)
        turn = rng.uniform(-0.6, 0.6)
        away = arm.reach * rng.uniform(0.5, 0.68)
        middle = np.array([away * np.cos(turn), away * np.sin(turn), arm.reach * rng.uniform(0.05, 0.35)])
        yaw = turn + rng.uniform(-0.35, 0.35)
        along = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        elevation = rng.uniform(0.6, 1.57)
        out = np.cos(elevation) * np.array([-np.cos(yaw), -np.sin(yaw), 0.0]) + np.sin(elevation) * np.array([0, 0, 1.0])
        across = np.cross(along, out)
        # Corners of the section about the edge, to a tenth of a micrometre: the mesh is what the owner has.
        width, depth = 0.08, 0.05
        faces = (-out - across) / np.sqrt(2), (-out + across) / np.sqrt(2)
        section = np.array([0 * out, width * faces[0], width * faces[0] + depth * faces[1], depth * faces[1]])
        first = middle - 0.5 * self.length * along
        self.corners = np.round(np.concatenate([first + section, first + self.length * along + section]), 7)
        way = self.corners[4] - self.corners[0]
        self.length = float(np.linalg.norm(way))
        along = way / self.length
        normals = [np.cross(self.corners[k] - self.corners[0], along) for k in (1, 3)]
        normals = [v / np.linalg.norm(v) * np.sign(v @ out) for v in normals]
        out = sum(normals) / np.linalg.norm(sum(normals))
        self.edge = np.array([self.corners[0], along, out])
        for d in (self.device, self.true_device):
            d.update(edge_length=self.length)

    def mesh(self):
        """Triangles of the bar as an STL file's text, outward."""
        c = self.corners
        middle = c.mean(axis=0)
        quads = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
        out = ["solid part"]
        for q in quads:
            for a, b, d in ((q[0], q[1], q[2]), (q[0], q[2], q[3])):
                normal = np.cross(c[b] - c[a], c[d] - c[a])
                if normal @ (c[a] - middle) < 0:
                    b, d, normal = d, b, -normal
                normal /= np.linalg.norm(normal)
                out.append("facet normal " + " ".join(f"{x:.6f}" for x in normal) + "\n outer loop")
                out += ["  vertex " + " ".join(f"{x:.7f}" for x in c[k]) for k in (a, b, d)]
                out.append(" endloop\nendfacet")
        return "\n".join([*out, "endsolid part", ""])

    def _programs(self, rng):
        reach = ride.Reach(self.arm, self.truth, self.edge, self.length)
        stroke = self.device["stroke"]
        leans = [0.0, rng.uniform(0.12, 0.24), -rng.uniform(0.1, 0.18)]
        rng.shuffle(leans)
        roll, posture = reach.posture(rng, leans, 0.5 * stroke)
        force = rng.uniform(90, 200)
        shares = rng.permutation([1.0, 1.5, 2.0]) * rng.uniform(0.9, 1.1, 3)
        speeds = rng.permutation([0.045, 0.06, 0.08]) * rng.uniform(0.9, 1.1, 3)
        strokes = rng.permutation([0.42, 0.5, 0.58]) * stroke
        self.programs = {}
        for k, name in enumerate(("a", "b", "predict")):
            pressure = [round(min(x, 5.5e5), -3) for x in np.array([1.0, rng.uniform(1.15, 1.4)]) * shares[k] * force / self.device["area_1"]]
            standoff = (stroke - strokes[k]) + rng.uniform(0.05, 0.08)
            plan = {"lean": leans[k], "speed": speeds[k], "stroke": strokes[k], "pressures": pressure, "roll": roll, "places": (0.015, self.length - 0.015), "standoff": standoff, "swing": 0.1, "aside": 1.0}
            for _ in range(12):
                made = ride.program(rng, reach, posture, plan)
                if ride.clear(reach, made, stroke) > 0.008 and np.abs(np.gradient(made[2], plant.SAMPLE, axis=0)).max() < 2.6:
                    break
                plan["swing"] *= 0.85
                plan["aside"] *= 0.85
            else:
                raise ride.Unreachable
            self.programs[name] = made

    def drives(self, motions):
        """Drives by what the programs ask of each joint without friction."""
        rng, truth = self.rng, self.truth
        self.peak = np.max([np.quantile(np.abs(m.carried), 0.995, axis=0) for m in motions.values()], axis=0)
        m = plant.model(self.arm, truth)
        d = mujoco.MjData(m)
        d.qpos[:6] = self.programs["a"][2][len(self.programs["a"][2]) // 2]
        mujoco.mj_forward(m, d)
        full = np.zeros((7, 7))
        mujoco.mj_fullM(m, d, full)
        mass = np.diag(full)[:6]
        friction = rng.uniform(0.06, 0.12, 6) * self.peak
        friction = np.maximum(friction, rng.uniform(0.08, 0.12, 6) * friction.max())
        viscous = friction * rng.uniform(1.0, 1.8, 6)
        inertia = np.maximum(rng.uniform(0.4, 1.1, 6) * mass, 0.09 * friction)
        self.logs_currents = rng.random() < 0.75
        three = lambda v: np.array([rounded(x) for x in v])  # noqa: E731
        self.gain = three(rng.uniform(8, 13, 6)) if self.logs_currents else np.ones(6)
        self.coulomb, self.viscous, self.motor_inertia = three(friction), three(viscous), three(inertia)
        self.noise = np.array([rounded(v, 2) for v in rng.uniform(0.035, 0.05, 6) * friction / self.gain])
        # A finer encoder where the mass behind it is large: its noise twice differentiated, through 25 Hz, stays below the current's.
        shaken = (mass + inertia) * (2 * np.pi * 25) ** 2 * 0.35
        self.joint_noise = rounded(min(2e-6, float(np.min(0.6 * self.noise * self.gain / shaken))), 2)
        self.device_noise = np.array([400.0, 4e-5, 0.8])
        truth.gain = inside(rng, self.gain, self.tolerance["gain"]) if self.logs_currents else np.ones(6)
        truth.motor_inertia = inside(rng, self.motor_inertia, self.tolerance["inertia"])
        truth.coulomb, truth.viscous = inside(rng, self.coulomb, self.tolerance["friction"]), inside(rng, self.viscous, self.tolerance["friction"])
        self.no_friction_keys = np.zeros(6, bool)

    def nominal_for_effects(self):
        """What `effects` asks of a cell, under the names that the arms' generator has for it."""
        return types.SimpleNamespace(arm=self.arm, truth=self.truth, peak=self.peak, sensor=self.sensor, gain=self.gain, coulomb=self.coulomb, viscous=self.viscous, tolerance=self.tolerance, cell=self)

    # Files.

    def arm_toml(self, urdf):
        arm, t, s = self.arm, self.tolerance, self.sensor

        def row(v):
            return "[" + ", ".join(f"{x:.6g}" for x in v) + "]"
        lines = ['kind = "recorded_arm"', "schema = 1", "", "[arm]", f'urdf = "{urdf}"', 'flange = "flange"', f"gravity_m_per_s2 = {row(arm.gravity)}",
                 f"link_mass_tolerance = {self.mass_tolerance}", f"link_centre_tolerance_m = {self.centre_tolerance}"]
        for j in range(arm.n):
            lines += ["", "[[drive]]", f'joint = "{arm.joint_names[j]}"']
            if self.logs_currents:
                lines.append(f"gain_n_m_per_a = {{ value = {self.gain[j]:.6g}, tolerance = {t['gain']} }}")
            lines.append(f"motor_inertia_kg_m2 = {{ value = {self.motor_inertia[j]:.6g}, tolerance = {t['inertia']} }}")
            if not self.no_friction_keys[j]:
                lines += [f"coulomb_friction_n_m = {{ value = {self.coulomb[j]:.6g}, tolerance = {t['friction']} }}",
                          f"viscous_friction_n_m_s_per_rad = {{ value = {self.viscous[j]:.6g}, tolerance = {t['friction']} }}"]
        lines += ["", "# All beyond the sensor: housing of the device, and slide with tool at no stroke.", "[wrench_sensor]", f"height_m = {s['height']}", f"rotation_z_rad = {s['rotation']}",
                  f"zero_force_n = {{ value = [0.0, 0.0, 0.0], tolerance_n = {s['zero_tolerance'][0]} }}", f"zero_torque_n_m = {{ value = [0.0, 0.0, 0.0], tolerance_n_m = {s['zero_tolerance'][1]} }}",
                  f"tool_mass_kg = {{ value = {s['mass']}, tolerance = {s['mass_tolerance']} }}", f"tool_centre_m = {{ value = {row(s['centre'])}, tolerance_m = {s['centre_tolerance']} }}",
                  f"tool_inertia_kg_m2 = {row(s['inertia'])}", "", "[sensors]", f"rate_hz = {1 / plant.SAMPLE:.0f}", f"joint_rad = {self.joint_noise}", f"{'current_a' if self.logs_currents else 'torque_n_m'} = {row(self.noise)}",
                  f"wrench_force_n = {s['noise'][0]}", f"wrench_torque_n_m = {s['noise'][1]}", "", "[recordings]", 'fit = ["a.csv", "b.csv"]', 'predict = "predict.csv"', ""]
        return "\n".join(lines)

    def cell_toml(self, urdf, edge, reversed_):
        d, m = self.device, self.moving
        springs = ", ".join(f"{x:.6g}" for x in self.spring)
        return f"""schema = 2
kind = "recorded_cell"
title = "Cell with a wrench sensor at the flange"

[arm]
urdf = "{urdf}"
base_link = "base_link"
flange_link = "flange"
recorded_arm = "arm.toml"

[joints]
servo_bandwidth_hz = {plant.BANDWIDTH:g}
stiffness_n_m_per_rad = [{springs}]
damping_time_ms = {1e3 * self.damping_time:g}
damping_time_tolerance_ms = {1e3 * self.damping_tolerance:g}

[device]
ideal = true
model = "device.toml"

[device.override]
cylinder_count = {d['cylinder_count']}
bore_mm = {d['bore_mm']}
rod_mm = {d['rod_mm']}
stroke_mm = {1e3 * d['stroke']:g}
dead_volume_cm3 = {1e6 * d['dead_volume']:g}
moving_mass_kg = {m['mass']:g}
supply_orifice_mm2 = {1e6 * d['supply']:g}
exhaust_orifice_mm2 = {1e6 * d['exhaust']:g}
discharge_coefficient = {d['discharge']:g}
regulator_gain = 1
regulator_time_constant_s = {d['time_constant']:g}
regulator_dead_time_ms = 0
end_stop_stiffness_n_per_m = {d['stop_stiffness']:g}
end_stop_damping_n_s_per_m = {d['stop_damping']:g}
moving_centre_of_mass_mm = {1e3 * m['centre']:g}
moving_radius_of_gyration_mm = {1e3 * m['gyration']:g}
tool_centre_mm = {1e3 * m['ball']:g}
tool_ball_radius_mm = {1e3 * d['radius']:g}

[workpiece]
mesh = "part.stl"
mesh_unit = "m"
position_mm = [0, 0, 0]

[workpiece.edge]
edge = {edge}
{'reversed = true' if reversed_ else ''}
[contact]
stiffness_n_per_m = {d['stiffness']:g}
damping_n_s_per_m = {d['damping']:g}
friction_coefficient = {d['friction']:g}

[sensors]
joints_rad = {self.joint_noise:g}
regulator_pressure_pa = {self.device_noise[0]:g}
stroke_um = {1e6 * self.device_noise[1]:g}
force_n = {self.device_noise[2]:g}

[belief]
tolerance = 0.005
start_stroke_tolerance_mm = 0.2
"""

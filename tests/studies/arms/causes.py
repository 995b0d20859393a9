"""What is concealed in an arm: every effect of the vocabulary at sizes drawn, and laws that have no name."""
import copy
from dataclasses import dataclass

import numpy as np

CHANNELS = ("force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z")
NEEDS_SENSOR = ("wrench_zero", "tool_weight_error", "wrench_frame_turned", "wrench_gain_error", "wrench_crosstalk", "wrench_drift")
NAMES = ("joint_friction", "stribeck_joint_friction", "load_dependent_joint_friction", "motor_inertia_error", "drive_gain_error", "joint_torque_offset", "gear_ripple", "compliant_joint",
         "joint_encoder_offset", "joint_warm_up", "payload", "link_mass_error", "base_tilt", "dress_pack_spring", "outside_push", *NEEDS_SENSOR, "current_late")
LAWS = ("tight_spot", "cable_catches", "two_ripples", "churning_grease", "dragging_brake", "one_way_viscous", "stiffening_cable", "saturating_motor")


@dataclass
class Drawn:
    """A cause: `without` it, and `at(size)`, size from 0 to 1, with it: numbers, parameters. `belief` edits what is nominal."""

    name: str
    subsystem: str
    place: dict
    without: object
    at: object
    tolerance: object = None  # of parameters, by their values
    belief: object = None
    depends_on: tuple = ()


def share(parameters, part=0.12, **other):
    return {k: other.get(k, part * abs(v)) for k, v in parameters.items()}


def edit(numbers, **changes):
    out = copy.copy(numbers)
    for key, value in changes.items():
        setattr(out, key, value)
    return out


def replaced(values, j, value):
    out = np.array(values, float)
    out[j] = value
    return out


def either(rng, low, high):
    """A factor above or below one, by size."""
    up = rng.random() < 0.5
    return lambda s: (low[0] + s * (low[1] - low[0])) if up else (high[0] + s * (high[1] - high[0]))


def _joint(rng, b, turning=False):
    joints = np.flatnonzero(~b.arm.prismatic) if turning else np.arange(b.arm.n)
    j = int(rng.choice(joints))
    return j, {"joint": j + 1}


def joint_friction(rng, b):
    t = b.truth
    j, place = _joint(rng, b)
    none = rng.random() < 0.5 or None

    def at(s):
        k = (0.02 + 0.98 * s) if none else 1.6 + 2.4 * s
        dry, wet = k * b.coulomb[j], k * b.viscous[j]
        return edit(t, coulomb=replaced(t.coulomb, j, dry), viscous=replaced(t.viscous, j, wet)), {"coulomb_n_m": dry, "viscous_n_m_s_per_rad": wet}

    def belief():
        b.no_friction_keys[j] = bool(none)
    base = edit(t, coulomb=replaced(t.coulomb, j, 0.0 if none else b.coulomb[j]), viscous=replaced(t.viscous, j, 0.0 if none else b.viscous[j]))
    return Drawn("joint_friction", "joints", place, base, at, share, belief)


def stribeck_joint_friction(rng, b):
    t = b.truth
    j, place = _joint(rng, b)
    speed = rng.uniform(0.025, 0.12) * (0.5 if b.arm.prismatic[j] else 1.0)

    def at(s):
        static = t.coulomb[j] * (1.05 + 1.3 * s)
        own = edit(t, static=replaced(t.coulomb, j, static), stribeck_speed=speed)
        return own, {"coulomb_n_m": t.coulomb[j], "viscous_n_m_s_per_rad": t.viscous[j], "static_n_m": static, "stribeck_velocity_rad_per_s": speed}
    return Drawn("stribeck_joint_friction", "joints", place, t, at, lambda p: share(p, stribeck_velocity_rad_per_s=0.15 * speed))


def load_dependent_joint_friction(rng, b):
    j, place = _joint(rng, b)
    sign = 1 if rng.random() < 0.8 else -0.4
    zeros = np.zeros(b.arm.n)

    def at(s):
        mu = sign * (0.003 + 0.15 * s)
        return edit(b.truth, friction_per_load=replaced(zeros, j, mu)), {"friction_per_load": mu}
    return Drawn("load_dependent_joint_friction", "joints", place, b.truth, at, share)


def motor_inertia_error(rng, b):
    j, place = _joint(rng, b)
    tolerance = b.tolerance["inertia"]
    factor = either(rng, (1.15 + tolerance, 2.6), (0.9 - tolerance, 0.15))

    def at(s):
        value = factor(s) * b.inertia[j]
        return edit(b.truth, motor_inertia=replaced(b.truth.motor_inertia, j, value)), {"inertia_kg_m2": value}
    return Drawn("motor_inertia_error", "joints", place, edit(b.truth, motor_inertia=replaced(b.truth.motor_inertia, j, b.inertia[j])), at, share)


def drive_gain_error(rng, b):
    j, place = _joint(rng, b)
    factor = either(rng, (1.14, 1.45), (0.87, 0.65))

    def at(s):
        value = factor(s) * b.gain[j]
        return edit(b.truth, gain=replaced(b.truth.gain, j, value)), {"gain_n_m_per_a": value}
    return Drawn("drive_gain_error", "joints", place, edit(b.truth, gain=replaced(b.truth.gain, j, b.gain[j])), at, lambda p: share(p, 0.05))


def joint_torque_offset(rng, b):
    j, place = _joint(rng, b)
    sign, zeros = rng.choice([-1, 1]), np.zeros(b.arm.n)

    def at(s):
        value = sign * b.coulomb[j] * (0.03 + 1.2 * s)
        return edit(b.truth, offset=replaced(zeros, j, value)), {"offset_n_m": value}
    return Drawn("joint_torque_offset", "joints", place, b.truth, at, share)


def gear_ripple(rng, b):
    j, place = _joint(rng, b, turning=True)
    cycles, phase = float(rng.choice([4, 6, 8, 10, 12, 16, 20, 24, 32, 50])), rng.uniform(0, 2 * np.pi)

    def at(s):
        value = b.coulomb[j] * (0.02 + 0.6 * s)
        return edit(b.truth, ripples=[(j, value, cycles, phase)]), {"amplitude_n_m": value, "cycles_per_turn": cycles}
    return Drawn("gear_ripple", "joints", place, b.truth, at, lambda p: share(p, cycles_per_turn=0.1))


def compliant_joint(rng, b):
    j, place = _joint(rng, b, turning=True)

    def at(s):
        value = max(b.peak[j], 3 * b.coulomb[j]) / (2e-4 * 40**s)
        return edit(b.truth, stiffness=(j, value)), {"stiffness_n_m_per_rad": value}
    return Drawn("compliant_joint", "joints", place, b.truth, at, share)


def joint_encoder_offset(rng, b):
    j, place = _joint(rng, b, turning=True)
    sign, zeros = rng.choice([-1, 1]), np.zeros(b.arm.n)

    def at(s):
        value = sign * (0.002 + 0.1 * s)
        return edit(b.truth, encoder=replaced(zeros, j, value)), {"offset_rad": value}
    return Drawn("joint_encoder_offset", "joints", place, b.truth, at, lambda p: share(p, offset_rad=max(0.004, 0.1 * abs(p["offset_rad"]))))


def joint_warm_up(rng, b):
    j, place = _joint(rng, b)
    constant = rng.uniform(3, 12)

    def at(s):
        return edit(b.truth, warm_up=(j, 0.06 + 0.55 * s, constant)), {"fraction": 0.06 + 0.55 * s, "time_constant_s": constant}
    return Drawn("joint_warm_up", "joints", place, b.truth, at, lambda p: share(p, 0.1, time_constant_s=0.15 * constant))


def payload(rng, b):
    x, y, z = *rng.uniform(-0.06, 0.06, 2), rng.uniform(0.02, 0.15)

    def at(s):
        mass = b.arm.total_mass * (0.004 + 0.12 * s)
        return edit(b.truth, payload=(mass, np.array([x, y, z]))), {"mass_kg": mass, "centre_x_m": x, "centre_y_m": y, "centre_z_m": z}
    return Drawn("payload", "load", {}, b.truth, at, lambda p: dict(mass_kg=max(0.12 * p["mass_kg"], 0.007 * b.arm.total_mass), centre_x_m=0.01, centre_y_m=0.01, centre_z_m=0.022))


def link_mass_error(rng, b):
    j = int(rng.integers(1, b.arm.n))
    factor = either(rng, (1.1 + b.mass_tolerance, 1.9), (0.9 - b.mass_tolerance, 0.55))

    def at(s):
        value = factor(s) * b.arm.masses[j]
        return edit(b.truth, mass=replaced(b.truth.mass, j, value)), {"mass_kg": value}
    return Drawn("link_mass_error", "load", {"link": b.arm.link_names[j]}, edit(b.truth, mass=replaced(b.truth.mass, j, b.arm.masses[j])), at, lambda p: share(p, 0.16))


def base_tilt(rng, b):
    way = rng.uniform(0, 2 * np.pi)

    def at(s):
        tilt = (0.003 + 0.09 * s) * np.array([np.cos(way), np.sin(way)])
        return edit(b.truth, tilt=tuple(tilt)), {"roll_rad": tilt[0], "pitch_rad": tilt[1]}
    return Drawn("base_tilt", "mount", {}, b.truth, at, lambda p: dict(roll_rad=0.004, pitch_rad=0.004))


def dress_pack_spring(rng, b):
    j, place = _joint(rng, b)
    rest = b.arm.middle[j] + rng.uniform(-0.8, 0.8) * (0.4 if b.arm.prismatic[j] else 1.0)

    def at(s):
        value = b.coulomb[j] * (0.05 + 2.0 * s) * (2.5 if b.arm.prismatic[j] else 1.0)
        return edit(b.truth, spring=(j, value, rest)), {"stiffness_n_m_per_rad": value, "rest_rad": rest}
    return Drawn("dress_pack_spring", "surroundings", place, b.truth, at, lambda p: share(p, rest_rad=0.06))


def outside_push(rng, b):
    recording = ["fourier", "slow", "still"][rng.integers(3)]
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    start, seconds = rng.uniform(2, 14), rng.uniform(0.6, 3.5)

    def at(s):
        force = np.max(b.coulomb[~b.arm.prismatic]) / b.arm.reach * (0.05 + 6 * s)
        return edit(b.truth, push=dict(recording=recording, start=start, end=start + seconds, force=force * way)), {"start_s": start, "end_s": start + seconds, "force_n": force}
    return Drawn("outside_push", "surroundings", {"recording": recording}, b.truth, at, lambda p: share(p, start_s=0.12, end_s=0.12))


def _sensor_with(b, **changes):
    return edit(b.truth, sensor={**b.truth.sensor, **changes})


def wrench_zero(rng, b):
    sign = rng.choice([-1, 1], 6) * rng.uniform(0.5, 1.0, 6)
    least = np.repeat(b.sensor["zero_tolerance"], 3)
    keys = [f"{c}_n" if i < 3 else f"{c}_n_m" for i, c in enumerate(CHANNELS)]

    def at(s):
        zero = np.sign(sign) * 1.3 * least + sign * s * np.repeat([12.0, 1.0], 3)
        return _sensor_with(b, zero=zero), dict(zip(keys, zero))
    return Drawn("wrench_zero", "wrench_sensor", {}, _sensor_with(b, zero=np.zeros(6)), at, lambda p: share(p, 0.05))


def tool_weight_error(rng, b):
    s0, way = b.sensor, rng.choice([-1, 1], 3) * rng.uniform(0.5, 1.0, 3)
    factor = either(rng, (1.04, 1.5), (0.96, 0.6))

    def at(s):
        mass, centre = factor(s) * s0["mass"], s0["centre"] + way * (0.008 + 0.03 * s)
        own = _sensor_with(b, mass=mass, centre=centre, inertia=s0["inertia"] * mass / s0["mass"])
        return own, {"mass_kg": mass, "centre_x_m": centre[0], "centre_y_m": centre[1], "centre_z_m": centre[2]}
    base = _sensor_with(b, mass=s0["mass"], centre=s0["centre"], inertia=s0["inertia"])
    return Drawn("tool_weight_error", "wrench_sensor", {}, base, at, lambda p: dict(mass_kg=0.02 * p["mass_kg"], centre_x_m=0.003, centre_y_m=0.003, centre_z_m=0.003))


def wrench_frame_turned(rng, b):
    sign = rng.choice([-1, 1])

    def at(s):
        angle = sign * (0.02 + 0.6 * s)
        return _sensor_with(b, rotation=b.sensor["rotation"] + angle), {"angle_rad": angle}
    return Drawn("wrench_frame_turned", "wrench_sensor", {}, b.truth, at, lambda p: dict(angle_rad=0.01))


def wrench_gain_error(rng, b):
    c = int(rng.integers(6))
    sign = rng.choice([-1, 1])

    def at(s):
        gain = 1 + sign * (0.02 + 0.3 * s)
        return edit(b.truth, wrench_gain=replaced(np.ones(6), c, gain)), {"gain": gain}
    return Drawn("wrench_gain_error", "wrench_sensor", {"channel": CHANNELS[c]}, b.truth, at, lambda p: dict(gain=max(0.01, 0.1 * abs(p["gain"] - 1))))


def wrench_crosstalk(rng, b):
    source, target = (int(k) for k in rng.choice(6, 2, replace=False))
    # Metres from a force to a torque, and the other way.
    unit = 0.05 if source < 3 <= target else 8.0 if target < 3 <= source else 1.0
    sign = rng.choice([-1, 1])

    def at(s):
        value = sign * unit * (0.01 + 0.3 * s)
        return edit(b.truth, crosstalk=(source, target, value)), {"coefficient": value}
    return Drawn("wrench_crosstalk", "wrench_sensor", {"source": CHANNELS[source], "target": CHANNELS[target]}, b.truth, at, share)


def wrench_drift(rng, b):
    c = int(rng.integers(6))
    sign, unit = rng.choice([-1, 1]), 1.0 if c < 3 else 0.05

    def at(s):
        value = sign * unit * (0.01 + 0.6 * s)
        return edit(b.truth, drift=replaced(np.zeros(6), c, value)), {"n_per_s": value}
    return Drawn("wrench_drift", "wrench_sensor", {"channel": CHANNELS[c]}, b.truth, at, share)


def current_late(rng, b):
    def at(s):
        delay = round((0.002 + 0.04 * s) / 0.0005) * 0.0005
        return edit(b.truth, delay=delay), {"delay_s": delay}
    return Drawn("current_late", "timing", {}, b.truth, at, lambda p: share(p, 0.05))


class Law:
    """A law that no name covers: dry friction that it adds, or a torque."""

    def __init__(self, kind, joint, size, numbers):
        self.kind, self.joint, self.size, self.numbers = kind, joint, size, numbers

    def dry(self, q, v, t):
        place, width = self.numbers[:2]
        if self.kind == "tight_spot":
            return self.size * np.exp(-(((q - place) / width) ** 2) / 2)
        if self.kind == "dragging_brake":  # for a while in each recording
            return self.size * ((t > 3 + 2 * width) & (t < 9 + 2 * width))
        return 0.0

    def torque(self, q, v, t, carried):
        place, width, more, scale = self.numbers
        if self.kind == "cable_catches":
            return self.size * np.maximum(q - place, 0) / width
        if self.kind == "two_ripples":
            return self.size * (np.sin(9 * q + place) + 0.85 * np.sin((21 + round(10 * more)) * q + width))
        if self.kind == "churning_grease":
            return self.size * v * np.abs(v)
        if self.kind == "one_way_viscous":
            return self.size * np.maximum(v, 0)
        if self.kind == "stiffening_cable":
            return self.size * ((q - place) / width) ** 3
        if self.kind == "saturating_motor":
            return self.size * carried * np.abs(carried) / scale**2
        return 0.0


DEPENDS_ON = {"tight_spot": ("joints", ("joint_angle", "speed_sign")), "cable_catches": ("surroundings", ("joint_angle",)), "two_ripples": ("joints", ("joint_angle",)),
              "churning_grease": ("joints", ("speed",)), "dragging_brake": ("joints", ("time", "speed_sign")), "one_way_viscous": ("joints", ("speed",)),
              "stiffening_cable": ("surroundings", ("joint_angle",)), "saturating_motor": ("joints", ("load_torque",))}


def unlisted(rng, b, kind):
    j, place = _joint(rng, b, turning=True)
    subsystem, depends_on = DEPENDS_ON[kind]
    numbers = (b.arm.middle[j] + rng.uniform(-0.3, 0.3), rng.uniform(0.2, 0.5), rng.random(), b.peak[j])

    def at(s):
        return edit(b.truth, law=Law(kind, j, b.coulomb[j] * (0.05 + 2.5 * s), numbers)), {}
    return Drawn("unlisted", subsystem, place, b.truth, at, None, depends_on=depends_on)


def draw(rng, b, name, kind=None):
    return unlisted(rng, b, kind) if name == "unlisted" else globals()[name](rng, b)

"""What is concealed in a cell: effects of arm, wrench sensor, part and device, at sizes drawn. Those of a recorded arm are drawn by its generator."""
import numpy as np

from arms import causes
from arms.causes import Drawn, edit, either, replaced, share

ARM = (("joint_friction",), ("payload",), ("drive_gain_error", "joint_torque_offset"), ("joint_encoder_offset", "compliant_joint"))
SENSOR = ("wrench_zero", "tool_weight_error", "wrench_frame_turned", "wrench_gain_error", "wrench_crosstalk", "wrench_drift")
PART = ("part_misplaced", "burr")
DEVICE = ("coulomb_viscous_friction", "regulator_gain_error", "external_leakage", "cross_piston_leakage", "supply_restriction")


def deck(seed):
    """Effects in the order of case numbers, a dozen after the other: four of the arm, three of sensor and tool, two of the part, two of the device, none."""
    rng = np.random.default_rng(seed)
    while True:
        cards = [str(rng.choice(names)) for names in ARM] + list(map(str, rng.choice(SENSOR, 3, replace=False))) + list(PART) + list(map(str, rng.choice(DEVICE, 2, replace=False))) + ["nothing"]
        rng.shuffle(cards)
        yield from cards


def _device(b, **changes):
    return edit(b.truth, device={**b.truth.device, **changes})


def joint_encoder_offset(rng, b):
    j, place = causes._joint(rng, b)
    sign = rng.choice([-1, 1])

    def at(s):
        value = sign * (2e-4 + 4e-3 * s)
        return edit(b.truth, encoder=replaced(np.zeros(6), j, value)), {"offset_rad": value}
    return Drawn("joint_encoder_offset", "arm", place, b.truth, at, lambda p: share(p, offset_rad=max(2e-4, 0.1 * abs(p["offset_rad"]))))


def compliant_joint(rng, b):
    j, place = causes._joint(rng, b)

    def at(s):
        value = b.truth.gear[j] / (2 * 50**s)
        return edit(b.truth, gear=replaced(b.truth.gear, j, value)), {"stiffness_n_m_per_rad": value}
    return Drawn("compliant_joint", "arm", place, b.truth, at, share)


def tool_weight_error(rng, b):
    s0, way, cell, moving = b.sensor, rng.choice([-1, 1], 3) * rng.uniform(0.5, 1.0, 3), b.cell, b.truth.moving
    factor = either(rng, (1.04, 1.4), (0.96, max(0.7, (moving["mass"] + 0.6) / s0["mass"])))

    def at(s):
        mass, centre = factor(s) * s0["mass"], s0["centre"] + way * (0.008 + 0.02 * s)
        own = edit(b.truth, housing=cell.true_housing(mass, centre, moving))
        return own, {"mass_kg": mass, "centre_x_m": centre[0], "centre_y_m": centre[1], "centre_z_m": centre[2]}
    base = edit(b.truth, housing=cell.true_housing(s0["mass"], s0["centre"], moving))
    return Drawn("tool_weight_error", "wrench_sensor", {}, base, at, lambda p: dict(mass_kg=0.02 * p["mass_kg"], centre_x_m=0.003, centre_y_m=0.003, centre_z_m=0.003))


def part_misplaced(rng, b):
    signs, steep = rng.choice([-1, 1], 2), rng.uniform(1e-3, 8e-3)

    def at(s):
        shift, tilt = signs[0] * (5e-5 + 2e-3 * s), signs[1] * (2e-4 + steep * s)
        return _device(b, shift=shift, tilt=tilt), {"shift_m": shift, "tilt_m_per_m": tilt}
    return Drawn("part_misplaced", "workpiece", {}, b.truth, at, lambda p: dict(shift_m=max(5e-5, 0.1 * abs(p["shift_m"])), tilt_m_per_m=max(5e-4, 0.1 * abs(p["tilt_m_per_m"]))))


def burr(rng, b):
    place = b.cell.length * rng.uniform(0.2, 0.8)
    half = rng.uniform(3e-3, 8e-3)

    def at(s):
        height = 5e-5 + 9.5e-4 * s
        return _device(b, burr_height=height, burr_position=place, burr_half_length=half), {"position_m": place, "height_m": height}
    return Drawn("burr", "workpiece", {}, b.truth, at, lambda p: dict(position_m=2e-3, height_m=0.15 * p["height_m"]))


def coulomb_viscous_friction(rng, b):
    viscous = rng.uniform(30, 120)

    def at(s):
        return _device(b, coulomb=2 + 28 * s, viscous=viscous), {"coulomb_force_n": 2 + 28 * s, "viscous_coefficient_n_s_per_m": viscous}
    return Drawn("coulomb_viscous_friction", "force_balance", {}, b.truth, at, lambda p: share(p, viscous_coefficient_n_s_per_m=0.3 * viscous))


def regulator_gain_error(rng, b):
    factor = either(rng, (1.01, 1.12), (0.99, 0.88))

    def at(s):
        return _device(b, gain=factor(s)), {"gain": factor(s)}
    return Drawn("regulator_gain_error", "regulator", {}, b.truth, at, lambda p: dict(gain=max(0.003, 0.1 * abs(p["gain"] - 1))))


def _leak(rng, b, name, key):
    def at(s):
        area = b.truth.device["supply"] * (0.02 + 0.5 * s)
        return _device(b, **{key: area}), {"orifice_area_m2": area}
    return Drawn(name, "chambers", {}, b.truth, at, share)


def external_leakage(rng, b):
    return _leak(rng, b, "external_leakage", "leak_outside")


def cross_piston_leakage(rng, b):
    return _leak(rng, b, "cross_piston_leakage", "leak_across")


def supply_restriction(rng, b):
    def at(s):
        area = b.truth.device["supply"] * (0.8 - 0.68 * s)
        return _device(b, supply=area), {"orifice_area_m2": area}
    return Drawn("supply_restriction", "chambers", {}, b.truth, at, share)


def draw(rng, b, name):
    return globals()[name](rng, b) if name in globals() else getattr(causes, name)(rng, b)

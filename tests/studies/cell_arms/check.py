"""The generator's cells by other means: torques and wrench by Pinocchio, the contact by its law, the chambers by another integrator, the engine's step halved."""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

from arms.bodies import rotation

from . import plant, pneumatics
from .cell import Cell


def pinocchio_torques(cell, motion):
    """Torques of gears and force on the slide, the tool's wrench on the sensor, and the ball's places; None without Pinocchio."""
    try:
        import pinocchio as pin
    except ImportError:
        return None
    arm, n = cell.arm, cell.truth
    m = pin.Model()
    m.gravity.linear = arm.gravity
    parent = 0
    for i, (_, origin, axis) in enumerate(arm.joints):
        joint = pin.JointModelRevoluteUnaligned(*map(float, axis))
        parent = m.addJoint(parent, joint, pin.SE3(np.eye(3), np.array(origin, float)), f"j{i}")
        m.appendBodyToJoint(parent, pin.Inertia(n.mass[i], n.centre[i], arm.inertias[i] * n.mass[i] / arm.masses[i]), pin.SE3.Identity())
    flange = pin.SE3(rotation(arm.flange_rpy), arm.flange_at)
    h, v = n.housing, n.moving
    m.appendBodyToJoint(parent, pin.Inertia(h["mass"], np.asarray(h["centre"], float), np.diag(h["inertia"])), flange)
    slide = m.addJoint(parent, pin.JointModelPZ(), flange, "slide")
    m.appendBodyToJoint(slide, pin.Inertia(v["mass"], np.array([0, 0, v["centre"]]), v["mass"] * v["gyration"] ** 2 * np.eye(3)), pin.SE3.Identity())
    d = m.createData()
    out, wrench, ball = np.zeros((len(motion.time), 7)), np.zeros((len(motion.time), 6)), np.zeros((len(motion.time), 3))
    for i in range(len(motion.time)):
        q, dq, a = (np.append(motion.link[k][i], motion.stroke[i, k]) for k in range(3))
        pin.forwardKinematics(m, d, q)
        at = d.oMi[slide]
        ball[i] = at.act(np.array([0, 0, v["ball"]]))
        force, point = motion.applied[i, :3], motion.applied[i, 3:]
        external = [pin.Force.Zero() for _ in range(m.njoints)]
        external[slide] = at.actInv(pin.Force(force, np.cross(point, force)))
        out[i] = pin.rnea(m, d, q, dq, a, external)
        # Newton and Euler for all beyond the sensor, in the flange's axes about the sensor's origin.
        frame = d.oMi[parent] * flange * pin.SE3(np.eye(3), np.array([0, 0, cell.height]))
        body = pin.Inertia(h["mass"], np.asarray(h["centre"], float), np.diag(h["inertia"]))
        speed, acceleration = flange.actInv(d.v[parent]), flange.actInv(d.a_gf[parent])
        needed = body * acceleration + speed.cross(body * speed)
        mass = pin.Inertia(v["mass"], np.array([0, 0, v["centre"]]), v["mass"] * v["gyration"] ** 2 * np.eye(3))
        needed += pin.SE3(np.eye(3), np.array([0, 0, q[6]])).act(mass * d.a_gf[slide] + d.v[slide].cross(mass * d.v[slide]))
        # What acts on the tool from outside, less what moves it, is what it does to the sensor.
        total = frame.actInv(pin.Force(force, np.cross(point, force))) - pin.SE3(np.eye(3), np.array([0, 0, cell.height])).actInv(needed)
        wrench[i] = np.concatenate([total.linear, total.angular])
    return out, wrench, ball


def check(seed):
    """Prints what is compared, and whether all of it holds."""
    cell = Cell(np.random.default_rng([99, seed]))
    program = cell.programs["a"]
    motion = plant.simulate(cell.arm, cell.truth, cell.edge, program)
    numbers, time = cell.truth, motion.time
    fine = []

    def line(what, value, limit, unit):
        fine.append(bool(value <= limit))
        print(f"{'ok  ' if fine[-1] else 'OFF '} {what}: {value:.3g} {unit} (at most {limit:g})")
    by_other = pinocchio_torques(cell, motion)
    if by_other is not None:
        torques, wrench, ball = by_other
        line("joint torques against Pinocchio, largest difference", np.abs(torques[:, :6] - motion.carried).max(), 1e-6, "N m")
        line("force on the slide against Pinocchio, largest difference", np.abs(torques[:, 6] - motion.slide_force).max(), 1e-6, "N")
        line("wrench's forces against Newton's law of housing and slide", np.abs(wrench[:, :3] - motion.wrench[:, :3]).max(), 1e-6, "N")
        line("wrench's torques against Euler's", np.abs(wrench[:, 3:] - motion.wrench[:, 3:]).max(), 1e-6, "N m")
        # The contact by its law, its rate by differences of the ball's places.
        depth = numbers.device["radius"] - (ball - cell.edge[0]) @ cell.edge[2]
        law = np.where(depth > 0, np.maximum(numbers.device["stiffness"] * depth + numbers.device["damping"] * np.gradient(depth, plant.SAMPLE), 0), 0)
        line("contact force against its law, 99 % of samples", np.quantile(np.abs(law - motion.force), 0.99), 0.5, "N")
    still = (time > 0.45) & (time < 0.58)
    mass, centre, _ = plant.tool(numbers.housing, numbers.moving, cell.height)
    weight = np.linalg.norm(motion.wrench[still, :3], axis=1)
    line("still wrench against the tool's weight", np.abs(weight / (9.81 * mass) - 1).max(), 2e-3, "of it")
    at = centre + numbers.moving["mass"] / mass * motion.stroke[still, :1] * [0, 0, 1]
    line("its torque against the weight at its centre", np.abs(np.cross(at, motion.wrench[still, :3]) - motion.wrench[still, 3:]).max(), 2e-2, "N m")
    d = numbers.device
    riding = (time > time[np.argmax(program[3] > 0)] + 0.8) & (motion.set_pressure > 0)
    steady = riding & (np.abs(motion.stroke[:, 1]) < 2e-3)
    balance = motion.pressures[:, 0] * d["area_1"] - motion.pressures[:, 1] * d["area_2"] - 101325.0 * d["rod_area"]
    inside = (motion.stroke[:, 0] > 1e-4) & (motion.stroke[:, 0] < d["stroke"] - 1e-4)
    line("force on the slide against pressures", np.abs(motion.slide_force - balance)[inside].max(), 1e-9, "N")
    line("chamber 1 against the regulator while it rides", np.abs(motion.pressures[steady, 0] - 101325.0 - motion.outlet[steady]).max() / 1e5, 0.05, "bar")
    regulator = [0.0]
    for p in motion.set_pressure[:-1]:
        regulator.append(d["gain"] * p + (regulator[-1] - d["gain"] * p) * np.exp(-plant.SAMPLE / d["time_constant"]))
    line("regulator against its closed form", np.abs(np.array(regulator) - motion.outlet).max(), 1e-3, "Pa")
    # Chambers by another integrator along the simulated stroke.
    stroke = CubicHermiteSpline(time, motion.stroke[:, 0], motion.stroke[:, 1])
    rate = stroke.derivative()
    from_, to = np.searchsorted(time, [3.0, 6.0])

    def slopes(t, p):
        return pneumatics.rates(plant.parameters(d), p[0], p[1], np.interp(t, time, motion.outlet), float(stroke(t)), float(rate(t)))
    solved = solve_ivp(slopes, time[[from_, to]], motion.pressures[from_], "LSODA", t_eval=time[from_:to + 1], rtol=1e-7, atol=1.0, max_step=1e-3)
    line("chambers against LSODA from 3 s to 6 s", np.abs(solved.y.T - motion.pressures[from_:to + 1]).max(), 60.0, "Pa")
    line("contact force that pulls", -min(motion.force.min(), 0.0), 0.0, "N")
    halved = plant.simulate(cell.arm, numbers, cell.edge, program, 2 * plant.HOLD)
    apart = np.ones(len(time), bool)
    for m in (motion, halved):
        hit = ((m.stroke[:, 0] < 1e-4) | (m.stroke[:, 0] > d["stroke"] - 1e-4)) & (np.abs(m.stroke[:, 1]) > 0.01)
        apart &= np.convolve(hit, np.ones(41), "same") == 0
    rms = lambda x: float(np.sqrt(np.mean(np.square(x))))  # noqa: E731
    line("half the step: stroke", rms((halved.stroke - motion.stroke)[apart, 0]), 1e-5, "m, RMS")
    line("half the step: contact force", rms((halved.force - motion.force)[apart]), 0.2, "N, RMS")
    line("half the step: wrench's forces", rms((halved.wrench - motion.wrench)[apart, :3]), 0.05, "N, RMS")
    line("half the step: joint torques", rms((halved.carried - motion.carried)[apart]), 0.05, "N m, RMS")
    return all(fine)

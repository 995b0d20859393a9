"""A cell simulated by MuJoCo: the arm's links on the springs of their joints behind prescribed motors, device and contact by `pneumatics`, drives' friction as a Maxwell slip."""
from dataclasses import dataclass, field

import mujoco
import numpy as np

from arms import friction
from arms.bodies import quaternion, rotation

from . import pneumatics

SAMPLE = 0.002
HOLD = 20  # Steps of the engine to a sample.
STEP = SAMPLE / HOLD
BANDWIDTH = 25.0


@dataclass
class Numbers:
    """What a cell really is."""

    mass: np.ndarray
    centre: np.ndarray
    gear: np.ndarray  # stiffness of the springs between motors and links
    damping_time: float
    gain: np.ndarray
    motor_inertia: np.ndarray
    coulomb: np.ndarray
    viscous: np.ndarray
    device: dict  # by names of `pneumatics`
    housing: dict  # mass, centre (3), inertia (3)
    moving: dict  # mass, centre, gyration, ball: along the slide from the flange at no stroke
    sensor: dict  # height, rotation, zero (6)
    # Effects.
    encoder: np.ndarray = field(default_factory=lambda: np.zeros(6))
    payload: tuple | None = None  # mass, centre
    static: np.ndarray | None = None
    stribeck_speed: float = 0.05
    offset: np.ndarray = field(default_factory=lambda: np.zeros(6))
    ripples: list = field(default_factory=list)  # joint, amplitude, cycles, phase
    spring: tuple | None = None  # of a dress pack: joint, stiffness, rest
    wrench_gain: np.ndarray = field(default_factory=lambda: np.ones(6))
    crosstalk: tuple | None = None  # source, target, coefficient
    drift: np.ndarray = field(default_factory=lambda: np.zeros(6))


# What the motion of arm and slide does not depend on: it need not be simulated again for these.
READ_ALONE = ("gain", "motor_inertia", "coulomb", "viscous", "static", "stribeck_speed", "offset", "ripples", "spring", "wrench_gain", "crosstalk", "drift", "sensor")


def tool(housing, moving, height):
    """Mass, centre from the sensor's origin and inertia about the centre of all beyond the sensor, at no stroke."""
    mass = housing["mass"] + moving["mass"]
    at = np.array([0, 0, moving["centre"]])
    centre = (housing["mass"] * np.asarray(housing["centre"]) + moving["mass"] * at) / mass
    inertia = np.diag(housing["inertia"]) + moving["mass"] * moving["gyration"] ** 2 * np.eye(3)
    for own, place in ((housing["mass"], housing["centre"]), (moving["mass"], at)):
        r = np.asarray(place) - centre
        inertia += own * (r @ r * np.eye(3) - np.outer(r, r))
    return mass, centre - [0, 0, height], inertia


def model(arm, numbers):
    """The arm with its device for MuJoCo; the sensor's site has the flange's axes."""
    def text(v):
        return " ".join(f"{x:.12g}" for x in np.ravel(v))
    h, m = numbers.housing, numbers.moving
    flange = f'pos="{text(arm.flange_at)}" quat="{text(quaternion(rotation(arm.flange_rpy)))}"'
    inner = (f'<body name="housing" {flange}><inertial pos="{text(h["centre"])}" mass="{h["mass"]:.12g}" diaginertia="{text(h["inertia"])}"/>'
             f'<site name="sensor" pos="0 0 {numbers.sensor["height"]}"/>'
             f'<body name="moving"><joint name="slide" type="slide" axis="0 0 1"/><inertial pos="0 0 {m["centre"]:.12g}" mass="{m["mass"]:.12g}" diaginertia="{text([m["mass"] * m["gyration"] ** 2] * 3)}"/></body></body>')
    if numbers.payload:
        mass, centre = numbers.payload
        inner += f'<body name="payload" {flange}><inertial pos="{text(centre)}" mass="{mass:.12g}" diaginertia="{text([1e-5 * mass] * 3)}"/></body>'
    for i in reversed(range(arm.n)):
        _, origin, axis = arm.joints[i]
        t = arm.inertias[i] * numbers.mass[i] / arm.masses[i]
        full = [t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2]]
        inner = (f'<body name="{arm.link_names[i]}" pos="{text(origin)}"><joint type="hinge" axis="{text(axis)}"/>'
                 f'<inertial pos="{text(numbers.centre[i])}" mass="{numbers.mass[i]:.12g}" fullinertia="{text(full)}"/>{inner}</body>')
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian" autolimits="false" inertiagrouprange="0 0"/><option gravity="{text(arm.gravity)}" timestep="{STEP}" integrator="Euler"><flag contact="disable"/></option>'
        f'<worldbody>{inner}</worldbody><sensor><force site="sensor"/><torque site="sensor"/></sensor></mujoco>')


@dataclass
class Motion:
    """A simulated recording at its samples, without noise, and the motors' motion on the engine's grid."""

    time: np.ndarray
    path: np.ndarray
    command: np.ndarray
    set_pressure: np.ndarray
    motor: tuple  # q, v, a as encoders see them, at the engine's steps
    link: tuple  # q, v, a of the links
    carried: np.ndarray  # torque that gears carry to the links [N m]
    wrench: np.ndarray  # of the tool on the sensor, in the flange's axes, about the sensor's origin
    outlet: np.ndarray
    stroke: np.ndarray  # and its rate, its acceleration
    force: np.ndarray
    applied: np.ndarray  # force on the ball and its point, in the base's axes
    slide_force: np.ndarray
    gap: np.ndarray
    pressures: np.ndarray


def parameters(device):
    return np.array([float(device.get(name, 0.0)) for name in pneumatics.NAMES])


def simulate(arm, numbers, edge, program, hold=HOLD):
    """Runs a program: time, path, command, set pressure at samples."""
    time, path, command, set_pressure = program
    count, n = len(time), arm.n
    m = model(arm, numbers)
    step = SAMPLE / hold
    m.opt.timestep = step
    d = mujoco.MjData(m)
    motor = [np.stack(x, axis=1) for x in zip(*(pneumatics.lag(np.ascontiguousarray(command[:, j]), hold, BANDWIDTH) for j in range(n)))]
    # The servo closes on the encoder: the motor itself is off by what that reads too much.
    q, v = motor[0] - numbers.encoder, motor[1]
    k, c = numbers.gear, numbers.gear * numbers.damping_time
    d.qpos[:n] = q[0]
    device = parameters(numbers.device)
    state = np.array([pneumatics.ATMOSPHERE, pneumatics.ATMOSPHERE, 0.0])
    elements, out = np.zeros(len(pneumatics.SHARES) + 1), np.zeros(9)
    moving, root = m.body("moving").id, m.body(arm.link_names[0]).id
    place, turn, velocity, com, centre = d.xpos[moving], d.xmat[moving].reshape(3, 3), d.cvel[moving], d.subtree_com[root], d.xipos[moving]
    ball_at = numbers.moving["ball"]
    applied, outside, bias = d.qfrc_applied, d.xfrc_applied[moving], d.qfrc_bias
    delay = round(numbers.device.get("delay", 0.0) / SAMPLE)
    rows = {name: np.zeros((count, width)) for name, width in (("link", 3 * n), ("carried", n), ("wrench", 6), ("slide", 3), ("applied", 6), ("more", 6))}
    # Damping of stiff springs is taken at the end of a step, by the engine.
    m.dof_damping[:n] = c
    inverse = mujoco.MjData(m)
    still = m.dof_damping.copy()
    for i in range(count):
        pressure = set_pressure[max(i - delay, 0)]
        for s in range(hold):
            j = min(i * hold + s, len(q) - 1)
            mujoco.mj_step1(m, d)
            if s == 0:
                at = (d.qpos.copy(), d.qvel.copy())
                rows["more"][i, 3:] = state
            pneumatics.step(device, state, elements, edge, (i + s / hold) * SAMPLE, step, pressure, d.qpos[n], d.qvel[n], place, turn, ball_at, velocity, com, out)
            # Gravity and Coriolis torques are compensated: the springs carry the rest.
            applied[:n] = k * (q[j] - d.qpos[:n]) + c * v[j] + bias[:n]
            applied[n] = out[0]
            outside[:3] = out[2:5]
            outside[3:] = 0 if out[1] == 0 else np.cross(out[5:8] - centre, out[2:5])
            if s == 0:
                rows["applied"][i] = out[2:8]
                rows["more"][i, :3] = out[1], out[0], out[8]
                inverse.xfrc_applied[moving] = outside
            mujoco.mj_step2(m, d)
            if s == 0:
                # What gears and sensor carry, by the acceleration that the step really had.
                acceleration = (d.qvel - at[1]) / step
                inverse.qpos[:], inverse.qvel[:], inverse.qacc[:] = at[0], at[1], acceleration
                m.dof_damping[:] = 0
                mujoco.mj_inverse(m, inverse)
                m.dof_damping[:] = still
                by_contact = np.zeros(n + 1)
                mujoco.mj_applyFT(m, inverse, inverse.xfrc_applied[moving, :3], inverse.xfrc_applied[moving, 3:], inverse.xipos[moving], moving, by_contact)
                rows["carried"][i] = (inverse.qfrc_inverse - by_contact)[:n]
                rows["link"][i] = np.concatenate([at[0][:n], at[1][:n], acceleration[:n]])
                rows["slide"][i] = at[0][n], at[1][n], acceleration[n]
                # MuJoCo's sensor reads what the sensor does to the tool.
                rows["wrench"][i] = -inverse.sensordata
    more = rows["more"]
    link = tuple(rows["link"][:, j * n:(j + 1) * n] for j in range(3))
    return Motion(time, path, command, set_pressure, tuple(motor), link, rows["carried"], rows["wrench"], more[:, 5], rows["slide"], more[:, 0], rows["applied"], more[:, 1], more[:, 2], more[:, 3:5])


def drives(numbers, motion, start):
    """Motors' torques at the joints' side at the samples [N m]."""
    q, v, a = motion.motor
    hold = (len(q) - 1) // (len(motion.time) - 1)
    at = np.arange(len(motion.time)) * hold
    out = motion.carried.copy()
    for j in range(out.shape[1]):
        sliding = np.full(len(q), numbers.coulomb[j])
        if numbers.static is not None:
            sliding += (numbers.static[j] - numbers.coulomb[j]) * np.exp(-((v[:, j] / numbers.stribeck_speed) ** 2))
        out[:, j] += friction.along(q[:, j], SAMPLE / hold, sliding, max(numbers.coulomb[j], 1e-9), start[j])[at]
        out[:, j] += numbers.viscous[j] * v[at, j] + numbers.motor_inertia[j] * a[at, j] + numbers.offset[j]
        for joint, amplitude, cycles, phase in numbers.ripples:
            if joint == j:
                out[:, j] += amplitude * np.sin(cycles * q[at, j] + phase)
        if numbers.spring and numbers.spring[0] == j:
            out[:, j] += numbers.spring[1] * (q[at, j] - numbers.spring[2])
    return out


def read(numbers, motion, start):
    """Readings without noise by channel: drive (samples, joints), wrench (samples, 6), device (samples, 3: outlet, stroke, force)."""
    c, s = np.cos(numbers.sensor["rotation"]), np.sin(numbers.sensor["rotation"])
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    wrench = np.hstack([motion.wrench[:, :3] @ turn.T, motion.wrench[:, 3:] @ turn.T])
    reading = wrench * numbers.wrench_gain
    if numbers.crosstalk:
        source, target, share = numbers.crosstalk
        reading[:, target] += share * wrench[:, source]
    reading += numbers.sensor["zero"] + np.outer(motion.time, numbers.drift)
    return {"drive": drives(numbers, motion, start) / numbers.gain, "wrench": reading, "device": np.column_stack([motion.outlet, motion.stroke[:, 0], motion.force])}

"""What an arm's sensors read along a motion: MuJoCo's inverse dynamics, Maxwell-slip friction, MuJoCo's force and torque sensor; and the effects of the vocabulary, by equations of this file."""
import copy
from dataclasses import dataclass, field

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

from . import friction
from .bodies import rotation
from .motion import LEAD, STEP


@dataclass
class Numbers:
    """What the arm really is. Of a prismatic joint read N for N m and m for rad."""

    mass: np.ndarray
    centre: np.ndarray
    gain: np.ndarray
    motor_inertia: np.ndarray
    coulomb: np.ndarray
    viscous: np.ndarray
    load_mass: float = 0.0
    load_centre: np.ndarray = field(default_factory=lambda: np.zeros(3))
    sensor: dict | None = None  # height, rotation, zero (6), mass, centre, inertia, tip
    # Effects.
    static: np.ndarray | None = None
    stribeck_speed: float = 0.05
    friction_per_load: np.ndarray | None = None
    warm_up: tuple | None = None  # joint, fraction, time constant
    offset: np.ndarray | None = None
    ripples: list = field(default_factory=list)  # joint, amplitude, cycles, phase
    stiffness: tuple | None = None  # joint, N m/rad
    encoder: np.ndarray | None = None
    payload: tuple | None = None  # mass, centre
    tilt: tuple = (0.0, 0.0)
    spring: tuple | None = None  # joint, stiffness, rest
    push: dict | None = None  # recording, start, end, force (3)
    wrench_gain: np.ndarray = field(default_factory=lambda: np.ones(6))
    crosstalk: tuple | None = None  # source, target, coefficient
    drift: np.ndarray = field(default_factory=lambda: np.zeros(6))
    delay: float = 0.0
    law: object = None  # a law without a name: kind, joint, numbers


@dataclass
class Motion:
    """A recording's motion as logged on the fine grid, from LEAD before its start: motor's side and, behind a soft gear, the link's."""

    name: str
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    command: np.ndarray
    samples: np.ndarray  # indices of the fine grid
    press: np.ndarray | None = None  # share of the force of contact
    press_force: float = 0.0
    start: np.ndarray | None = None  # how far friction's elements are bent at first
    link: tuple | None = None  # q, v, a of the link's side

    @property
    def time(self):
        return (self.samples - round(LEAD / STEP)) * STEP


class Plant:
    """MuJoCo's model of an arm, with the numbers of a truth."""

    def __init__(self, arm, numbers):
        self.arm, self.numbers = arm, numbers
        self.model = m = arm.model()
        self.data = mujoco.MjData(m)
        for i, name in enumerate(arm.link_names):
            body = m.body(name).id
            m.body_inertia[body] *= numbers.mass[i] / arm.masses[i]
            m.body_mass[body] = numbers.mass[i]
            m.body_ipos[body] = numbers.centre[i]
        turn = rotation(arm.flange_rpy)
        self.tool, self.last = m.body("tool").id, m.body(arm.link_names[-1]).id
        self._point("load", numbers.load_mass, numbers.load_centre)
        if numbers.payload:
            self._point("payload", *numbers.payload)
        if numbers.sensor:
            s = numbers.sensor
            up = np.array([0, 0, s["height"]])
            m.body_mass[self.tool], m.body_ipos[self.tool] = s["mass"], up + s["centre"]
            m.body_inertia[self.tool], m.body_iquat[self.tool] = s["inertia"], [1, 0, 0, 0]
            site = m.site("sensor").id
            m.site_pos[site] = up
            m.site_quat[site] = [np.cos(s["rotation"] / 2), 0, 0, np.sin(s["rotation"] / 2)]
        roll, pitch = numbers.tilt
        m.opt.gravity[:] = rotation([roll, pitch, 0]).T @ arm.gravity
        mujoco.mj_setConst(m, self.data)
        self.flange = np.array(arm.flange_at), turn

    def _point(self, name, mass, centre):
        body = self.model.body(name).id
        self.model.body_mass[body] = max(mass, 1e-9)
        self.model.body_ipos[body] = centre
        self.model.body_inertia[body] = max(mass, 1e-9) * 1e-5

    def inverse(self, q, v, a, force=None, press=None):
        """Torques that the gears carry to the links [N m], and the sensor's six numbers; `force` on the flange's origin [N, base's axes], `press` share of contact at the tip."""
        m, d = self.model, self.data
        carried, wrench = np.zeros(q.shape), np.zeros((len(q), 6))
        at, torque = np.zeros(3), np.zeros(3)
        for i in range(len(q)):
            d.qpos[:], d.qvel[:], d.qacc[:] = q[i], v[i], a[i]
            if press is not None:
                self._contact(press[i], q[i], v[i])
            mujoco.mj_inverse(m, d)
            outside = np.zeros(self.arm.n)
            if force is not None and force[i].any():
                at = d.xpos[self.last] + d.xmat[self.last].reshape(3, 3) @ self.flange[0]
                mujoco.mj_applyFT(m, d, force[i], torque, at, self.last, outside)
            if press is not None:
                mujoco.mj_applyFT(m, d, d.xfrc_applied[self.tool, :3], d.xfrc_applied[self.tool, 3:], d.xipos[self.tool], self.tool, outside)
            # MuJoCo's sensor reads what the sensor does to the tool; ours what the tool does to the sensor.
            carried[i], wrench[i] = d.qfrc_inverse - outside, -d.sensordata
        d.xfrc_applied[:] = 0
        return carried, wrench

    def _contact(self, force, q, v):
        """The surface pushes back along the tool, and rubs against its way."""
        m, d = self.model, self.data
        d.xfrc_applied[:] = 0
        if force == 0:
            return
        mujoco.mj_kinematics(m, d)
        mujoco.mj_comPos(m, d)
        frame = d.xmat[self.tool].reshape(3, 3)
        s = self.numbers.sensor
        tip = d.xpos[self.tool] + frame @ [0, 0, s["height"] + s["tip"]]
        jacobian = np.zeros((3, self.arm.n))
        mujoco.mj_jac(m, d, jacobian, None, tip, self.tool)
        normal = -frame[:, 2]
        way = jacobian @ v
        way -= normal * (normal @ way)
        push = force * (normal - 0.25 * way / (np.linalg.norm(way) + 0.01))
        d.xfrc_applied[self.tool, :3] = push
        d.xfrc_applied[self.tool, 3:] = np.cross(tip - d.xipos[self.tool], push)

    # What drives and sensors read.

    def push(self, name, time):
        p = self.numbers.push
        if not p or p["recording"] != name:
            return None
        edge = 0.2 * (p["end"] - p["start"])
        inside = np.clip(np.minimum(time - p["start"], p["end"] - time) / edge, 0, 1)
        share = inside**2 * (3 - 2 * inside)
        return share[:, None] * p["force"]

    def sliding(self, motion, joint, carried, at):
        """Sliding friction along the fine grid [N m]."""
        n = self.numbers
        time = np.arange(len(motion.q)) * STEP - LEAD
        base = np.full(len(time), n.coulomb[joint])
        if n.static is not None and n.static[joint] > n.coulomb[joint]:
            base += (n.static[joint] - n.coulomb[joint]) * np.exp(-((motion.v[:, joint] / n.stribeck_speed) ** 2))
        if n.friction_per_load is not None and n.friction_per_load[joint]:
            base += n.friction_per_load[joint] * np.interp(np.arange(len(time)), at, np.abs(carried[:, joint]))
        if n.law is not None and n.law.joint == joint:
            base = base + n.law.dry(motion.q[:, joint], motion.v[:, joint], np.maximum(time, 0))
        return np.maximum(base, 0) * self.warm(joint, time)

    def warm(self, joint, time):
        if not self.numbers.warm_up or self.numbers.warm_up[0] != joint:
            return 1.0
        _, fraction, constant = self.numbers.warm_up
        return 1 - fraction * (1 - np.exp(-np.maximum(time, 0) / constant))

    def drives(self, motion, carried, at):
        """Motors' torques at the joints' side at fine samples `at` [N m]."""
        n, out = self.numbers, carried.copy()
        time = at * STEP - LEAD
        for j in range(self.arm.n):
            q, v = motion.q[at, j], motion.v[at, j]
            sliding = self.sliding(motion, j, carried, at)
            stiff = max(n.coulomb[j], 1e-9)
            out[:, j] += friction.along(motion.q[:, j], STEP, sliding, stiff, motion.start[j])[at]
            out[:, j] += n.viscous[j] * v * self.warm(j, time) + n.motor_inertia[j] * motion.a[at, j]
            if n.offset is not None:
                out[:, j] += n.offset[j]
            for joint, amplitude, cycles, phase in n.ripples:
                if joint == j:
                    out[:, j] += amplitude * np.sin(cycles * q + phase)
            if n.spring and n.spring[0] == j:
                out[:, j] += n.spring[1] * (q - n.spring[2])
            if n.law is not None and n.law.joint == j:
                out[:, j] += n.law.torque(q, v, np.maximum(time, 0), carried[:, j])
        return out

    def read(self, motion):
        """What sensors read without noise, by channel: drive (samples, joints), link, wrench."""
        n = self.numbers
        shifted = np.maximum(motion.samples - round(n.delay / STEP), 0)
        q, v, a = motion.link if motion.link is not None and n.stiffness else (motion.q, motion.v, motion.a)
        # Motions are as logged: where an encoder's zero is off, the arm stands elsewhere.
        q = q if n.encoder is None else q - n.encoder

        def at(samples):
            press = None if motion.press is None else motion.press[samples] * motion.press_force
            return self.inverse(q[samples], v[samples], a[samples], self.push(motion.name, samples * STEP - LEAD), press)
        carried, wrench = at(motion.samples)
        late = carried if n.delay == 0 else at(shifted)[0]
        out = {"drive": self.drives(motion, late, shifted) / n.gain, "link": q[motion.samples]}
        if n.sensor:
            reading = wrench * n.wrench_gain
            if n.crosstalk:
                source, target, share = n.crosstalk
                reading[:, target] += share * wrench[:, source]
            out["wrench"] = reading + n.sensor["zero"] + np.outer(motion.time, n.drift)
        return out


def move(plant, name, command, samples, start, press=None, press_force=0.0):
    """The motion of an arm behind its servos along a path of commands."""
    n, arm = plant.numbers, plant.arm
    lead = round(LEAD / STEP)
    command = np.concatenate([np.tile(command[0], (lead, 1)), command, np.tile(command[-1], (round(0.05 / STEP), 1))])
    grid = np.arange(0, len(command), 20)
    speed = np.gradient(command, STEP, axis=0)
    forced = None if press is None else np.interp(grid, np.arange(lead, lead + len(press)), press, left=0, right=0) * press_force
    push = plant.push(name, grid * STEP - LEAD)
    true = command if n.encoder is None else command - n.encoder
    asked, _ = plant.inverse(true[grid], speed[grid], np.gradient(speed, STEP, axis=0)[grid], push, forced)
    mass = np.zeros((arm.n, arm.n))
    mujoco.mj_fullM(plant.model, plant.data, mass)
    # The servo knows gravity and motion of its model, a tenth off.
    states = []
    for j in range(arm.n):
        load = np.interp(np.arange(len(command)), grid, asked[:, j])
        static = n.static[j] if n.static is not None else n.coulomb[j]
        inertia = mass[j, j] + n.motor_inertia[j]
        states.append(friction.servo(command[:, j], STEP, inertia, 45.0, load, 0.95 * load, n.coulomb[j], static, n.stribeck_speed, n.viscous[j], start[j]))
    q, v, a = (np.stack([s[k] for s in states], axis=1) for k in range(3))
    motion = Motion(name, q, v, a, command, samples + lead, press=None if press is None else np.pad(press, (lead, len(command) - lead - len(press))), press_force=press_force, start=start)
    return soften(plant, motion) if n.stiffness else motion


def soften(plant, motion):
    """Behind a soft gear the link's motion, smoothed, is what is given; the motor's follows from the torque carried."""
    joint, stiffness = plant.numbers.stiffness
    sos = butter(4, 12.0, output="sos", fs=1 / STEP)
    q = sosfiltfilt(sos, motion.q, axis=0)
    v = np.gradient(q, STEP, axis=0)
    a = np.gradient(v, STEP, axis=0)
    grid = np.arange(0, len(q), 4)
    press = None if motion.press is None else motion.press[grid] * motion.press_force
    carried, _ = plant.inverse(q[grid], v[grid], a[grid], plant.push(motion.name, grid * STEP - LEAD), press)
    wound = CubicSpline(grid * STEP, carried[:, joint] / stiffness)
    time = np.arange(len(q)) * STEP
    motor = [x.copy() for x in (q, v, a)]
    for x, order in zip(motor, range(3)):
        x[:, joint] += wound(time, order)
    motion = copy.copy(motion)
    motion.link, (motion.q, motion.v, motion.a) = (q, v, a), motor
    return motion

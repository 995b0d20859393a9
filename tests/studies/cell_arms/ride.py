"""Programs of a cell: free motion of all joints, approach, ride along the edge, retraction, free motion again."""
import mujoco
import numpy as np

from arms.motion import smooth

from . import plant

SAMPLE = plant.SAMPLE


class Unreachable(Exception):
    """No posture of the arm for a pose."""


class Reach:
    """Postures of an arm for poses of its ball on an edge."""

    def __init__(self, arm, numbers, edge, length):
        self.arm, self.edge, self.length, self.ball, self.radius = arm, edge, length, numbers.moving["ball"], numbers.device["radius"]
        self.model = plant.model(arm, numbers)
        self.data = mujoco.MjData(self.model)
        self.body = self.model.body("housing").id

    def forward(self, q):
        self.data.qpos[: self.arm.n], self.data.qpos[self.arm.n] = q, 0
        mujoco.mj_kinematics(self.model, self.data)
        return self.data.xpos[self.body].copy(), self.data.xmat[self.body].reshape(3, 3).copy()

    def jacobian(self):
        mujoco.mj_comPos(self.model, self.data)
        j = np.zeros((2, 3, self.arm.n + 1))
        mujoco.mj_jacBody(self.model, self.data, j[0], j[1], self.body)
        return j[:, :, : self.arm.n].reshape(6, self.arm.n)

    def pose(self, place, standoff, lean, roll, stroke):
        """Flange that has the ball, at a stroke, off the edge by a standoff along the bisector, leaned about the edge."""
        first, along, out = self.edge
        across = np.cross(along, out)
        axis = -(np.cos(lean) * out + np.sin(lean) * across)
        side = np.cos(roll) * along + np.sin(roll) * np.cross(axis, along)
        turn = np.column_stack([side, np.cross(axis, side), axis])
        ball = first + place * along + (self.radius + standoff) * out
        return ball - axis * (self.ball + stroke), turn

    def solve(self, pose, guess, rounds=60):
        """Newton's method on position and turn."""
        q = np.array(guess)
        for _ in range(rounds):
            at, turn = self.forward(q)
            relative = pose[1] @ turn.T
            vector, quat = np.zeros(3), np.zeros(4)
            mujoco.mju_mat2Quat(quat, relative.ravel())
            mujoco.mju_quat2Vel(vector, quat, 1.0)
            error = np.concatenate([pose[0] - at, vector])
            if np.abs(error).max() < 1e-10:
                return q
            j = self.jacobian()
            step = np.linalg.solve(j.T @ j + 1e-9 * np.eye(self.arm.n), j.T @ error)
            q = q + step * min(1.0, 0.5 / max(np.abs(step).max(), 1e-12))
        raise Unreachable

    def dexterity(self, q):
        self.forward(q)
        return np.linalg.svd(self.jacobian(), compute_uv=False)[-1]

    def low(self, q):
        """Lowest joint behind the first two [m]."""
        self.forward(q)
        return min(self.data.xpos[self.model.body(name).id][2] for name in self.arm.link_names[2:])

    def posture(self, rng, lean_span, stroke):
        """Roll about the slide and posture from which the whole edge is ridden best."""
        best = (0.0, None, None)
        for roll in np.linspace(-np.pi, np.pi, 8, endpoint=False):
            for _ in range(5):
                guess = self.arm.middle + rng.uniform(-1.0, 1.0, self.arm.n)
                try:
                    q = self.solve(self.pose(0.5 * self.length, 0.0, 0.0, roll, stroke), guess)
                    if np.any(np.abs(q - self.arm.middle) > 2.3):
                        continue
                    worst, steep = 1.0, 0.0
                    for lean in lean_span:
                        for place in (0.02, self.length - 0.02):
                            own = self.solve(self.pose(place, 0.0, lean, roll, stroke), q)
                            steep = max(steep, np.abs(own - q).max())
                            if np.any(np.abs(own - self.arm.middle) > 2.5) or steep > 1.2 or self.low(own) < 0.0:
                                raise Unreachable
                            worst = min(worst, self.dexterity(own))
                except Unreachable:
                    continue
                if worst > best[0]:
                    best = (worst, roll, q)
        if best[0] < 0.04:
            raise Unreachable
        return best[1], best[2]


def eased(seconds):
    """Shares of a way from rest to rest at samples, the first one left out."""
    count = max(round(seconds / SAMPLE), 2)
    return smooth(np.arange(1, count + 1) / count)


def ramped(length, speed, ramp=0.25):
    """Way from rest to rest at a speed, with smooth ramps, at samples."""
    seconds = length / speed + ramp
    count = round(seconds / SAMPLE)
    t = np.arange(1, count + 1) * SAMPLE
    way = np.cumsum(smooth(np.minimum(t, seconds - t) / ramp))
    return length * way / way[-1]


def program(rng, reach, posture, plan):
    """Time, path, command, set pressure. `plan`: lean, speed, stroke, pressures before and after the middle, roll, places of start and end."""
    arm, n = reach.arm, reach.arm.n
    start, end = plan["places"]
    pose = lambda place, standoff: reach.pose(place, standoff, plan["lean"], plan["roll"], plan["stroke"])  # noqa: E731
    high = plan["standoff"]

    def straight(places, standoffs, guess):
        out, q = [], guess
        for place, standoff in zip(places, standoffs):
            q = reach.solve(pose(place, standoff), q)
            out.append(q)
        return np.array(out)

    def free(before, after, seconds):
        """Between postures with all joints swinging: each reverses several times."""
        share = eased(seconds)
        swing = plan["swing"] * rng.uniform(0.6, 1.0, n) * rng.choice([-1, 1], n)
        turns = rng.uniform(1.1, 1.9, n)
        t = np.arange(1, len(share) + 1) * SAMPLE
        ends = smooth(t / 0.4) * smooth((t[-1] - t) / 0.4)
        return before + share[:, None] * (after - before) + swing * np.sin(2 * np.pi * np.outer(t, turns)) * ends[:, None]

    touch = straight([start], [0.0], posture)[0]
    above = straight([start], [high], touch)[0]
    beside = above + rng.uniform(0.1, 0.3, n) * rng.choice([-1, 1], n) * plan["aside"]
    blocks = []  # joints, path, pressure

    def add(joints, place, pressure):
        joints = np.atleast_2d(joints)
        place, pressure = (np.broadcast_to(x, len(joints)) for x in (place, pressure))
        blocks.append((joints, place, pressure))
        return joints[-1]

    def still(q, seconds, place, pressure):
        return add(np.tile(q, (round(seconds / SAMPLE), 1)), place, pressure)

    first, second = plan["pressures"]
    still(beside, 0.6, start, 0.0)
    q = add(free(beside, above, 1.7), start, 0.0)
    still(q, 0.25, start, 0.0)
    down = eased(0.8)
    q = add(straight(np.full(len(down), start), high * (1 - down), q), start, 0.0)
    q = still(q, 0.85, start, first)
    way = start + ramped(end - start, plan["speed"])
    q = add(straight(way, np.zeros(len(way)), q), way, np.where(way < 0.5 * (start + end), first, second))
    q = still(q, 0.15, end, second)
    up = eased(0.9)
    q = add(straight(np.full(len(up), end), high * up, q), end, 0.0)
    still(q, 0.2, end, 0.0)
    q = add(free(q, q + rng.uniform(0.1, 0.3, n) * rng.choice([-1, 1], n) * plan["aside"], 1.7), end, 0.0)
    still(q, 0.35, end, 0.0)
    command, path, pressure = (np.concatenate([b[k] for b in blocks]) for k in range(3))
    command, path = np.round(command, 8), np.round(path, 6)
    time = np.arange(len(path)) * SAMPLE
    return time, path, command, pressure


def clear(reach, made, full):
    """Least standoff of the ball at full stroke while the tool is to be in the air, of the plane through the edge across its bisector [m]."""
    time, path, command, pressure = made
    first, along, out = reach.edge
    air = np.concatenate([np.arange(0, round(2.5 / SAMPLE), 10), np.arange(len(time) - round(2.2 / SAMPLE), len(time), 10)])
    least = np.inf
    for i in air:
        at, turn = reach.forward(command[i])
        for stroke in (0.0, full):
            least = min(least, out @ (at + turn[:, 2] * (reach.ball + stroke) - first) - reach.radius)
    return least

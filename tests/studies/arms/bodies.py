"""Serial arms drawn by seed: what the maker says of links and joints, as a URDF for the owner and as a model for MuJoCo."""
import math

import mujoco
import numpy as np

HALF = math.pi / 2
# Kind with its count of joints: share of arms, whether currents are logged.
KINDS = {"industrial_6": (0.25, True), "cobot_6": (0.25, True), "light_7": (0.18, False), "handling_5": (0.1, True),
         "gantry_6": (0.07, True), "rail_7": (0.07, True), "railed_8": (0.03, False), "scara_5": (0.05, True)}


def rotation(rpy):
    """Rotation matrix of roll, pitch, yaw about fixed x, y, z, as in URDF."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr], [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def quaternion(matrix):
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(matrix).ravel())
    return out


class Arm:
    """Links and joints by the maker's numbers: `joints` of (type, origin, axis), `masses` [kg], `centres` [m], `inertias` about the centres [kg m2]."""

    def __init__(self, rng):
        names = list(KINDS)
        self.kind = names[rng.choice(len(names), p=[KINDS[k][0] for k in names])]
        self.logs_currents = KINDS[self.kind][1]
        self.reach = rng.uniform(0.7, 1.9)
        self.total_mass = 22.0 * self.reach**2 * rng.uniform(0.9, 2.2)
        joints, flange, mass_shares, self.middle = getattr(self, "_" + self.kind.rsplit("_", 1)[0])(rng, self.reach)
        self.joints, self.flange_at, self.flange_rpy = joints, np.array(flange[0], float), np.array(flange[1], float)
        self.n = len(joints)
        self.prismatic = np.array([kind == "prismatic" for kind, _, _ in joints])
        self.middle = np.array(self.middle) + rng.uniform(-0.15, 0.15, self.n)
        shares = np.array(mass_shares) * rng.uniform(0.8, 1.2, self.n)
        self.masses = np.array([float(f"{m:.3g}") for m in self.total_mass * shares / shares.sum()])
        self._draw_inertias(rng)
        stem = ["joint_{}", "axis_{}", "j{}", "arm_joint_{}"][rng.integers(4)]
        self.joint_names = [stem.format(i + 1) for i in range(self.n)]
        self.link_names = [f"link_{i + 1}" for i in range(self.n)]
        self.gravity = self._mount(rng)

    @staticmethod
    def _industrial(rng, reach):
        shoulder, height = rng.uniform(0.05, 0.15) * reach, rng.uniform(0.25, 0.35) * reach
        upper = 0.5 * (reach - shoulder)
        fore = reach - shoulder - upper
        elbow, wrist, split = rng.uniform(0, 0.08) * reach, rng.uniform(0.06, 0.1) * reach, rng.uniform(0.3, 0.6)
        origins = [[0, 0, height], [shoulder, 0, 0], [0, 0, upper], [split * fore, 0, elbow], [(1 - split) * fore, 0, 0], [0.6 * wrist, 0, 0]]
        axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]
        joints = [("revolute", o, a) for o, a in zip(origins, axes)]
        return joints, ([wrist, 0, 0], [0, HALF, 0]), [0.3, 0.3, 0.22, 0.1, 0.05, 0.015], [0, 0.2, -0.1, 0.2, 0.7, 0]

    @staticmethod
    def _cobot(rng, reach):
        base, side, upper = rng.uniform(0.1, 0.16) * reach, rng.uniform(0.08, 0.13) * reach, rng.uniform(0.42, 0.48) * reach
        fore, wrist = rng.uniform(0.4, 0.45) * reach, rng.uniform(0.07, 0.1) * reach
        origins = [[0, 0, base], [0, side, 0], [0, -0.9 * side, upper], [0, 0, fore], [0, wrist, 0], [0, 0, wrist]]
        axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, -1], [0, 1, 0]]
        joints = [("revolute", o, a) for o, a in zip(origins, axes)]
        return joints, ([0, 0.9 * wrist, 0], [-HALF, 0, 0]), [0.24, 0.42, 0.14, 0.08, 0.08, 0.03], [0, -0.5, 1.0, 0.6, 0.3, 0]

    @staticmethod
    def _light(rng, reach):
        part = reach / 6.5
        origins = [[0, 0, part], [0, 0.05 * part, part], [0, -0.05 * part, part], [0.2 * part, 0, part], [-0.2 * part, 0, part], [0, 0, part], [0.3 * part, 0, 0.3 * part]]
        axes = [[0, 0, 1], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1], [0, 1, 0], [0, 0, 1]]
        joints = [("revolute", o, a) for o, a in zip(origins, axes)]
        return joints, ([0, 0, rng.uniform(0.3, 0.5) * part], [0, 0, 0]), [0.22, 0.22, 0.18, 0.16, 0.11, 0.08, 0.03], [0, 0.5, 0, 1.1, 0, 0.8, 0]

    @staticmethod
    def _handling(rng, reach):
        shoulder, height, wrist = rng.uniform(0.08, 0.15) * reach, rng.uniform(0.3, 0.4) * reach, rng.uniform(0.06, 0.1) * reach
        upper = 0.5 * (reach - shoulder)
        origins = [[0, 0, height], [shoulder, 0, 0], [0, 0, upper], [reach - shoulder - upper, 0, 0], [wrist, 0, 0]]
        joints = [("revolute", o, a) for o, a in zip(origins, [[0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 1, 0], [1, 0, 0]])]
        return joints, ([0.5 * wrist, 0, 0], [0, HALF, 0]), [0.32, 0.33, 0.22, 0.09, 0.03], [0, 0.2, 0.1, 0.5, 0]

    @staticmethod
    def _gantry(rng, reach):
        wrist = rng.uniform(0.08, 0.14) * reach
        origins = [[0, 0, 1.5 * reach], [0, 0, 0.1], [0.1, 0, 0], [0, 0, -0.5 * reach], [0, 0, -wrist], [0, 0, -wrist]]
        axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1], [0, 1, 0], [0, 0, 1]]
        joints = [("prismatic" if i < 3 else "revolute", o, a) for i, (o, a) in enumerate(zip(origins, axes))]
        return joints, ([0, 0, -0.8 * wrist], [math.pi, 0, 0]), [0.4, 0.25, 0.18, 0.08, 0.06, 0.02], [0, 0, 0, 0, 0.7, 0]

    @staticmethod
    def _on_rail(joints, flange, shares, middle):
        return [("prismatic", [0, 0, 0.15], [0, 1, 0]), *joints], flange, [0.25, *shares], [0.0, *middle]

    @staticmethod
    def _rail(rng, reach):
        return Arm._on_rail(*Arm._industrial(rng, reach))

    @staticmethod
    def _railed(rng, reach):
        return Arm._on_rail(*Arm._light(rng, reach))

    @staticmethod
    def _scara(rng, reach):
        part, wrist = 0.5 * reach, rng.uniform(0.05, 0.1) * reach
        origins = [[0, 0, 0.4], [0.1, 0, 0], [part, 0, 0], [part, 0, 0], [0, 0, -wrist]]
        joints = [("prismatic" if i == 0 else "revolute", o, a) for i, (o, a) in enumerate(zip(origins, [[0, 0, 1]] * 4 + [[0, 1, 0]]))]
        return joints, ([0, 0, -wrist], [math.pi, 0, 0]), [0.3, 0.34, 0.22, 0.1, 0.04], [0, 0.3, -0.6, 0.2, 0.6]

    def _draw_inertias(self, rng):
        """Cylinders along each link, somewhat askew, their centres somewhat aside."""
        ends = [np.array(o, float) for _, o, _ in self.joints[1:]] + [self.flange_at]
        self.centres, self.inertias = np.zeros((self.n, 3)), []
        for i, end in enumerate(ends):
            length = max(np.linalg.norm(end), 0.06 * self.reach)
            radius = max(0.12 * length, 0.035 * self.reach * (1 - 0.5 * i / self.n))
            self.centres[i] = np.round(end * rng.uniform(0.35, 0.55) + rng.uniform(-0.15, 0.15, 3) * radius * 1.5, 4)
            along = end / np.linalg.norm(end)
            round_, long = self.masses[i] * radius**2 / 2, self.masses[i] * (3 * radius**2 + length**2) / 12
            tensor = long * np.eye(3) + (round_ - long) * np.outer(along, along)
            askew = rotation(rng.uniform(-0.15, 0.15, 3))
            self.inertias.append(np.array([[float(f"{v:.4g}") for v in row] for row in askew @ tensor @ askew.T]))

    @staticmethod
    def _mount(rng):
        way = rng.random()
        if way < 0.8:
            return np.array([0, 0, -9.81])
        if way < 0.9:
            return np.array([0, 0, 9.81])
        return np.array([0, -9.81, 0]) if way < 0.95 else np.round(9.81 * np.array([math.sin(0.5), 0, -math.cos(0.5)]), 4)

    def urdf(self, efforts):
        def numbers(v):
            return " ".join(f"{x:.9g}" for x in v)
        lines = ['<?xml version="1.0"?>', f'<robot name="{self.kind}">', '  <link name="base_link"/>']
        parent = "base_link"
        for i, (kind, origin, axis) in enumerate(self.joints):
            t, name = self.inertias[i], self.link_names[i]
            lower, upper = (-2.0, 2.0) if self.prismatic[i] else (self.middle[i] - 3.0, self.middle[i] + 3.0)
            lines += [f'  <link name="{name}">', f'    <inertial><origin xyz="{numbers(self.centres[i])}" rpy="0 0 0"/><mass value="{self.masses[i]:.9g}"/>'
                      f'<inertia ixx="{t[0, 0]:.9g}" iyy="{t[1, 1]:.9g}" izz="{t[2, 2]:.9g}" ixy="{t[0, 1]:.9g}" ixz="{t[0, 2]:.9g}" iyz="{t[1, 2]:.9g}"/></inertial>', "  </link>",
                      f'  <joint name="{self.joint_names[i]}" type="{kind}"><parent link="{parent}"/><child link="{name}"/><origin xyz="{numbers(origin)}" rpy="0 0 0"/>'
                      f'<axis xyz="{numbers(axis)}"/><limit lower="{lower:.3f}" upper="{upper:.3f}" effort="{efforts[i]:.3g}" velocity="{1.5 if self.prismatic[i] else 3.2}"/></joint>']
            parent = name
        lines += ['  <link name="flange"/>', f'  <joint name="flange_fixed" type="fixed"><parent link="{parent}"/><child link="flange"/>'
                  f'<origin xyz="{numbers(self.flange_at)}" rpy="{numbers(self.flange_rpy)}"/></joint>', "</robot>", ""]
        return "\n".join(lines)

    def model(self):
        """The same arm for MuJoCo, with bodies at the flange for declared load, payload and tool; their masses are set later."""
        def numbers(v):
            return " ".join(f"{x:.12g}" for x in np.ravel(v))
        inner = ""
        flange = f'pos="{numbers(self.flange_at)}" quat="{numbers(quaternion(rotation(self.flange_rpy)))}"'
        tip = '<inertial pos="0 0 0" mass="1e-9" diaginertia="1e-12 1e-12 1e-12"/>'
        for name in ("load", "payload"):
            inner += f'<body name="{name}" {flange}>{tip}</body>'
        inner += f'<body name="tool" {flange}>{tip}<site name="sensor"/></body>'
        for i in reversed(range(self.n)):
            kind, origin, axis = self.joints[i]
            t = self.inertias[i]
            full = [t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2]]
            inner = (f'<body name="{self.link_names[i]}" pos="{numbers(origin)}"><joint type="{"slide" if self.prismatic[i] else "hinge"}" axis="{numbers(axis)}"/>'
                     f'<inertial pos="{numbers(self.centres[i])}" mass="{self.masses[i]:.12g}" fullinertia="{numbers(full)}"/>{inner}</body>')
        return mujoco.MjModel.from_xml_string(
            f'<mujoco><compiler angle="radian" autolimits="false" inertiagrouprange="0 0"/><option gravity="{numbers(self.gravity)}"><flag contact="disable"/></option>'
            f'<worldbody>{inner}</worldbody><sensor><force site="sensor"/><torque site="sensor"/></sensor></mujoco>')

"""An arm by its URDF alone: where its joint angles put the tool, and what torques hold it still. Shares nothing with the program."""

import math
import xml.etree.ElementTree as xml

import numpy as np


def numbers(text, default):
    return np.array([float(word) for word in text.split()]) if text else np.array(default, dtype=float)


def turned(roll, pitch, yaw):
    """Rotation by roll, pitch, yaw about fixed x, y, z."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def pose(rotation, position):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, position
    return matrix


def origin(element):
    found = element.find("origin")
    if found is None:
        return np.eye(4)
    return pose(turned(*numbers(found.get("rpy"), [0, 0, 0])), numbers(found.get("xyz"), [0, 0, 0]))


def about(axes, angles):
    """Rotations about an axis, one an angle, by Rodrigues' formula."""
    x, y, z = axes
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    s, c = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + s * cross + (1 - c) * (cross @ cross)


class Arm:
    """The chain from the base of a scenario's arm to its flange, and the device on it."""

    def __init__(self, scenario_path, scenario, device):
        arm, process = scenario["arm"], scenario["process"]
        urdf = xml.parse(scenario_path.parent / arm["urdf"]).getroot()
        self.links = {link.get("name"): link for link in urdf.iter("link")}
        by_child = {joint.find("child").get("link"): joint for joint in urdf.iter("joint")}
        link, self.chain = arm["flange_link"], []
        while link in by_child and link != arm.get("base_link"):
            self.chain.insert(0, by_child[link])
            link = by_child[link].find("parent").get("link")
        position, rotation = arm.get("base_position_mm", [0, 0, 0]), arm.get("base_rotation_deg", [0, 0, 0])
        self.base = pose(turned(*np.radians(rotation)), 1e-3 * np.array(position, dtype=float))
        self.moving = [joint for joint in self.chain if joint.get("type") != "fixed"]
        self.tool_centre = 1e-3 * device["tool_centre_mm"]
        self.housing = device.get("housing_mass_kg", 0.0), 1e-3 * device.get("housing_centre_of_mass_mm", 0.0)
        self.slide = device["moving_mass_kg"], 1e-3 * device["moving_centre_of_mass_mm"]
        self.working_stroke = 1e-3 * process.get("working_stroke_mm", device["stroke_mm"] / 2)
        self.gravity = np.array(scenario.get("simulation", {}).get("gravity_m_per_s2", [0.0, 0.0, -9.81]))

    def flange(self, angles):
        """Poses of the flange for rows of joint angles [rad]; and of every link and the axis of every joint on the way."""
        frames = np.broadcast_to(self.base, (len(angles), 4, 4))
        links, joints, index = [], [], 0
        for joint in self.chain:
            frames = frames @ origin(joint)
            if joint.get("type") != "fixed":
                found = joint.find("axis")
                axis = numbers(found.get("xyz") if found is not None else None, [1, 0, 0])
                axis = axis / np.linalg.norm(axis)
                turn = np.zeros((len(angles), 4, 4))
                turn[:, :3, :3], turn[:, 3, 3] = about(axis, angles[:, index]), 1.0
                joints.append((frames[:, :3, :3] @ axis, frames[:, :3, 3]))
                frames = frames @ turn
                index += 1
            links.append((joint.find("child").get("link"), frames))
        return frames, links, joints

    def tip(self, angles, stroke):
        """Centres of the tool's ball [m] and the tool's axes, for joint angles [rad] and strokes [m]."""
        frames, _, _ = self.flange(angles)
        axis = frames[:, :3, 2]
        return frames[:, :3, 3] + axis * (self.tool_centre + stroke)[:, None], axis

    def holding_torques(self, angles, stroke, force_on_tool):
        """Torques [N m] that hold arm, housing and slide still against gravity and a force on the tool [N]."""
        angles, stroke = np.atleast_2d(angles), np.atleast_1d(stroke)
        frames, links, joints = self.flange(angles)
        flange, axis = frames[0, :3, 3], frames[0, :3, 2]
        bodies = [(self.housing[0], flange + axis * self.housing[1]), (self.slide[0], flange + axis * (self.slide[1] + stroke[0]))]
        for name, frame in links:
            inertial = self.links[name].find("inertial")
            if inertial is not None:
                bodies.append((float(inertial.find("mass").get("value")), (frame[0] @ origin(inertial))[:3, 3]))
        loads = [(mass * self.gravity, centre) for mass, centre in bodies]
        loads.append((np.asarray(force_on_tool), flange + axis * (self.tool_centre + stroke[0])))
        torques = []
        for number, (direction, point) in enumerate((axis[0], place[0]) for axis, place in joints):
            behind = loads[2:-1]
            # Links ahead of a joint do not load it.
            beyond = [load for load, (name, _) in zip(behind, self.with_mass(links)) if self.is_behind(name, number)]
            beyond += loads[:2] + loads[-1:]
            moment = sum(np.cross(centre - point, load) for load, centre in beyond)
            torques.append(-float(direction @ moment))
        return np.array(torques)

    def with_mass(self, links):
        return [(name, frame) for name, frame in links if self.links[name].find("inertial") is not None]

    def is_behind(self, name, number):
        """Whether a link of the chain moves with the joint of a number, from 0."""
        moved = -1
        for joint in self.chain:
            moved += joint.get("type") != "fixed"
            if joint.find("child").get("link") == name:
                return moved >= number
        return False


# Samples beside a bend that are not compared.
BESIDE_BEND = 200


def path_errors(arm, process, angles, references, stroke):
    """Lateral error and lag [m] of the tool against its plan, and where they are well defined: where the plan moves straight on."""
    tip, _ = arm.tip(angles, stroke)
    planned, axis = arm.tip(references, np.full(len(stroke), arm.working_stroke))
    steps = np.gradient(planned, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    known = lengths > 1e-6
    tangent = steps / np.where(known, lengths, 1.0)[:, None]
    # The way back along the tool's axis, across the path.
    handle = -axis + tangent * (axis * tangent).sum(axis=1)[:, None]
    handle /= np.linalg.norm(handle, axis=1)[:, None]
    lean = math.radians(process.get("lean_deg", 0.0))
    left = math.cos(lean) * np.cross(handle, tangent) + math.sin(lean) * handle
    off = tip - planned
    bend = np.linalg.norm(np.gradient(tangent, axis=0), axis=1)
    # Near a bend the joints' splines leave the path that they stand for by some micrometres, which is no error of the tool's.
    bends = np.convolve(bend >= 1e-4, np.ones(2 * BESIDE_BEND + 1), mode="same") > 0.5
    known &= ~bends
    return (off * left).sum(axis=1), -(off * tangent).sum(axis=1), known

"""Collisions of a cell's bodies along a motion by coal, for placements that tests/real_robots/collisions.rs wrote.

    coal_placements.py PLACEMENTS.json RESULT.json

Each pair's least signed distance over the knots of the motion [m], negative for the depth, of one that is deeper than 2 mm the first such; a bound where spheres are farther apart than 20 mm.
Convex solids are
coal.Convex on the vertices as given, surfaces a triangle mesh in an OBBRSS tree.
"""
import json
import sys

import coal
import numpy as np

NEAR = 0.02
DEEP = -0.002


def rotation(x, y, z, w):
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def geometry(solid):
    vertices, triangles = np.array(solid["vertices"]), np.array(solid["triangles"])
    mesh = coal.BVHModelOBBRSS()
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(vertices)
    faces.extend(coal.Triangle(*map(int, triangle)) for triangle in triangles)
    mesh.beginModel(len(triangles), len(vertices))
    mesh.addSubModel(points, faces)
    mesh.endModel()
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    radius = np.linalg.norm(vertices - middle, axis=1).max()
    if solid["convex"]:
        mesh.buildConvexHull(True, "Qt")
        return mesh.convex, middle, radius
    return mesh, middle, radius


class Body:
    """A body with its poses over the motion, one for each knot, or one alone."""

    def __init__(self, body, motion):
        mount = body["mount"]
        poses = [mount["world"]] if "world" in mount else [links[mount["link"]] for links in motion]
        turns = np.array([rotation(*pose["quaternion"]) for pose in poses])
        shifts = np.array([pose["position"] for pose in poses])
        self.placed = [coal.Transform3s(turn, shift) for turn, shift in zip(turns, shifts)]
        self.solids = [
            (shape, turns @ middle + shifts, radius)
            for shape, middle, radius in (geometry(solid) for solid in body["solids"])
        ]

    def at(self, knot):
        return self.placed[min(knot, len(self.placed) - 1)]


def least(one, two):
    """Least distance of two bodies over the motion."""
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    best = np.inf
    for shape_one, middle_one, radius_one in one.solids:
        for shape_two, middle_two, radius_two in two.solids:
            gaps = np.linalg.norm(middle_one - middle_two, axis=1) - radius_one - radius_two
            for knot in np.argsort(gaps):
                # Solids are no nearer than the spheres about them.
                if gaps[knot] >= min(best, NEAR):
                    best = min(best, gaps[knot])
                    break
                result.clear()
                distance = coal.distance(shape_one, one.at(knot), shape_two, two.at(knot), request, result)
                best = min(best, distance)
                if best < DEEP:
                    return best
    return best


def main():
    with open(sys.argv[1]) as file:
        documents = json.load(file)
    answer = []
    for document in documents:
        motion = document["motion"]
        robot = {body["name"]: Body(body, motion) for body in document["robot"]}
        for placement in document["placements"]:
            standing = {body["name"]: Body(body, motion) for body in placement["bodies"]}
            named = robot | standing
            answer.append([least(named[first], named[second]) for first, second in placement["pairs"]])
    with open(sys.argv[2], "w") as file:
        json.dump(answer, file)


main()

#!/usr/bin/env python3
"""Writes the example parts plate.stl and bracket.stl beside this file.

Binary STL in millimetres (load with scale 0.001), counter-clockwise seen from outside, the same
bytes each time. Python's standard library only. The shapes are described in README.md.
"""

import math
import struct
from pathlib import Path

# Angle of one facet of an arc [deg]: at 20 mm radius its chord is 0.76 um inside the arc.
FACET_DEG = 1.0


def arc(centre, radius, start_deg, sweep_deg):
    """Points from start to start + sweep, both included."""
    count = round(abs(sweep_deg) / FACET_DEG)
    points = []
    for i in range(count + 1):
        angle = math.radians(start_deg + sweep_deg * i / count)
        points.append((centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)))
    return points


def cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def in_triangle(p, a, b, c):
    """Whether p lies in the counter-clockwise triangle or on its border."""
    return cross(a, b, p) >= 0 and cross(b, c, p) >= 0 and cross(c, a, p) >= 0


def segments_cross(a, b, c, d):
    """Whether the open segments a-b and c-d properly cross."""
    return cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0


def bridge(outer, hole):
    """One ring of the counter-clockwise outline and the clockwise hole, joined at their nearest points.

    Rings are lists of indices into one list of points; the two bridge points appear twice.
    """
    points, outer_ring, hole_ring = outer[0], outer[1], hole
    _, i, j = min(
        (math.dist(points[a], points[b]), i, j)
        for i, a in enumerate(outer_ring)
        for j, b in enumerate(hole_ring)
    )
    a, b = points[outer_ring[i]], points[hole_ring[j]]
    for ring in (outer_ring, hole_ring):
        for k in range(len(ring)):
            assert not segments_cross(a, b, points[ring[k - 1]], points[ring[k]])
    turned = hole_ring[j:] + hole_ring[: j + 1]
    return outer_ring[: i + 1] + turned + outer_ring[i:]


def clip_ears(points, ring):
    """Triangles of a simple ring: the ear with the shortest cut first, which avoids long slivers."""
    ring = list(ring)
    triangles = []

    def is_ear(k):
        ia, ib, ic = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
        a, b, c = points[ia], points[ib], points[ic]
        if cross(a, b, c) <= 1e-9:
            return False
        for n, index in enumerate(ring):
            p = points[index]
            # Only reflex corners can reach into an ear; those at its own corners do not count.
            if p in (a, b, c):
                continue
            before, after = points[ring[n - 1]], points[ring[(n + 1) % len(ring)]]
            if cross(before, p, after) <= 0 and in_triangle(p, a, b, c):
                return False
        return True

    while len(ring) > 3:
        cuts = sorted(
            (math.dist(points[ring[k - 1]], points[ring[(k + 1) % len(ring)]]), k)
            for k in range(len(ring))
        )
        for _, k in cuts:
            if is_ear(k):
                triangles.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
                del ring[k]
                break
        else:
            raise ValueError("no ear left: the outline crosses itself")
    triangles.append(tuple(ring))
    return triangles


def extrude(outline, holes, depth):
    """Triangles of the outline (counter-clockwise) less its holes (clockwise), from z = -depth to 0."""
    points = list(outline)
    rings = [list(range(len(outline)))]
    ring = rings[0]
    for hole in holes:
        indices = list(range(len(points), len(points) + len(hole)))
        points += hole
        rings.append(indices)
        ring = bridge((points, ring), indices)
    caps = clip_ears(points, ring)
    top = [(x, y, 0.0) for x, y in points]
    bottom = [(x, y, -depth) for x, y in points]
    triangles = [(top[a], top[b], top[c]) for a, b, c in caps]
    triangles += [(bottom[a], bottom[c], bottom[b]) for a, b, c in caps]
    for indices in rings:
        for k, b in enumerate(indices):
            a = indices[k - 1]
            triangles.append((top[a], bottom[a], bottom[b]))
            triangles.append((top[a], bottom[b], top[b]))
    return triangles


def plate():
    """300 x 120 x 20 mm; the origin is the middle of the top edge at y = 0."""
    outline = [(-150.0, 0.0), (150.0, 0.0), (150.0, 120.0), (-150.0, 120.0)]
    return extrude(outline, [], 20.0)


def bracket():
    """L of 160 x 140 x 15 mm with 60 mm legs, see README.md; the origin is its sharp corner."""
    outline = [(0.0, 0.0)]
    outline += arc((140.0, 20.0), 20.0, -90.0, 90.0)
    outline += arc((140.0, 40.0), 20.0, 0.0, 90.0)
    outline += arc((75.0, 75.0), 15.0, -90.0, -90.0)
    outline += arc((40.0, 120.0), 20.0, 0.0, 90.0)
    outline += [(0.0, 140.0)]
    hole = arc((35.0, 35.0), 20.0, 0.0, -360.0)[:-1]
    return extrude(outline, [hole], 15.0)


def write(path, triangles):
    header = b"idc-cell part, millimetres, made by make_parts.py".ljust(80, b" ")
    records = [header, struct.pack("<I", len(triangles))]
    for a, b, c in triangles:
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.sqrt(sum(x * x for x in n))
        records.append(struct.pack("<12fH", *(x / length for x in n), *a, *b, *c, 0))
    path.write_bytes(b"".join(records))
    print(f"{path.name}: {len(triangles)} triangles, {path.stat().st_size} bytes")


if __name__ == "__main__":
    folder = Path(__file__).resolve().parent
    write(folder / "plate.stl", plate())
    write(folder / "bracket.stl", bracket())

#!/usr/bin/env python3
"""Forty parts with small flaws, made and spoilt by code of its own: what `idc edges` mends of them, and where it says it did.

    python3 tests/studies/flawed_parts.py [--seed 1] [--count 40] [--cells] [--keep FOLDER] [IDC]

Plates with round corners, bores and pockets and angle brackets with a fillet; each gets one to five flaws of one kind. A part counts if
it is read with less than 0.1 % of its volume changed and a note for each flawed region within 2 % of the part's size of it, or is
refused with a place. With --cells each part that is read is also made a cell (`idc new cell --part`) and run. Without numpy.
"""

import argparse
import json
import math
import random
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def volume(points, faces):
    return sum(dot(points[a], cross(points[b], points[c])) for a, b, c in faces) / 6


def rounded_rectangle(width, depth, radius, steps):
    outline = []
    for quarter, (x, y) in enumerate([(width - radius, depth - radius), (radius, depth - radius), (radius, radius), (width - radius, radius)]):
        for step in range(steps + 1):
            angle = math.pi / 2 * (quarter + step / steps)
            outline.append((x + radius * math.cos(angle), y + radius * math.sin(angle)))
    return outline


def ring(inner, outer):
    """Triangles between two loops of points about one centre, by angle; indices (which, number)."""
    centre = tuple(sum(point[axis] for point in inner) / len(inner) for axis in (0, 1))

    def from_first(loop):
        angles = [math.atan2(y - centre[1], x - centre[0]) % (2 * math.pi) for x, y in loop]
        start = angles.index(min(angles))
        return start, [(angles[(start + i) % len(loop)]) for i in range(len(loop))] + [angles[start] + 2 * math.pi]

    (first_in, angles_in), (first_out, angles_out) = from_first(inner), from_first(outer)
    i = o = 0
    found = []
    while i < len(inner) or o < len(outer):
        here_in, here_out = ("i", (first_in + i) % len(inner)), ("o", (first_out + o) % len(outer))
        if o == len(outer) or (i < len(inner) and angles_in[i + 1] < angles_out[o + 1]):
            found.append((here_in, here_out, ("i", (first_in + i + 1) % len(inner))))
            i += 1
        else:
            found.append((here_in, here_out, ("o", (first_out + o + 1) % len(outer))))
            o += 1
    return found


def ears(outline):
    left = list(range(len(outline)))
    found = []

    def area(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = outline[a], outline[b], outline[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            inside = lambda p: min(area(a, b, p), area(b, c, p), area(c, a, p)) >= 0
            if area(a, b, c) > 1e-9 and not any(inside(p) for p in left if p not in (a, b, c)):
                found.append((a, b, c))
                left.pop(k)
                break
        else:
            raise ValueError("no ear")
    return found + [tuple(left)]


class Part:
    def __init__(self):
        self.points, self.faces = [], []

    def loop(self, outline, z):
        first = len(self.points)
        self.points += [(x, y, z) for x, y in outline]
        return list(range(first, first + len(outline)))

    def wall(self, low, high):
        for k in range(len(low)):
            a, b, c, d = low[k], low[(k + 1) % len(low)], high[(k + 1) % len(low)], high[k]
            self.faces += [(a, b, c), (a, c, d)]

    def ring(self, inner, outer, up):
        flat = lambda loop: [self.points[index][:2] for index in loop]
        for face in ring(flat(inner), flat(outer)):
            a, b, c = [(inner if which == "i" else outer)[number] for which, number in face]
            self.faces.append((a, b, c) if up else (a, c, b))

    def cap(self, loop, up):
        for a, b, c in ears([self.points[index][:2] for index in loop]):
            self.faces.append(tuple(loop[k] for k in ((a, b, c) if up else (a, c, b))))


def make(random_):
    part = Part()
    kind = random_.choice(["plate", "bore", "pocket", "angle"])
    width, depth, height = random_.uniform(120, 260), random_.uniform(80, 160), random_.uniform(10, 30)
    outline = rounded_rectangle(width, depth, random_.uniform(8, 20), random_.choice([6, 12, 24]))
    if kind == "angle":
        leg, fillet = random_.uniform(25, 35), random_.uniform(5, 12)
        arc = [(leg + fillet - fillet * math.sin(t), leg + fillet - fillet * math.cos(t)) for t in (math.pi / 2 * k / 10 for k in range(11))]
        outline = [(0, 0), (width, 0), (width, leg)] + arc + [(leg, depth), (0, depth)]
    low, high = part.loop(outline, 0), part.loop(outline, height)
    part.wall(low, high)
    if kind in ("plate", "angle"):
        part.cap(low, False)
        part.cap(high, True)
        return kind, part
    middle = (width * random_.uniform(0.45, 0.55), depth * random_.uniform(0.45, 0.55))
    if kind == "bore":
        radius, sides = random_.uniform(12, 25), random_.choice([24, 48, 96])
        hole = [(middle[0] + radius * math.cos(2 * math.pi * k / sides), middle[1] + radius * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
        bottom = part.loop(hole, 0)
    else:
        hole = [(x + middle[0] - width / 4, y + middle[1] - depth / 4) for x, y in rounded_rectangle(width / 2, depth / 2, 9, 8)]
        bottom = part.loop(hole, height / 2)
    top = part.loop(hole, height)
    part.wall(top, bottom)
    part.ring(top, high, True)
    if kind == "bore":
        part.ring(bottom, low, False)
    else:
        part.cap(low, False)
        part.cap(bottom, True)
    return kind, part


KINDS = ["twice", "double sided", "turned", "on a side", "unwelded", "hole", "fin", "needle", "touching"]


def spoil(points, faces, kind, random_, size, used):
    """Spoils one face whose corners no other flaw has; returns the place."""
    for _ in range(1000):
        index = random_.randrange(len(faces))
        a, b, c = faces[index]
        if len(used & {a, b, c}) > 1:
            continue
        longest = max(math.dist(points[p], points[q]) for p, q in ((a, b), (b, c), (c, a)))
        if math.dist(points[a], points[b]) > 0.01 * size and (kind != "hole" or longest < 0.6 * size):
            break
    else:
        return None
    used |= {a, b, c}
    middle = tuple(sum(points[corner][axis] for corner in (a, b, c)) / 3 for axis in range(3))
    half = tuple((points[a][axis] + points[b][axis]) / 2 for axis in range(3))
    normal = cross(sub(points[b], points[a]), sub(points[c], points[a]))
    length = math.sqrt(dot(normal, normal))
    normal = tuple(value / length for value in normal)
    new = len(points)
    if kind == "twice":
        faces.append((b, c, a))
    elif kind == "double sided":
        faces.append((b, a, c))
    elif kind == "turned":
        faces[index] = (b, a, c)
    elif kind == "on a side":
        points.append(half)
        faces[index] = (a, new, c)
        faces.append((new, b, c))
        return half
    elif kind == "unwelded":
        off = size * 10 ** random_.uniform(-5.3, -3.7)
        points.append(tuple(value + off * random_.uniform(-0.5, 0.5) for value in points[a]))
        faces[index] = (new, b, c)
        return points[a]
    elif kind == "hole":
        faces.pop(index)
    elif kind == "fin":
        points.append(tuple(value + 0.01 * size * towards for value, towards in zip(half, normal)))
        faces.append((a, b, new))
        return half
    elif kind == "needle":
        points.append(half)
        faces[index] = (a, new, c)
        faces.append((new, b, c))
        faces.append((a, b, new))
        return half
    elif kind == "touching":
        return touch(points, faces, (a, b), normal, size)
    return middle


def touch(points, faces, edge, normal, size):
    """A narrow body of its own that shares one outer edge with the part; no place where the edge is no outer one."""
    a, b = edge
    other = next((face for face in faces if a in face and b in face and face[(face.index(b) + 1) % 3] == a), None)
    if other is None:
        return None
    p, q, r = (points[corner] for corner in other)
    beside = cross(sub(q, p), sub(r, p))
    beside = tuple(value / math.sqrt(dot(beside, beside)) for value in beside)
    apex = next(corner for corner in other if corner not in edge)
    if dot(normal, beside) > 0.5 or dot(normal, sub(points[apex], points[a])) > -1e-6:
        return None
    up = tuple(x + y for x, y in zip(normal, beside))
    along = sub(points[b], points[a])
    aside = cross(along, up)
    half = tuple((x + y) / 2 for x, y in zip(points[a], points[b]))
    height, width = 0.02 * size / math.sqrt(dot(up, up)), 0.004 * size / math.sqrt(dot(aside, aside))
    new = len(points)
    for sign in (1, -1):
        points.append(tuple(m + height * u + sign * width * s for m, u, s in zip(half, up, aside)))
    body = [(a, b, new), (b, a, new + 1), (a, new, new + 1), (b, new + 1, new)]
    if volume(points, body) < 0:
        body = [(x, z, y) for x, y, z in body]
    faces += body
    return half


def write(path, points, faces):
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(faces)))
        for face in faces:
            file.write(bytes(12))
            for corner in face:
                file.write(struct.pack("<3f", *points[corner]))
            file.write(bytes(2))


def judge(idc, path, truth, places, size):
    done = subprocess.run([idc, "edges", str(path), "--json"], capture_output=True, text=True)
    if done.returncode == 2 and re.search(r"at \(-?[\d.]+, ", done.stderr):
        return "refused", done.stderr.strip()
    if done.returncode != 0:
        return "bad", done.stderr.strip()
    reported = json.loads(done.stdout)
    change = abs(reported["volume_mm3"] / truth - 1)
    found = [place for mended in reported["mended"] for place in mended["places_mm"]]
    # A face's flaw is located by its middle, by a corner or by the middle of its sides.
    near = lambda place: any(math.dist(place, other) < 0.02 * size + place_reach for other in found)
    place_reach = 0.35 * size
    missed = sum(not near(place) for place in places)
    if change > 1e-3 or missed:
        return "bad", f"volume changed by {change:.2e}, {missed} of {len(places)} places not reported: {reported['notes']}"
    return "mended", f"volume changed by {change:.1e}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("idc", nargs="?", default="target/release/idc")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--cells", action="store_true")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    random_ = random.Random(arguments.seed)
    good = ran = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(arguments.keep or scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for number in range(arguments.count):
            form, part = make(random_)
            points, faces = list(part.points), list(part.faces)
            truth = volume(points, faces)
            size = max(max(p[axis] for p in points) - min(p[axis] for p in points) for axis in range(3))
            kind, count = KINDS[number % len(KINDS)], random_.randint(1, 5)
            places, used = [], set()
            for _ in range(200):
                if len(places) == count:
                    break
                place = spoil(points, faces, kind, random_, size, used)
                places += [place] if place else []
            if kind == "touching":
                # What touches belongs to the part.
                truth = volume(points, faces)
            path = folder / f"part_{number:02}.stl"
            write(path, points, faces)
            verdict, words = judge(arguments.idc, path, truth, places, size)
            good += verdict != "bad"
            line = f"{number:2} {form:7} {count} x {kind:13} {verdict:8} {words}"
            if arguments.cells and verdict == "mended":
                cell = folder / f"part_{number:02}.toml"
                made = subprocess.run([arguments.idc, "new", "cell", str(cell), "--part", str(path), "--force"], capture_output=True, text=True)
                codes = [made.returncode]
                if made.returncode == 0:
                    out = folder / f"out_{number:02}"
                    run = subprocess.run([arguments.idc, "run", str(cell), "--out", str(out), "--force", "--no-recording", "--quiet"], capture_output=True, text=True)
                    codes.append(run.returncode)
                    line += "" if run.returncode == 0 else f"\n     run: {run.stderr.strip()[:300]}"
                else:
                    line += f"\n     new: {made.stderr.strip()[:300]}"
                ran += codes == [0, 0]
                line += f"  cell {codes}"
            print(line, flush=True)
    print(f"{good} of {arguments.count} mended with places and less than 0.1 % of the volume changed, or refused with a place")
    if arguments.cells:
        print(f"{ran} of them made a cell that ran with exit code 0")
    return 0 if good >= 0.9 * arguments.count else 1


if __name__ == "__main__":
    sys.exit(main())

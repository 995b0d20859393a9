#!/usr/bin/env python3
"""Makes URDF files in the style of five makers of industrial robots as ROS-Industrial publishes them, and has each run: `idc new cell --urdf`, then `idc run`, without an edit.

    python3 tests/studies/made_robots.py --out build/made_robots              # all 30
    python3 tests/studies/made_robots.py --out build/made_robots --only 0 12  # some of them

Reach 0.5 m to 3 m, no <inertial>, effort limits of 0, frames for tools turned as each maker has them, meshes of several kinds at package:// and relative
paths, robots on the floor, under the ceiling and at a wall. Everything comes from one seed; no file of anybody's is copied. Needs Python 3 alone.
"""

import argparse
import json
import math
import random
import struct
import subprocess
import sys
from pathlib import Path

PI = math.pi
SEED = 38


def prism(start, end, radius, sides=8):
    """Corners and triangles of a closed prism between two points."""
    axis = [e - s for s, e in zip(start, end)]
    length = math.sqrt(sum(a * a for a in axis)) or 1.0
    axis = [a / length for a in axis]
    other = [1, 0, 0] if abs(axis[0]) < 0.9 else [0, 1, 0]
    u = cross(axis, other)
    norm = math.sqrt(sum(a * a for a in u))
    u = [a / norm for a in u]
    v = cross(axis, u)
    points = []
    for base in (start, end):
        for i in range(sides):
            c, s = math.cos(2 * PI * i / sides), math.sin(2 * PI * i / sides)
            points.append([b + radius * (c * p + s * q) for b, p, q in zip(base, u, v)])
    triangles = []
    for i in range(sides):
        j = (i + 1) % sides
        triangles += [(i, j, sides + j), (i, sides + j, sides + i)]
    for i in range(1, sides - 1):
        triangles += [(0, i + 1, i), (sides, sides + i, sides + i + 1)]
    return points, triangles


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def join(shapes):
    points, triangles = [], []
    for own, faces in shapes:
        triangles += [tuple(i + len(points) for i in face) for face in faces]
        points += own
    return points, triangles


def write_mesh(path, mesh, unit):
    """A mesh by its file's ending; `unit` is the length that the file counts in [m]."""
    points, triangles = mesh
    points = [[x / unit for x in p] for p in points]
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".stl" and "ascii" in path.stem:
        lines = [f"solid {path.stem}"]
        for face in triangles:
            lines.append("facet normal 0 0 0\nouter loop")
            lines += ["vertex " + " ".join(f"{x:.6f}" for x in points[i]) for i in face]
            lines.append("endloop\nendfacet")
        path.write_text("\n".join(lines + [f"endsolid {path.stem}", ""]))
    elif path.suffix == ".stl":
        data = b"exported".ljust(80, b"\0") + struct.pack("<I", len(triangles))
        for face in triangles:
            data += struct.pack("<12fH", 0, 0, 0, *[x for i in face for x in points[i]], 0)
        path.write_bytes(data)
    elif path.suffix == ".obj":
        lines = ["# exported"] + ["v " + " ".join(f"{x:.6f}" for x in p) for p in points]
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in triangles]
        path.write_text("\n".join(lines) + "\n")
    elif path.suffix == ".dae":
        flat = " ".join(f"{x:.6f}" for p in points for x in p)
        indices = " ".join(str(i) for face in triangles for i in face)
        path.write_text(
            f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="meter" meter="{unit}"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="{3 * len(points)}">{flat}</float_array>
      <technique_common><accessor source="#a" count="{len(points)}" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="{len(triangles)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""
        )


STYLES = {
    # Names of links and joints, axes at rest (x ahead), the frame for tools, endings of the drawn and of the collision mesh.
    "abb": dict(link="link_{}", joint="joint_{}", axes=["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"],
                tool=[("tool0", "0 {half} 0")], meshes=(".dae", ".stl")),
    "fanuc": dict(link="link_{}", joint="joint_{}", axes=["0 0 1", "0 1 0", "0 -1 0", "-1 0 0", "0 -1 0", "-1 0 0"],
                  tool=[("flange", "0 0 0"), ("tool0", "{pi} -{half} 0")], meshes=(".stl", ".stl")),
    "kuka": dict(link="link_{}", joint="joint_a{}", axes=["0 0 -1", "0 1 0", "0 1 0", "-1 0 0", "0 1 0", "-1 0 0"],
                 tool=[("tool0", "0 {half} 0")], meshes=(".dae", "_ascii.stl")),
    "motoman": dict(link="link_{}_{}", joint="joint_{}_{}", axes=["0 0 1", "0 1 0", "0 -1 0", "-1 0 0", "0 -1 0", "-1 0 0"],
                    tool=[("tool0", "{pi} -{half} 0")], meshes=(".stl", "_ascii.stl")),
    "staubli": dict(link="link_{}", joint="joint_{}", axes=["0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1"],
                    tool=[("flange", "0 0 0"), ("tool0", "0 0 0")], meshes=(".obj", ".obj")),
}


def make(folder, number):
    """Writes robot `number` (0 to 29) into a folder; returns its URDF file and what is odd about it."""
    rng = random.Random(SEED * 1000 + number)
    maker = list(STYLES)[number % len(STYLES)]
    style = STYLES[maker]
    variant = number // len(STYLES)
    reach = 0.5 * 6 ** ((variant + rng.random()) / 6)  # 0.5 m to 3 m
    name = f"{maker}_made_{number:02}"
    package = folder / f"{name}_support"
    upright = maker == "staubli"  # its arm stands up at rest, others' forearms point ahead
    a1 = rng.uniform(0.05, 0.15) * reach
    upper = 0.5 * (reach - a1)
    fore = reach - a1 - upper
    elbow = rng.uniform(0.0, 0.08) * reach
    height = rng.uniform(0.25, 0.35) * reach
    wrist = rng.uniform(0.06, 0.09) * reach
    split = rng.uniform(0.4, 0.9)
    ahead = (lambda x: [0, 0, x]) if upright else (lambda x: [x, 0, 0])
    origins = [[0, 0, height], [a1, 0, 0], [0, 0, upper],
               [c + d for c, d in zip(ahead(split * fore), [0, 0, 0] if upright else [0, 0, elbow])],
               ahead((1 - split) * fore), ahead(wrist)]
    if maker == "kuka":  # the height is part of the second joint's origin in others
        origins[0], origins[1] = [0, 0, 0.6 * height], [a1, 0, 0.4 * height]
    limits = [(-2.9, 2.9), (-1.6, 2.2), (-3.5, 1.2), (-3.4, 3.4), (-2.1, 2.1), (-6.2, 6.2)]
    if upright:
        limits[2] = (-2.4, 2.4)
    speed = 3.0 * reach ** -0.8
    thick = [0.12, 0.1, 0.075, 0.055, 0.045, 0.035]
    odd = []
    names = "s l u r b t".split()
    link = lambda i: "base_link" if i == 0 else style["link"].format(i, names[i - 1])
    joint = lambda i: style["joint"].format(i, names[i - 1])
    unit = 0.001 if variant % 3 == 1 else 1.0
    relative = variant % 3 == 2
    text = [f'<?xml version="1.0" ?>', f"<!-- made by {Path(__file__).name}, seed {SEED}, number {number} -->",
            f'<robot name="{name}" xmlns:xacro="http://www.ros.org/wiki/xacro">']
    if variant % 2:
        text.append('  <material name="paint"><color rgba="0.9 0.5 0.1 1"/></material>')

    def geometry(index, ending):
        kind = "collision" if ending == style["meshes"][1] and ending != style["meshes"][0] else "visual"
        file = package / "meshes" / name / kind / f"{link(index)}{ending}"
        if index < 6:
            end = origins[index]
        else:
            end = ahead(0.01 * reach)
        radius = thick[max(index - 1, 0)] * reach
        if index == 0:
            mesh = prism([0, 0, 0], [0, 0, max(origins[0][2] - 0.03 * reach, 0.05 * reach)], 0.14 * reach)
        elif index == 6:
            mesh = prism([0, 0, 0], end, radius)
        else:
            mesh = join([prism([0, 0, 0], end, radius), prism([0, -1.1 * radius, 0], [0, 1.1 * radius, 0], 1.1 * radius)])
        # A COLLADA file says its unit itself.
        write_mesh(file, mesh, unit)
        own = f"meshes/{name}/{kind}/{file.name}"
        path = f"../{own}" if relative else f"package://{package.name}/{own}"
        scale = f' scale="{unit} {unit} {unit}"' if unit != 1.0 and file.suffix != ".dae" else ""
        return f'<geometry><mesh filename="{path}"{scale}/></geometry>'

    for index in range(7):
        text.append(f'  <link name="{link(index)}">')
        if index in (2, 3) and number % 10 == 7:
            odd.append(f"a mass on {link(index)} alone") if index == 2 else None
            if index == 2:
                mass = 15 * reach**2.65
                inertia = mass * upper * upper / 12
                text.append(f'    <inertial><origin xyz="0 0 {0.5 * upper:.4f}"/><mass value="{mass:.2f}"/>'
                            f'<inertia ixx="{inertia:.4f}" ixy="0" ixz="0" iyy="{inertia:.4f}" iyz="0" izz="{0.1 * inertia:.4f}"/></inertial>')
        drawn, met = style["meshes"]
        text.append(f'    <visual name="visual"><origin xyz="0 0 0" rpy="0 0 0"/>{geometry(index, drawn)}'
                    f'<material name="{"paint" if variant % 2 else ""}">{"" if variant % 2 else "<color rgba=%s1 0.4 0 1%s/>" % (chr(34), chr(34))}</material></visual>')
        material = '<material name=""><color rgba="1 1 0 1"/></material>' if maker == "abb" else ""
        text.append(f'    <collision name="collision"><origin xyz="0 0 0" rpy="0 0 0"/>{geometry(index, met)}{material}</collision>')
        text.append("  </link>")
    for index in range(1, 7):
        origin = " ".join(f"{x:.5f}" for x in origins[index - 1])
        axis = style["axes"][index - 1]
        lower, upper_limit = limits[index - 1]
        if "-" in axis:
            lower, upper_limit = -upper_limit, -lower
        velocity = speed * (1 if index < 4 else 1.8)
        effort = 'effort="0" '
        if maker == "motoman" and variant == 0:
            effort = ""
        if maker == "kuka" and variant in (1, 4):
            velocity = 0.0
        text += [f'  <joint name="{joint(index)}" type="revolute">',
                 f'    <origin xyz="{origin}" rpy="0 0 0"/>',
                 f'    <parent link="{link(index - 1)}"/><child link="{link(index)}"/>',
                 f'    <axis xyz="{axis}"/>',
                 f'    <limit {effort}lower="{lower:.4f}" upper="{upper_limit:.4f}" velocity="{velocity:.4f}"/>',
                 *(['    <dynamics damping="0.0" friction="0.0"/>'] if maker == "staubli" else []),
                 "  </joint>"]
    parent = link(6)
    face = ahead(0.01 * reach)
    tools = style["tool"]
    if variant == 3 and len(tools) > 1:
        tools = tools[:1]
        odd.append("no tool0, a flange with x out of it" if not upright else "no tool0")
    elif variant == 4:
        tools = [("tool0", "0 0 0")] if not upright else [("tool0", "{half} 0 0")]
        odd.append("tool0 with z sideways")
    for frame, rpy in tools:
        rpy = rpy.format(half=f"{PI / 2:.11f}", pi=f"{PI:.11f}")
        xyz = " ".join(f"{x:.5f}" for x in face)
        text += [f'  <joint name="{parent}-{frame}" type="fixed"><origin xyz="{xyz}" rpy="{rpy}"/>'
                 f'<parent link="{parent}"/><child link="{frame}"/></joint>', f'  <link name="{frame}"/>']
        parent, face = frame, [0, 0, 0]
    text += ['  <link name="base"/>', f'  <joint name="base_link-base" type="fixed"><origin xyz="0 0 {height:.4f}" rpy="0 0 0"/>'
             '<parent link="base_link"/><child link="base"/></joint>']
    stand = {11: ("under the ceiling", f"0 0 {1.6 * reach:.3f}", f"{PI:.6f} 0 0"),
             17: ("at a wall", f"0 0 {1.2 * reach:.3f}", f"0 {PI / 2:.6f} 0"),
             23: ("on a table, turned", "0 0 0.5", "0 0 2.0"), 28: ("under the ceiling", f"0 0 {1.6 * reach:.3f}", f"0 {PI:.6f} 0")}
    if number in stand:
        words, xyz, rpy = stand[number]
        odd.append(words)
        text += ['  <link name="world"/>', f'  <joint name="world-base_link" type="fixed"><origin xyz="{xyz}" rpy="{rpy}"/>'
                 '<parent link="world"/><child link="base_link"/></joint>']
    if variant % 2:
        text.append('  <gazebo reference="link_1"><mu1>0.2</mu1></gazebo>')
        text.append(f'  <transmission name="t1"><type>transmission_interface/SimpleTransmission</type><joint name="{joint(1)}"/></transmission>')
    text.append("</robot>")
    urdf = package / "urdf" / f"{name}.urdf"
    urdf.parent.mkdir(parents=True, exist_ok=True)
    urdf.write_text("\n".join(text) + "\n")
    return urdf, reach, ", ".join(odd)


def judge(idc, folder, urdf):
    """What is wrong after `new cell` and `run`; an empty text where nothing is, and the numbers shown."""
    cell = folder / f"{urdf.stem}.toml"
    made = subprocess.run([idc, "new", "cell", cell, "--urdf", urdf, "--force"], capture_output=True, text=True)
    if made.returncode:
        return f"new cell: exit {made.returncode}: {made.stderr.strip()[:400]}", ""
    out = folder / f"{urdf.stem}_run"
    ran = subprocess.run([idc, "run", cell, "--out", out, "--no-recording", "--force"], capture_output=True, text=True)
    if ran.returncode:
        return f"run: exit {ran.returncode}: {ran.stderr.strip()[:400]}", ""
    document = json.loads((out / "summary.json").read_text())
    summary = document["summary"]
    faults = []
    share = summary["joint_torque_share_percent"]
    if share is None or share > 100:
        faults.append(f"a drive at {share} % of its limit")
    if not summary["force_mean_n"] or document["stopped"]:
        faults.append("the part is not reached")
    estimated = document.get("estimated_masses")
    if not estimated or not estimated["links"]:
        faults.append("masses are not marked as estimated")
    else:
        for drive in estimated["joints"]:
            if not drive["least_n_m"] <= drive["largest_n_m"] <= drive["greatest_n_m"]:
                faults.append(f"the interval of {drive['joint']} does not hold its value")
        if "estimated" not in (out / "report.html").read_text():
            faults.append("report.html does not say estimated")
        checked = subprocess.run([idc, "check", cell], capture_output=True, text=True).stdout
        if "estimated from shapes" not in checked:
            faults.append("check does not say estimated")
    force = summary["force_mean_n"] or 0.0
    shown = f"{force:.1f} N, drives up to {share or 0:.0f} % of their limits, {made.stdout.splitlines()[0] if made.stdout else ''}"
    return "; ".join(faults), shown


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--idc", default="target/release/idc")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", type=int, nargs="*")
    parser.add_argument("--make", action="store_true", help="make the files alone")
    arguments = parser.parse_args()
    numbers = arguments.only if arguments.only is not None else range(30)
    bad = 0
    for number in numbers:
        urdf, reach, odd = make(arguments.out, number)
        if arguments.make:
            print(urdf)
            continue
        fault, shown = judge(arguments.idc, arguments.out, urdf)
        bad += bool(fault)
        print(f"{number:2} {urdf.stem} {reach:.2f} m{f' ({odd})' if odd else ''}: {fault or shown}", flush=True)
    if not arguments.make:
        print(f"{len(list(numbers)) - bad} of {len(list(numbers))} run as they are written")
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()

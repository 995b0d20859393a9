"""Mass matrices and gravity torques of five robots, by Pinocchio, for tests/real_robots.rs.

    python tests/reference/pinocchio_reference.py build/references/robots.json

The robots' files come with the packages pybullet (pybullet_data) and example-robot-data. Joints off the
path to the tip are locked at zero or at the limit nearest to it; rotor inertias are left out.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin

CONFIGURATIONS = 5
GRAVITY = [0.0, 0.0, -9.81]  # m/s2, in the base link's axes


def folder_of(package: str) -> Path:
    """The folder of an installed package, without importing it (its import may need a screen)."""
    for entry in map(Path, sys.path):
        if (entry / package).is_dir():
            return (entry / package).resolve()
    raise SystemExit(f"package folder {package} is not installed")


def robots() -> list[dict]:
    bullet = folder_of("pybullet_data")
    shared = folder_of("cmeel.prefix") / "share" / "example-robot-data"
    universal = shared / "robots" / "ur_description" / "urdf"
    return [
        dict(name="kuka_iiwa", file=bullet / "kuka_iiwa/model.urdf", base="lbr_iiwa_link_0", tip="lbr_iiwa_link_7", packages={}),
        dict(name="panda", file=bullet / "franka_panda/panda.urdf", base="panda_link0", tip="panda_link8", packages={}),
        dict(name="xarm6", file=bullet / "xarm/xarm6_robot.urdf", base="link_base", tip="link6", packages={}),
        dict(name="ur5", file=universal / "ur5_robot.urdf", base="base_link", tip="tool0", packages={"example-robot-data": shared}),
        dict(name="ur10", file=universal / "ur10_robot.urdf", base="base_link", tip="tool0", packages={"example-robot-data": shared}),
    ]


def path_joints(model: pin.Model, tip: str) -> list[int]:
    """Indices of the moving joints between the world and the tip's frame, base first."""
    joint = model.frames[model.getFrameId(tip)].parentJoint
    path = []
    while joint > 0:
        path.append(joint)
        joint = model.parents[joint]
    return path[::-1]


def reduced(model: pin.Model, path: list[int]) -> pin.Model:
    """The model with every other joint locked."""
    rest = np.clip(pin.neutral(model), model.lowerPositionLimit, model.upperPositionLimit)
    others = [index for index in range(1, model.njoints) if index not in path]
    return pin.buildReducedModel(model, others, rest)


def reference(robot: dict, random: np.random.Generator) -> dict:
    full = pin.buildModelFromUrdf(str(robot["file"]))
    path = path_joints(full, robot["tip"])
    names = [full.names[index] for index in path]
    model = reduced(full, path)
    assert list(model.names)[1:] == names, "the reduced model keeps the path's order"
    model.armature[:] = 0.0
    model.rotorInertia[:] = 0.0
    model.gravity.linear = np.array(GRAVITY)
    data = model.createData()
    frame = model.getFrameId(robot["tip"])
    base = model.getFrameId(robot["base"])
    level = model.frames[base].placement.rotation
    assert np.allclose(level, np.eye(3)), "gravity is given in the base link's axes"
    cases = []
    for _ in range(CONFIGURATIONS):
        share = random.random(model.nv)
        q = model.lowerPositionLimit + share * (model.upperPositionLimit - model.lowerPositionLimit)
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        gravity = pin.computeGeneralizedGravity(model, data, q)
        pin.framesForwardKinematics(model, data, q)
        base_from_tip = data.oMf[base].inverse() * data.oMf[frame]
        cases.append({
            "q": q.tolist(),
            "mass_matrix": mass.tolist(),
            "gravity_torques": gravity.tolist(),
            "base_from_tip": base_from_tip.homogeneous.tolist(),
        })
    return {
        "name": robot["name"],
        "urdf": str(robot["file"]),
        "package_directories": {name: str(folder) for name, folder in robot["packages"].items()},
        "base_link": robot["base"],
        "tip_link": robot["tip"],
        "gravity": GRAVITY,
        "joints": names,
        "cases": cases,
    }


def main() -> None:
    target = Path(sys.argv[1])
    references = []
    for index, robot in enumerate(robots()):
        if not robot["file"].is_file():
            raise SystemExit(f"{robot['name']}: {robot['file']} is missing")
        references.append(reference(robot, np.random.default_rng(index + 1)))
    written = {"pinocchio": pin.__version__, "robots": references}
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = target.with_suffix(".unfinished")
    unfinished.write_text(json.dumps(written, indent=1))
    unfinished.replace(target)
    print(f"{target}: {len(references)} robots, {CONFIGURATIONS} configurations each")


main()

"""MuJoCo stepping the same arm with the same load, for benches/step: its speed, and that it does the same job.

Reads one line of JSON (the scene, written by benches/step/peer.rs; SI units, all in the arm's base frame) and
answers with one: the static contact force and penetration. Then answers each line `round` with the time that
following the edge took, and a line of JSON (steps, the finest step, times apart) with error and cost of each of its
integrators at each step. Steps run in mujoco.rollout's loop in C; nothing of Python is inside the time.

The same URDF; the slide, the moving mass and the ball are added to it. The axes have position servos of the same
gains, MuJoCo's own gravity compensation, and the rest of the feed-forward as given torques. The device is a given
force on the slide: its pneumatics, the inverse dynamics and the planned path cost MuJoCo nothing.
"""

import json
import sys
import time

import mujoco
import numpy as np
from mujoco import rollout

# Impedance of the contact: with a given stiffness it only says how MuJoCo splits it into its two parameters.
IMPEDANCE = 0.95
SETTLING_STEPS = 3000
SETTLING_TIME = 3.0


def model_of(scene: dict, solref: list[float]) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_file(scene["urdf"])
    option = spec.option
    option.timestep = scene["step"]
    option.gravity = scene["gravity"]
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    for body in spec.bodies:
        body.gravcomp = 1.0
    axes = [joint.name for joint in spec.joints]

    device = scene["device"]
    tool = spec.body(scene["flange"]).add_body(name="tool", gravcomp=0.0)
    tool.explicitinertial = True
    tool.mass = device["mass"]
    tool.ipos = [0, 0, device["centre_of_mass"]]
    tool.inertia = [device["inertia"]] * 3
    tool.add_joint(name="slide", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    centre, radius = [0, 0, device["ball_centre"]], device["ball_radius"]
    ball = dict(name="ball", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius, 0, 0], pos=centre)
    tool.add_geom(contype=0, conaffinity=0, **ball)
    tool.add_site(name="nose", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[2 * radius, 0, 0], pos=centre)

    part, contact = scene["part"], scene["contact"]
    box = dict(name="part", type=mujoco.mjtGeom.mjGEOM_BOX, size=part["half_size"])
    spec.worldbody.add_geom(pos=part["centre"], quat=part["rotation"], contype=0, conaffinity=0, **box)
    friction = [contact["friction"]] * 2 + [0.0] * 3
    solimp = [IMPEDANCE, IMPEDANCE, 1e-3, 0.5, 2]
    pair = dict(geomname1="ball", geomname2="part", condim=3, friction=friction)
    spec.add_pair(solref=solref, solimp=solimp, **pair)
    spec.add_sensor(type=mujoco.mjtSensor.mjSENS_TOUCH, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="nose")
    spec.add_sensor(type=mujoco.mjtSensor.mjSENS_FRAMEPOS, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="nose")

    servo = scene["servo"]
    for axis, stiffness, damping in zip(axes, servo["stiffness"], servo["damping"], strict=True):
        actuator = spec.add_actuator(name=axis, target=axis, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.set_to_position(kp=stiffness, kv=damping)
    return spec.compile()


def true_contact(scene: dict) -> mujoco.MjModel:
    """The model whose contact has the scene's stiffness and damping, in N/m and N s/m.

    MuJoCo's contact force is (k r + b v) / R with its regularisation R, and solref = (-k d, -b d) in the direct
    format, d the impedance. (MuJoCo documentation, Modeling, solver parameters.)
    """
    model = model_of(scene, [-1.0, -1.0])
    data = mujoco.MjData(model)
    data.qpos[:] = scene["start"]["position"]
    mujoco.mj_forward(model, data)
    if data.ncon != 1:
        raise SystemExit(f"mujoco_peer: the ball should touch the part once at the start, not {data.ncon} times")
    scale = IMPEDANCE * data.efc_R[data.contact[0].efc_address]
    contact = scene["contact"]
    return model_of(scene, [-contact["stiffness"] * scale, -contact["damping"] * scale])


def controls(model: mujoco.MjModel, rows: dict) -> np.ndarray:
    """Servo references, then the applied joint forces, a row a step."""
    servo = np.atleast_2d(rows["position"])
    applied = np.atleast_2d(rows["applied"])
    assert servo.shape[1] == model.nu and applied.shape[1] == model.nv, (servo.shape, applied.shape)
    return np.hstack([servo, applied])[None]


def over_steps(rows: np.ndarray, apart: float, step: float, place: float) -> np.ndarray:
    """Rows that are so far apart, linear in between, at a place in each step: 0 its start, 1 its end."""
    count = int(round((len(rows) - 1) * apart / step))
    middles = (np.arange(count) + place) * step / apart
    before = np.minimum(middles.astype(int), len(rows) - 2)
    share = (middles - before)[:, None]
    return rows[before] * (1.0 - share) + rows[before + 1] * share


def precision(model: mujoco.MjModel, scene: dict, wanted: dict) -> list[dict]:
    """Error over cost of each integrator: 90th percentiles against its own run at the finest step."""
    spec = int(mujoco.mjtState.mjSTATE_CTRL | mujoco.mjtState.mjSTATE_QFRC_APPLIED)
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    hold, rows = controls(model, scene["start"]["hold"]), controls(model, scene["follow"])[0]

    def run(step: float, place: float) -> tuple[np.ndarray, np.ndarray, float]:
        model.opt.timestep = step
        data = mujoco.MjData(model)
        data.qpos[:] = scene["start"]["position"]
        start = np.zeros(mujoco.mj_stateSize(model, whole))
        mujoco.mj_getState(model, data, start, whole)

        def go(state: np.ndarray, control: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
            return rollout.rollout(model, data, state, control, control_spec=spec, nstep=steps)

        states, _ = go(start[None], hold, int(round(SETTLING_TIME / step)))
        settled = states[0, -1][None].copy()
        control = over_steps(rows, scene["step"], step, place)[None]
        costs = []
        for _ in range(3):
            started = time.perf_counter()
            states, sensors = go(settled, control, control.shape[1])
            costs.append((time.perf_counter() - started) / (control.shape[1] * step))
        every = int(round(wanted["apart"] / step))
        # What is computed with a state is there before its step: positions of a sensor are those of the step's start.
        angles = states[0, every - 1 :: every, 1 : model.nq]
        tips = sensors[0, every::every, 1:4]
        return angles, tips, float(np.median(costs))

    found = []
    for name in ("EULER", "IMPLICITFAST", "RK4"):
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{name}")
        # Inputs hold over a step: taken where in it they err least.
        for place, where in ((0.0, "start"), (0.5, "middle"), (1.0, "end")):
            angles, tips, _ = run(wanted["finest"], place)
            for step in wanted["steps"]:
                there, at, cost = run(step, place)
                count, tip_count = min(len(there), len(angles)), min(len(at), len(tips))
                joints = np.abs(there[:count] - angles[:count])
                off = np.linalg.norm(at[:tip_count] - tips[:tip_count], axis=1)
                error = dict(joints=float(np.quantile(joints, 0.9)), tip=float(np.quantile(off, 0.9)))
                found.append(dict(integrator=f"{name.lower()} {where}", step=step, cost=cost, **error))
    return found


def main() -> None:
    scene = json.loads(sys.stdin.readline())
    model = true_contact(scene)
    data = mujoco.MjData(model)
    spec = int(mujoco.mjtState.mjSTATE_CTRL | mujoco.mjtState.mjSTATE_QFRC_APPLIED)
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS

    def run(state: np.ndarray, control: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
        states, sensors = rollout.rollout(model, data, state, control, control_spec=spec, nstep=steps)
        return states[0], sensors[0, :, 0]

    data.qpos[:] = scene["start"]["position"]
    start = np.zeros(mujoco.mj_stateSize(model, whole))
    mujoco.mj_getState(model, data, start, whole)
    states, forces = run(start[None], controls(model, scene["start"]["hold"]), SETTLING_STEPS)
    settled = states[-1]
    # rollout leaves the last state in data.
    mujoco.mj_forward(model, data)
    print(
        json.dumps(
            dict(
                version=mujoco.__version__,
                static_force=float(forces[-500:].mean()),
                penetration=float(-data.contact[0].dist) if data.ncon else 0.0,
            )
        ),
        flush=True,
    )

    follow = controls(model, scene["follow"])
    steps = follow.shape[1]
    for line in sys.stdin:
        if line.startswith("{"):
            print(json.dumps(precision(model, scene, json.loads(line))), flush=True)
            continue
        if line.strip() != "round":
            break
        started = time.perf_counter()
        states, forces = run(settled[None], follow, steps)
        seconds = time.perf_counter() - started
        late = forces[steps // 5 :]
        reply = dict(seconds=seconds, steps=steps, force_mean=float(late.mean()), force_deviation=float(late.std()))
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""A real UR10e by us and by peers, in one run: currents of one free path predicted by the arm fitted to another, and a load.

    PYTHON tests/studies/arm_peers.py IDC OUT [--only pinocchio figaroh] [--write docs/evidence/PEERS.md]

PYTHON has what docs/evidence/peers/requirements.txt names; a peer that is not there is left out and said so. Recordings and error are those of ur10e_arm.py beside this: fitted to
free_12harm_30s, judged on free_14harm_50s by the RMS of the residual over the RMS of the current, both through a zero-phase low-pass at 6 Hz, while any joint moves faster than
0.01 rad/s. The load is what explains loaded_14harm_50s with the arm as fitted to the free path. Peers get what their manuals ask for: positions, speeds and accelerations filtered the
same way, gains free within what is published where the method allows it, else in the middle of it.
"""
import argparse
import importlib.metadata
import inspect
import json
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import ur10e_arm as study  # noqa: E402

FIT, PREDICT, LOADED = "free_12harm_30s.csv", "free_14harm_50s.csv", "loaded_14harm_50s.csv"
JOINTS = range(1, 7)
MIDDLE = np.array([(low + high) / 2 for low, high in study.GAINS])
RATE = 100.0
START, END = "<!-- ur10e: by tests/studies/arm_peers.py -->", "<!-- end of ur10e -->"


class Log:
    """A recording at 100 Hz: angles and currents filtered, speeds and accelerations by central differences of the filtered angles."""

    def __init__(self, path):
        self.raw = study.read(path)
        time_s = self.raw["time_s"]
        self.time = np.array([time_s[0] + i / RATE for i in range(int((time_s[-1] - time_s[0]) * RATE))])
        grid = list(self.time)

        def filtered(what):
            return np.array([study.low_pass(study.on_grid(time_s, self.raw[f"joint_{j}_{what}"], grid)) for j in JOINTS]).T
        self.q, self.current = filtered("rad"), filtered("current_a")
        self.v = np.gradient(self.q, 1 / RATE, axis=0)
        self.a = np.gradient(self.v, 1 / RATE, axis=0)
        self.moves = np.abs(self.v).max(axis=1) > 0.01


def errors(log, predicted):
    """Share of the current that is left, in per cent, joint by joint."""
    return study.shares(log.raw, {"time_s": list(log.time), **{f"joint_{j}_current_a": list(predicted[:, j - 1]) for j in JOINTS}})


def plain_urdf(out):
    """The URDF without meshes, which are not there."""
    text = re.sub(r"<(visual|collision)>.*?</\1>", "", (study.RECORDINGS / "ur10e.urdf").read_text(), flags=re.S)
    path = out / "ur10e.urdf"
    path.write_text(text)
    return path


def squares(matrix, target):
    return np.linalg.lstsq(matrix, target, rcond=None)[0]


def regressors(urdf, log):
    """Pinocchio's joint torque regressor: samples, joints, ten parameters a link."""
    import pinocchio
    model = pinocchio.buildModelFromUrdf(str(urdf))
    data = model.createData()
    made = np.stack([pinocchio.computeJointTorqueRegressor(model, data, q, v, a) for q, v, a in zip(log.q, log.v, log.a)])
    return model, made


def load_of(free, gain, log, regressor):
    """Mass at the flange that explains what the free arm leaves of the currents: least squares over mass and its first moments."""
    left = ((log.current - free) * gain)[log.moves]
    last = regressor[log.moves][:, :, 50:54]
    weight = 1 / left.std(axis=0)
    return float(squares((last * weight[:, None]).reshape(-1, 4), (left * weight).ravel())[0])


def diagnosed(idc, case, result):
    """Runs the program; seconds of processor that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([idc, "diagnose", case, "--out", result, "--force"], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def ours(idc, out, logs):
    case, result = out / "case", out / "result"
    study.write_case(case, [FIT], PREDICT)
    spent = diagnosed(idc, case, result)
    answer = json.loads((result / "diagnosis.json").read_text())
    found = study.shares(study.read(case / PREDICT), study.read(result / "prediction.csv"))
    # The load: the arm as found, and the loaded recording.
    loaded, second = out / "loaded", out / "loaded_result"
    loaded.mkdir(parents=True, exist_ok=True)
    study.write_log(study.RECORDINGS / LOADED, loaded / LOADED)
    study.write_log(study.RECORDINGS / PREDICT, loaded / PREDICT)
    improved = (result / "improved.toml").read_text()
    shutil.copy(case / "ur10e.urdf", loaded)
    improved = re.sub(r'urdf = ".*"', 'urdf = "ur10e.urdf"', improved)
    improved = re.sub(r"fit = \[.*?\]", f'fit = ["{LOADED}"]', improved, flags=re.S)
    (loaded / "arm.toml").write_text(re.sub(r'predict = ".*"', f'predict = "{PREDICT}"', improved))
    spent_on_load = diagnosed(idc, loaded, second)
    effects = json.loads((second / "diagnosis.json").read_text())
    mass = next((e["parameters"]["mass_kg"] for e in effects["effects"] if e["name"] == "payload"), None)
    text = f"{mass['value']:.2f} ({mass['low']:.2f} to {mass['high']:.2f})" if mass else "none named"
    before = next((e for e in answer["effects"] if e["name"] == "payload"), None)
    # The second diagnosis states the whole load: what the first took for one is in it.
    text += f", of which {before['parameters']['mass_kg']['value']:.2f} were named without a load, at {100 * before['confidence']:.0f} %" if before else ""
    named = "; ".join(dict.fromkeys(e["name"].replace("_", " ") for e in answer["effects"]))
    return {"errors": found, "payload": text, "seconds": spent, "names": f"{named}; with the load: {'; '.join(e['name'].replace('_', ' ') for e in effects['effects']) or 'nothing'}",
            "seconds_load": spent_on_load, "lines": "0, an arm.toml of 46"}


def pinocchio_plain(out, logs):
    """Each joint for itself: the URDF's torque, tanh(speed/0.01), speed, constant, acceleration."""
    urdf = plain_urdf(out)
    begin = time.process_time()

    def columns(log, j, torque):
        v = log.v[:, j]
        return np.column_stack([torque[:, j], np.tanh(v / 0.01), v, np.ones(len(v)), log.a[:, j]])
    made = {}
    for name, log in logs.items():
        model, regressor = regressors(urdf, log)
        own = np.concatenate([model.inertias[i + 1].toDynamicParameters() for i in range(6)])
        made[name] = (regressor @ own, regressor)
    moves = logs[FIT].moves
    found = [squares(columns(logs[FIT], j, made[FIT][0])[moves], logs[FIT].current[moves, j]) for j in range(6)]

    def predict(name):
        return np.column_stack([columns(logs[name], j, made[name][0]) @ found[j] for j in range(6)])
    # A gain that gravity does not show is taken as published.
    seen = np.array([1 / f[0] if f[0] > 0 else 0.0 for f in found])
    gain = np.array([g if 0.75 * low <= g <= 1.25 * high else m for g, (low, high), m in zip(seen, study.GAINS, MIDDLE)])
    return {"errors": errors(logs[PREDICT], predict(PREDICT)), "payload": f"{load_of(predict(LOADED), gain, logs[LOADED], made[LOADED][1]):.2f}", "seconds": time.process_time() - begin,
            "names": "nothing: gain, dry and viscous friction, offset, inertia of each joint as numbers"}


def pinocchio_base(out, logs):
    """The whole arm: base parameters, friction, offsets and rotors in newton metres with gains in the middle of what is published."""
    urdf = plain_urdf(out)
    begin = time.process_time()

    def columns(log, regressor):
        n = len(log.time)
        extra = np.zeros((n, 6, 24))
        for j in range(6):
            v = log.v[:, j]
            extra[:, j, 4 * j:4 * j + 4] = np.column_stack([np.tanh(v / 0.01), v, np.ones(n), log.a[:, j]])
        return np.concatenate([regressor, extra], axis=2)
    made = {name: columns(log, regressors(urdf, log)[1]) for name, log in logs.items()}
    fit, moves = logs[FIT], logs[FIT].moves
    matrix, target = made[FIT][moves], (fit.current * MIDDLE)[moves]
    weight = 1 / target.std(axis=0)
    for _ in range(3):  # weights by what each joint leaves
        rows = (matrix * weight[:, None]).reshape(-1, matrix.shape[2])
        found = np.linalg.lstsq(rows, (target * weight).ravel(), rcond=1e-4)[0]
        weight = 1 / (target - matrix @ found).std(axis=0)
    free = made[LOADED] @ found / MIDDLE
    return {"errors": errors(logs[PREDICT], made[PREDICT] @ found / MIDDLE), "payload": f"{load_of(free, MIDDLE, logs[LOADED], made[LOADED][:, :, :60]):.2f}", "seconds": time.process_time() - begin,
            "names": "nothing: base parameters, friction, offsets, rotors as numbers"}


def figaroh(out, logs):
    """figaroh's regressor with friction, rotors and offsets, base parameters by its QR decomposition; torques by the middle gains, which it needs."""
    import warnings
    from figaroh.identification.parameter import add_standard_additional_parameters, get_standard_parameters
    from figaroh.tools.load_robot import load_robot
    from figaroh.tools.qrdecomposition import QRDecomposer
    from figaroh.tools.regressor import build_regressor_basic, build_regressor_reduced, get_index_eliminate
    warnings.simplefilter("ignore")
    urdf = plain_urdf(out)
    begin = time.process_time()
    robot = load_robot(str(urdf), package_dirs=str(out))
    config = {"has_friction": True, "has_actuator_inertia": True, "has_joint_offset": True, "is_joint_torques": True, "is_external_wrench": False, "act_idxv": list(range(6)),
              **{k: [0.0] * 6 for k in ("fv", "fs", "Ia", "off")}}
    standard = {**get_standard_parameters(robot.model), **add_standard_additional_parameters(robot.model, config)}
    fit, moves = logs[FIT], logs[FIT].moves
    matrix = build_regressor_basic(robot, fit.q[moves], fit.v[moves], fit.a[moves], config)
    unseen, names = get_index_eliminate(matrix, standard, 1e-6)
    torque = (fit.current * MIDDLE)[moves].T.ravel()
    _, _, base, values, *_ = QRDecomposer().double_decomposition(torque, build_regressor_reduced(matrix, unseen), names, standard)
    first = [re.split(r" [+-] ", name)[0].split("*")[-1].strip() for name in base]
    places = [list(standard).index(name) for name in first]

    def predict(name):
        log = logs[name]
        own = build_regressor_basic(robot, log.q, log.v, log.a, config)[:, places] @ np.asarray(values)
        return own.reshape(6, -1).T / MIDDLE
    _, regressor = regressors(urdf, logs[LOADED])
    return {"errors": errors(logs[PREDICT], predict(PREDICT)), "payload": f"{load_of(predict(LOADED), MIDDLE, logs[LOADED], regressor):.2f}", "seconds": time.process_time() - begin,
            "names": f"nothing: {len(base)} base parameters as numbers"}


def mujoco_sysid(out, logs):
    """MuJoCo's toolbox with inverse dynamics as its rollout: damping, dry friction, armature, gain and offset of each joint, links' masses and centres within our tolerances."""
    import mujoco
    from mujoco import sysid
    urdf = plain_urdf(out)
    begin = time.process_time()

    def built():
        spec = mujoco.MjSpec.from_file(str(urdf))
        spec.option.timestep = 1e-4  # nothing is stepped; it bounds how crisp dry friction can be
        spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
        for joint in spec.joints:
            joint.solref_friction, joint.solimp_friction = [2e-4, 1.0], [0.99, 0.999, 0.001, 0.5, 2.0]
        for j, joint in enumerate(spec.joints):
            sensor = spec.add_sensor()
            sensor.name, sensor.type, sensor.dim = f"current_{j}", mujoco.mjtSensor.mjSENS_USER, 1
        for kind in "qva":
            for j, joint in enumerate(spec.joints):
                act = spec.add_actuator()
                act.name, act.target, act.trntype = f"{kind}_{j}", joint.name, mujoco.mjtTrn.mjTRN_JOINT
        return spec

    def currents(model, motion, values):
        data, made = mujoco.MjData(model), np.empty((len(motion), 6))
        for i, row in enumerate(motion):
            data.qpos[:], data.qvel[:], data.qacc[:] = row[:6], row[6:12], row[12:]
            mujoco.mj_inverse(model, data)
            made[i] = data.qfrc_inverse
        gain, offset = (np.array([values[f"{k}_{j}"].value[0] for j in range(6)]) for k in ("gain", "offset"))
        return made / gain + offset

    def rollout(models, datas, control_signal, initial_states, param_dicts, rollout_signal_mapping, rollout_state_mapping, ctrl_mapping):
        made = []
        for model, control, start, values in zip(models, control_signal, initial_states, param_dicts, strict=True):
            times = control.times[1:]
            state = np.column_stack([times, control.data[1:, :12]])
            made.append(sysid.SystemTrajectory(model=model, control=control, initial_state=start, state=sysid.TimeSeries(times, state, rollout_state_mapping),
                                               sensordata=sysid.TimeSeries(times, currents(model, control.data, values)[1:], rollout_signal_mapping)))
        return made
    spec = built()
    names, bodies = [j.name for j in spec.joints], [j.parent.name for j in spec.joints]
    model = spec.compile()
    params = sysid.ParameterDict()

    def add(name, start, low, high, modifier=None):
        made = sysid.Parameter(name, nominal=start, min_value=low, max_value=high, modifier=modifier)
        params.add(made)

    def set_joint(j, key):
        def modify(s, p):
            if key == "damping":
                s.joint(names[j]).damping[0] = p.value[0]
            else:
                setattr(s.joint(names[j]), key, p.value[0])
        return modify
    for j, (low, high) in enumerate(study.GAINS):
        add(f"gain_{j}", MIDDLE[j], 0.75 * low, 1.25 * high)
        add(f"offset_{j}", 0.0, -1.0, 1.0)
        for key, start, most in (("armature", 1.0, 20.0), ("frictionloss", 5.0, 60.0), ("damping", 5.0, 80.0)):
            add(f"{key}_{j}", start, 0.0, most, set_joint(j, key))
        params.add(sysid.body_inertia_param(spec, model, bodies[j], scale_rot_inertia=True, mass_bound_mult=np.array([0.95, 1.05]), ipos_bound_off=np.array([-0.01, 0.01])))

    def sequence(log, every):
        kept = np.flatnonzero(log.moves)[::every]
        motion = np.hstack([log.q, log.v, log.a])[kept]
        times = np.arange(len(kept)) / RATE
        start = sysid.create_initial_state(model, motion[0, :6], motion[0, 6:12])
        return sysid.ModelSequences("ur10e", spec, "fit", start, sysid.TimeSeries(times, motion), sysid.TimeSeries.from_names(times, log.current[kept], model))
    residual = sysid.build_residual_fn(models_sequences=[sequence(logs[FIT], 2)], n_threads=1, custom_rollout=rollout, resample_true=False)
    best, _ = sysid.optimize(initial_params=params, residual_fn=residual, optimizer="mujoco", verbose=False)
    model = sysid.apply_param_modifiers(best, spec)
    model = model if isinstance(model, mujoco.MjModel) else spec.compile()

    def predict(name):
        log = logs[name]
        return currents(model, np.hstack([log.q, log.v, log.a]), best)
    gain = np.array([best[f"gain_{j}"].value[0] for j in range(6)])
    spent = time.process_time() - begin
    _, regressor = regressors(urdf, logs[LOADED])
    return {"errors": errors(logs[PREDICT], predict(PREDICT)), "payload": f"{load_of(predict(LOADED), gain, logs[LOADED], regressor):.2f}", "seconds": spent,
            "names": "nothing: gain, offset, dry and viscous friction, armature of each joint, masses and centres as numbers"}


PEERS = {"pinocchio_plain": ("Pinocchio, a regression a joint", pinocchio_plain, ("pin",)), "pinocchio_base": ("Pinocchio, base parameters of the arm", pinocchio_base, ("pin",)),
         "figaroh": ("figaroh", figaroh, ("figaroh", "pin")), "mujoco": ("MuJoCo's sysid", mujoco_sysid, ("mujoco",))}


def section(rows, command, idc):
    lines = [START, "", "## A real UR10e: currents of another path, and a load", "",
             "`../shared/recordings/ur10e_arm`: fitted to free_12harm_30s, judged on free_14harm_50s (RMS left over RMS of the current, both through 6 Hz, while any joint moves); then 2.805 kg at the flange, from",
             "loaded_14harm_50s with the arm as fitted to the free path. Which terms there are the peers' users choose and write; we name them. Lines: of the peer's function in the script, comments and",
             "blank lines left out, the regression of the load among them where it is its own. Payload of the peers: least squares over what their free arm leaves of the loaded path.", "",
             f"    {command}", "", "| by | 1 | 2 | 3 | 4 | 5 | 6 | payload, kg | seconds | lines to write |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for row in rows:
        if "errors" in row:
            spent = f"{row['seconds']:.0f}" + (f" + {row['seconds_load']:.0f} for the load" if "seconds_load" in row else "")
            lines.append(f"| {row['by']} | " + " | ".join(f"{e:.1f}" for e in row["errors"]) + f" | {row['payload']} | {spent} | {row['lines']} |")
        else:
            lines.append(f"| {row['by']} | " + " | ".join("-" * 1 for _ in range(6)) + f" | - | - | {row['trouble']} |")
    lines += ["| asked of us (the issue's plain regression) | " + " | ".join(f"{e:.1f}" for e in study.ASKED) + " | 2.805 within 6 % | 20 | |", ""]
    lines += [f"- {row['by']} names {row['names']}." for row in rows if "names" in row]
    return "\n".join([*lines, "", f"Versions: {idc}, " + ", ".join(f"{p} {v}" for p, v in versions().items()) + ". Seconds of processor.", "", END])


def versions():
    found = {}
    for package in ("pin", "figaroh", "mujoco", "numpy", "scipy"):
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = "not there"
    return found


def written(function):
    return sum(1 for text in inspect.getsource(function).splitlines() if text.strip() and not text.strip().startswith(("#", '"""')))


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("idc")
    ap.add_argument("out", type=pathlib.Path)
    ap.add_argument("--only", nargs="*", choices=["idc", *PEERS])
    ap.add_argument("--recordings", type=pathlib.Path, default=study.RECORDINGS)
    ap.add_argument("--write", type=pathlib.Path, help="Markdown file whose section is replaced, or to which it is added")
    a = ap.parse_args()
    study.RECORDINGS = a.recordings
    if not study.RECORDINGS.is_dir():
        sys.exit(f"skipped: {study.RECORDINGS} is not there")
    a.out.mkdir(parents=True, exist_ok=True)
    for name in (FIT, PREDICT, LOADED):
        study.write_log(study.RECORDINGS / name, a.out / name)
    logs = {name: Log(a.out / name) for name in (FIT, PREDICT, LOADED)}
    rows = []
    for name, (by, function, packages) in {"idc": ("idc", None, ()), **PEERS}.items():
        if a.only and name not in a.only:
            continue
        if any(versions().get(p) == "not there" for p in packages):
            rows.append({"by": by, "trouble": "not installed"})
            continue
        row = ours(a.idc, a.out, logs) if name == "idc" else {"lines": written(function), **function(a.out, logs)}
        rows.append({"by": by, **row})
        print(by, row, flush=True)
    said = subprocess.run([a.idc, "--version"], capture_output=True, text=True).stdout.strip()
    text = section(rows, "PYTHON tests/studies/arm_peers.py IDC OUT --write docs/evidence/PEERS.md", said)
    print(text)
    (a.out / "peers.json").write_text(json.dumps(rows, indent=1))
    if a.write:
        there = a.write.read_text() if a.write.is_file() else ""
        if START in there:
            there = there[: there.index(START)].rstrip() + "\n\n" + there[there.index(END) + len(END):].lstrip()
        a.write.write_text(there.rstrip() + "\n\n" + text + "\n")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Faults of sensors and clocks, and numbers of the sheet that are off, put into devices of the laboratory, diagnosed and scored (standard library only).

    faults.py PROGRAM --out DIR [--what data|sheet] [--count N] [--draw K] [--make]

`data`: N devices with a fault alone and N with a fault beside an effect, the kinds in turn. `sheet`: N devices, one number of whose rig.toml is off by at least five standard deviations in
one channel (RMS over one recording), measured by `idc predict`. --make writes the cases and stops. Answers that stand are kept.
Named: the effect (or number) at 0.5 or above; the fault with kind, channel, recording and size (a fifth, or one standard deviation; times 50 ms); nothing else at 0.5 or above.
"""
import argparse, csv, json, math, pathlib, random, re, subprocess, sys

INPUTS = ["time_s", "set_pressure_pa", "solenoid", "surface_m"]
CHANNELS = ["regulator_pressure_pa", "stroke_m", "force_n", "acceleration_m_per_s2"]
KINDS = ["zero_anew", "force_jumps", "held", "frozen", "kgf", "sign", "late", "log_clock", "logger_clock", "absolute", "noise", "stroke_jumps", "early", "index", "bar", "pressure_zero", "stroke_mm", "lbf"]
NUMBERS = ["cylinder.bore_m", "cylinder.rod_m", "cylinder.stroke_m", "cylinder.gravity_along_axis_m_per_s2", "cylinder.moving_mass_kg", "cylinder.dead_volume_m3", "regulator.time_constant_s", "regulator.gain",
           "valve.supply_orifice_m2", "valve.exhaust_orifice_m2", "valve.discharge_coefficient", "contact.stiffness_n_per_m", "contact.damping_n_s_per_m", "end_stop.stiffness_n_per_m", "end_stop.damping_n_s_per_m"]
SAME = {"cylinder.gravity_along_axis_m_per_s2": "axial_force_offset", "cylinder.moving_mass_kg": "moving_mass_error", "cylinder.dead_volume_m3": "extra_dead_volume", "regulator.gain": "regulator_gain_error",
        "valve.supply_orifice_m2": "supply_restriction", "valve.exhaust_orifice_m2": "exhaust_restriction", "contact.stiffness_n_per_m": "contact_stiffness_error"}

ALIKE = {"discharge_coefficient": ("supply_orifice_m2", "exhaust_orifice_m2")}


def read(path):
    with open(path, newline="") as f:
        rows = list(csv.reader(f))
    return rows[0], {n: [float(r[i]) if r[i] else math.nan for r in rows[1:]] for i, n in enumerate(rows[0])}


def write(path, names, columns):
    with open(path, "w", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        w.writerow(names)
        for row in zip(*(columns[n] for n in names)):
            w.writerow(["" if math.isnan(x) else repr(x) for x in row])


def at(time, values, t):
    if t <= time[0]:
        return values[0]
    if t >= time[-1]:
        return values[-1]
    lo, hi = 0, len(time) - 1
    while hi - lo > 1:
        mid = (lo + hi) // 2
        lo, hi = (mid, hi) if time[mid] <= t else (lo, mid)
    s = (t - time[lo]) / (time[hi] - time[lo])
    return values[lo] + s * (values[hi] - values[lo])


def noises(rig):
    sensors = rig[rig.index("[sensors]"):]
    return {c: float(re.search(rf"^{c} = (\S+)", sensors, re.M)[1]) for c in CHANNELS}


def spoil(kind, rng, tables, predict, noise):
    """Puts a fault into the recordings; returns its entries. `predict`: the true readings of the recording to predict, read as the sensors would."""
    faults, names = [], list(tables)
    every = list(tables.values()) + [predict]

    def gain(channel, g):
        for t in every:
            t[channel] = [g * v for v in t[channel]]
        faults.extend(dict(kind="gain", channel=channel, recording=n, value=g) for n in names)

    def later(channels, scale, offset, inputs=False):
        for t in every:
            time, start = t["time_s"], t["time_s"][0]
            for c in channels:
                s = noise[c]
                # The signal is read between samples; noise is not made smoother by it.
                old = list(t[c])
                t[c] = [at(time, old, start + (x - start - offset) / scale) for x in time]
                # Linear between two samples takes part of the noise's variance; it is put back.
                for i, x in enumerate(time):
                    u = start + (x - start - offset) / scale
                    if time[0] < u < time[-1]:
                        h = time[1] - time[0]
                        f = ((u - time[0]) / h) % 1.0
                        lost = 1 - (f * f + (1 - f) ** 2)
                        t[c][i] += rng.gauss(0, s * math.sqrt(max(lost, 0)))
    if kind == "zero_anew":
        for n, t in tables.items():
            z = rng.choice([-1, 1]) * rng.uniform(4, 14)
            t["force_n"] = [v + z for v in t["force_n"]]
            faults.append(dict(kind="zero_offset", channel="force_n", recording=n, value=z))
    elif kind in ("force_jumps", "stroke_jumps"):
        c = "force_n" if kind == "force_jumps" else "stroke_m"
        n = rng.choice(names)
        t = tables[n]
        size = rng.choice([-1, 1]) * noise[c] * rng.uniform(9, 25)
        when = t["time_s"][-1] * rng.uniform(0.25, 0.75)
        t[c] = [v + size * (x >= when) for v, x in zip(t[c], t["time_s"])]
        faults.append(dict(kind="zero_jump", channel=c, recording=n, value=size, time_s=when))
    elif kind == "held":
        c = rng.choice(CHANNELS[:3])
        period = rng.choice([0.02, 0.032, 0.04, 0.06])
        for t in every:
            time = t["time_s"]
            held, out, last = None, [], None
            for x, v in zip(time, t[c]):
                k = math.floor((x - time[0]) / period + 1e-6)
                if k != last:
                    held, last = v, k
                out.append(held)
            t[c] = out
        faults.extend(dict(kind="held", channel=c, recording=n, value=period) for n in names)
    elif kind == "frozen":
        c, n = rng.choice(CHANNELS[:3]), rng.choice(names)
        t = tables[n]
        start = t["time_s"][-1] * rng.uniform(0.2, 0.6)
        end = start + rng.uniform(0.5, 1.2)
        before = at(t["time_s"], t[c], start)
        t[c] = [before if start <= x < end else v for v, x in zip(t[c], t["time_s"])]
        faults.append(dict(kind="frozen", channel=c, recording=n, start_s=start, end_s=end))
    elif kind == "kgf":
        gain("force_n", 1 / 9.80665)
    elif kind == "lbf":
        gain("force_n", 1 / 4.4482216)
    elif kind == "sign":
        gain(rng.choice(["force_n", "acceleration_m_per_s2"]), -1.0)
    elif kind == "bar":
        gain("regulator_pressure_pa", rng.choice([1e-5, 1e-3, 1 / 6894.757]))
    elif kind == "stroke_mm":
        gain("stroke_m", 1e3)
    elif kind in ("late", "early"):
        c = rng.choice(CHANNELS[:3])
        offset = rng.uniform(0.02, 0.08) * (1 if kind == "late" else -1)
        later([c], 1.0, offset)
        faults.extend(dict(kind="clock_offset", channel=c, recording=n, value=offset) for n in names)
    elif kind in ("log_clock", "index"):
        scale = 1 + rng.choice([-1, 1]) * rng.uniform(0.012, 0.05)
        for t in every:
            s = t["time_s"][0]
            t["time_s"] = [s + scale * (x - s) for x in t["time_s"]]
        faults.extend(dict(kind="clock_scale", channel=None, recording=n, value=scale) for n in names)
    elif kind == "logger_clock":
        scale = 1 + rng.choice([-1, 1]) * rng.uniform(0.006, 0.018)
        later(CHANNELS, scale, 0.0)
        faults.extend(dict(kind="clock_scale", channel=c, recording=n, value=scale) for n in names for c in CHANNELS)
    elif kind == "absolute":
        for t in every:
            t["regulator_pressure_pa"] = [v + 101325 for v in t["regulator_pressure_pa"]]
        faults.extend(dict(kind="zero_offset", channel="regulator_pressure_pa", recording=n, value=101325) for n in names)
    elif kind == "pressure_zero":
        n = rng.choice(names)
        z = rng.choice([-1, 1]) * noise["regulator_pressure_pa"] * rng.uniform(10, 30)
        t = tables[n]
        t["regulator_pressure_pa"] = [v + z for v in t["regulator_pressure_pa"]]
        faults.append(dict(kind="zero_offset", channel="regulator_pressure_pa", recording=n, value=z))
    elif kind == "noise":
        for c in rng.sample(CHANNELS[:3], rng.randint(1, 2)):
            s = noise[c] * rng.uniform(2.5, 5)
            for t in every:
                t[c] = [v + rng.gauss(0, math.sqrt(s * s - noise[c] ** 2)) for v in t[c]]
            noise[c] = s
            faults.extend(dict(kind="noise", channel=c, recording=n, value=s) for n in names)
    return faults


def number(x):
    try:
        return float(x)
    except (TypeError, ValueError):
        return math.inf


def fits(got, want, noise):
    rec = str(got.get("recording", "all")).removesuffix(".csv")
    if got.get("kind") != want["kind"] or rec not in ("all", want["recording"]) or got.get("channel") != want["channel"] or number(got.get("probability", 1)) < 0.5:
        return False
    if want["kind"] == "frozen":
        return all(abs(number(got.get(k)) - want[k]) < 0.05 for k in ("start_s", "end_s"))
    v, w = number(got.get("value")), want["value"]
    if want["kind"] == "clock_scale":
        return abs(v - w) <= 0.2 * abs(w - 1)
    if want["kind"] == "gain":
        return abs(v - w) <= 0.02 * abs(w)
    if want["kind"] == "zero_jump" and abs(number(got.get("time_s")) - want["time_s"]) > 0.1:
        return False
    return abs(v - w) <= max(0.2 * abs(w), noise[want["channel"]] if want["kind"].startswith("zero") else 0)


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def score(answer, truth):
    d = json.loads((answer / "diagnosis.json").read_text())
    effects = [(e["name"], e.get("key"), number(e.get("confidence"))) for e in d["effects"]]
    faults = d.get("data_faults") or []
    want = [(truth["effect"], None)] if truth["effect"] else []
    if truth["number"]:
        key = truth["number"]["key"]
        want.append((SAME[key], None) if key in SAME else ("number_off", key))
    alike = set(want)
    if any(f["kind"] == "clock_offset" and f["channel"] == "force_n" for f in truth["faults"]):
        alike.add(("channel_time_offset", None))
    effect = all(any((n, k) == w and p >= 0.5 for n, k, p in effects) for w in want)
    fault = all(any(fits(g, f, truth["noise"]) for g in faults) for f in truth["faults"])
    there = {(f["kind"], f["channel"]) for f in truth["faults"]}
    if truth["effect"] == "channel_time_offset":
        there.add(("clock_offset", "force_n"))
    beside = [(f"{n}{k or ''}", p) for n, k, p in effects if (n, k) not in alike] + [(f"{g['kind']}:{g['channel']}", number(g.get("probability", 1))) for g in faults if (g["kind"], g["channel"]) not in there]
    worst = 0.0
    try:
        _, mine = read(answer / "prediction.csv")
        _, measured = read(answer.parent.parent / "truth" / f"{answer.name}.predict.csv")
        for c in CHANNELS:
            e = sorted(abs(a - b) / truth["noise_read"][c] for a, b in zip(mine[c], measured[c]) if not math.isnan(b))
            worst = max(worst, e[int(0.9 * (len(e) - 1))])
    except (OSError, KeyError):
        worst = math.inf
    return dict(effect=effect, fault=fault, beside=[b for b in beside if b[1] >= 0.5], false_sure=[b for b in beside if b[1] > 0.9], worst=worst, seconds=d["seconds"],
                got=[f"{n}{k or ''}@{p:.2f}" for n, k, p in effects] + [f"{g['kind']}:{g['channel']}:{g['recording']}:{number(g.get('value')):.4g}@{number(g.get('probability', 1)):.2f}" for g in faults])


def make(program, out, what, count, draw):
    base = out / "base"
    if not base.exists():
        done = run(program, "laboratory", "--devices", 2 * count, "--draw", draw, "--out", base, "--quiet")
        if done.returncode:
            sys.exit(done.stderr)
    cases, truths = out / "cases", out / "truth"
    for d in (cases, truths):
        d.mkdir(parents=True, exist_ok=True)
    for i, sealed in enumerate(sorted((base / "sealed").glob("*.json"), key=lambda p: int(p.stem.rsplit("-", 1)[1]))):
        rng = random.Random(f"{what}-{draw}-{i}")
        t = json.loads(sealed.read_text())
        effect = t["effects"][0]["name"] if t["effects"] else None
        if what == "sheet" and i % 3 == 1 and not effect:
            continue
        folder = base / "cases" / sealed.stem
        rig = (folder / "rig.toml").read_text()
        noise = noises(rig)
        files = sorted(p for p in folder.glob("*.csv") if p.stem != "predict")
        tables = {p.stem: read(p)[1] for p in files}
        header = read(files[0])[0]
        _, inputs = read(folder / "predict.csv")
        _, readings = read(sealed.with_name(sealed.stem + ".predict.csv"))
        predict = {**inputs, **{c: readings[c] for c in CHANNELS}}
        truth = dict(effect=effect, faults=[], number=None, kind=None)
        if what == "data":
            kind = KINDS[(i // 2) % len(KINDS)]
            truth.update(kind=kind, faults=spoil(kind, rng, tables, predict, noise))
        else:
            key = NUMBERS[i % len(NUMBERS)]
            rig, truth["number"] = off(program, folder, rig, key, rng, noise, out)
            truth["kind"] = key
            if truth["number"] is None or SAME.get(key) == effect:
                continue
        name = f"{i:03d}-{truth['kind'].split('.')[-1]}-{effect or 'alone'}"
        where = cases / name
        where.mkdir(exist_ok=True)
        (where / "rig.toml").write_text(rig)
        for n, t2 in tables.items():
            write(where / f"{n}.csv", header, t2)
        write(where / "predict.csv", INPUTS, predict)
        write(truths / f"{name}.predict.csv", ["time_s", *CHANNELS], predict)
        gains = {f["channel"]: abs(f["value"]) for f in truth["faults"] if f["kind"] == "gain"}
        truth.update(noise={c: noise[c] for c in CHANNELS}, noise_read={c: noise[c] * gains.get(c, 1) for c in CHANNELS})
        (truths / f"{name}.json").write_text(json.dumps(truth, indent=1))


def off(program, folder, rig, key, rng, noise, out):
    """The rig file with one number off by five standard deviations or more; none where it does not show by twice its value."""
    table, name = key.split(".")
    pattern = re.compile(rf"(\[{table}\]\n(?:(?!\[).*\n)*?{name} = (?:\{{ value = )?)([-\d.e+]+)")
    sheet = float(pattern.search(rig)[2])
    # What the tolerance of a number that acts alike takes up is within the sheet.
    alike = (name, *ALIKE.get(name, ()))
    tolerances = [float(t) for n in alike for t in re.findall(rf"^{n} = .*tolerance = ([\d.e-]+)", rig, re.M)]
    least = 2.5 * max(tolerances, default=0.0)
    sign = rng.choice([-1, 1])
    for change in (0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 0.9):
        if change < least:
            continue
        factor = (1 + change) if sign > 0 else 1 / (1 + change)
        other = pattern.sub(lambda m: m[1] + repr(sheet * factor), rig, count=1)
        if influence(program, folder, rig, other, noise, out) >= 5:
            return other, dict(key=key, value=sheet, sheet=sheet * factor)
    return rig, None


def influence(program, folder, one, other, noise, out):
    """Largest RMS over one recording and channel of what two rig files predict apart, in standard deviations of the sensor."""
    worst = 0.0
    for recording in ("stairs", "ride", "cycle"):
        results = []
        for k, text in enumerate((one, other)):
            where = out / "scratch" / str(k)
            where.mkdir(parents=True, exist_ok=True)
            (where / "rig.toml").write_text(text)
            done = run(program, "predict", where / "rig.toml", folder / f"{recording}.csv", "--out", where / "p.csv", "--force")
            if done.returncode:
                sys.exit(done.stderr)
            results.append(read(where / "p.csv")[1])
        for c in CHANNELS:
            d = [(a - b) / noise[c] for a, b in zip(results[0][c], results[1][c])]
            worst = max(worst, math.sqrt(sum(x * x for x in d) / len(d)))
    return worst


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program")
    p.add_argument("--out", required=True, type=pathlib.Path)
    p.add_argument("--what", choices=["data", "sheet"], default="data")
    p.add_argument("--count", type=int, default=18)
    p.add_argument("--draw", type=int, default=0)
    p.add_argument("--make", action="store_true")
    a = p.parse_args()
    if not (a.out / "truth").exists():
        make(a.program, a.out, a.what, a.count, a.draw)
    if a.make:
        return
    results = []
    for case in sorted((a.out / "cases").iterdir()):
        answer = a.out / "answers" / case.name
        said = None
        if not (answer / "diagnosis.json").exists():
            said = run(a.program, "diagnose", case, "--out", answer, "--force", "--quiet")
        truth = json.loads((a.out / "truth" / f"{case.name}.json").read_text())
        try:
            r = score(answer, truth)
        except (OSError, ValueError) as e:
            r = dict(effect=False, fault=False, beside=[], false_sure=[], worst=math.inf, seconds=None, got=[f"NO ANSWER {e} {said.stderr[-200:] if said else ''}"])
        results.append((truth, r))
        ok = r["effect"] and r["fault"] and not r["beside"]
        print(f"{case.name:50} {'ok ' if ok else 'BAD'} effect {int(r['effect'])} fault {int(r['fault'])} beside {r['beside']} sure {len(r['false_sure'])} p90 {r['worst']:.2f} s {r['seconds'] and round(r['seconds'])} {' '.join(r['got'])}", flush=True)
    for alone in (True, False):
        those = [r for t, r in results if (t["effect"] is None) == alone]
        if those:
            print(json.dumps(dict(alone=alone, cases=len(those), effect=sum(r["effect"] for r in those), fault=sum(r["fault"] for r in those), nothing_else=sum(not r["beside"] for r in those),
                                  false_sure=sum(bool(r["false_sure"]) for r in those), predicted=sum(r["worst"] <= 2 for r in those))))


main()

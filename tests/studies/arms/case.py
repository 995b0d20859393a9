"""One recorded arm by its number: drawn, sized, written with its sealed truth."""
import itertools
import json
import pathlib

import numpy as np

from . import causes, motion
from .bodies import Arm
from .nominal import Nominal
from .plant import Plant, move

LEAST, MOST = 3.0, 50.0  # Sizes: largest RMS of what the effect changes in one channel and recording [standard deviations of its sensor].
SEED = 20261127


def deck():
    """Causes in the order of case numbers: every name once, four times nothing, four laws without a name, over and over in new orders."""
    rng = np.random.default_rng(SEED)
    laws = 0
    while True:
        cards = [(name, None) for name in causes.NAMES] + [("nothing", None)] * 4
        for _ in range(4):
            cards.append(("unlisted", causes.LAWS[laws % len(causes.LAWS)]))
            laws += 1
        rng.shuffle(cards)
        yield from (tuple(card) for card in cards)


class Case:
    """An arm, its nominal values, its paths, and what is concealed."""

    def __init__(self, number, name, law):
        self.number, self.name, self.law = number, name, law
        self.rng = rng = np.random.default_rng([SEED, number])
        for _ in range(20):
            self._draw(rng)
            if name == "nothing" or self._conceal(rng):
                return
        raise RuntimeError(f"case {number}: no arm in which {name} shows")

    def _draw(self, rng):
        name = self.name
        while True:
            arm = Arm(rng)
            if name != "drive_gain_error" or arm.logs_currents:
                break
        needs = name in causes.NEEDS_SENSOR
        has_links = name == "compliant_joint" or (name != "joint_encoder_offset" and rng.random() < 0.12)
        self.arm, self.nominal = arm, Nominal(rng, arm, needs or rng.random() < 0.3, has_links)
        self.rate = int(rng.choice([100, 125, 250], p=[0.45, 0.45, 0.1]))
        self.uneven = rng.random() < 0.2
        self.cause, self.size, self.sigma = None, None, 0.0
        self._paths(rng)

    def _paths(self, rng):
        arm = self.arm
        self.paths = {"fourier": (motion.fourier(rng, arm, 20.0, rng.uniform(1.1, 1.5)), None), "slow": (motion.slow(rng, arm), None), "still": (motion.still(rng, arm), None)}
        if self.nominal.sensor and rng.random() < 0.5:
            self.paths["work"] = motion.work(rng, arm)
        self.press_force = rng.uniform(25, 60)
        self.fit = list(self.paths)
        self.paths["predict"] = (motion.fourier(rng, arm, 14.0, rng.uniform(1.1, 1.5), slow_half=True), None)
        self.starts = {name: rng.uniform(-0.7, 0.7, arm.n) for name in self.paths}
        self.samples = {}
        for name, (path, _) in self.paths.items():
            rate = {"slow": 100, "still": 50}.get(name, self.rate)
            step = round(1 / rate / motion.STEP)
            samples = np.arange(0, len(path), step)
            if self.uneven:
                samples = np.clip(samples + rng.integers(-max(step // 4, 1), max(step // 4, 1) + 1, len(samples)), 0, len(path) - 1)
                samples[0] = 0
            self.samples[name] = samples

    def motions(self, numbers, names, every=1):
        plant = Plant(self.arm, numbers)
        return [move(plant, n, self.paths[n][0], self.samples[n][::every], self.starts[n], self.paths[n][1], self.press_force) for n in names]

    def noise(self):
        b = self.nominal
        out = {"drive": b.noise, "link": np.full(self.arm.n, 2e-5)}
        if b.sensor:
            out["wrench"] = np.repeat(b.sensor["noise"], 3)
        return out

    def channels(self):
        return ("drive", *(["link"] if self.nominal.with_link_encoders else []), *(["wrench"] if self.nominal.sensor else []))

    def changed(self, cause, size, motions):
        """Largest RMS of what the effect changes [standard deviations]."""
        numbers, _ = cause.at(size)
        if numbers.stiffness:
            motions = self.motions(numbers, self.fit, 4)
        noise, largest = self.noise(), 0.0
        for m in motions:
            # Every fourth sample will do.
            there, gone = Plant(self.arm, numbers).read(m), Plant(self.arm, cause.without).read(m)
            for c in self.channels():
                largest = max(largest, float(np.sqrt(np.mean(((there[c] - gone[c]) / noise[c]) ** 2, axis=0)).max()))
        return largest

    def _conceal(self, rng):
        """The cause at its size: where even its largest natural size is below the least, another place is drawn, then another arm."""
        for _ in range(8):
            cause = causes.draw(rng, self.nominal, self.name, self.law)
            motions = self.motions(cause.without, self.fit, 4)
            most = self.changed(cause, 1.0, motions)
            if most >= LEAST:
                break
        else:
            return False
        if cause.belief:
            cause.belief()
        aim = np.exp(rng.uniform(np.log(LEAST), np.log(min(MOST, most))))
        low, high = 1e-3, 1.0
        for _ in range(6):
            middle = (low * high) ** 0.5
            low, high = (middle, high) if self.changed(cause, middle, motions) < aim else (low, middle)
        self.cause, self.size, self.sigma = cause, high, self.changed(cause, high, motions)
        return True

    def truth(self):
        effects = []
        if self.cause:
            _, parameters = self.cause.at(self.size)
            own = {"name": self.name, "truth": self.law or self.name, "subsystem": self.cause.subsystem, "parameters": {**self.cause.place, **{k: float(v) for k, v in parameters.items()}}}
            if self.name == "unlisted":
                own["parameters"]["depends_on"] = list(self.cause.depends_on)
            else:
                own["tolerance"] = {k: float(v) for k, v in self.cause.tolerance(parameters).items()}
            effects.append(own)
        return {"case": f"case-{self.number:03}", "kind": self.arm.kind, "effects": effects, "sigma": self.sigma}

    def columns(self, m, reading, predict):
        """Columns of a log with noise, by name."""
        rng, b, arm = self.rng, self.nominal, self.arm
        out = {"time_s": (m.time, 4)}
        for j in range(arm.n):
            out[f"joint_{j + 1}_command_{self.unit(j)}"] = (m.command[m.samples, j], 6)
        for j in range(arm.n):
            out[f"joint_{j + 1}_{self.unit(j)}"] = (m.q[m.samples, j] + b.position_noise * rng.normal(size=len(m.samples)), 8)
        for j in range(arm.n):
            out[f"joint_{j + 1}_{self.unit(j)}_per_s"] = (m.v[m.samples, j] + 0.0005 * rng.normal(size=len(m.samples)), 4)
        noise = self.noise()
        for c in self.channels():
            for k in range(reading[c].shape[1]):
                out[self.column(c, k)] = (reading[c][:, k] + noise[c][k] * rng.normal(size=len(m.samples)), 7 if c == "link" else 4)
        if predict:
            inputs = {k: v for k, v in out.items() if not k.endswith("_per_s") and not any(k == self.column(c, j) for c in self.channels() for j in range(reading[c].shape[1]))}
            return inputs, {k: v for k, v in out.items() if k == "time_s" or (k not in inputs and not k.endswith("_per_s"))}
        return out, None

    def unit(self, j):
        return "m" if self.arm.prismatic[j] else "rad"

    def column(self, kind, k):
        if kind == "wrench":
            return f"wrench_{causes.CHANNELS[k]}_{'n' if k < 3 else 'n_m'}"
        what = f"link_{self.unit(k)}" if kind == "link" else "current_a" if self.arm.logs_currents else "force_n" if self.arm.prismatic[k] else "torque_n_m"
        return f"joint_{k + 1}_{what}"

    def numbers(self):
        return self.cause.at(self.size)[0] if self.cause else self.nominal.truth

    def write(self, cases, truths):
        folder = cases / f"case-{self.number:03}"
        folder.mkdir(parents=True, exist_ok=True)
        truths.mkdir(parents=True, exist_ok=True)
        urdf = f"{self.arm.kind}.urdf"
        (folder / urdf).write_text(self.arm.urdf(2.5 * self.nominal.peak + 5 * self.nominal.coulomb))
        (folder / "arm.toml").write_text(self.nominal.toml(urdf, self.rate, self.fit, "work" in self.fit))
        numbers = self.numbers()
        plant = Plant(self.arm, numbers)
        for m in self.motions(numbers, list(self.paths)):
            own, asked = self.columns(m, plant.read(m), m.name == "predict")
            write_csv(folder / f"{m.name}.csv", own)
            if asked:
                write_csv(truths / f"case-{self.number:03}.predict.csv", asked)
        noise = self.noise()
        truth = self.truth()
        truth["noise"] = {self.column(c, k): float(noise[c][k]) for c in self.channels() for k in range(6 if c == "wrench" else self.arm.n)}
        truth["mismatch"] = []
        (truths / f"case-{self.number:03}.json").write_text(json.dumps(truth, indent=1))
        return truth


def write_csv(path, columns):
    rows = zip(*([f"{x:.{digits}f}" for x in values] for values, digits in columns.values()))
    path.write_text(",".join(columns) + "\n" + "\n".join(",".join(row) for row in rows) + "\n")


def make(number, out):
    """Writes the arm of a number below a folder."""
    name, law = next(itertools.islice(deck(), number, None))
    return Case(number, name, law).write(pathlib.Path(out) / "cases", pathlib.Path(out) / "truth")

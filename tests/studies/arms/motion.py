"""Paths that owners record: a Fourier path, one joint after the other, still postures, pressing and sliding, and one to predict."""
import numpy as np

STEP = 0.0005  # Of the fine grid on which joints are simulated [s].
LEAD = 0.7  # Time at rest before a recording starts [s].


def smooth(s):
    """Share of a way from rest to rest, without a jump of the acceleration."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10 - 15 * s + 6 * s * s)


def fourier(rng, arm, seconds, top, slow_half=False):
    """All joints, from rest to rest; speeds up to about `top` [rad/s]."""
    t = np.arange(round(seconds / STEP) + 1) * STEP
    out = np.zeros((t.size, arm.n))
    for j in range(arm.n):
        order = np.arange(1, 6)
        size, phase = rng.uniform(0.3, 1.0, 5) / order**0.8, rng.uniform(0, 2 * np.pi, 5)
        turn = 2 * np.pi * order / min(seconds, 20.0)
        time = t
        if slow_half:  # The second half at a tenth of the speed.
            rate = 1 - 0.9 * smooth((t - 0.45 * seconds) / (0.1 * seconds))
            time = np.concatenate([[0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * STEP)])
        path = (size * np.sin(np.outer(time, turn) + phase)).sum(axis=1)
        ends = smooth(t / 1.5) * smooth((t[-1] - t) / 1.5)
        path = (path - path.mean()) * ends
        speed = np.abs(np.gradient(path, STEP)).max()
        limit = top * rng.uniform(0.8, 1.1) * (0.4 if arm.prismatic[j] else 1.0)
        scale = min(limit / speed, (0.35 if arm.prismatic[j] else 1.25) / np.abs(path).max())
        out[:, j] = arm.middle[j] + scale * path
    return out


def moves(start, way, speed, acceleration):
    """One way at a speed, from rest to rest, as samples of the fine grid."""
    ramp = min(speed / acceleration, abs(way) / speed)
    seconds = abs(way) / speed + ramp
    t = np.arange(1, round(seconds / STEP) + 1) * STEP
    profile = np.minimum(np.minimum(t / ramp, (seconds - t) / ramp), 1.0)
    profile = smooth(profile)
    travelled = np.cumsum(profile)
    return start + way * travelled / travelled[-1]


def slow(rng, arm):
    """One joint after the other, to and fro at three speeds, the others held."""
    rest = arm.middle + rng.uniform(-0.3, 0.3, arm.n) * np.where(arm.prismatic, 0.5, 1.0)
    blocks = [np.tile(rest, (round(0.3 / STEP), 1))]
    for j in range(arm.n):
        unit = (0.5 if arm.prismatic[j] else 1.0) * rng.uniform(0.85, 1.15)
        for speed, way in ((0.02, 0.02), (0.1, 0.075), (0.4, 0.16)):
            for sign in (1, -1):
                begin = rest[j] + (0 if sign > 0 else way * unit)
                path = moves(begin, sign * way * unit, speed * unit, 2.0)
                block = np.tile(rest, (path.size + round(0.06 / STEP), 1))
                block[: path.size, j] = path
                block[path.size:, j] = path[-1]
                blocks.append(block)
    return np.concatenate(blocks)


def still(rng, arm, postures=10):
    """Postures held for a second, quick moves between."""
    spread = np.where(arm.prismatic, 0.3, 1.0)
    at = arm.middle + rng.uniform(-0.8, 0.8, arm.n) * spread
    blocks = [np.tile(at, (round(0.5 / STEP), 1))]
    for _ in range(postures):
        to = arm.middle + rng.uniform(-0.8, 0.8, arm.n) * spread
        seconds = 1.9 * np.max(np.abs(to - at) / np.where(arm.prismatic, 0.9, 2.2)) + 0.15
        s = smooth(np.arange(1, round(seconds / STEP) + 1) * STEP / seconds)
        blocks += [at + s[:, None] * (to - at), np.tile(to, (round(1.05 / STEP), 1))]
        at = to
    return np.concatenate(blocks)


def work(rng, arm):
    """Three presses, sliding slowly meanwhile; the share of the force at each step beside it."""
    at = arm.middle + rng.uniform(-0.2, 0.2, arm.n)
    blocks, shares = [np.tile(at, (round(0.6 / STEP), 1))], [np.zeros(round(0.6 / STEP))]
    for _ in range(3):
        to = at + rng.uniform(-0.12, 0.12, arm.n)
        seconds = rng.uniform(2.4, 3.4)
        t = np.arange(1, round(seconds / STEP) + 1) * STEP
        blocks.append(at + smooth((t - 0.5) / (seconds - 1.0))[:, None] * (to - at))
        wave = 1 + 0.15 * np.sin(2 * np.pi * rng.uniform(0.8, 2.0) * t)
        shares.append(rng.uniform(0.6, 1.0) * smooth(t / 0.4) * smooth((seconds - t) / 0.4) * wave)
        rest = round(0.5 / STEP)
        blocks.append(np.tile(to, (rest, 1)))
        shares.append(np.zeros(rest))
        at = to
    return np.concatenate(blocks), np.concatenate(shares)

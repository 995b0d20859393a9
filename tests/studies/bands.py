#!/usr/bin/env python3
"""How many readings lie inside the stated 90 % bands of predictions, and how unknown ground is reported.

    tests/studies/bands.py ANSWERS TRUTH [ANSWERS TRUTH ...]

ANSWERS holds CASE/prediction.csv of `idc diagnose --all`, TRUTH holds CASE.predict.csv, what the sensors read. Printed are, of each channel, the share of
readings inside the band on known and on unknown ground, the median half width in standard deviations of the noise (CASE.json: noise), the cases in which a
channel's error exceeds 4 standard deviations (root mean square), with what was reported of them, and the share of known ground that was called unknown:
samples of cases whose error stays within 4.
"""
import csv
import json
import math
import sys
from pathlib import Path

CHANNELS = ["regulator_pressure_pa", "stroke_m", "force_n", "acceleration_m_per_s2"]


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(row, name):
    text = row.get(name, "")
    return float(text) if text not in ("", None) else math.nan


def main(folders):
    inside = {(c, k): [0, 0] for c in CHANNELS for k in (0, 1)}
    widths = {c: [] for c in CHANNELS}
    far, flagged, known = [], 0, 0
    for answers, truth in zip(folders[::2], folders[1::2]):
        for path in sorted(Path(answers).glob("*/prediction.csv")):
            case = path.parent.name
            measured = Path(truth) / f"{case}.predict.csv"
            if not measured.is_file():
                continue
            noise = json.loads((Path(truth) / f"{case}.json").read_text()).get("noise", {})
            mine, theirs = rows(path), rows(measured)
            worst, unknown = 0.0, 0
            for channel in CHANNELS:
                squares = count = 0
                for a, b in zip(mine, theirs):
                    value, low, high = (number(a, channel + end) for end in ("", "_low", "_high"))
                    read = number(b, channel)
                    if math.isnan(read) or math.isnan(value):
                        continue
                    sums = inside[channel, int(number(a, "known_ground"))]
                    sums[0] += low <= read <= high
                    sums[1] += 1
                    sigma = noise.get(channel, math.nan)
                    if not math.isnan(high):
                        widths[channel].append((high - low) / 2 / sigma)
                    squares += ((read - value) / sigma) ** 2
                    count += 1
                if count:
                    worst = max(worst, math.sqrt(squares / count))
            unknown = sum(1 - int(number(a, "known_ground")) for a in mine)
            if worst > 4:
                far.append((case, worst, unknown / len(mine)))
            else:
                flagged += unknown
                known += len(mine)
    for channel in CHANNELS:
        text = []
        for ground, name in ((1, "known"), (0, "unknown")):
            held, of = inside[channel, ground]
            text.append(f"{100 * held / of:.1f} % of {of} on {name} ground" if of else f"none on {name} ground")
        width = sorted(widths[channel])
        half = width[len(width) // 2] if width else math.nan
        print(f"{channel:24s} {'; '.join(text)}; median half width {half:.2f} standard deviations of the noise")
    held = sum(inside[c, 1][0] for c in CHANNELS)
    of = sum(inside[c, 1][1] for c in CHANNELS)
    print(f"all channels             {100 * held / max(of, 1):.1f} % on known ground")
    print(f"called unknown of cases within 4 standard deviations: {100 * flagged / max(known, 1):.1f} % of the samples")
    for case, worst, share in far:
        print(f"  {case}: error {worst:.1f} standard deviations, {100 * share:.0f} % of it reported as unknown ground")


main(sys.argv[1:])

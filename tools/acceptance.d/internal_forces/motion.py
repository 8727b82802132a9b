#!/usr/bin/env python3
"""Twice the feedback of the internal force costs no motion: the CoM's error on the ellipse, wedges with slow torque loops and
the lab's. 5 seeds draw the start, and in
`wedges_lab`, the state estimated, all that `lab` draws."""
import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from wedge_runs import each, finish, give_up, rms, rows_of

SEEDS = range(100, 105)


def error(behavior, world, seed, feedback):
    place = "truth.com.pos" if behavior != "wedges_ellipse" else "com.pos"  # not the estimate
    done, rows = rows_of(behavior, world, seed, [f"{place}.*", "com.ref.*"], "--for", "16 s", "--set", f"feedback={feedback}")
    if done["end"] != "time":
        give_up(f"{behavior} in {world}, seed {seed}: {done['end']}")
    return rms(math.hypot(float(r[f"{place}.x"]) - float(r["com.ref.x"]), float(r[f"{place}.z"]) - float(r["com.ref.z"]))
               for r in rows if float(r["time"]) >= 4.0)


def main():
    texts, passed = [], True
    for behavior, world, gain in (("wedges_ellipse", "wedges_detuned", 2.5), ("wedges_ellipse_lab", "wedges_lab", 1.0)):
        single = each(error, [(behavior, world, seed, gain) for seed in SEEDS])
        double = each(error, [(behavior, world, seed, 2 * gain) for seed in SEEDS])
        changes = [b / a - 1.0 for a, b in zip(single, double)]
        texts.append(f"{world}, K_F {gain} to {2 * gain}: CoM {1e3 * statistics.median(single):.2f} to "
                     f"{1e3 * statistics.median(double):.2f} mm rms, largest change {100 * max(map(abs, changes)):.1f} %")
        passed = passed and max(map(abs, changes)) < 0.05
    finish("; ".join(texts), passed)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Twice the feedback of the internal force costs no motion: the CoM's error on the ellipse, wedges with slow torque loops and
the lab's. 5 seeds draw the start (and in `wedges_lab` all that `lab` draws)."""
import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from wedge_runs import each, finish, rms, rows_of

SEEDS = range(100, 105)


def error(world, seed, feedback):
    _, rows = rows_of("wedges_ellipse", world, seed, ["com.pos.*", "com.ref.*"], "--for", "16 s", "--set", f"feedback={feedback}")
    return rms(math.hypot(float(r["com.pos.x"]) - float(r["com.ref.x"]), float(r["com.pos.z"]) - float(r["com.ref.z"]))
               for r in rows if float(r["time"]) >= 4.0)


def main():
    texts, passed = [], True
    for world, gain in (("wedges_detuned", 2.5), ("wedges_lab", 1.0)):
        single = each(error, [(world, seed, gain) for seed in SEEDS])
        double = each(error, [(world, seed, 2 * gain) for seed in SEEDS])
        changes = [b / a - 1.0 for a, b in zip(single, double)]
        texts.append(f"{world}, K_F {gain} to {2 * gain}: CoM {1e3 * statistics.median(single):.2f} to "
                     f"{1e3 * statistics.median(double):.2f} mm rms, largest change {100 * max(map(abs, changes)):.1f} %")
        passed = passed and max(map(abs, changes)) < 0.05
    finish("; ".join(texts), passed)


if __name__ == "__main__":
    main()

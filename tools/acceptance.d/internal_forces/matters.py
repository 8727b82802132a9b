#!/usr/bin/env python3
"""Feedback of the internal force keeps the feet from sliding: wedges with slow torque loops, friction 0.7, 100 N `sum`. People
hold the torso for a second and let go. 20 seeds draw where the CoM is, within +-1 cm of the middle, and what the world draws
(joints, velocity, rates at the start); feet 5 and 14 cm to the side."""
import math
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from wedge_runs import WORLDS, each, finish, held_start, scenario_rows, slid, world_text

SEEDS = range(100, 120)
LET_GO = 1.0  # s


def outcome(side, seed, feedback):
    """(stays up, m that a foot has slid after people let go, appearances of fault.slip)."""
    shift = random.Random(seed).uniform(-0.01, 0.01)
    world = world_text(WORLDS / "wedges_detuned.yaml", shift=shift, side=side)
    done, rows = scenario_rows("wedges_hold", world, seed, ["point.right_foot.*", "point.left_foot.*"], held_start(LET_GO), "6 s",
                               "--set", "world.ground.friction=0.7", "--set", f"feedback={feedback}")
    way = slid([row for row in rows if float(row["time"]) >= LET_GO - 0.01])
    return done["end"] == "time", way, sum(t >= LET_GO for t in done["slips"])


def main():
    texts, passed = [], True
    for side in (0.05, 0.14):
        for feedback in (0, 5):
            runs = each(outcome, [(side, seed, feedback) for seed in SEEDS])
            lost = sum(not up or way > 0.05 for up, way, _ in runs)
            slips = sum(slip > 0 for _, _, slip in runs)
            most = max((way for up, way, _ in runs if up), default=math.nan)
            texts.append(f"feet {100 * side:.0f} cm aside, K_F {feedback}: {lost} of {len(runs)} slide or fall, fault.slip in "
                         f"{slips}, the others move {1e3 * most:.1f} mm at most")
            passed = passed and (lost >= 18 if feedback == 0 else lost == 0 and slips == 0)
    finish("; ".join(texts), passed)


if __name__ == "__main__":
    main()

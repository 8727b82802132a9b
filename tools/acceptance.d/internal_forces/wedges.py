#!/usr/bin/env python3
"""[Kim16] Figs. 8-9: on two wedges with slow torque loops the CoM goes round an ellipse; the internal force's error with and
without feedback against a = Kp/(1 + Kp), CoM and torso from 4 s on. People hold the torso in the first second. 10 seeds draw
the start: joints, velocity, rates."""
import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from wedge_runs import each, finish, held_start, largest, relative_error, scenario_rows

SEEDS = range(100, 110)
SHARE = 0.8 / 1.8  # a: of a commanded torque that arrives
FEEDBACK = 5
SIGNALS = ["internal.*", "com.pos.*", "com.ref.*", "base.rpy.*"]


def figures(world, seed, feedback, integral):
    done, rows = scenario_rows("wedges_ellipse", world, seed, SIGNALS, held_start(1.0), "16 s", "--set",
                               f"feedback={feedback}", "--set", f"integral={integral} 1/s")
    late = [row for row in rows if float(row["time"]) >= 4.0]
    if done["end"] != "time":
        return None
    com = largest(math.hypot(float(r["com.pos.x"]) - float(r["com.ref.x"]), float(r["com.pos.z"]) - float(r["com.ref.z"]))
                  for r in late)
    torso = largest(max(abs(float(r["base.rpy.pitch"])), abs(float(r["base.rpy.roll"]))) for r in late)
    return relative_error(late), com, torso


def main():
    texts, passed, want = [], True, True
    for world in ("wedges_detuned", "wedges_20"):
        for feedback, integral in ((0, 0), (FEEDBACK, 0), (FEEDBACK, 10)):
            runs = each(figures, [(world, seed, feedback, integral) for seed in SEEDS])
            stood = [run for run in runs if run]  # without feedback a foot may slide before there is any force
            passed = passed and len(stood) >= (len(runs) if feedback else 8)
            force, com, torso = zip(*stood)
            expected = (1 - SHARE) / (1 + SHARE * feedback)
            name = f"{world}, K_F {feedback}" + (f", K_I {integral}/s" if integral else "")
            texts.append(f"{name}, {len(stood)} of {len(runs)} stand: force {100 * statistics.median(force):.1f} % rms (worst {100 * max(force):.1f}"
                         + (f", expected {100 * expected:.1f}" if not integral else "")
                         + f"), CoM {1e3 * max(com):.1f} mm, torso {max(torso):.3f} rad")
            if integral:
                want = want and max(force) < 0.02 and max(com) <= 5e-3 and max(torso) <= 0.03
                continue
            passed = passed and all(abs(f / expected - 1.0) <= 0.15 for f in force)
            if world == "wedges_detuned":
                passed = passed and (min(force) > 0.5 if feedback == 0 else max(force) < 0.2)
                if feedback:
                    passed = passed and max(com) <= 0.01 and max(torso) <= 0.05
    finish("; ".join(texts), passed, want)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The quadruped trots 200 steps in place and at 0.3 m/s: 20 seeds of `varied` (want: of `lab`, state estimated, too)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import SEED, WANT, finish, run_all

STEPS, SEEDS, MUST = 200, range(SEED, SEED + 20), 18
GAITS = {"in place": ("quadruped_trot", 0.0), "ahead": ("quadruped_trot_forward", 0.3)}  # m/s


def measure(world, suffix):
    """Text of both gaits in a world, and the least number of seeds that made all steps."""
    texts, least = [], len(SEEDS)
    for name, (behavior, speed) in GAITS.items():
        runs = run_all([(seed, [behavior + suffix, "--world", world, "--seed", seed, "--steps", STEPS, "--for", f"{STEPS} s"])
                        for seed in SEEDS])
        good = [r for r in runs.values() if r["steps"] >= STEPS and not r["fell"]]
        low = [f"{seed}: {r['steps']}" for seed, r in runs.items() if r["steps"] < STEPS]
        text = f"{name} {len(good)} of {len(SEEDS)}" + (f" (fell {', '.join(low)})" if low else "")
        if good:
            off = max(abs(r["mean_speed_last_50_mps"][0] - speed) for r in good)
            text += f", speed within {off:.3f} m/s, clearance {100 * min(r['clearance_min_m'] for r in good):.1f} cm at least"
        texts.append(text)
        least = min(least, len(good))
    return f"{world}: {'; '.join(texts)}", least


figure, least = measure("varied", "")
want = None
if WANT:
    text, in_lab = measure("lab", "_lab")
    figure += f". {text}"
    want = min(least, in_lab) >= MUST
finish(f"{STEPS} steps, {figure}", least >= MUST, want)

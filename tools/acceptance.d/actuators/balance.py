#!/usr/bin/env python3
"""balance_best and balance (with its overlay) in `sea`: 300 steps, a hundred seeds of start and actuators."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import statistics

from rows import SEED, WANT, finish, run_all

STEPS = 300
SEEDS = range(SEED, SEED + 100)
figures, counts = [], []
for name in ("balance_best", "balance_sea"):
    runs = run_all([(seed, [name, "--world", "sea", "--seed", seed, "--steps", STEPS, "--for", "150 s"])
                    for seed in SEEDS])
    steps = sorted(r["steps"] for r in runs.values())
    counts.append(sum(s >= STEPS for s in steps))
    fell = [f"{seed}: {r['steps']}" for seed, r in runs.items() if r["steps"] < STEPS]
    figures.append(f"{name} {counts[-1]} of {len(runs)} (median {statistics.median(steps):.0f}, worst {steps[0]} steps"
                   + (f"; fell {', '.join(fell)})" if fell else ")"))
want = None
if WANT:
    far = run_all([(seed, ["balance_best", "--world", "sea", "--seed", seed, "--steps", 3000, "--for", "1500 s"])
                   for seed in range(SEED, SEED + 20)])
    long = sum(r["steps"] >= 3000 for r in far.values())
    figures.append(f"3000 steps {long} of 20")
    want = min(counts) >= 99 and long == 20
elif min(counts) < 99:
    want = False
finish("; ".join(figures) + "; drawn: start, springs +-3 %, friction 0.5 to 1.5 Nm", min(counts) >= 95, want)

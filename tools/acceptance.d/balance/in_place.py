#!/usr/bin/env python3
"""In place with Tables I and II, ideal actuators and state: 3000 steps on each of two seeds (want: 10^5)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BALANCE, SEED, WANT, finish, pick, run_all

SEEDS = (SEED, SEED + 1)
MUST, WANTED = 3000, 100_000  # number of steps
LIMITS = {"roll": 0.005, "pitch": 0.005, "height": 0.002, "yaw": 0.1}  # rad, m
UNITS = {"roll": "rad", "pitch": "rad", "height": "m", "yaw": "rad"}

steps = WANTED if WANT else MUST
results = run_all([(seed, [BALANCE, "--seed", seed, "--steps", steps]) for seed in SEEDS])
worst = {name: max(pick(r, "error", name, "max") for r in results.values()) for name in LIMITS}
within = all(worst[name] <= LIMITS[name] for name in LIMITS)
reached = min(pick(r, "steps") for r in results.values())
away = max(pick(r, "max_distance_m") for r in results.values())
fell = [str(seed) for seed, r in results.items() if r["fell"]]
figure = f"{reached} steps on each of {len(SEEDS)} seeds" + (f", FELL on {', '.join(fell)}" if fell else "")
figure += "; largest error " + ", ".join(f"{name} {worst[name]:.4f} {UNITS[name]}" for name in LIMITS)
figure += f"; at most {away:.2f} m from its place"
passed = reached >= MUST and within and away <= 1.0
finish(figure, passed and (WANT or not fell), passed and reached >= steps and not fell if WANT else None)

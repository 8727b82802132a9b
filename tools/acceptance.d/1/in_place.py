#!/usr/bin/env python3
"""In place with Tables I and II, ideal actuators and state: 3000 steps (want: 10^5)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BALANCE, WANT, finish, pick, run_all

STEPS = 100_000 if WANT else 3000
LIMITS = {"roll": 0.005, "pitch": 0.005, "height": 0.002, "yaw": 0.1}  # rad, m
UNITS = {"roll": "rad", "pitch": "rad", "height": "m", "yaw": "rad"}

cases = [("in place", [BALANCE, "--seed", 1, "--steps", STEPS])]
result = run_all(cases)["in place"]
worst = {name: pick(result, "error", name, "max") for name in LIMITS}
steps = pick(result, "steps")
within = all(worst[name] <= LIMITS[name] for name in LIMITS)
figure = f"{steps} steps, end {result['end']}; largest error " + ", ".join(
    f"{name} {worst[name]:.4f} {UNITS[name]}" for name in LIMITS)
finish(figure, steps >= 3000 and within, steps >= STEPS and within and not result["fell"] if WANT else None)

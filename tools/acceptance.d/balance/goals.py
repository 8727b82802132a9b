#!/usr/bin/env python3
"""A goal with constant velocity, 100 steps each: mean speed over the last 50 within 10 %."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, SEED, WANT, finish, run_all

STEPS = 100
GOALS = {"0.1 forward": (0.1, 0.0), "0.2 forward": (0.2, 0.0), "0.3 forward": (0.3, 0.0),
         "0.2 backward": (-0.2, 0.0), "0.1 sideways": (0.0, 0.1)}  # m/s
WANTED = {"0.5 forward": (0.5, 0.0)}


def error(result, goal):
    """Relative error of the mean speed along the goal's direction."""
    speed = sum(g * g for g in goal) ** 0.5
    measured = result.get("mean_speed_last_50_mps")
    if not measured:
        return float("inf")
    return abs(sum(m * g for m, g in zip(measured, goal)) / speed**2 - 1)


def good(result, goal):
    return result["steps"] >= STEPS and not result["fell"] and error(result, goal) <= 0.1


goals = dict(GOALS, **(WANTED if WANT else {}))
results = run_all([(name, [BEST, "--seed", SEED, "--steps", STEPS, f"--goal-velocity={x},{y}"])
                   for name, (x, y) in goals.items()])
figure = "; ".join(f"{name}: {r['steps']} steps, {100 * error(r, goals[name]):.1f} %" + (" FELL" if r["fell"] else "")
                   for name, r in results.items())
passed = all(good(results[name], goal) for name, goal in GOALS.items())
finish(figure, passed, passed and good(results["0.5 forward"], WANTED["0.5 forward"]) if WANT else None)

#!/usr/bin/env python3
"""Pushes of 4 N s over 0.1 s: 16 directions x 4 phases after step 16; and 6 N s, reported."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import statistics

from rows import BEST, SEED, finish, run_all

AFTER, MORE = 16, 60  # steps before and after the push


def case(force, direction, phase):
    push = f"{force},0.1,{direction},step {AFTER} phase {phase}"
    # One step more than AFTER + MORE: a push late in a step is followed by 60 complete ones.
    return (force, direction, phase), [BEST, "--seed", SEED, "--steps", AFTER + MORE + 1, "--push", push]


def survives(result):
    return (result["steps"] >= AFTER + MORE and not result["fell"] and result["goal_error_m"] is not None
            and result["goal_error_m"] < 0.5)


def report(results):
    alive = [r for r in results if survives(r)]
    back = [r["goal_error_m"] for r in alive]
    text = f"{len(alive)} of {len(results)}"
    if alive:
        text += f" (back within median {statistics.median(back):.3f} m, worst {max(back):.3f} m)"
    return len(alive), text


results = run_all([case(force, 22.5 * i, phase / 4) for force in (40, 60) for i in range(16) for phase in range(4)])
four, four_text = report([r for key, r in results.items() if key[0] == 40])
six, six_text = report([r for key, r in results.items() if key[0] == 60])
lost = [f"{key[1]:g} deg/{key[2]:g}" for key, r in results.items() if key[0] == 40 and not survives(r)]
figure = f"4 N s: {four_text}; 6 N s: {six_text}" + (f"; lost at 4 N s: {', '.join(lost)}" if lost else "")
finish(figure, four >= 54, four == 64)

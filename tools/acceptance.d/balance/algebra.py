#!/usr/bin/env python3
"""WBOSC against a dense solve of eq. (30) over 1000 seeded states."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

# Largest difference over all states, relative to the largest acceleration involved.
BAR = 1e-9
figures = bench("bench_algebra")
names = ["task_acceleration", "dense_solve", "internal_force", "lower_priority"]
values = {name: float(pick(figures, name)) for name in names}
figure = f"{pick(figures, 'states')} states; " + ", ".join(f"{n.replace('_', ' ')} {v:.1e}" for n, v in values.items())
finish(figure, pick(figures, "states") >= 1000 and all(v <= BAR for v in values.values()))

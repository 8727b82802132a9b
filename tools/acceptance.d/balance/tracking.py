#!/usr/bin/env python3
"""Commanded minus achieved task acceleration in MuJoCo, lift after its first 10 ms, 50 steps."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_tracking")
worst, steps = float(pick(figures, "max_error")), pick(figures, "steps")
finish(f"largest {worst:.2e} m/s^2 or rad/s^2 over {steps} steps", steps >= 50 and worst <= 3e-3, worst <= 1e-3)

#!/usr/bin/env python3
"""A run with logging against a bare mj_step loop over the same steps, same process."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_run_cost")
ratio, factor = float(pick(figures, "ratio")), float(pick(figures, "real_time_factor"))
finish(f"{ratio:.2f} x the bare loop, {factor:.0f} x real time", ratio <= 1.8, ratio <= 1.5)

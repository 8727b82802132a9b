#!/usr/bin/env python3
"""A run in `sea` against a bare mj_step loop over the same physics steps; the tick itself."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_run_cost", "balance_best", "sea")
ratio = float(pick(figures, "ratio"))
allocations = int(pick(figures, "allocations"))
finish(f"{ratio:.2f} x the bare loop, {float(pick(figures, 'real_time_factor')):.0f} x real time, {allocations} "
       f"allocations in a tick", ratio <= 2.5 and allocations == 0, ratio <= 1.8)

#!/usr/bin/env python3
"""A tick on both feet with the tension fed back against one without; allocations."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_cost")
ratio, median = (float(pick(figures, "tension", key)) for key in ("over_dual", "over_dual_median"))
allocations = int(pick(figures, "allocations"))
finish(f"{ratio:.3f} x the tick without feedback (medians {median:.3f}), {allocations} allocations",
       ratio <= 1.05 and allocations == 0)

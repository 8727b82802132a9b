#!/usr/bin/env python3
"""Cost of a tick against mj_step, and of the WBOSC algebra against a naive Appendix A."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_cost")
ratio = {s: float(pick(figures, s, "tick_over_mj_step")) for s in ("dual", "single")}
speedup = {s: float(pick(figures, s, "naive_over_reduced")) for s in ("dual", "single")}
torque = max(float(pick(figures, s, "torque_difference")) for s in ("dual", "single"))
allocations = pick(figures, "allocations")
paced = float(pick(figures, "paced_tick_us"))
tick = "/".join(f"{float(pick(figures, s, 'tick_us')):.2f}" for s in ("dual", "single"))
figure = (f"tick dual/single {tick} us = {ratio['dual']:.2f}/{ratio['single']:.2f} x mj_step, {allocations} allocations; "
          f"algebra {speedup['dual']:.1f}/{speedup['single']:.1f} x faster than naive, torques equal to {torque:.0e}; "
          f"paced tick {paced:.1f} us")
passed = (max(ratio.values()) <= 0.9 and allocations == 0 and speedup["dual"] >= 6 and speedup["single"] >= 4
          and torque <= 1e-9)
finish(figure, passed, passed and max(ratio.values()) <= 0.55)

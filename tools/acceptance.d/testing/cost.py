#!/usr/bin/env python3
"""A scenario with script, expectations, coverage and golden trace against the plain run: wall time, interleaved."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_scenario_cost")
ratio, rounds = float(pick(figures, "ratio")), int(pick(figures, "rounds"))
finish(f"{ratio:.3f} x the plain run (median of {rounds} interleaved rounds)", ratio <= 1.15)

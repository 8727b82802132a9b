#!/usr/bin/env python3
"""Torque differences at the start and the end of each contact transition."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

figures = bench("bench_transitions")
declared, undeclared = float(pick(figures, "declared_Nm")), float(pick(figures, "undeclared_Nm"))
step = float(pick(figures, "max_tick_step_Nm"))  # within 30 ms of a contact change, without the impact tick
finish(f"declared {declared:.2g} Nm, undeclared {undeclared:.1f} Nm; largest step between ticks {step:.2f} Nm",
       declared <= 0.1 and step <= 5.0)

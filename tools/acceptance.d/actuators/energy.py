#!/usr/bin/env python3
"""Energy of rotor, spring and losses over 10 000 random trajectories."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, unit

passed, case = unit("hal/hal_test", "SeriesElastic.EnergyIsBalancedOverRandomTrajectories")
worst = 1e-9 * float(case["worst_ppb"])
finish(f"worst of 10000: {100 * worst:.2g} % of the energy turned over", passed and worst <= 1e-3)

#!/usr/bin/env python3
"""Whole runs in `lab` on the estimate against a bare mj_step loop over the same physics steps; the estimators against
the whole-body algebra of two feet."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish, pick

MUST = {"motion_capture": 0.7, "contact_kalman": 1.5}  # of the whole-body algebra; the want is half
runs = {name: bench("bench_run_cost", name, "lab") for name in ("balance_lab", "balance_no_mocap")}
ratios = [float(pick(run, "ratio")) for run in runs.values()]
parts = bench("bench_estimators")
shares = {name: float(pick(parts, name, "over_wbosc_dual")) for name in MUST}
# With both feet down a filter has more to correct.
shares["contact_kalman"] = max(shares["contact_kalman"], float(pick(parts, "contact_kalman_two_feet", "over_wbosc_dual")))
allocations = int(pick(parts, "allocations")) + sum(int(pick(run, "allocations")) for run in runs.values())
finish(f"{ratios[0]:.2f} and {ratios[1]:.2f} x the bare loop; motion_capture {shares['motion_capture']:.2f}, contact_kalman "
       f"{shares['contact_kalman']:.2f} of the algebra; {allocations} allocations in a tick",
       max(ratios) <= 3 and all(shares[n] <= MUST[n] for n in MUST) and allocations == 0,
       max(ratios) <= 2 and all(shares[n] <= MUST[n] / 2 for n in MUST))

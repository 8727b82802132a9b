#!/usr/bin/env python3
"""[Kim16]'s own configuration in `lab`: 100 seeds beside the robot's 16, 16 and 18 steps. People hold it until its first step."""
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, run_all

runs = run_all([(seed, ["tests/runs/lab/paper_held.yaml", "--seed", seed]) for seed in range(100, 200)])
steps = sorted(run["figures"]["steps"] for run in runs.values())
quartiles = statistics.quantiles(steps, n=4)
finish(f"{len(steps)} seeds: least {steps[0]}, quartiles {', '.join(f'{q:.0f}' for q in quartiles)}, most {steps[-1]} steps "
       f"(the robot: 16, 16, 18); {sum(s >= 16 for s in steps)} reach 16", True)

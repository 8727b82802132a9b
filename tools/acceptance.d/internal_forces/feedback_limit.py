#!/usr/bin/env python3
"""The least unstable feedback of an internal force, over low-passes, delays and torque loops: computed as `check` does,
against bisection in simulation."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import bench, finish

WITHIN, WANTED = 0.15, 0.08  # of the computed limit
LEAST = 10  # cases with legs alike


def main():
    cases = bench("bench_force_feedback")["cases"]
    worst, outside = {True: 0.0, False: 0.0}, 0
    for case in cases:
        found = case["simulated"]
        print(f"{case['name']}: computed {case['computed']:.3f}, simulated {'-' if found is None else format(found, '.3f')}",
              file=sys.stderr)
        if found is None:
            outside += 1
            continue
        worst[case["alike"]] = max(worst[case["alike"]], abs(found / case["computed"] - 1.0))
    alike = [case for case in cases if case["alike"]]
    spans = "; ".join(f"{case['name']}: {case['computed']:.3g}" for case in cases)
    finish(f"{len(alike)} limits, worst {100 * worst[True]:.2f} % from simulation; with legs unlike each other "
           f"{100 * worst[False]:.1f} %; {outside} not found; {spans}",
           len(alike) >= LEAST and not outside and max(worst.values()) <= WITHIN,
           not outside and worst[True] <= WANTED)


if __name__ == "__main__":
    main()

"""Runs in the world `lab`, shared by the rows of this chapter."""
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import run_all


def steps_of(behavior, seeds, steps, *options):
    """Steps by seed, in `lab`."""
    runs = run_all([(seed, [behavior, "--world", "lab", "--seed", seed, "--steps", steps, "--for", f"{0.5 * steps + 20} s",
                            *options]) for seed in seeds])
    return {seed: run["steps"] for seed, run in runs.items()}


def counted(steps, cap):
    """`98 of 100 at 300 (median 300, worst 12; fell 104: 12, 177: 250)`."""
    low = {seed: s for seed, s in steps.items() if s < cap}
    text = f"{len(steps) - len(low)} of {len(steps)} at {cap} (median {statistics.median(steps.values()):.0f}, " \
           f"worst {min(steps.values())}"
    return text + (f"; fell {', '.join(f'{seed}: {s}' for seed, s in low.items())})" if low else ")")


def reached(label, *options):
    """How many of 40 seeds make 300 steps on balance_lab with these options, and the figure."""
    steps = steps_of("balance_lab", range(100, 140), 300, *options)
    return sum(s >= 300 for s in steps.values()), f"{label}: {counted(steps, 300)}"

#!/usr/bin/env python3
"""Size of the log of a stepping minute, and what it costs the tick: CPU of the loop's own thread, mean over a run; the median
of eleven runs, since it depends on which cores the two threads get."""
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BEST, SEED, bench, finish, give_up, pick, run, scratch

RUNS = 11

with scratch() as folder:
    try:
        result = run(BEST, "--seed", SEED, "--for", "60s", "--log", folder, log=True)
    except (OSError, RuntimeError, ValueError) as problem:
        give_up(problem)
    megabytes = (Path(folder) / "log.mcap").stat().st_size / 1e6
if result["time_s"] < 59.9 or result["steps"] < 100:
    give_up(f"only {result['steps']} steps in {result['time_s']} s")
means = sorted(float(pick(bench("bench_log"), "mean_us")) for _ in range(RUNS))
mean = statistics.median(means)
finish(f"{megabytes:.1f} MB a minute, {result['steps']} steps; a tick {mean:.2f} us, median of {RUNS} runs "
       f"({means[0]:.2f} to {means[-1]:.2f})", megabytes < 25.0 and mean <= 0.5, megabytes < 10.0 and mean <= 0.5)

#!/usr/bin/env python3
"""Seeds mean something: the paths of different seeds part, the same seed gives the same log; and how the walking behaviors
fare over 100 seeds of `flat` and of `varied`. `--quick`: 20 seeds instead of 100."""
import csv
import itertools
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from math import hypot
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import BALANCE, BEST, FOOTFALL, PROCESSES, ROOT, SEED, finish, run, run_all, scratch

PAPER = "behaviors/library/balance_paper.yaml"
COUNT = 20 if "--quick" in sys.argv[1:] else 100
PATHS = 20  # seeds whose paths are compared, 40 steps each


def path_of(folder, world, seed):
    """[(x, y), ...] of the CoM at even times, m."""
    log = Path(folder) / f"{world}_{seed}"
    run(BEST, "--world", world, "--seed", seed, "--steps", 40, "--log", log, log=True)
    text = subprocess.run([FOOTFALL, "export", log, "--csv", "--signals", "com.pos.*"], cwd=ROOT, check=True,
                          capture_output=True, text=True).stdout
    rows = csv.DictReader(text.splitlines())
    x, y = (next(name for name in rows.fieldnames if name.startswith(f"com.pos.{axis}")) for axis in "xy")
    return [(float(row[x]), float(row[y])) for row in rows]


def apart(a, b):
    """Distances at the same times, m, while both go on."""
    return [hypot(p[0] - q[0], p[1] - q[1]) for p, q in zip(a, b)]


def paths(folder, world):
    with ThreadPoolExecutor(PROCESSES) as pool:
        return list(pool.map(lambda seed: path_of(folder, world, seed), range(SEED, SEED + PATHS)))


def same_bits(folder):
    logs = []
    for name in ("once", "again"):
        run(BEST, "--world", "varied", "--seed", SEED, "--steps", 40, "--log", Path(folder) / name, log=True)
        logs.append((Path(folder) / name / "log.mcap").read_bytes())
    return logs[0] == logs[1]


def fate(behavior, world, steps):
    """(falls, text) over the seeds; what does not make all its steps counts as a fall."""
    runs = run_all([(seed, [behavior, "--world", world, "--seed", seed, "--steps", steps]) for seed in range(SEED, SEED + COUNT)])
    good = [r for r in runs.values() if r["end"] == "steps"]
    errors = sorted(r["goal_error_m"] for r in good)
    text = f"{Path(behavior).stem} in {world}, {steps} steps: {COUNT - len(good)} of {COUNT} fell"
    if good:
        text += f", goal error median {statistics.median(errors):.3f} m, worst {errors[-1]:.3f} m"
    lost = [str(seed) for seed, r in runs.items() if r["end"] != "steps"]
    return COUNT - len(good), text + (f" (seeds {', '.join(lost)})" if lost else "")


with scratch() as folder:
    flat = statistics.median(max(apart(a, b)) for a, b in itertools.combinations(paths(folder, "flat"), 2))
    varied = statistics.median(apart(a, b)[-1] for a, b in itertools.combinations(paths(folder, "varied"), 2))
    same = same_bits(folder)
best_falls, best = fate(BEST, "varied", 300)
others = [fate(behavior, world, 300)[1] for behavior in (BALANCE, PAPER) for world in ("flat", "varied")]
figure = (f"median pair of {PATHS} seeds: {1e3 * flat:.0f} mm apart in flat, {1e3 * varied:.1f} mm after 40 steps in varied; "
          f"the same seed {'gives the same bits' if same else 'DIFFERS'}; " + "; ".join([best, *others]))
finish(figure, flat > 5e-3 and varied > 2e-3 and same and best_falls <= COUNT // 20, best_falls <= COUNT // 100)

#!/usr/bin/env python3
"""Triped and quadruped: the CoM circles (5 cm) while each internal force follows its own sine, in `ideal` and, estimated, in `lab`."""
import csv
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import subprocess

from rows import FOOTFALL, ROOT, SEED, finish, give_up, run, scratch

ROBOTS = {"triped": (8.0, 3), "quadruped": (6.0, 6)}  # N, amplitude of the sines; how many
CASES = {"ideal": ("", range(SEED, SEED + 1), 0.01, 0.5e-3), "lab": ("_lab", range(SEED, SEED + 10), 0.15, 0.01)}
BEGIN, END = 1.0, 10.99  # s: of the state `circle`


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def errors(behavior, world, seed):
    """(largest rms error of the internal forces in N, how many forces, largest distance of the CoM from its way in m)."""
    place = "com.pos" if world == "ideal" else "truth.com.pos"  # not the estimate
    with scratch() as folder:
        done = run(behavior, "--world", world, "--seed", seed, "--log", folder, log=True)
        if done["end"] != "finished":
            return math.inf, 0, math.inf
        text = subprocess.run([FOOTFALL, "export", folder, "--csv", "--signals", "internal.*", f"{place}.*", "com.ref.*", "--from",
                               f"{BEGIN}s", "--to", f"{END}s"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    rows = list(csv.DictReader(text.splitlines()))
    if not rows:
        give_up(f"no rows in the log of {behavior}")
    names = sorted({key.split(".")[1] for key in rows[0] if key.startswith("internal.")})
    force = max(rms([float(r[f"internal.{n}.reference"]) - float(r[f"internal.{n}.measured"]) for r in rows]) for n in names)
    return force, len(names), max(math.dist([float(r[f"{place}.{a}"]) for a in "xyz"], [float(r[f"com.ref.{a}"]) for a in "xyz"])
                                  for r in rows)


texts, passed, want = [], True, True
for robot, (amplitude, forces) in ROBOTS.items():
    for world, (suffix, seeds, force_bar, motion_bar) in CASES.items():
        results = [errors(f"{robot}_circle{suffix}", world, seed) for seed in seeds]
        force = max(r[0] for r in results) / amplitude
        motion = max(r[2] for r in results)
        texts.append(f"{robot} {world} ({len(results)} seeds): forces {100 * force:.2f} % rms, motion {1e3 * motion:.2f} mm")
        passed = passed and force <= force_bar and motion <= motion_bar and all(r[1] == forces for r in results)
        want = want and force <= force_bar / 2 and motion <= motion_bar / 2
finish("; ".join(texts), passed, passed and want)

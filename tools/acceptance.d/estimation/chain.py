#!/usr/bin/env python3
"""Negative control: with the swing-time rule and without the wider step balance_lab falls in `lab`, and the log shows how.

docs/why-it-falls.md: a step longer than any healthy one comes before, or with, what then throws the robot down.
"""
import json
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, ROOT, SEED, finish, give_up, run_all, scratch

STEPS = 300
SEEDS = range(SEED, SEED + 20)
CONTROL = "tests/runs/regression/behaviors/extension_rule.yaml"
# What throws the robot down: a long step after one of these is its result.
BLOWS = ("fast_foot", "slip", "yaw_rate", "saturated", "tilt")


def chain(log):
    done = subprocess.run([FOOTFALL, "why", str(log), "--fall", "--json"], cwd=ROOT, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=300)
    if done.returncode:
        give_up(f"footfall why --fall: {(done.stderr.strip().splitlines() or ['no message'])[0]}")
    return json.loads(done.stdout)


def chains(behavior):
    """One object of `footfall why --fall --json` a seed."""
    out = []
    for pair in zip(*[iter(SEEDS)] * 2):  # logs take space: two at a time
        with scratch() as folder:
            run_all([(seed, [behavior, "--world", "lab", "--seed", seed, "--steps", STEPS, "--for", "210 s",
                             "--log", f"{folder}/{seed}"]) for seed in pair], log=True)
            out += [chain(f"{folder}/{seed}") for seed in pair]
    return out


def begins_with_a_long_step(fall):
    first = {c["id"]: c["before_end"] for c in fall["crossings"]}
    blows = [first[name] for name in BLOWS if name in first]
    return "long_step" in first and first["long_step"] >= max(blows, default=0)


falls = [c for c in chains(CONTROL) if c["fell"]]
healthy = [c for c in chains("balance_lab") if not c["fell"]]
shown = sum(map(begins_with_a_long_step, falls))
steps = sum(c["healthy"]["steps"] for c in healthy)
long = sum(c["healthy"]["long_step"] for c in healthy)
order = []
for name in dict.fromkeys(c["id"] for f in falls for c in f["crossings"]):
    before = [c["before_end"] for f in falls for c in f["crossings"] if c["id"] == name]
    if 2 * len(before) >= len(falls):
        order.append((-statistics.median(before), name, len(before)))
finish(f"{len(falls)} of {len(SEEDS)} fell, median {statistics.median(f['steps'] for f in falls) if falls else 0:.0f} touchdowns; "
       f"{shown} of them begin with a long step, of which {long} in {steps} steps of balance_lab "
       f"({len(healthy)} of {len(SEEDS)} did not fall); median step of the first crossing, from the last: "
       + ", ".join(f"{name.replace('_', ' ')} {median:g} ({count})" for median, name, count in sorted(order)),
       len(falls) >= 15 and shown >= 0.8 * len(falls) and len(healthy) >= 19 and long <= 0.01 * steps)

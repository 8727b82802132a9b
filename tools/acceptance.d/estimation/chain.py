#!/usr/bin/env python3
"""Negative control: with the swing-time rule and without the wider step balance_lab falls in `lab`, and the log shows how.

docs/why-it-falls.md: each link of the chain is a rate, over all steps of the control: how often what follows comes after
the cause, against how often it comes without. `balance_lab` has neither stretched nor narrow steps.
"""
import csv
import json
import math
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import FOOTFALL, ROOT, SEED, finish, give_up, run_all, scratch

STEPS = 300
SEEDS = range(SEED, SEED + 20)
CONTROL = "tests/runs/regression/behaviors/extension_rule.yaml"
# Of a row of `footfall export --steps`; limits as `footfall why --fall` has them (lab/steps/fall_chain.cc), but for the
# stretched step: 0.16 of the 0.2 s that the rule may take.
OUT = {
    "stretched step": lambda row: row["step_time_s"] > 0.52,
    "narrow step": lambda row: row["width_m"] < 0.10,
    "fast foot": lambda row: row["speed_m_s"] > 0.8,
    "slip": lambda row: max(row["slip_single_m"], row["slip_double_m"]) > 0.006,
    "fast turn": lambda row: max(abs(row["yaw_rate_rad_s"]), abs(row["yaw_rate_after_rad_s"])) > 0.8,
}
# Cause, effect, steps between them, least ratio of the effect's rates with and without the cause. Chosen, with their least
# ratios, on seeds 1 to 60, where each held in both halves.
LINKS = [("stretched step", "narrow step", 0, 2), ("narrow step", "fast foot", 1, 2), ("fast foot", "slip", 0, 5),
         ("fast foot", "fast turn", 0, 5), ("fast turn", "fall within 4 steps", 0, 5)]
LAST = 4
FIRST = 3  # steps of a run's start that no link begins with


def steps_of(log):
    done = subprocess.run([FOOTFALL, "export", str(log), "--steps"], cwd=ROOT, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=300)
    if done.returncode:
        give_up(f"footfall export --steps: {(done.stderr.strip().splitlines() or ['no message'])[0]}")
    numbers = [{k: float(v) if v else math.nan for k, v in row.items() if k != "foot"}
               for row in csv.DictReader(done.stdout.splitlines())]
    return [{**{name: out(row) for name, out in OUT.items()}, "fall within 4 steps": k + LAST >= len(numbers)}
            for k, row in enumerate(numbers)]


def rates(runs, cause, effect, lag):
    """[hits, steps] after the cause, and without it."""
    found = {True: [0, 0], False: [0, 0]}
    for rows in runs:
        for now, then in zip(rows[FIRST:], rows[FIRST + lag:]):
            found[now[cause]][0] += then[effect]
            found[now[cause]][1] += 1
    return found[True], found[False]


def rate(hits, steps):
    return hits / steps if steps else math.nan


def chain(log):
    done = subprocess.run([FOOTFALL, "why", str(log), "--fall", "--json"], cwd=ROOT, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=300)
    if done.returncode:
        give_up(f"footfall why --fall: {(done.stderr.strip().splitlines() or ['no message'])[0]}")
    return json.loads(done.stdout)


def chains(behavior):
    """Of each seed the object of `footfall why --fall --json`, and its steps."""
    out = []
    for pair in zip(*[iter(SEEDS)] * 2):  # logs take space: two at a time
        with scratch() as folder:
            run_all([(seed, [behavior, "--world", "lab", "--seed", seed, "--steps", STEPS, "--for", "210 s",
                             "--log", f"{folder}/{seed}"]) for seed in pair], log=True)
            out += [(chain(f"{folder}/{seed}"), steps_of(f"{folder}/{seed}")) for seed in pair]
    return out


control = chains(CONTROL)
falls = [c for c, _ in control if c["fell"]]
healthy = [(c, rows) for c, rows in chains("balance_lab") if not c["fell"]]
steps = sum(len(rows) for _, rows in healthy)
odd = sum(row["stretched step"] or row["narrow step"] for _, rows in healthy for row in rows)
shown, holds = [], True
for cause, effect, lag, least in LINKS:
    after, without = rates([rows for _, rows in control], cause, effect, lag)
    ratio = rate(*after) / rate(*without) if without[0] else math.inf
    holds = holds and ratio >= least
    shown.append(f"{cause} to {effect} {after[0]} of {after[1]} against {without[0]} of {without[1]} ({ratio:.3g} x)")
order = []
for name in dict.fromkeys(c["id"] for f in falls for c in f["crossings"]):
    before = [c["before_end"] for f in falls for c in f["crossings"] if c["id"] == name]
    if 2 * len(before) >= len(falls):
        order.append((-statistics.median(before), name, len(before)))
finish(f"{len(falls)} of {len(SEEDS)} fell, median {statistics.median(f['steps'] for f in falls) if falls else 0:.0f} touchdowns; "
       f"links: {', '.join(shown)}; stretched or narrow: {odd} of {steps} steps of balance_lab ({len(healthy)} of {len(SEEDS)} "
       "did not fall); median step of the first crossing, from the last: "
       + ", ".join(f"{name.replace('_', ' ')} {median:g} ({count})" for median, name, count in sorted(order)),
       len(falls) >= 15 and holds and len(healthy) >= 19 and odd <= 0.01 * steps)

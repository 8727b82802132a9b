#!/usr/bin/env python3
"""Pushes on the wedges in `wedges_lab`, the state estimated: 0.5 s at the torso, 40 N backwards, 150 N down, and both; the
reference of the internal force by statics. 20 seeds draw what `lab` draws and the error of the believed slopes. A static
robot with feet 30 cm before and behind its middle tips at 69 N. Want: 60 N with feet at 40 cm."""
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from wedge_runs import WANT, WORLDS, each, finish, held_start, scenario_rows, world_text

SEEDS = range(100, 120)
CASES = {"40 N backwards": ["force: 40 N, direction: 180 deg"], "150 N down": ["force: 150 N, elevation: -90 deg"],
         "both": ["force: 40 N, direction: 180 deg", "force: 150 N, elevation: -90 deg"]}


def survives(pushes, seed, apart=None):
    world = None if apart is None else world_text(WORLDS / "wedges_lab.yaml", apart=apart)
    script = held_start(1.0) + [f"{{at: 3 s, push: {{body: torso, {push}, for: 0.5 s}}}}" for push in pushes]
    done, rows = scenario_rows("wedges_push", world or "wedges_lab", seed, ["internal.*"], script, "6 s")
    reference = [2.0 * 0.5 * float(r["internal.tension.reference"]) for r in rows if 2.0 <= float(r["time"]) < 3.0]
    return done["end"] == "time", statistics.median(reference) if reference else float("nan")


def main():
    texts, passed, want = [], True, None
    for name, pushes in CASES.items():
        runs = each(survives, [(pushes, seed) for seed in SEEDS])
        up = sum(stays for stays, _ in runs)
        texts.append(f"{name}: {up} of {len(runs)} (reference {statistics.median(r for _, r in runs):.0f} N)")
        passed = passed and up >= 19
    if WANT:
        runs = each(survives, [(["force: 60 N, direction: 180 deg"], seed, 0.40) for seed in SEEDS])
        up = sum(stays for stays, _ in runs)
        texts.append(f"60 N backwards, feet at 40 cm: {up} of {len(runs)}")
        want = up >= 19
    finish("; ".join(texts), passed, want)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""balance_lab in `lab` behind a goal of 0.2 and 0.35 m/s (want: 0.5): 40 seeds of 300 steps each."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import counted, steps_of

from rows import WANT, finish


def reached(speed):
    steps = steps_of("balance_lab", range(100, 140), 300, "--goal-velocity", f"{speed},0")
    return sum(s >= 300 for s in steps.values()), f"{speed} m/s: {counted(steps, 300)}"


slow, text = reached(0.2)
fast, more = reached(0.35)
figures = [text, more]
want = None
if WANT:
    fastest, more = reached(0.5)
    figures.append(more)
    want = fastest >= 36
finish("; ".join(figures), slow >= 38 and fast >= 36, want)

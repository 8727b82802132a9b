#!/usr/bin/env python3
"""balance_lab in `lab` on friction 0.5 and 0.3 (want: 0.2): 40 seeds of 300 steps each."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import counted, steps_of

from rows import WANT, finish


def reached(friction):
    steps = steps_of("balance_lab", range(100, 140), 300, "--set", f"world.ground.friction={friction}")
    return sum(s >= 300 for s in steps.values()), f"friction {friction}: {counted(steps, 300)}"


half, text = reached(0.5)
third, more = reached(0.3)
figures = [text, more]
want = None
if WANT:
    fifth, more = reached(0.2)
    figures.append(more)
    want = fifth >= 32
finish("; ".join(figures), half >= 38 and third >= 36, want)

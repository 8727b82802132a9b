#!/usr/bin/env python3
"""balance_lab in `lab` behind a goal of 0.2 and 0.35 m/s (want: 0.5): 40 seeds of 300 steps each."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import reached

from rows import WANT, finish

slow, text = reached("0.2 m/s", "--goal-velocity", "0.2,0")
fast, more = reached("0.35 m/s", "--goal-velocity", "0.35,0")
figures = [text, more]
want = None
if WANT:
    fastest, more = reached("0.5 m/s", "--goal-velocity", "0.5,0")
    figures.append(more)
    want = fastest >= 36
finish("; ".join(figures), slow >= 38 and fast >= 36, want)

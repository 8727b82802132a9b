#!/usr/bin/env python3
"""balance_lab in `lab` on friction 0.5 and 0.3 (want: 0.2): 40 seeds of 300 steps each."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import reached

from rows import WANT, finish

half, text = reached("friction 0.5", "--set", "world.ground.friction=0.5")
third, more = reached("friction 0.3", "--set", "world.ground.friction=0.3")
figures = [text, more]
want = None
if WANT:
    fifth, more = reached("friction 0.2", "--set", "world.ground.friction=0.2")
    figures.append(more)
    want = fifth >= 32
finish("; ".join(figures), half >= 38 and third >= 36, want)

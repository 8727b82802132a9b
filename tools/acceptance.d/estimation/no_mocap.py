#!/usr/bin/env python3
"""balance_no_mocap in `lab` (IMU, joints and contacts; gyro bias unknown at the start): 100 seeds of 300 steps, 40 of 1000."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import counted, steps_of

from rows import WANT, finish

near = steps_of("balance_no_mocap", range(100, 200), 300)
far = steps_of("balance_no_mocap", range(100, 140), 1000)
figures = [counted(near, 300), counted(far, 1000)]
passed = sum(s >= 300 for s in near.values()) >= 90 and sum(s >= 1000 for s in far.values()) >= 36
want = None
if WANT:
    longest = steps_of("balance_no_mocap", range(100, 120), 3000)
    figures.append(counted(longest, 3000))
    want = sum(s >= 3000 for s in longest.values()) >= 19
finish("; ".join(figures) + "; drawn: start, actuators, sensors, floor, control model", passed, want)

#!/usr/bin/env python3
"""Gains exchanged between stance and swing at random moments."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, unit

jump, changed = unit("hal/hal_test", "TorqueLoop.AChangeOfGainsLeavesTheCommandContinuous")
jolt, moved = unit("hal/hal_test", "Drive.AChangeBetweenStanceAndSwingNeitherJumpsNorJolts")
step = float(moved["jolt"])
finish(f"1000 random changes: the motor's command continuous to {float(changed['worst']):.1g} nNm; spring torque in a "
       f"tick steps by {step:.2f} Nm more than without the change", jump and jolt and step <= 2)

#!/usr/bin/env python3
"""1000 live edits of torque loops while the robot steps on its springs."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, unit

passed, case = unit("engine/engine_test", "HardwareLink.AThousandLiveEditsWhileSteppingOnSpringsNeitherFellNorJolt")
saved, _ = unit("behaviors/behaviors_test", "SaveTorqueLoops.*Random*")
step, command = float(case["torque_step"]), float(case["command_step"])
finish(f"{case['edits']} edits, no fall; measured torque steps by {step:.2f} Nm at most (its command {command:.1f}); "
       f"200 rounds of saving {'bit for bit' if saved else 'FAILED'}", passed and saved and step <= command + 2)

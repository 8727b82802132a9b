#!/usr/bin/env python3
"""Frequency response of both torque loops against the sampled transfer function, output locked and free."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, unit

passed, case = unit("hal/hal_test", "Drive.RespondsAsTheSampledTransferFunctionLockedAndFree")
gain, phase = 100 * float(case["gain"]), float(case["phase_deg"])
finish(f"1 to 100 Hz, both types, locked and free, delay 0 and a tick: gain within {gain:.2g} %, phase within "
       f"{phase:.2g} deg of the sampled transfer function", passed and gain <= 2 and phase <= 2)

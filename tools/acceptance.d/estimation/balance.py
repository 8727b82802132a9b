#!/usr/bin/env python3
"""balance_lab in `lab` (motion capture, Appendix C in the loop): 100 seeds of 300 steps, 40 of 1000."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from lab_runs import counted, steps_of

from rows import WANT, finish

near = steps_of("balance_lab", range(100, 200), 300)
far = steps_of("balance_lab", range(100, 140), 1000)
figures = [counted(near, 300), counted(far, 1000)]
passed = sum(s >= 300 for s in near.values()) >= 95 and sum(s >= 1000 for s in far.values()) >= 38
want = None
if WANT:
    longest = steps_of("balance_lab", range(100, 110), 10_000)
    rough = steps_of("balance_lab", range(100, 140), 300, *(f"--set={x}" for x in (
        "world.ground.friction=0.5", "world.sensors.gyro.noise=0.03", "world.sensors.gyro.bias=0.75deg/s",
        "world.sensors.accelerometer.noise=0.21", "world.sensors.accelerometer.bias=0.09",
        "world.sensors.mocap.noise=3mm", "world.sensors.mocap.placement=3mm", "world.sensors.mocap.occlusion=15%",
        "world.sensors.joint.resolution=1.14e-3")))
    figures += [counted(longest, 10_000), "noise x3, friction 0.5: " + counted(rough, 300)]
    want = sum(s >= 10_000 for s in longest.values()) >= 9 and sum(s >= 300 for s in rough.values()) >= 36
finish("; ".join(figures) + "; drawn: start, actuators, sensors, floor, control model", passed, want)
